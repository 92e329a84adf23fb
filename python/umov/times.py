"""Times: ISO 8601 with an offset, aware datetimes, or astropy's Time."""
from __future__ import annotations

import datetime
from collections.abc import Iterable, Mapping, Sequence, Set
from typing import TYPE_CHECKING, Any, TypeGuard, Union

import numpy as np

from . import _umov
from ._numbers import no_foreign, number
from .errors import UsageError

if TYPE_CHECKING:
    from astropy.time import Time

__all__ = ["utc"]

AnyTime = Union[str, datetime.datetime, "Time"]


def _is_astropy(time: Any) -> TypeGuard[Time]:
    """A Time of astropy, which need not be imported; a TimeDelta knows no stars."""
    return hasattr(type(time), "sidereal_time")


def _is_skyfield(time: Any) -> bool:
    return hasattr(time, "utc_iso") and hasattr(time, "tai")


def is_moment(value: Any) -> bool:
    """Something that `utc` takes for a time and that is no text."""
    return isinstance(value, datetime.datetime) or _is_astropy(value) or _is_skyfield(value)


def _exact(time: Time) -> list[str]:
    """All its moments in ISO 8601 to a nanosecond, with Z: by erfa, as astropy's own texts are, which take four times as long."""
    if np.any(time.mask):
        raise UsageError("a Time is masked; a time that is known was expected. Leave out what is masked.")
    if time.scale == "local":
        raise UsageError(f"{time!r} is of scale local, which nobody can bring to UTC; another scale was expected, such as "
                         'Time(..., scale="utc")')
    try:
        import erfa  # of astropy

        moments = time.utc
        year, month, day, clock = erfa.d2dtf("UTC", 9, np.ravel(moments.jd1), np.ravel(moments.jd2))
        if not ((year >= 0) & (year <= 9999)).all():
            raise ValueError(f"the year {year[(year < 0) | (year > 9999)][0]}")
    except Exception as error:
        raise UsageError(f"a Time of scale {time.scale} and format {time.format} is none in UTC ({error}); one of our calendar was "
                         "expected") from error
    parts = (year, month, day, *(clock[name] for name in "hmsf"))
    return ["%04d-%02d-%02dT%02d:%02d:%02d.%09dZ" % row for row in zip(*(part.tolist() for part in parts), strict=True)]


def utc(time: AnyTime) -> str:
    """A time as the scenario writes it: ISO 8601, UTC, with Z.

    Parameters
    ----------
    time
        ISO 8601 with an offset or Z, a day alone (its 0 h UTC), an aware datetime, an astropy Time of any scale or one of
        skyfield; `UsageError` for a time without a zone, with the two lines that mend it.

    Examples
    --------
    >>> umov.utc("2018-01-21T06:00:00+02:00")
    '2018-01-21T04:00:00.000Z'
    >>> from astropy.time import Time
    >>> umov.utc(Time("2018-01-21T04:00:37", scale="tai"))
    '2018-01-21T04:00:00.000Z'
    """
    if isinstance(time, str):
        return _umov.check_time(time)
    if isinstance(time, (datetime.datetime, np.datetime64)) and time != time:
        raise UsageError("NaT is no time; a time that is known was expected. Leave it out.")
    if isinstance(time, datetime.datetime):
        if time.tzinfo is None:
            raise UsageError(
                f"{time!r} has no time zone; an aware datetime was expected. In UTC that is:\n"
                "    from datetime import timezone\n"
                "    time = time.replace(tzinfo=timezone.utc)")
        return _umov.check_time(time.isoformat())
    if _is_astropy(time):
        if not time.isscalar:
            raise UsageError(f"a Time of shape {time.shape}; a single time was expected")
        return _umov.check_time(_exact(time)[0])
    if isinstance(time, np.datetime64):
        raise UsageError(f"{time!r} has no time zone; an aware time was expected. In UTC that is astropy.time.Time({str(time)!r}, "
                         'scale="utc")')
    if _is_skyfield(time):
        if time.shape:
            raise UsageError(f"a Time of skyfield of shape {time.shape}; a single time was expected, such as times[0]")
        return _umov.check_time(time.utc_iso(places=9))  # a datetime knows neither leap seconds nor less than a microsecond
    raise UsageError(f"{time!r} is a {type(time).__name__}; a time was expected: ISO 8601 with an offset "
                     "(\"2018-01-21T04:00:00Z\"), an aware datetime or an astropy Time")


