"""Geometric sums of poses, made once, for as many materials and bands as you like."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from . import _umov
from ._jobs import Progress, Watch, job_options
from .engines import Floats, directions
from .satellites import Bands, Satellite, band_table
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


class Abundances:
    """Sums of poses before any colour. `sum` and `half_width` are read-only views (..., column) of the library's
    memory.

    >>> sums = umov.Sums(hst).abundances(*umov.random_poses(10, phase_deg=60))
    >>> sums.sum.shape == (10, len(sums.columns))
    True
    """

    def __init__(self, abundances: _umov.Abundances, shape: tuple[int, ...]) -> None:
        self._abundances, self._shape = abundances, shape

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


class Coloured(NamedTuple):
    """What materials make of sums.

    >>> sums = umov.Sums(hst)
    >>> sums.apply(sums.abundances([0, 0, 1], [0, 1, 1])).half_width.shape
    (3, 4)
    """

    stokes: Floats  #: (..., band, 4): I, Q, U, V [m2/sr] in the scattering frame
    half_width: Floats  #: 95 % half-widths of the same


class Sums:
    """An object whose poses are rendered once, and coloured as often as you like. `others` are scenes of the same
    mesh whose roughness must be served exactly too: `InputError` says where a material that is applied has another.
    Hiding is looked up in masks, as `Engine(method="masks")` does; where that mends mirrors by rays the half-widths
    tell how far these sums may be off.

    >>> sums = umov.Sums(hst)
    >>> poses = umov.random_poses(100, phase_deg=60, seed=1)
    >>> made = sums.abundances(*poses)
    >>> sums.apply(made, bands=["nm:450", "nm:550", "nm:650", "nm:850"]).stokes.shape
    (100, 4, 4)
    """

    def __init__(self, scene: AnyScenario, *, others: Sequence[AnyScenario] = (), threads: int = 0,
                 cache: bool | str | os.PathLike[str] = True, progress: Progress = None) -> None:
        self.scenario = Scenario(scene)  #: what is lit
        self._source = scene
        self._others = [Scenario(one) for one in others]
        self._threads = threads
        self._sums = _umov.Sums(self.scenario._scenario, [one._scenario for one in self._others],
                                job_options(threads, cache), Watch(progress))

    def abundances(self, sun: ArrayLike, observer: ArrayLike, *, progress: Progress = None) -> Abundances:
        """Sums for directions (..., 3) in the body frame, of any length, which broadcast against each other."""
        flat, shape = directions(sun, observer)
        return Abundances(self._sums.abundances(*flat, self._threads, Watch(progress)), shape)

    def apply(self, abundances: Abundances, scene: AnyScenario | None = None, *, bands: Bands | None = None,
              materials: Mapping[str, Any] | str | None = None, progress: Progress = None) -> Coloured:
        """Stokes [m2/sr] (..., band, 4) in the scattering frame of the same poses, and half-widths, for the materials and bands of a
        scene with the same mesh groups; without one for those of this, with `bands` or `materials` instead."""
        asked = self._source if scene is None else scene
        if materials is not None:
            asked = _with_materials(Scenario(asked), materials)
        changes = None if bands is None else {"bands.set": band_table(bands)["set"]}
        stokes, half_width, _ = self._sums.apply(abundances._abundances, Scenario(asked, changes)._scenario,
                                                 self._threads, Watch(progress))
        shape = (*abundances._shape, *stokes.shape[1:])
        return Coloured(stokes.reshape(shape), half_width.reshape(shape))


def _with_materials(scenario: Scenario, materials: Mapping[str, Any] | str) -> dict[str, Any]:
    document = scenario.to_dict()
    made = Satellite.from_dict({**document["object"][0], "materials": materials, "material": document.get("material", {})})
    table = made.to_dict()
    own = {**document.get("material", {}), **table.pop("material", {})}
    return {**document, "object": [{**document["object"][0], "materials": table["materials"]}],
            **({"material": own} if own else {})}
