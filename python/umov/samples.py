"""Files that come with the package, for examples: meshes, elements, scenarios, a measured BRDF."""
from __future__ import annotations

import pathlib

from .errors import InputError

__all__ = ["example"]

_FILES = pathlib.Path(__file__).parent / "files"


def example(name: str) -> pathlib.Path:
    """The path of a file that comes with the package, so that examples run wherever it is installed.

    Parameters
    ----------
    name
        Such as "hst.obj" and "agena.obj" (meshes in metres, +Z up), "hst.tle" (elements), "hst_maui.toml" (a
        scenario); what is none of them is an `InputError` that lists them all.

    Examples
    --------
    >>> umov.example("hst.tle").read_text().splitlines()[0]
    'HST'
    """
    found = {path.name: path for path in sorted(_FILES.rglob("*.*")) if path.is_file()}
    if not isinstance(name, str) or name not in found:
        raise InputError(f"there is no example {name!r}; one of {', '.join(found)} was expected")
    return found[name]