def columns_of(value: Any) -> list[str] | None:
    """Names of the columns of a table of astropy, of pandas or of umov; None for what is none, a row of one too."""
    if hasattr(value, "colnames") and not hasattr(value, "index"):
        return list(value.colnames)
    if hasattr(value, "columns") and hasattr(value, "iloc"):
        return [str(one) for one in value.columns]
    return list(value.names) if hasattr(value, "to_qtable") and hasattr(value, "names") else None


def utc_list(times: AnyTime | Sequence[AnyTime]) -> tuple[list[str], bool]:
    """Times of a call, and whether it was a single one."""
    if isinstance(times, (str, datetime.datetime)):
        return [utc(times)], True
    if (_is_astropy(times) and times.isscalar) or (_is_skyfield(times) and not getattr(times, "shape", ())):
        return [utc(times)], True
    columns = columns_of(times)
    if columns is not None:
        raise UsageError(f"a table with the columns {', '.join(columns)}; times were expected. Give its column of time, such as "
                         f'table["{next((one for one in columns if "time" in one.lower()), "time_utc")}"].')
    listed: Any = times
    if _is_skyfield(listed):  # whose several are no list
        return [_umov.check_time(one) for one in listed.utc_iso(places=9)], False
    if not isinstance(listed, Iterable) or isinstance(listed, (Mapping, Set)) or not getattr(listed, "shape", (1,)):
        raise UsageError(f"{times!r} is a {type(times).__name__}; a time or a list of times was expected")
    if _is_astropy(listed):  # one conversion for all
        return [_umov.check_time(one) for one in _exact(listed)], False
    return [utc(one) for one in listed], False


def is_gap(one: Any) -> bool:
    """None, or NaT and NaN of numpy and pandas."""
    return one is None or type(one).__name__ in ("NaTType", "NAType") or (isinstance(one, (float, np.floating, np.datetime64)) and one != one)


def plain_column(column: Any, name: str, what: str) -> Any:
    """A column of objects as it can be written: moments as texts in UTC, gaps (None, NaT, NA) as empty cells; all else as it is."""
    no_foreign(column, f"{what}'s column {name}")
    dtype = getattr(column, "dtype", None)
    if getattr(dtype, "tz", None) is not None:
        return _of_objects(list(column), name, what)  # of pandas, with a zone
    if getattr(dtype, "kind", "") == "M":
        raise UsageError(f"{what}'s column {name} has times without a zone, so they could be local times or UTC; aware times were expected. In UTC "
                         f'that is df["{name}"].dt.tz_localize("UTC") in pandas, and astropy.time.Time({name}, scale="utc")')
    if isinstance(column, np.ndarray) or (isinstance(column, (list, tuple)) and any(one is None or is_moment(one) or isinstance(
            one, (datetime.date, np.datetime64)) for one in column)):
        return _of_objects(list(column), name, what) if getattr(column, "dtype", object) == object else column
    return column


def _of_objects(cells: list[Any], name: str, what: str) -> Any:
    known = [one for one in cells if not is_gap(one)]
    if all(isinstance(one, str) for one in known):
        return ["" if is_gap(one) else str(one) for one in cells]
    truths = [row for row, one in enumerate(cells) if isinstance(one, (bool, np.bool_))]
    if truths:
        raise UsageError(f"{what}'s column {name}, row {truths[0]} is {cells[truths[0]]!r}; numbers, texts or times were expected, one kind in a column")
    if all(isinstance(one, (int, float, np.number)) for one in known):
        return np.array([np.nan if is_gap(one) else float(one) for one in cells])
    out = []
    for row, one in enumerate(cells):
        place = f"{what}'s column {name}, row {row}"
        if not (is_gap(one) or isinstance(one, (str, datetime.date, np.datetime64)) or is_moment(one)):
            raise UsageError(f"{place} is {str(one)[:60]!r}, of type {type(one).__name__}; numbers, texts or times were expected, one kind in a column")
        try:
            out.append("" if is_gap(one) else utc(one))
        except UsageError as error:
            raise UsageError(f"{place}: {error}") from error
    return out


def seconds(step: Any, name: str = "step") -> float:
    """A length of time in seconds: a Quantity, a timedelta, or a plain number if it is named so."""
    if isinstance(step, datetime.timedelta):
        return number(step.total_seconds(), name)
    if isinstance(step, np.timedelta64):
        return number(step / np.timedelta64(1, "s"), name)
    if hasattr(step, "to_value"):
        try:
            length = step.to("s")
        except Exception as error:
            raise UsageError(f"{name} is {step!r}; a length of time was expected ({error})") from error
        return number(length.to_value("s"), name)
    raise UsageError(f"{name} is {step!r}, a number without a unit; a Quantity was expected. Give "
                     f"{name}={step!r} * astropy.units.s or {name}_s={step!r}.")
