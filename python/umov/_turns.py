"""Figures of how brightness repeats: of light curves, and of anybody's tables."""
from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _umov
from ._axes import MANY, PHASE_MAP, axes_or_new as _axes, passes_of as _passes
from ._numbers import number
from .errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .light_curves import LightCurve
    from .periods import AnyLight

_Stretch = tuple[str, NDArray[np.float64], NDArray[np.float64]]


def _periodic(curve: LightCurve, band: str | int, part: NDArray[np.intp]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Seconds and magnitudes of a pass without range and eclipse, where there is light that is no mere limit."""
    which = curve.band(band)
    intensity = curve.intensity[part, which]
    lit = (intensity > 0) & ~curve["mag_limit"][part, which]
    whole, rest = (jd[part] - jd[0] for jd in curve._jd)
    return (whole[lit] + rest[lit]) * 86400.0, -2.5 * np.log10(intensity[lit])


def _stretches(light: Any, band: str | int, gap_s: float) -> Iterator[_Stretch]:
    """Name, seconds and magnitudes of each pass of a light curve, or of each stretch of a table: those of all count from one
    begin."""
    from .light_curves import LightCurve as Curve
    if isinstance(light, Curve):
        for part in _passes(light):
            yield str(light.pass_id[part[0]]), *_periodic(light, band, part)
        return
    from astropy.time import Time

    from .periods import brightness
    table = brightness(light, band, gap_s)
    numbers, first = np.unique(table["stretch"], return_index=True)
    begins = Time([str(one).removesuffix("Z") for one in table["begin_utc"][first]], scale="utc")
    for stretch, begin in zip(numbers, begins):
        rows = table["stretch"] == stretch
        yield str(table["begin_utc"][rows][0]), (begin - begins[0]).to_value("s") + table["seconds"][rows], table["mag"][rows]


def periodogram(curve: LightCurve | AnyLight, axes: Axes | None = None, *, band: str | int = 0, gap_s: float = 1200.0) -> Axes:
    """Lomb-Scargle power of the magnitude against period, as the report has it: a line for each pass, a parabola taken
    off (range and phase angle change slowly), a floating mean (Zechmeister & Kuerster 2009). A body that looks alike
    twice a turn peaks at half its period as well. The highest peak of all stands in the title.

    Parameters
    ----------
    curve
        A light curve; or light of your own in any form that `umov.period` takes: a file, DataFrame, dictionary or table.
    axes
        To draw into; None: a new figure.
    band
        Its name, or its number along the second axis (of a table: among the names of its bands, sorted).
    gap_s
        Of a table: a longer gap begins a new line [s].

    Examples
    --------
    >>> tumbling = umov.run(EXAMPLES / "agena_maui.toml", set={
    ...     "time.step_s": 2, "object.attitude": {"mode": "spin", "axis": "+X", "period_s": 23.7}})
    >>> plot.periodogram(tumbling).get_xlabel()
    'period [s]'
    >>> import numpy as np
    >>> t = np.arange(0, 120, 0.5)
    >>> mine = {"mjd_utc": 60000 + t / 86400, "mag": 7 + 0.3 * np.sin(2 * np.pi * t / 8.2)}
    >>> plot.periodogram(mine).get_title()
    '8.199 s'
    """
    axes = _axes(axes)
    best = (0.0, 0.0)  # power, period
    for line, (name, seconds, values) in enumerate(_stretches(curve, band, gap_s)):
        period, power, peak = _umov.periodogram(seconds, values)
        if not len(power):
            continue
        axes.plot(period, power, color=MANY[line % len(MANY)], linewidth=1, label=name)
        best = max(best, (float(power.max()), peak))
    if not best[1]:
        raise UsageError("no pass has twelve epochs with light that varies; a longer one or shorter steps were expected")
    axes.set(xlabel="period [s]", ylabel="power", xscale="log", ylim=(0, 1), title=f"{best[1]:.4g} s")
    axes.grid(alpha=0.3)
    if len(axes.lines) > 1:
        axes.legend(fontsize="small")
    return axes


def folded(curve: LightCurve | AnyLight, period_s: float, axes: Axes | None = None, *, band: str | int = 0,
           gap_s: float = 1200.0) -> Axes:
    """Magnitude without range and eclipse against the part of a turn, coloured by time; of your own light the magnitude as it
    is.

    Parameters
    ----------
    curve
        A light curve; or light of your own in any form that `umov.period` takes.
    period_s
        Of the turn [s], above 0.
    axes
        To draw into; None: a new figure.
    band
        Its name, or its number along the second axis (of a table: among the names of its bands, sorted).
    gap_s
        Of a table: a longer gap begins a new stretch [s].

    Examples
    --------
    >>> plot.folded(curve, period_s=41).get_xlabel()
    'turn of 41 s'
    """
    from .light_curves import LightCurve as Curve
    period_s = number(period_s, "period_s")
    if not period_s > 0:
        raise UsageError(f"period_s is {period_s!r}; a number above 0 was expected")
    axes = _axes(axes)
    parts = list(_stretches(curve, band, gap_s))
    seconds, values = (np.concatenate([part[k] for part in parts] or [np.empty(0)]) for k in (1, 2))
    if not len(seconds):
        raise UsageError("no epoch has light; a curve with some was expected")
    drawn = axes.scatter(seconds / period_s % 1, values, c=seconds, cmap=PHASE_MAP, s=8)
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
    axes.set(xlabel=f"turn of {period_s:g} s", xlim=(0, 1),
             ylabel="magnitude, −2.5 lg intensity" if isinstance(curve, Curve) else "magnitude")
    axes.grid(alpha=0.3)
    if axes.figure is not None:
        axes.figure.colorbar(drawn, ax=axes, label="time [s]")
    return axes
