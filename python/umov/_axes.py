"""What figures over time share: axes, the stretches that a line joins, ticks with a date."""
from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from .errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .light_curves import LightCurve

# Okabe & Ito (2008); the first three follow the wavelength from blue to red, as in the report.
THREE = ("#0072b2", "#009e73", "#d55e00")
MANY = ("#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00", "#cc79a7", "#000000")
MARKERS = ("o", "s", "^", "D", "P", "X", "*")
PHASE_MAP = "cividis"

_Draw = TypeVar("_Draw", bound=Callable[..., Any])


def of_a_curve(draw: _Draw) -> _Draw:
    """A figure of a light curve: told of anything else before it is drawn in part."""

    @functools.wraps(draw)
    def checked(curve: Any, *args: Any, **more: Any) -> Any:
        from .light_curves import LightCurve as Wanted
        if not isinstance(curve, Wanted):
            raise UsageError(f"curve is a {type(curve).__name__}; a LightCurve was expected, as umov.run and light_curve give")
        return draw(curve, *args, **more)

    return cast(_Draw, checked)


def band_title(name: str) -> str:
    """A band's name for people: that of a filter as it is, a wavelength with its unit behind it.

    Parameters
    ----------
    name
        As scenarios spell it.

    Examples
    --------
    >>> plot.band_title("nm:550"), plot.band_title("Bessell.V")
    ('550 nm', 'Bessell.V')
    """
    return f"{name[3:]} nm" if name.startswith("nm:") else name


def axes_or_new(axes: Axes | None, projection: str | None = None) -> Axes:
    """Those given, or those of a new figure."""
    if axes is not None:
        if not hasattr(axes, "plot") or not hasattr(axes, "figure"):
            raise UsageError(f"axes is a {type(axes).__name__}; Axes of matplotlib were expected, or None for new ones")
        return axes
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise UsageError("a figure needs the package matplotlib: pip install matplotlib") from error
    made: Axes = plt.figure(figsize=(7, 4.5), layout="constrained").add_subplot(projection=projection)
    return made


def passes_of(curve: LightCurve) -> Iterator[NDArray[np.intp]]:
    """Epochs of each pass: no line joins two of them."""
    ids = curve.pass_id
    for one in dict.fromkeys(ids.tolist()):
        yield np.flatnonzero(ids == one)


def every(count: int) -> int:
    """Some two dozen markers on a line, however many points it has."""
    return max(1, count // 24)


def time_axis(axes: Axes) -> None:
    """Short ticks, and the date once beside them."""
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter
    locator = AutoDateLocator(minticks=3, maxticks=8)  # type: ignore[no-untyped-call]
    axes.xaxis.set_major_locator(locator)
    axes.xaxis.set_major_formatter(ConciseDateFormatter(locator))  # type: ignore[no-untyped-call]
    axes.set_xlabel("UTC")


def interfaces_of(curve: LightCurve) -> Iterator[tuple[str, dict[str, Any]]]:
    """Materials of a curve's objects, each without the light from below its surface."""
    from .materials import Material
    if curve.scenario is None:
        raise UsageError("the curve has no scenario, so no materials; one that umov.run made was expected")
    document = curve.scenario.to_dict()
    own = document.get("material", {})
    names = dict.fromkeys(name for one in document["object"] for value in one["materials"].values()
                          for name in (value.values() if isinstance(value, dict) else [value]))
    for name in names:
        table = dict(own[name]) if name in own else Material(name).to_dict()
        if "table" not in table:
            yield name, {key: value for key, value in table.items() if key not in ("body", "haze", "interreflection")}
