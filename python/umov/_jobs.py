"""How jobs run: what is watched, on how many threads, and where masks are kept."""
from __future__ import annotations

import logging
import os
import pathlib
import sys
import warnings
from collections.abc import Callable
from typing import Union

from . import _umov
from ._numbers import path_text, truth, whole
from ._words import in_python
from .errors import UmovWarning, UsageError

Progress = Union[None, bool, Callable[[str, int, int], object]]
_LOG = logging.getLogger("umov")


def _is_mute() -> bool:
    """Nobody sees a bar: a program without a console, such as pythonw, or one that closed its streams."""
    return sys.stderr is None or bool(getattr(sys.stderr, "closed", False))


class _Bar:
    """progress=True: tqdm where it is installed, else a line on a terminal."""

    def __init__(self) -> None:
        self._what = ""
        self._bar: object = None
        try:
            with warnings.catch_warnings():  # a notebook without ipywidgets has a bar of letters, and need not be told so
                warnings.simplefilter("ignore")
                from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
            self._make: Callable[..., object] | None = tqdm
        except ImportError:
            self._make = None
        if _is_mute():
            self._make = None

    def __call__(self, what: str, done: int, total: int) -> None:
        if self._make is None:
            if not _is_mute() and sys.stderr.isatty():
                print(f"\r{what}: {done} of {total} ", end="\n" if done == total else "",
                      file=sys.stderr, flush=True)
            return
        if what != self._what:
            self._what, self._bar = what, self._make(total=total, desc=what)
        bar: object = self._bar
        bar.n, bar.total = done, total  # type: ignore[attr-defined]  # a first word of a stage may not know its length
        bar.refresh()  # type: ignore[attr-defined]


def _stack_level() -> int:
    """Frames up to the first outside of this package: where a warning is shown."""
    level, frame = 2, sys._getframe(2)
    package = os.path.dirname(__file__)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == package:
        level, frame = level + 1, frame.f_back
    return level


class Watch:
    """What the library tells while a job runs, in the thread that called it."""

    def __init__(self, progress: Progress) -> None:
        self._progress: Callable[[str, int, int], object] | None = None
        if progress is True:
            self._progress = _Bar()
        elif callable(progress):
            self._progress = progress
        elif progress is not None and progress is not False:
            raise UsageError(f"progress is {progress!r}; True, False or a callable (what, done, total) was expected")

    def progress(self, what: str, done: int, total: int) -> None:
        if self._progress is not None:
            self._progress(what, done, total)

    def remark(self, text: str) -> None:
        _LOG.info(text)

    def warn(self, text: str) -> None:
        warnings.warn(in_python(text), UmovWarning, stacklevel=_stack_level())


def cache_folder(cache: bool | str | os.PathLike[str]) -> str:
    """Where masks of earlier jobs are kept: for True that of the command."""
    if not isinstance(cache, bool):
        return path_text(cache, "cache")
    if not cache:
        return ""
    base = os.environ.get("XDG_CACHE_HOME", "")
    if base.startswith("/"):
        return str(pathlib.Path(base) / "umov")
    home = os.environ.get("HOME", "")
    return str(pathlib.Path(home) / ".cache" / "umov") if home.startswith("/") else ""


def job_options(threads: int = 0, cache: bool | str | os.PathLike[str] = True,
                allow_bad_checksum: bool = False,
                allow_old_elements: bool = False, device: str = "cpu") -> _umov.JobOptions:
    if device not in ("cpu", "cuda", "auto"):
        raise UsageError(f"device is {device!r}; cpu, cuda or auto was expected")
    out = _umov.JobOptions(whole(threads, "threads"), cache_folder(cache), truth(allow_bad_checksum, "allow_bad_checksum"),
                            truth(allow_old_elements, "allow_old_elements"))
    if device != "cpu":
        out.set_device(device, os.environ.get("UMOV_CUDA_PATH", ""), [os.environ.get("VIRTUAL_ENV", ""), sys.prefix])
    return out
