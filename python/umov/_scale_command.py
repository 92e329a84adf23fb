"""The command umov, as what runs jobs in parts calls it."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import sysconfig
import warnings
from typing import Any

from ._jobs import _stack_level
from .errors import DeviceError, InputError, UmovWarning, error_from


def find_program(program: str | None) -> str:
    """The command beside this package, or the one of the path."""
    here = pathlib.Path(__file__).parent
    places = [program, pathlib.Path(sysconfig.get_path("scripts")) / "umov", here.parents[1] / "apps/cli/umov",
              shutil.which("umov")]
    for place in places:
        if place and os.access(place, os.X_OK):
            return str(place)
    raise DeviceError("the command umov was not found. Install it with pip install umov, or say program=\"...\".")


def call(program: str, *words: Any) -> str:
    """What ``umov scale`` prints; its error as ours."""
    done = subprocess.run([program, "scale", *map(str, words)], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, check=False)
    if done.returncode == 0:
        return done.stdout
    lines = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    text = lines[-1].removeprefix("error: ") if lines else done.stderr.strip()
    raise error_from((done.returncode, text, "", 0, 0))


def call_for_rows(program: str, *words: Any) -> None:
    """`call` of what ends when all rows are there: that some of them have no answer is a warning then, which says why."""
    try:
        call(program, *words)
    except InputError as problem:
        if " have no answer, the others have theirs: " not in str(problem):
            raise
        warnings.warn(str(problem), UmovWarning, stacklevel=_stack_level())
