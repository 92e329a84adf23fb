"""Pictures of an object as an observer sees it, and its triangles."""
from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._made import Made
from ._numbers import lengths, number_array, path_text, text, whole_between
from .errors import DeviceError, UsageError
from .scenarios import AnyScenario, Scenario
from .times import AnyTime, utc

__all__ = ["Mesh", "Picture", "mesh", "render"]

SHADES = ("intensity", "polarization", "angle", "material", "colour")
MOST_RAYS = 12288  #: along an axis: the largest picture at three rays a pixel


class Picture(Made):
    """A PNG file in memory, shown by notebooks.

    >>> picture = umov.render(hst, sun=[1, 1, 1], observer=[0, 1, 1], side=64, samples=1)
    >>> picture.png[:8] == b"\\x89PNG\\r\\n\\x1a\\n", picture
    (True, <umov.Picture 'material'>)
    """

    def __init__(self, png: bytes, shade: str) -> None:
        self.png = png  #: the file
        self.shade = shade  #: what its colours tell

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the file.

        Parameters
        ----------
        path
            The PNG file.
        """
        try:
            with open(path_text(path, "path"), "wb") as out:
                out.write(self.png)
        except OSError as error:
            raise DeviceError(f"{os.fspath(path)}: cannot write here: {error.strerror}. Make the folder first or choose another "
                              "one.") from error

    def _repr_png_(self) -> bytes:
        return self.png

    def __repr__(self) -> str:
        return f"<umov.Picture {self.shade!r}>"


def render(scene: AnyScenario, *, shade: str = "material", band: str = "", sun: ArrayLike | None = None,
           observer: ArrayLike | None = None, up: ArrayLike = (0, 0, 1), time: AnyTime | None = None,
           side: int = 512, samples: int = 3, threads: int = 0, progress: Progress = None,
           allow_bad_checksum: bool = False, allow_old_elements: bool = False) -> Picture:
    """The object as the observer sees it, north up: the picture of `umov render`.

    With `sun` and `observer`, directions (3) in the body frame, from there, with `up` upwards; else on the
    scenario's orbit at `time`, or where the first pass is brightest. An object that is in shadow or below the horizon
    at `time` is drawn in full sunlight all the same, with a warning. `UsageError` for what does not go together, `NoResult` if nothing of the span is lit.

    Parameters
    ----------
    scene
        A path, dictionary, Scenario or Satellite.
    shade
        intensity, polarization, angle, material or colour (three bands).
    band
        Whose light, by name; "": the middle one.
    sun
        Direction (3) to the Sun in the body frame, of any length; with `observer`.
    observer
        The same to the observer.
    up
        What is upwards in the picture (3), body frame.
    time
        UTC on the scenario's orbit, instead of directions; None: where the first pass is brightest.
    side
        Of the picture [pixel], 1 to 4096.
    samples
        Rays per pixel and axis, 1 to 8. All are kept in memory, 32 bytes each and for each band: side * samples is at
        most 12288, which takes 5 GB, in colour 15 GB.
    threads
        0 for all cores; the bytes do not depend on it.
    progress
        True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that called;
        what it raises comes through.
    allow_bad_checksum
        Elements whose checksum is wrong are taken.
    allow_old_elements
        Elements over 30 days from `time` or the span are taken.

    Examples
    --------
    >>> umov.render(EXAMPLES / "hst_maui.toml", shade="intensity", time="2018-01-21T05:11:00Z", side=64).shade
    'intensity'
    """
    if shade not in SHADES:
        raise UsageError(f"shade is {shade!r}; one of {', '.join(SHADES)} was expected")
    if (sun is None) != (observer is None):
        raise UsageError("sun without observer, or the other way round; both or none were expected")
    side, samples = whole_between(side, "side", 1, 4096), whole_between(samples, "samples", 1, 8)
    if side * samples > MOST_RAYS:
        raise UsageError(f"side * samples is {side} * {samples} = {side * samples}; at most {MOST_RAYS} was expected, as all rays are "
                         "kept in memory (5 GB for those). Take fewer samples or a smaller side.")
    directions = [] if sun is None else [_three(value, name) for value, name in
                                         ((sun, "sun"), (observer, "observer"), (up, "up"))]
    png = _umov.render(Scenario(scene)._scenario, shade, text(band, "band"), directions, None if time is None else utc(time),
                       side, samples, job_options(threads, False, allow_bad_checksum, allow_old_elements), Watch(progress))
    return Picture(png, shade)


def _three(value: Any, name: str) -> tuple[float, float, float]:
    out = number_array(lengths(value, name), name)
    if out.shape != (3,):
        raise UsageError(f"{name} has shape {out.shape}; (3,) was expected")
    return float(out[0]), float(out[1]), float(out[2])


class Mesh(NamedTuple):
    """Triangles of an object as they are lit: cleaned, in metres, in the body frame.

    >>> made = umov.mesh(hst)
    >>> made.vertices.shape[1], made.faces.shape[1], "light_shield" in made.group_names
    (3, 3, True)
    """

    vertices: NDArray[np.float64]  #: (V, 3) [m]
    faces: NDArray[np.uint32]  #: (F, 3), counter-clockwise from outside
    groups: NDArray[np.uint32]  #: (F): into group_names
    group_names: list[str]  #: mesh materials


def mesh(scene: AnyScenario, *, object: int = 0, progress: Progress = None) -> Mesh:
    """The triangles of an object of a scenario.

    Parameters
    ----------
    scene
        A path, dictionary, Scenario or Satellite.
    object
        Number of the object, from 0.
    progress
        True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that called;
        what it raises comes through.

    Examples
    --------
    >>> int(umov.mesh(hst).faces.max()) < len(umov.mesh(hst).vertices)
    True
    """
    scenario = Scenario(scene)
    which = whole_between(object, "object", 0, len(scenario.objects) - 1)
    return Mesh(*_umov.mesh(scenario._scenario, which, Watch(progress)))
