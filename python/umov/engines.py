"""The fast layer: Stokes of an object for directions, without an orbit."""
from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._made import Made
from ._numbers import between, lengths, number_array, path_text, real_array, whole
from .errors import UsageError, raise_stopped
from .satellites import AnyBands, band_changes
from .scenarios import AnyScenario, Scenario

__all__ = ["Engine", "Light", "random_poses"]

Floats = NDArray[np.float64]
MOST_POSES = 2**32
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


class Engine(Made):
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
        Relative 95 % half-width that is asked of I, 1e-6 to 1; None: the scenario's, and where it has none, 0.05 with
        "auto", down to 0.02 of the object's typical light.
    laser
        Stokes vector (4) of an active source in the Sun's place; None: sunlight.
    temperatures
        Heat instead of reflected light: kelvin, [300] for all, and "GROUP=350"; Stokes parameters are then in
        W/(sr nm).
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
                 laser: Sequence[float] | None = None, temperatures: Sequence[str | float] = (),
                 mask_file: str | os.PathLike[str] | None = None, threads: int = 0,
                 cache: bool | str | os.PathLike[str] = True, device: str = "cpu", progress: Progress = None) -> None:
        if method not in (None, "auto", "rays", "masks"):
            raise UsageError(f"method is {method!r}; auto, rays or masks was expected")
        accuracy = None if accuracy is None else between(accuracy, "accuracy", 1e-6, 1)
        laser = None if laser is None else _stokes(laser)
        temperatures = kelvins(temperatures)
        mask_file = None if mask_file is None else path_text(mask_file, "mask_file")
        self.scenario = Scenario(scene, changed(set, bands))  #: what is lit
        self._threads = threads
        self._options = {"method": method, "accuracy": accuracy, "laser": laser, "temperatures": temperatures,
                         "mask_file": mask_file, "threads": threads, "cache": cache,
                         "device": device}
        self._light = _umov.Light(self.scenario._scenario, method, accuracy,
                                  laser or [], temperatures, mask_file or "", job_options(threads, cache, device=device),
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
        `InputError` for NaN and directions of length 0. Signs: +Q perpendicular to the scattering plane, V > 0 right-handed
        (docs/conventions.md). Ctrl-C raises `Interrupted` with the poses that were lit in `partial`: the first of all in
        C order, (poses, band, 4).
        """
        flat, shape = directions(sun, observer)
        out, stopped = self._light.stokes(*flat, self._threads, Watch(progress))
        if stopped is not None:
            raise_stopped(stopped, out)
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

        Notes
        -----
        Ctrl-C raises `Interrupted`, as in `evaluate`, with a Light of the first poses in `partial`.
        """
        flat, shape = directions(sun, observer)
        stokes, half_width, is_dark, method, stopped = self._light.light(*flat, self._threads, Watch(progress))
        if stopped is not None:
            raise_stopped(stopped, Light(stokes, half_width, is_dark, np.array(METHODS)[method]))
        full = (*shape, len(self.bands), 4)
        return Light(stokes.reshape(full), half_width.reshape(full), is_dark.reshape(shape),
                     np.array(METHODS)[method].reshape(shape))

    def keep_masks(self) -> None:
        """Keeps what was learnt of the masks for later engines (`cache`, `mask_file`)."""
        self._light.keep_masks()

    def __repr__(self) -> str:
        facts = self.facts
        return (f"<umov.Engine {', '.join(name or 'unnamed' for name in self.scenario.objects)}: {facts['triangles']} triangles, "
                f"{', '.join(self.bands)}; {facts['visibility']}>")

    def __getstate__(self) -> dict[str, Any]:
        return {"scenario": self.scenario, "options": self._options}

    def __setstate__(self, state: dict[str, Any]) -> None:
        Engine.__init__(self, state["scenario"], **state["options"])


def changed(set: Mapping[str, Any] | None, bands: AnyBands | None) -> dict[str, Any] | None:
    """Changes of a scenario's keys, bands among them."""
    if set is not None and not isinstance(set, Mapping):
        raise UsageError(f"set is a {type(set).__name__}; a dictionary of keys was expected, such as {{\"render.bounces\": 2}}")
    return {**(set or {}), **band_changes(bands)} or None


def _stokes(laser: Any) -> list[float]:
    out = number_array(laser, "laser")
    if out.shape != (4,):
        raise UsageError(f"laser has shape {out.shape}; I, Q, U, V were expected")
    if not (out[0] > 0 and np.linalg.norm(out[1:]) <= out[0] * (1 + 1e-12)):
        raise UsageError(f"laser is {out.tolist()}; I > 0 and sqrt(Q2 + U2 + V2) <= I were expected")
    return [float(one) for one in out]


def kelvins(temperatures: Any) -> list[str]:
    """Temperatures as the command takes them."""
    if isinstance(temperatures, (str, bytes)) or not hasattr(temperatures, "__iter__") or getattr(temperatures, "ndim", 1) != 1:
        raise UsageError(f"temperatures is {temperatures!r}; a list was expected, such as [300, \"wing=350\"]")
    return [one if isinstance(one, str) else f"{between(one, 'temperatures', 0, 1e6):.17g}" for one in temperatures]


def directions(sun: ArrayLike, observer: ArrayLike) -> tuple[tuple[Floats, Floats], tuple[int, ...]]:
    given = []
    for value, name in ((sun, "sun"), (observer, "observer")):
        one = real_array(lengths(value, name), name, "numbers, directions (..., 3),")
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
        if math.prod(shape[:-1]) > MOST_POSES:
            raise UsageError(f"sun {given[0].shape} and observer {given[1].shape} broadcast to {math.prod(shape[:-1])} poses; at most "
                             f"{MOST_POSES} at once were expected. Light them part by part.")
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
    both = _umov.random_directions(whole(count, "count", 10**9), between(phase_deg, "phase_deg", 0, 180), whole(seed, "seed", most),
                                   whole(first, "first", 10**12))
    return both[0], both[1]
