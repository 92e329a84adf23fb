"""Pages of python/gallery as notebooks: run once for each build, kept with what they printed and drew.

A page is a script in cells ("# %%", "# %% [markdown]"). It is run in a folder of its own; what a cell prints, the
value of its last line and the pictures that it saves belong to the cell. tools/docs shows them, the tests ask for them.
"""
from __future__ import annotations

import base64
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "build/release/python"
KEPT = ROOT / "build/release/gallery"
#: Of pages with a figure that turns: from the site itself.
PLOTLY = '<script src="../_static/plotly.min.js"></script>'
RUNNER = pathlib.Path(__file__).with_name("run_page.py")


def pages() -> list[pathlib.Path]:
    return sorted((ROOT / "python/gallery").glob("*.py"))


def _key(page: pathlib.Path) -> str:
    """Changes with the page and with everything of the package."""
    digest = hashlib.sha256(page.read_bytes() + RUNNER.read_bytes() + pathlib.Path(__file__).read_bytes())
    for path in sorted((PACKAGE / "umov").glob("*")):
        if path.suffix in (".py", ".so"):
            digest.update(path.read_bytes())
    return digest.hexdigest()


def run(page: pathlib.Path) -> dict[str, object]:
    """What a page printed and drew: {"cells": [...], "pictures": {name: base64}}. A page that fails raises
    RuntimeError with its traceback."""
    kept, key = KEPT / f"{page.stem}.json", _key(page)
    if kept.exists():
        told: dict[str, object] = json.loads(kept.read_text())
        if told.get("key") == key:
            return told
    folder = KEPT / page.stem
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE), "MPLBACKEND": "Agg",
                   "XDG_CACHE_HOME": str(KEPT / "cache"), "NO_COLOR": "1"}
    done = subprocess.run([sys.executable, RUNNER, page, "cells.json"], cwd=folder, env=environment,
                          capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise RuntimeError(f"{page.name}: {done.stderr}")
    told = json.loads((folder / "cells.json").read_text())
    told["key"] = key
    told["pictures"] = {path.name: base64.b64encode(path.read_bytes()).decode() for path in folder.glob("*.png")}
    kept.write_text(json.dumps(told))
    return told


def _outputs(cell: dict[str, object], pictures: dict[str, str]) -> list[dict[str, object]]:
    out: list[dict[str, object]] = []
    if cell["printed"]:
        out.append({"output_type": "stream", "name": "stdout", "text": cell["printed"]})
    data: dict[str, object] = {}
    if cell["text"]:
        data["text/plain"] = cell["text"]
    if cell["html"]:
        data["text/html"] = cell["html"]
    if data:
        out.append({"output_type": "display_data", "metadata": {}, "data": data})
    for name in cell["pictures"]:  # type: ignore[attr-defined]
        out.append({"output_type": "display_data", "metadata": {}, "data": {"image/png": pictures[name]}})
    return out


def notebook(told: dict[str, object]) -> str:
    """The page as a notebook (nbformat 4.5) with its outputs."""
    cells = []
    for number, cell in enumerate(told["cells"]):  # type: ignore[arg-type,var-annotated]
        one = {"id": f"cell-{number}", "cell_type": cell["kind"], "metadata": {}, "source": cell["source"]}
        if cell["kind"] == "code":
            one |= {"execution_count": None, "outputs": _outputs(cell, told["pictures"])}  # type: ignore[arg-type]
        cells.append(one)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": cells}, indent=1)


def markdown(page: pathlib.Path, told: dict[str, object], pictures: pathlib.Path) -> str:
    """The page for the site; its pictures go into a folder."""
    pictures.mkdir(parents=True, exist_ok=True)
    out = ""
    for cell in told["cells"]:  # type: ignore[attr-defined]
        if cell["kind"] == "markdown":
            out += cell["source"] + "\n\n"
            continue
        out += f"```python\n{cell['source']}\n```\n\n"
        if cell["printed"]:
            out += f"```{{code-block}} text\n:class: output\n\n{cell['printed'].rstrip()}\n```\n\n"
        if cell["html"]:
            if "plotly-graph-div" in cell["html"] and PLOTLY not in out:
                out += f"```{{raw}} html\n{PLOTLY}\n```\n\n"
            out += "```{raw} html\n<div class=\"output\">" + cell["html"] + "</div>\n```\n\n"
        for name in cell["pictures"]:
            (pictures / f"{page.stem}_{name}").write_bytes(base64.b64decode(told["pictures"][name]))  # type: ignore[index]
            out += f"![{_caption(out, name)}]({pictures.name}/{page.stem}_{name})\n\n"
    links = f"<a download href=\"notebooks/{page.stem}.ipynb\">notebook</a> or <a download href=\"notebooks/{page.name}\">script</a>"
    return out + f"```{{raw}} html\n<p class=\"download\">This page as a {links}.</p>\n```\n"


def _caption(so_far: str, name: str) -> str:
    """For those who do not see the picture: the heading of the page."""
    heading = re.search(r"^# (.*)$", so_far, re.MULTILINE)
    return heading.group(1) if heading else name
