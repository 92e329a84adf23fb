"""Looks through the finished site: check.py SITE. Nothing is loaded from the network, links lead somewhere."""
from __future__ import annotations

import html.parser
import pathlib
import re
import sys
import urllib.parse


class _Page(html.parser.HTMLParser):
    """What a page loads, where it leads, and the places that others may lead to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.links: list[str] = []
        self.places: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = {key: value or "" for key, value in attrs}
        self.places.update(told[key] for key in ("id", "name") if key in told)
        if tag == "a" and "href" in told:
            self.links.append(told["href"])
        elif tag in ("img", "script", "iframe", "source") and "src" in told:
            self.loads.append(told["src"])
        elif tag == "link" and told.get("rel") in ("stylesheet", "icon", "preload", "shortcut icon"):
            self.loads.append(told.get("href", ""))


def _is_outside(link: str) -> bool:
    return bool(re.match(r"(https?:)?//|mailto:", link))


def _faults_of_links(path: pathlib.Path, pages: dict[pathlib.Path, _Page]) -> list[str]:
    out = []
    for link in pages[path].links + pages[path].loads:
        if _is_outside(link) or link.startswith(("javascript:", "data:")) or link in ("", "#"):
            continue
        file, _, place = link.partition("#")
        file = urllib.parse.unquote(file.partition("?")[0])
        target = (path.parent / file).resolve() if file else path
        if target.is_dir():
            target /= "index.html"
        if not target.exists():
            out.append(f"{path}: no file {link}")
        elif place and target in pages and urllib.parse.unquote(place) not in pages[target].places:
            out.append(f"{path}: no such place {link}")
    return out


def main(site: pathlib.Path) -> int:
    site = site.resolve()
    pages = {path: _Page(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    faults = []
    for path, page in pages.items():
        faults += [f"{path}: loads {load}" for load in page.loads if _is_outside(load)]
        # Doxygen looks after its own links.
        if "cpp" not in path.relative_to(site).parts:
            faults += _faults_of_links(path, pages)
    for style in site.rglob("*.css"):
        text = style.read_text(encoding="utf-8", errors="replace")
        faults += [f"{style}: loads {found}" for found in re.findall(r"(?:url\(|@import )[\"']?(?:https?:)?//[^)\"']*", text)]
    print("\n".join(faults), end="\n" if faults else "", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
