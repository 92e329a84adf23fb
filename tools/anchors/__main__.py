"""Makes the numbers that the tests hold umov against, from the formulas of docs/theory.

    .deps/venv/bin/python tools/anchors            writes tests/data/anchors
    .deps/venv/bin/python tools/anchors --check    says where what is stored is not what comes out

Nothing here reads or calls umov's own code. Each table names the formulas that it was made from; values that
stand as literals in a source (the text of `umov paper`, tests of one number) are listed in quotes.py, and
--check looks for them there."""

import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))

from quotes import missing_quotes  # noqa: E402
from tables import TABLES, text_of  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "tests/data/anchors"


def main(arguments):
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    check, bad, began = arguments == ["--check"], 0, time.time()
    texts = {name: text_of(table) for name, table in TABLES.items()}
    if check:
        for name, text in texts.items():
            path = FOLDER / f"{name}.csv"
            stored = path.read_text() if path.exists() else ""
            for number, (have, want) in enumerate(zip(stored.splitlines(), text.splitlines()), 1):
                if have != want:
                    print(f"{path.relative_to(ROOT)}:{number}: {have!r}, but the formulas give {want!r}")
                    bad += 1
            if len(stored.splitlines()) != len(text.splitlines()):
                print(f"{path.relative_to(ROOT)}: {len(stored.splitlines())} lines, expected "
                      f"{len(text.splitlines())}")
                bad += 1
        for path in FOLDER.glob("*.csv"):
            if path.stem not in texts:
                print(f"{path.relative_to(ROOT)}: nothing makes this table")
                bad += 1
    else:
        FOLDER.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (FOLDER / f"{name}.csv").write_text(text)
    for complaint in missing_quotes(ROOT, texts):
        print(complaint)
        bad += 1
    verb = "checked" if check else "written"
    print(f"anchors: {len(texts)} tables {verb}, {bad} wrong, {time.time() - began:.1f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
