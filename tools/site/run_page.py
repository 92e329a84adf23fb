"""Runs a page of python/gallery cell by cell: run_page.py PAGE OUT.json (see gallery.py)."""
import ast
import contextlib
import io
import json
import pathlib
import re
import sys


def cells_of(text):
    for part in re.split(r"^# %%", text, flags=re.MULTILINE):
        if not part.strip():
            continue
        first, _, body = part.partition("\n")
        if first.strip() == "[markdown]":
            yield "markdown", "\n".join(line.removeprefix("#").removeprefix(" ") for line in body.strip().splitlines())
        else:
            yield "code", body.strip()


def value_of(source, page, names):
    """Runs the lines of a cell; the value of the last one, if it is an expression."""
    tree = ast.parse(source, str(page))
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, str(page), "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), str(page), "eval"), names)


def html_of(value):
    if hasattr(value, "to_plotly_json"):  # the site has the script, the page is told so
        return value.to_html(full_html=False, include_plotlyjs=False, default_height="520px")
    show = getattr(value, "_repr_html_", None)
    return (show() or "") if show is not None else ""


def main(page, out):
    cells, names, seen = [], {"__name__": "__main__", "__file__": str(page)}, set()
    for kind, source in cells_of(page.read_text()):
        cell = {"kind": kind, "source": source, "printed": "", "text": "", "html": "", "pictures": []}
        if kind == "code":
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                value = value_of(source, page, names)
            pictures = sorted(path.name for path in pathlib.Path().glob("*.png") if path.name not in seen)
            seen.update(pictures)
            cell |= {"printed": printed.getvalue(), "pictures": pictures}
            html = html_of(value)  # what has no picture of itself was a call, made for what it does
            if html:
                cell |= {"text": repr(value)[:200], "html": html}
        cells.append(cell)
    out.write_text(json.dumps({"cells": cells}))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]))
