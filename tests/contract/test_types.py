"""Frames, bases, angles and time scales that do not fit together do not compile."""
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILES = sorted((pathlib.Path(__file__).parent / "types").glob("*.cpp"))


def compiled(path, *flags):
    return subprocess.run(["g++", "-std=c++20", "-fsyntax-only", f"-I{ROOT}/include", *flags, path],
                          text=True, capture_output=True, timeout=120, env={"LC_ALL": "C", "PATH": "/usr/bin"})


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_refused(path):
    good, bad = compiled(path), compiled(path, "-DBAD")
    assert good.returncode == 0, good.stderr
    # It fails for the reason that its first line names, and not for a misspelt header, say.
    reason = path.read_text().splitlines()[0].removeprefix("// refused: ")
    assert bad.returncode != 0 and reason in bad.stderr, bad.stderr
