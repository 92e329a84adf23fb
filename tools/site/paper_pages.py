"""The paper remade, for the site: what `umov paper` writes, made once and kept."""
from __future__ import annotations

import csv
import hashlib
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "build/release/paper"
#: What a verdict of the table means, in words of the page.
VERDICTS = {"shown": "shown", "agrees": "agrees", "partly": "agrees in part", "differs": "differs"}


def _key() -> str:
    """Changes with what the library is made of."""
    digest = hashlib.sha256()
    for folder in ("include", "src", "data"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "tests" not in path.parts:
                digest.update(path.read_bytes())
    return digest.hexdigest()


def made(umov: str | pathlib.Path) -> pathlib.Path:
    """The folder of one whole run of these sources, of which all checks hold: minutes where there is none yet."""
    stamp = KEPT.with_suffix(".made_of")
    key = _key()
    if not stamp.exists() or stamp.read_text() != key:
        done = subprocess.run([umov, "paper", "-o", KEPT, "-q", "--force"], text=True, capture_output=True, timeout=3600)
        if done.returncode != 0:
            raise RuntimeError(done.stdout[-2000:] + done.stderr[-4000:])
        missed = [f"{check['figure']}, {check['number']}: {check['found']}" for check in _rows(KEPT / "checks.ecsv") if check["holds"] != "yes"]
        if missed:
            raise RuntimeError("umov paper: these numbers are not their independent values: " + "; ".join(missed))
        stamp.write_text(key)
    return KEPT


def _rows(path: pathlib.Path) -> list[dict[str, str]]:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines, delimiter=" "))


def _name(figure: str) -> str:
    kind, number = re.fullmatch(r"([a-z]+)_?(\w+)", figure).groups()  # type: ignore[union-attr]
    return {"fig": "Figure", "table": "Table"}.get(kind, "Claim:") + " " + number.replace("_", " ")


def _order(path: pathlib.Path) -> list[object]:
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", path.name)]


def pictures(folder: pathlib.Path) -> list[pathlib.Path]:
    """Of all figures, in their order."""
    return sorted([*folder.glob("*.svg"), *folder.glob("*.png")], key=_order)


def markdown(folder: pathlib.Path, place: str) -> str:
    """A page of verdicts, each with its pictures, which stand in `place`."""
    verdicts, checks = _rows(folder / "verdicts.ecsv"), _rows(folder / "checks.ecsv")
    out = ("# The paper remade\n*Real Time Polarization Light Curves for Space Debris and Satellites*, figure by figure and claim by\n"
           f"claim, as this build remade it with `umov paper`: {len(verdicts)} of them, {len(checks)} numbers within the\n"
           "tolerance of their independent value. [What was changed](theory/paper.md) in the paper's equations, and why.\n\n"
           "```{raw} html\n<p><a href=\"paper/index.html\">The same as one page</a>, with what the paper says, how each was\n"
           "done, every check and figures to look into.</p>\n```\n\n")
    for row in verdicts:
        figure = row["figure"]
        own = [check for check in checks if check["figure"] == figure]
        out += f"## {_name(figure)}\n**{VERDICTS.get(row['verdict'], row['verdict'])}**: {row['summary']}."
        if own:
            out += f" {sum(check['holds'] == 'yes' for check in own)} of {len(own)} checks hold."
        out += "\n\n"
        for number, picture in enumerate((one for one in pictures(folder) if one.name.startswith(f"{figure}_")), 1):
            out += f"![{_name(figure)}, picture {number}]({place}/{picture.name})\n"
        out += "\n"
    return out
