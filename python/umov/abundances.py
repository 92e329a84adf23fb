"""Geometric sums of poses, made once, for as many materials and bands as you like."""
from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._made import Made
from .engines import Floats, directions
from .errors import UsageError, raise_stopped
from .satellites import AnyBands, Satellite, band_changes
from .scenarios import AnyScenario, Scenario

__all__ = ["Abundances", "Coloured", "Column", "Sums"]


class Column(NamedTuple):
    """What one column of the sums is.

    >>> umov.Sums(hst).abundances([0, 0, 1], [0, 1, 1]).columns[0].kind
    'specular'
    """

    kind: str  #: specular [m2/sr] or diffuse [m2]
    shape: float  #: specular: m of Blinn-Phong, alpha of Beckmann and GGX
    sides: list[str]  #: mesh materials that are summed together, "(back)" for their backs


class Abundances(Made):
    """Sums of poses before any colour. `sum` and `half_width` are read-only views (..., column) of the library's
    memory.

    >>> sums = umov.Sums(hst).abundances(*umov.random_poses(10, phase_deg=60))
    >>> sums.sum.shape == (10, len(sums.columns))
    True
    """

    def __init__(self, abundances: _umov.Abundances, shape: tuple[int, ...], key: str) -> None:
        self._abundances, self._shape = abundances, shape
        self._key = key  # of the object whose sums they are

    @property
    def columns(self) -> list[Column]:
        """What each column is."""
        return [Column(*one) for one in self._abundances.columns]

    @property
    def sum(self) -> Floats:
        """(..., column): area times lobe, over what is lit and seen."""
        flat = self._abundances.sum
        return flat.reshape(*self._shape, flat.shape[-1])

    @property
    def half_width(self) -> Floats:
        """95 % half-widths of the same."""
        flat = self._abundances.half_width
        return flat.reshape(*self._shape, flat.shape[-1])

    def __repr__(self) -> str:
        return f"<umov.Abundances: {' x '.join(map(str, self._shape)) or 'one'} poses, {len(self.columns)} columns>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (self._abundances.state, self._shape, self._key)


def _restore(state: Any, shape: tuple[int, ...], key: str) -> Abundances:
    return Abundances(_umov.Abundances.restore(*state), shape, key)


class Coloured(NamedTuple):
    """What materials make of sums.

    >>> sums = umov.Sums(hst)
    >>> sums.apply(sums.abundances([0, 0, 1], [0, 1, 1])).half_width.shape
    (3, 4)
    """

    stokes: Floats  #: (..., band, 4): I, Q, U, V [m2/sr] in the scattering frame
    half_width: Floats  #: 95 % half-widths of the same


class Sums(Made):
    """An object whose poses are rendered once, and coloured as often as you like. `others` are scenes of the same
    mesh whose roughness must be served exactly too: `InputError` says where a material that is applied has another.
    Hiding is looked up in masks, as `Engine(method="masks")` does; where that mends mirrors by rays the half-widths
    tell how far these sums may be off.

    Parameters
    ----------
    scene
        A path, dictionary, Scenario or Satellite; orbit, time and observer are not used.
    others
        Scenes of the same mesh, whose roughness is served exactly besides.
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

    Examples
    --------
    >>> sums = umov.Sums(hst)
    >>> poses = umov.random_poses(100, phase_deg=60, seed=1)
    >>> made = sums.abundances(*poses)
    >>> sums.apply(made, bands=["nm:450", "nm:550", "nm:650", "nm:850"]).stokes.shape
    (100, 4, 4)
    """

    def __init__(self, scene: AnyScenario, *, others: Iterable[AnyScenario] = (), threads: int = 0,
                 cache: bool | str | os.PathLike[str] = True, device: str = "cpu", progress: Progress = None) -> None:
        self.scenario = Scenario(scene)  #: what is lit
        self._source = scene
        if isinstance(others, (str, os.PathLike)) or not isinstance(others, Iterable):
            raise UsageError(f"others is {others!r}; a list of scenes was expected")
        self._others = [Scenario(one) for one in others]
        self._threads, self._cache, self._device = threads, cache, device
        told = "\n".join(one._told() for one in (self.scenario, *self._others))
        self._key = hashlib.sha256(told.encode()).hexdigest()
        self._sums = _umov.Sums(self.scenario._scenario, [one._scenario for one in self._others],
                                job_options(threads, cache, device=device), Watch(progress))

    def abundances(self, sun: ArrayLike, observer: ArrayLike, *, progress: Progress = None) -> Abundances:
        """Sums for directions (..., 3) in the body frame, of any length, which broadcast against each other.

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
        Ctrl-C raises `Interrupted` with the sums of the first poses, in C order, in `partial`: (poses, column).
        """
        flat, shape = directions(sun, observer)
        made = self._sums.abundances(*flat, self._threads, Watch(progress))
        if made.stopped is not None:
            raise_stopped(made.stopped, Abundances(made, (made.poses,), self._key))
        return Abundances(made, shape, self._key)

    def apply(self, abundances: Abundances, scene: AnyScenario | None = None, *, bands: AnyBands | None = None,
              materials: Mapping[str, Any] | str | None = None, progress: Progress = None) -> Coloured:
        """Stokes [m2/sr] (..., band, 4) in the scattering frame of the same poses, and half-widths, for the materials and bands of a
        scene with the same mesh groups; without one for those of this, with `bands` or `materials` instead.

        Parameters
        ----------
        abundances
            What `abundances` of this object gave.
        scene
            A scene with the same mesh groups, whose materials and bands are meant; None: this one.
        bands
            A set ("paper_rgb"), a list of names ("nm:550", "Bessell.V") or `umov.Bands`; None: those of the
            scenario.
        materials
            Materials by mesh material or "default", over those of the scene.
        progress
            True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that
            called; what it raises comes through.

        Notes
        -----
        `InputError` where a material has a roughness that the sums do not serve.
        """
        if not isinstance(abundances, Abundances) or abundances._key != self._key:
            raise UsageError("abundances are not of this object; what its own `abundances` gave was expected")
        asked = self._source if scene is None else scene
        if materials is not None:
            asked = _with_materials(Scenario(asked), materials)
        stokes, half_width, _ = self._sums.apply(abundances._abundances, Scenario(asked, band_changes(bands))._scenario,
                                                 self._threads, Watch(progress))
        shape = (*abundances._shape, *stokes.shape[1:])
        return Coloured(stokes.reshape(shape), half_width.reshape(shape))

    def __repr__(self) -> str:
        return f"<umov.Sums of {', '.join(self.scenario.objects)}>"

    def __getstate__(self) -> dict[str, Any]:
        return {"scene": self._source, "others": self._others, "threads": self._threads, "cache": self._cache,
                "device": self._device, "key": self._key}

    def __setstate__(self, state: dict[str, Any]) -> None:
        key = state.pop("key")
        Sums.__init__(self, state.pop("scene"), **state)
        self._key = key  # files of adapters lie elsewhere here, the sums are the same


def _with_materials(scenario: Scenario, materials: Mapping[str, Any] | str) -> dict[str, Any]:
    document = scenario.to_dict()
    made = Satellite.from_dict({**document["object"][0], "materials": materials, "material": document.get("material", {})})
    table = made.to_dict()
    own = {**document.get("material", {}), **table.pop("material", {})}
    return {**document, "object": [{**document["object"][0], "materials": table["materials"]}],
            **({"material": own} if own else {})}
