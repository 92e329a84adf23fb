"""Signatures of many objects."""
from __future__ import annotations

import os
from collections.abc import Sequence

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._numbers import path_text, whole, whole_between
from .errors import UsageError
from .tables import Table

__all__ = ["build_library"]


def build_library(scenarios: Sequence[str | os.PathLike[str]], folder: str | os.PathLike[str], *, cells: int = 20,
                  first: int = 0, count: int | None = None, threads: int = 0,
                  cache: bool | str | os.PathLike[str] = True, device: str = "cpu",
                  progress: Progress = None) -> Table:
    """Light and abundances of objects over all directions, a file each: `umov library build`.

    Parameters
    ----------
    scenarios
        Files of one object each; the file's name is the object's.
    folder
        Of the library; an object that is there and made of the same inputs stays.
    cells
        Directions: (cells + 1)^2 of Sun and observer, 4 to 60; 20 are 97,461 pairs, 9 deg apart.
    first
        Of the scenarios, from which on: machines that share the work name the same list.
    count
        How many of them at most; None: all.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    Rows are name, poses, error, abundances and state ("made", "recoloured", "was there"). After Ctrl-C the finished
    files are kept, and the same call goes on. docs/howto/library.md has the form of a file.

    Examples
    --------
    >>> made = umov.build_library([EXAMPLES / "agena_maui.toml"], "lib", cells=4)
    >>> str(made["name"][0]), str(made["state"][0]), int(made["poses"][0])
    ('agena_maui', 'made', 325)
    """
    paths = [scenarios] if isinstance(scenarios, (str, os.PathLike)) else scenarios
    if not isinstance(paths, Sequence) or not paths or not all(isinstance(one, (str, os.PathLike)) for one in paths):
        raise UsageError(f"scenarios is {scenarios!r}; a list of scenario files was expected")
    if not isinstance(folder, (str, os.PathLike)):
        raise UsageError(f"folder is {folder!r}; the name of a folder was expected")
    most = len(paths) if count is None else whole(count, "count")
    return Table(_umov.build_library([path_text(one, "scenarios") for one in paths], path_text(folder, "folder"),
                                     whole_between(cells, "cells", 4, 60), whole(first, "first"), most,
                                     job_options(threads, cache, device=device), Watch(progress)))
