"""Elements of sgp4's Satrec, which skyfield has too, as a file: the lines of their TLE where those hold all of them, else an OMM with
every digit."""
from __future__ import annotations

import datetime
import json
import math
import re
from collections.abc import Sequence
from typing import Any

from ._jobs import Watch
from .errors import UsageError

_RATE = 1440 / (2 * math.pi)  # rad/min to revolutions a day
#: mu [km3/s2] and radius [km] of the constants for which sets are made, and which umov has (Vallado et al. 2006, section II).
_WGS72 = (398600.8, 6378.135)
#: Julian dates of the years that a date can have.
_CALENDAR = (1721425.5, 5373119.5)
#: Names that a line over two others can be: neither an element set's number nor one of its lines.
_NAME = re.compile(r"[A-Za-z][ -~]{0,23}\Z")
#: What orbits follow from.
_ELEMENTS = ("ecco", "inclo", "nodeo", "argpo", "mo", "no_kozai", "bstar", "jdsatepoch", "jdsatepochF")


def texts_of(objects: Sequence[tuple[str, Any]]) -> dict[str, str]:
    """A file of objects, each a name and a Satrec: its name and what it holds."""
    for name, model in objects:
        _check(name, model)
    _warn_of_constants(objects)
    lines = [_lines(name, model) for name, model in objects]
    if all(one is not None for one in lines):
        return {"orbit.tle": "".join(one for one in lines if one is not None)}
    return {"orbit.json": json.dumps([_message(name, model) for name, model in objects])}


def _told(name: str, model: Any) -> str:
    return f"the Satrec of {name or model.satnum}"


def _check(name: str, model: Any) -> None:
    """Elements of which there is an orbit."""
    for key in (*_ELEMENTS, "ndot", "nddot"):
        if not math.isfinite(getattr(model, key)):
            raise UsageError(f"{_told(name, model)} has {key} = {getattr(model, key)!r}; a finite number was expected. Was it made by "
                             "twoline2rv or sgp4init?")
    for key, least, most in (("ecco", 0.0, 1 - 1e-12), ("inclo", 0.0, math.pi), ("no_kozai", 1e-9 / _RATE, 100 / _RATE)):
        if not least <= getattr(model, key) <= most:
            raise UsageError(f"{_told(name, model)} has {key} = {getattr(model, key)!r}; a number from {least:.3g} to {most:.6g} was expected "
                             "(radians, and radians a minute)")
    day = model.jdsatepoch + model.jdsatepochF
    if not _CALENDAR[0] <= day < _CALENDAR[1]:
        raise UsageError(f"{_told(name, model)} has its epoch at JD {day!r}; one of the years 1 to 9998 was expected")


def _warn_of_constants(objects: Sequence[tuple[str, Any]]) -> None:
    """umov would go another way than the Satrec does."""
    other = [(name, model) for name, model in objects if (model.mu, model.radiusearthkm) != _WGS72]
    old = [(name, model) for name, model in objects if getattr(model, "operationmode", "i") != "i"]
    for found, what in ((other, "has constants other than those of WGS72, with which sets are made and umov propagates: it stands elsewhere "
                                "here, by tens to hundreds of metres within days. Make it with sgp4.api.WGS72"),
                        (old, "has operation mode \"a\"; umov propagates in mode \"i\", which differs a little for deep space")):
        if found:
            more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
            Watch(None).warn(f"{_told(*found[0])}{more} {what}")


def _lines(name: str, model: Any) -> str | None:
    """The lines of a TLE, None where they would lose digits or the name: elements of sgp4init and of an OMM have more than they hold."""
    if name and not _NAME.match(name):
        return None
    try:
        from sgp4.api import WGS72, Satrec
        from sgp4.exporter import export_tle
    except ImportError as error:
        raise UsageError("an sgp4 Satrec needs the package sgp4: pip install sgp4") from error
    try:
        pair = export_tle(model)
        again = Satrec.twoline2rv(*pair, WGS72)
    except Exception:  # no lines can hold it: angles beyond a turn, a drag above 1
        return None
    if any(getattr(again, key) != getattr(model, key) for key in _ELEMENTS):
        return None
    return "\n".join([*([name] if name else []), *pair]) + "\n"


def _epoch(model: Any) -> str:
    """To a nanosecond, from the two parts of its Julian date: noon begins a Julian day."""
    days = math.floor(model.jdsatepoch - 0.5)
    rest = (model.jdsatepoch - 0.5 - days) + model.jdsatepochF
    nanoseconds = round(rest * 86400e9)
    date = datetime.date.fromordinal(days - 1721424) + datetime.timedelta(days=nanoseconds // 86_400_000_000_000)
    seconds, parts = divmod(nanoseconds % 86_400_000_000_000, 1_000_000_000)
    return f"{date.isoformat()}T{seconds // 3600:02}:{seconds // 60 % 60:02}:{seconds % 60:02}.{parts:09}"


def _message(name: str, model: Any) -> dict[str, Any]:
    """An Orbit Mean-Elements Message (CCSDS 502.0-B-3)."""
    launch = str(getattr(model, "intldesg", "") or "").strip()
    year = int(launch[:2]) if launch[:2].isdigit() else -1
    turn = 2 * math.pi
    return {"OBJECT_NAME": name or str(model.satnum), "OBJECT_ID": f"{year + (1900 if year >= 57 else 2000)}-{launch[2:]}" if year >= 0 else "unknown",
            "CENTER_NAME": "EARTH", "REF_FRAME": "TEME", "TIME_SYSTEM": "UTC", "MEAN_ELEMENT_THEORY": "SGP4", "EPOCH": _epoch(model),
            "MEAN_MOTION": model.no_kozai * _RATE, "ECCENTRICITY": model.ecco, "INCLINATION": math.degrees(model.inclo),
            "RA_OF_ASC_NODE": math.degrees(model.nodeo % turn), "ARG_OF_PERICENTER": math.degrees(model.argpo % turn),
            "MEAN_ANOMALY": math.degrees(model.mo % turn), "EPHEMERIS_TYPE": int(getattr(model, "ephtype", 0) or 0),
            "NORAD_CAT_ID": int(model.satnum), "ELEMENT_SET_NO": int(getattr(model, "elnum", 0) or 0),
            "REV_AT_EPOCH": int(getattr(model, "revnum", 0) or 0), "BSTAR": model.bstar, "MEAN_MOTION_DOT": model.ndot * _RATE * 1440,
            "MEAN_MOTION_DDOT": model.nddot * _RATE * 1440**2}
