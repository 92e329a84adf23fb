"""Gathers the pages of the documentation site: stage.py OUT UMOV. Sphinx reads OUT (tools/docs).

Pages of docs/ come as they are, with their equations set; those of docs/site are of the site alone; the gallery is
run, and the command line told by the command itself.
"""
from __future__ import annotations

import pathlib
import re
import subprocess
import sys
import textwrap

import equations
import gallery
import paper_pages

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Pages:
    """A folder of files, written only where they changed, so that Sphinx reads no page twice."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        self._written: set[pathlib.Path] = set()

    def put(self, name: str, text: str | bytes) -> None:
        path = self.folder / name
        data = text.encode() if isinstance(text, str) else text
        path.parent.mkdir(parents=True, exist_ok=True)
        self._written.add(path)
        if not path.exists() or path.read_bytes() != data:
            path.write_bytes(data)

    def drop_others(self) -> None:
        for path in self.folder.rglob("*"):
            if path.is_file() and path not in self._written:
                path.unlink()


def put_docs(pages: Pages) -> None:
    docs = ROOT / "docs"
    for path in sorted(docs.rglob("*")):
        name = path.relative_to(docs)
        if path.is_dir() or path.name in ("README.md", "Doxyfile") or "__pycache__" in name.parts:
            continue
        if name.parts[0] == "site":
            pages.put(str(name.relative_to("site")), path.read_bytes())
        elif path.suffix == ".md":
            text = re.sub(r"\.\./python/gallery/(\w+)\.py", r"gallery/\1.md", path.read_text())
            pages.put(str(name), equations.with_equations(text))
        else:
            pages.put(str(name), path.read_bytes())
    for page in ("CHANGELOG.md", "CONTRIBUTING.md"):
        # Links to the pages, which stand one folder higher here.
        pages.put(page.lower(), (ROOT / page).read_text().replace("](docs/", "]("))


def put_gallery(pages: Pages) -> None:
    rows = ""
    for page in gallery.pages():
        notebook = gallery.run(page)
        for number, picture in enumerate(gallery.pictures(notebook), 1):
            pages.put(f"gallery/pictures/{page.stem}_{number}.png", picture)
        pages.put(f"gallery/{page.stem}.md", gallery.markdown(page, notebook, "pictures"))
        pages.put(f"extra/gallery/notebooks/{page.stem}.ipynb", gallery.file_of(notebook))
        pages.put(f"extra/gallery/notebooks/{page.name}", page.read_bytes())
        rows += f"{page.stem}\n"
    head = ("# Gallery\nQuestions that people come with. Each page is a notebook and a script, and the tests run it;\n"
            "what it prints and draws here is what this build gave.\n\n")
    pages.put("gallery/index.md", head + "```{toctree}\n:maxdepth: 1\n\n" + rows + "```\n")


def _help_of(umov: str, verb: list[str]) -> str:
    return subprocess.run([umov, *verb, "--help"], capture_output=True, text=True, check=True).stdout


def wrapped(told: str, width: int = 88) -> str:
    """Help whose lines fit a page; what goes on stands below where its meaning begins."""
    out = []
    for line in told.splitlines():
        head = re.match(r" {20,}|\s*\S.*?  +|", line).group()
        out += textwrap.wrap(line, width, subsequent_indent=" " * len(head), break_long_words=False) if len(line) > width else [line]
    return "\n".join(out)


def put_command_line(pages: Pages, umov: str) -> None:
    """Every verb with what it says of itself."""
    text = ("# The command line\nWhat `umov VERB --help` says; `umov man` has all of it as a manual page, `umov completion`\n"
            "completes it in a shell. Exit codes: 0 done; 1 a fault of umov; 2 wrong usage; 3 bad input; 4 physics or\n"
            "numerics; 5 nothing to report; 6 device missing, disk full or not writable; 130 interrupted.\n\n")

    def add(verb: list[str]) -> None:
        nonlocal text
        told = _help_of(umov, verb)
        if verb:
            text += f"{'#' * (1 + len(verb))} umov {' '.join(verb)}\n"
        text += f"```text\n{wrapped(told.strip())}\n```\n\n"
        _, _, below = told.partition("\nSubcommands:\n")
        for name in re.findall(r"^  (\w+) {2,}", below, re.MULTILINE):
            add([*verb, name])

    add([])
    pages.put("command_line.md", text)


def put_paper(pages: Pages, umov: str) -> None:
    """Verdicts with their pictures, and the page that the command wrote."""
    folder = paper_pages.made(umov)
    pages.put("paper.md", paper_pages.markdown(folder, "paper_pictures"))
    for picture in paper_pages.pictures(folder):
        pages.put(f"paper_pictures/{picture.name}", picture.read_bytes())
    pages.put("extra/paper/index.html", (folder / "index.html").read_bytes())


def put_plotly(pages: Pages) -> None:
    """The script of figures that turn: in the site, so that no page asks the network."""
    import plotly
    script = pathlib.Path(plotly.__file__).parent / "package_data/plotly.min.js"
    pages.put("static/plotly.min.js", script.read_bytes())


def main(out: pathlib.Path, umov: str) -> None:
    pages = Pages(out)
    put_docs(pages)
    put_gallery(pages)
    put_command_line(pages, umov)
    put_paper(pages, umov)
    put_plotly(pages)
    pages.drop_others()


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2])
