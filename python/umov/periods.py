"""How the brightness of a light curve repeats."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

from . import _umov
from ._jobs import Watch
from ._numbers import between, number, text as checked_text, whole
from .errors import UsageError
from .light_curves import LightCurve
from .observing import _text_of
from .tables import Table

if TYPE_CHECKING:
    from astropy.table import QTable
    from astropy.timeseries import TimeSeries

__all__ = ["period"]

AnyLight = Union[str, "os.PathLike[str]", LightCurve, Table, "QTable", "TimeSeries", Mapping[str, Any]]


def period(light: AnyLight, *, band: str = "", peaks: int = 5, shortest_s: float = 0.0, longest_s: float = 1e300,
           gap_s: float = 1200.0, false_alarm: float = 0.01) -> Table:
    """Periods that a light curve shows: the rows of `umov period`, the highest peak of each stretch first.

    Parameters
    ----------
    light
        A LightCurve; or a file (CSV, ECSV), Table, astropy table, DataFrame or dictionary of columns with time_utc (or
        mjd_utc, or a column of astropy Times, as a TimeSeries has) and mag or flux. Columns of astropy are taken in
        their units; `UsageError` for one of another quantity.
    band
        Only this one; "" for each by itself.
    peaks
        How many of each stretch and band, 1 to 1000.
    shortest_s
        Shorter periods are left out [s].
    longest_s
        Longer periods are left out [s].
    gap_s
        A longer gap begins a new stretch: another pass [s].
    false_alarm
        Peaks that noise alone has more often than this are left out; 1 leaves none out.

    Notes
    -----
    Lomb-Scargle with a floating mean of the magnitudes less a parabola in time; periods are synodic, and of a body with two
    like sides half a turn shows: the column `meaning` names parts, multiples and aliases of higher peaks, the note `spin` what
    they may mean. `NoResult` where no stretch has twelve brightnesses, or none stands out of noise. Sources: Zechmeister & Kuerster (2009) for
    the periodogram, Montgomery & O'Donoghue (1999) for errors, Baluev (2008) for false alarms.

    Examples
    --------
    >>> from astropy.table import Table
    >>> import numpy as np
    >>> t = np.arange(0, 120, 0.5)
    >>> seen = Table({"mjd_utc": 60000 + t / 86400, "mag": 7 + 0.3 * np.sin(2 * np.pi * t / 8.2)})
    >>> found = umov.period(seen, peaks=1)
    >>> round(float(found["period"][0]), 1), found.unit("period")
    (8.2, 's')
    """
    if not 1 <= whole(peaks, "peaks") <= 1000:
        raise UsageError(f"peaks is {peaks!r}; 1 to 1000 was expected")
    gap = number(gap_s, "gap_s")
    if not gap >= 1:
        raise UsageError(f"gap_s is {gap_s!r}; 1 s or more was expected")
    chance = number(false_alarm, "false_alarm")
    if not 0 <= chance <= 1:
        raise UsageError(f"false_alarm is {false_alarm!r}; 0 to 1 was expected")
    reach = (between(shortest_s, "shortest_s", 0, 1e300), between(longest_s, "longest_s", 0, 1e300))
    if not reach[0] < reach[1]:
        raise UsageError(f"shortest_s is {shortest_s!r} and longest_s {longest_s!r}; a longest above the shortest was expected")
    text, path = _text_of(light, "light")
    return Table(_umov.period(text, path, checked_text(band, "band"), int(peaks), reach, (gap, chance), Watch(None)))


def brightness(light: Any, band: str | int, gap_s: float) -> Table:
    """The magnitudes that `period` looks at, of one band: by name, or by its number among the names in order."""
    gap = number(gap_s, "gap_s")
    if not gap >= 1:
        raise UsageError(f"gap_s is {gap_s!r}; 1 s or more was expected")
    text, path = _text_of(light, "curve")
    name = band
    if name == "":
        raise UsageError('band is ""; the name of one or its number was expected')
    if not isinstance(name, str):
        names = sorted(set(_umov.brightness(text, path, "", gap, None).column("band")))
        if not 0 <= whole(band, "band") < max(len(names), 1):
            raise UsageError(f"there is no band {band!r}; there are {', '.join(names)}")
        if not names:
            raise UsageError("curve has no row with a magnitude; some were expected")
        name = names[name]
    found = Table(_umov.brightness(text, path, name, gap, Watch(None)))
    if not len(found):
        raise UsageError("curve has no row with a magnitude; some were expected")
    return found
