"""The fast layer: Stokes of an object for directions, without an orbit."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._numbers import number, whole
from .errors import UsageError
from .satellites import AnyBands, band_changes
from .scenarios import AnyScenario, Scenario

__all__ = ["Engine", "Light", "random_poses"]

Floats = NDArray[np.float64]
METHODS = ("exact", "masks", "mended", "rays")


class Light(NamedTuple):
    """Stokes of poses with their numerical errors.

    >>> light = engine.light([0, 0, 1], [0, 1, 1])
    >>> light.stokes.shape, light.half_width.shape, bool(light.is_dark), str(light.method)
    ((3, 4), (3, 4), False, 'masks')
    """

    stokes: Floats  #: (..., band, 4): I, Q, U, V [m2/sr] in the scattering frame
    half_width: Floats  #: 95 % half-widths of the same
    is_dark: NDArray[np.bool_]  #: nothing is both lit and seen
    method: NDArray[Any]  #: exact, masks, mended or rays


class Engine:
    """An object ready to be lit from any direction: compiled once, then asked for as many poses as you like.

    Sunlight, or an active source (`laser`), or the body's own heat (`temperatures`). Thread safe; pickled by its scenario.

    Parameters
    ----------
    scene
        A path, dictionary, Scenario or Satellite; orbit, time and observer are not used.
    bands
        A set ("paper_rgb"), a list of names ("nm:550", "Bessell.V") or `umov.Bands`; None: those of the scenario.
    set
        Changes of the scenario's keys, such as {"render.bounces": 2}.
    method
        How hiding is found: "masks" (looked up), "rays" (traced), "auto" (masks, mended by rays); None: the
        scenario's.
    accuracy
        Relative 95 % half-width that is asked of I, 1e-6 to 1; None: the scenario's, and where it has none, 0.04 with
        "auto", down to 0.02 of the object's typical light.
    laser
        Stokes vector (4) of an active source in the Sun's place; None: sunlight.
    temperatures
        Heat instead of reflected light: kelvin as texts, "300" for all or "GROUP=350"; Stokes parameters are then
        in W/(sr nm).
    mask_file
        A file of masks to read and keep, instead of the cache.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that called;
        what it raises comes through.

    Notes
    -----
    `InputError` names the place in the scene that is wrong.

    Examples
    --------
    >>> engine = umov.Engine(hst, bands=["nm:550"], method="masks")
    >>> engine.evaluate([0, 0, 1], [0, 1, 1]).shape
    (1, 4)
    >>> sun, observer = umov.random_poses(100, phase_deg=60, seed=1)
    >>> engine.evaluate(sun, observer).shape
    (100, 1, 4)
    """

    def __init__(self, scene: AnyScenario, bands: AnyBands | None = None, *, set: Mapping[str, Any] | None = None,
                 method: str | None = None, accuracy: float | None = None,
                 laser: Sequence[float] | None = None, temperatures: Sequence[str] = (),
                 mask_file: str | os.PathLike[str] | None = None, threads: int = 0,
                 cache: bool | str | os.PathLike[str] = True, device: str = "cpu", progress: Progress = None) -> None:
        if method not in (None, "auto", "rays", "masks"):
            raise UsageError(f"method is {method!r}; auto, rays or masks was expected")
        if accuracy is not None and not 1e-6 <= accuracy <= 1:
            raise UsageError(f"accuracy is {accuracy!r}; a number from 1e-6 to 1 was expected")
        if laser is not None and len(laser) != 4:
            raise UsageError(f"laser has {len(laser)} numbers; I, Q, U, V were expected")
        changes = {**(set or {}), **band_changes(bands)}
        self.scenario = Scenario(scene, changes or None)  #: what is lit
        self._threads = threads
        self._options = {"method": method, "accuracy": accuracy, "laser": laser, "temperatures": list(temperatures),
                         "mask_file": mask_file, "threads": threads, "cache": cache,
                         "device": device}
        self._light = _umov.Light(self.scenario._scenario, method, accuracy,
                                  [float(x) for x in laser or ()], list(temperatures),
                                  "" if mask_file is None else os.fspath(mask_file), job_options(threads, cache, device=device),
                                  Watch(progress))

    @property
    def bands(self) -> list[str]:
        """Names of the bands, in the order of the axis before the last."""
        return self.scenario.bands

    @property
    def facts(self) -> dict[str, Any]:
        """What was made ready: method, triangles, classes, instruction set, cards ("" for none), bytes of
        masks.

        >>> engine.facts["is_convex"]
        False
        """
        return self._light.facts

    def evaluate(self, sun: ArrayLike, observer: ArrayLike, *, progress: Progress = None) -> Floats:
        """Stokes [m2/sr] (..., band, 4) in the scattering frame per unit solar irradiance, for directions
        (..., 3) in the body frame from the object to the Sun and to the observer, of any length, which
        broadcast against each other.

        Parameters
        ----------
        sun
            Directions (..., 3) from the object to the Sun, in the body frame, of any length; not 0, finite.
        observer
            The same to the observer. Both broadcast against each other.
        progress
            True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that
            called; what it raises comes through.

        Notes
        -----
        At phase 0 and 180 Q = U = 0; where nothing is both lit and seen all four are 0. `UsageError` for wrong shapes,
        NaN and directions of length 0. Signs: +Q perpendicular to the scattering plane, V > 0 right-handed
        (docs/conventions.md).
        """
        flat, shape = directions(sun, observer)
        out = self._light.stokes(*flat, self._threads, Watch(progress))
        return out.reshape(*shape, len(self.bands), 4)

    def light(self, sun: ArrayLike, observer: ArrayLike, *, progress: Progress = None) -> Light:
        """The same with half-widths, and how each pose was lit.

        Parameters
        ----------
        sun
            Directions (..., 3) from the object to the Sun, in the body frame, of any length; not 0, finite.
        observer
            The same to the observer. Both broadcast against each other.
        progress
            True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that
            called; what it raises comes through.
        """
        flat, shape = directions(sun, observer)
        stokes, half_width, is_dark, method = self._light.light(*flat, self._threads, Watch(progress))
        full = (*shape, len(self.bands), 4)
        return Light(stokes.reshape(full), half_width.reshape(full), is_dark.reshape(shape),
                     np.array(METHODS)[method].reshape(shape))

    def keep_masks(self) -> None:
        """Keeps what was learnt of the masks for later engines (`cache`, `mask_file`)."""
        self._light.keep_masks()

    def __repr__(self) -> str:
        facts = self.facts
        return (f"<umov.Engine {', '.join(self.scenario.objects)}: {facts['triangles']} triangles, "
                f"{', '.join(self.bands)}; {facts['visibility']}>")

    def __getstate__(self) -> dict[str, Any]:
        return {"scenario": self.scenario, "options": self._options}

    def __setstate__(self, state: dict[str, Any]) -> None:
        Engine.__init__(self, state["scenario"], **state["options"])


def directions(sun: ArrayLike, observer: ArrayLike) -> tuple[tuple[Floats, Floats], tuple[int, ...]]:
    given = []
    for value, name in ((sun, "sun"), (observer, "observer")):
        try:
            one = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise UsageError(f"{name} is no array of numbers; directions (..., 3) were expected") from error
        if one.ndim == 0 or one.shape[-1] != 3:
            raise UsageError(f"{name} has shape {one.shape}; directions (..., 3) were expected")
        given.append(one)
    if given[0].shape == given[1].shape:
        shape = given[0].shape
    else:
        try:
            shape = np.broadcast_shapes(given[0].shape, given[1].shape)
        except ValueError as error:
            raise UsageError(f"sun {given[0].shape} and observer {given[1].shape} do not fit together; shapes "
                             "that broadcast were expected") from error
        given = [np.broadcast_to(one, shape) for one in given]
    flat = [np.ascontiguousarray(one).reshape(-1, 3) for one in given]
    return (flat[0], flat[1]), shape[:-1]


def random_poses(count: int, phase_deg: float, seed: int = 0, first: int = 0) -> tuple[Floats, Floats]:
    """Directions of Sun and observer, `phase_deg` apart and turned uniformly: poses `first` to
    `first + count` of the stream of `seed`, those of `umov signature --poses`.

    Parameters
    ----------
    count
        How many, up to 1e9.
    phase_deg
        Angle between both directions, 0 to 180 [deg].
    seed
        Of the generator (Philox), a whole number from 0.
    first
        Number of the first pose.

    Notes
    -----
    Two arrays (count, 3) of unit vectors in the body frame. `UsageError` for numbers out of range.

    Examples
    --------
    >>> sun, observer = umov.random_poses(4, phase_deg=90)
    >>> bool(abs((sun * observer).sum(axis=1)).max() < 1e-15)
    True
    """
    most = 2**63 - 1
    both = _umov.random_directions(whole(count, "count", 10**9), number(phase_deg, "phase_deg"), whole(seed, "seed", most),
                                   whole(first, "first", 10**12))
    return both[0], both[1]
