"""Pages of python/gallery as notebooks, run by a Jupyter kernel: once for each build, kept with what they gave.

A page is a script in cells ("# %%", "# %% [markdown]"), of which a notebook is made, and a kernel of this interpreter
runs it in a folder of its own, as Jupyter does. The tests run them and the site shows them, with what the cells gave.
"""
from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
from collections.abc import Iterator

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "build/release/python"
KEPT = ROOT / "build/release/gallery"
#: Of pages with a figure that turns: from the site itself.
PLOTLY = '<script src="../_static/plotly.min.js"></script>'
#: What a kernel is told beside the environment: figures stand in the page, and a figure that turns brings no script.
SETTINGS = {"PYTHONPATH": str(PACKAGE), "XDG_CACHE_HOME": str(KEPT / "cache"), "NO_COLOR": "1",
            "MPLBACKEND": "module://matplotlib_inline.backend_inline", "PLOTLY_RENDERER": "plotly_mimetype",
            "PYDEVD_DISABLE_FILE_VALIDATION": "1"}
os.environ.setdefault("JUPYTER_PREFER_ENV_PATH", "1")  # the kernel of this environment, not the user's


def pages() -> list[pathlib.Path]:
    return sorted((ROOT / "python/gallery").glob("*.py"))


def _cells(text: str) -> Iterator[NotebookNode]:
    for number, part in enumerate(part for part in re.split(r"^# %%", text, flags=re.MULTILINE) if part.strip()):
        first, _, body = part.partition("\n")
        if first.strip() == "[markdown]":
            lines = (line.removeprefix("#").removeprefix(" ") for line in body.strip().splitlines())
            cell = nbformat.v4.new_markdown_cell("\n".join(lines))
        else:
            cell = nbformat.v4.new_code_cell(body.strip())
        cell["id"] = f"cell-{number}"  # the same in every build
        yield cell


def unrun(page: pathlib.Path) -> NotebookNode:
    """The page as a notebook without outputs."""
    made = nbformat.v4.new_notebook(cells=list(_cells(page.read_text(encoding="utf-8"))))
    made["metadata"]["kernelspec"] = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return made


def execute(notebook: NotebookNode, folder: pathlib.Path) -> NotebookNode:
    """Runs it in a folder; a cell that fails raises CellExecutionError with its traceback."""
    client = NotebookClient(notebook, timeout=300, kernel_name="python3", coalesce_streams=True,
                            extra_arguments=["--IPKernelApp.log_level=40"],  # of sockets: they are those of the loopback
                            resources={"metadata": {"path": str(folder)}})
    client.execute(env={**os.environ, **SETTINGS})
    for cell in notebook["cells"]:
        cell["metadata"].pop("execution", None)  # when it ran: another file in every build
        for output in cell.get("outputs", ()):
            if output["output_type"] == "stream":
                output["text"] = _without_places(output["text"])
    return notebook


def _without_places(text: str) -> str:
    """Without the folders of this machine: warnings by their words, files of the package by their names."""
    text = re.sub(r"^/\S+/ipykernel_\d+/\d+\.py:\d+: (\w+: .*)\n.*\n", r"\1\n", text, flags=re.MULTILINE)
    return text.replace(f"{PACKAGE}/umov/files/", "")


def _key(page: pathlib.Path) -> str:
    """Changes with the page and with everything of the package."""
    digest = hashlib.sha256(page.read_bytes() + pathlib.Path(__file__).read_bytes())
    for path in sorted((PACKAGE / "umov").rglob("*")):
        if path.suffix in (".py", ".so"):
            digest.update(path.read_bytes())
    return digest.hexdigest()


def run(page: pathlib.Path) -> NotebookNode:
    """The page as a notebook with what its cells gave."""
    kept, key = KEPT / f"{page.stem}.ipynb", _key(page)
    if kept.exists():
        told = nbformat.read(kept, as_version=4)
        if told["metadata"].get("umov_key") == key:
            return told
    folder = KEPT / page.stem
    folder.mkdir(parents=True, exist_ok=True)
    made = execute(unrun(page), folder)
    made["metadata"]["umov_key"] = key
    nbformat.validate(made)
    nbformat.write(made, kept)
    return made


def file_of(notebook: NotebookNode) -> str:
    """The .ipynb file, without what is ours alone."""
    out = nbformat.from_dict(notebook)
    out["metadata"].pop("umov_key", None)
    return str(nbformat.writes(out)) + "\n"


def pictures(notebook: NotebookNode) -> list[bytes]:
    """PNG files that the cells show, in order."""
    return [base64.b64decode(output["data"]["image/png"]) for cell in notebook["cells"]
            for output in cell.get("outputs", ()) if "image/png" in output.get("data", {})]


def _plotly_html(figure: dict[str, object]) -> str:
    """A figure that turns: the site has the script, the page is told so."""
    from plotly.io import to_html
    return str(to_html(figure, full_html=False, include_plotlyjs=False, default_height="520px", validate=False))


def _shown(output: NotebookNode, picture: str) -> str:
    """What a cell gave, in the words of the site."""
    data = output.get("data", {})
    if output["output_type"] == "stream":
        return f"```{{code-block}} text\n:class: output\n\n{output['text'].rstrip()}\n```\n\n"
    if "application/vnd.plotly.v1+json" in data:
        html = _plotly_html(data["application/vnd.plotly.v1+json"])
    elif "image/png" in data:
        return f"{picture}\n\n"
    elif "text/html" in data:
        html = data["text/html"]
    else:
        return f"```{{code-block}} text\n:class: output\n\n{data['text/plain']}\n```\n\n" if data else ""
    return "```{raw} html\n<div class=\"output\">" + html + "</div>\n```\n\n"


def markdown(page: pathlib.Path, notebook: NotebookNode, folder: str) -> str:
    """The page for the site, whose pictures stand in `folder` as PAGE_1.png and so on."""
    out, number = "", 0
    for cell in notebook["cells"]:
        if cell["cell_type"] == "markdown":
            out += cell["source"] + "\n\n"
            continue
        out += f"```python\n{cell['source']}\n```\n\n"
        for output in cell["outputs"]:
            number += "image/png" in output.get("data", {})
            shown = _shown(output, f"![{_caption(out)}]({folder}/{page.stem}_{number}.png)")
            if "plotly-graph-div" in shown and PLOTLY not in out:
                out += f"```{{raw}} html\n{PLOTLY}\n```\n\n"
            out += shown
    links = f"<a download href=\"notebooks/{page.stem}.ipynb\">notebook</a> or <a download href=\"notebooks/{page.name}\">script</a>"
    return out + f"```{{raw}} html\n<p class=\"download\">This page as a {links}.</p>\n```\n"


def _caption(so_far: str) -> str:
    """For those who do not see the picture: the heading of the page."""
    heading = re.search(r"^# (.*)$", so_far, re.MULTILINE)
    return heading.group(1) if heading else "a figure"
