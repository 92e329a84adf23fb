"""Numbers of arguments: what is none, or has another unit, is told of."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import UsageError


#: Ends of names that are not units as astropy spells them.
_UNITS = {"_deg_s": "deg/s", "_km_s": "km/s", "_e_s": "electron/s", "_hpa": "hPa"}


def plain(value: Any, name: str) -> Any:
    """A Quantity in the unit that the name ends with; all else as it is."""
    if not hasattr(value, "to_value"):
        return value
    if "_" not in name:
        raise UsageError(f"{name} has a unit; plain numbers were expected")
    unit = next((unit for end, unit in _UNITS.items() if name.endswith(end)), name.rsplit("_", 1)[-1])
    try:
        return value.to_value(unit)
    except Exception as error:
        raise UsageError(f"{name} is {value!r}; it does not go into that unit ({error})") from error


def number_array(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """Finite numbers as float64."""
    try:
        given = np.asarray(plain(value, name))
        if given.dtype.kind == "c":
            raise TypeError("complex")
        out = given.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"{name} is {value!r}; numbers were expected") from error
    if not np.isfinite(out).all():
        raise UsageError(f"{name} has values that are not finite; finite numbers were expected")
    return out


def number(value: Any, name: str) -> float:
    """One finite number. Texts are none, although float() would take them."""
    if isinstance(value, (str, bytes)):
        raise UsageError(f"{name} is {value!r}; a number was expected")
    out = number_array(value, name)
    if out.ndim:
        raise UsageError(f"{name} has shape {out.shape}; a single number was expected")
    return float(out)


def whole(value: Any, name: str, last: int = 2**31 - 1) -> int:
    """A whole number from 0 on."""
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool) or not 0 <= value <= last:
        raise UsageError(f"{name} is {value!r}; a whole number from 0 to {last} was expected")
    return int(value)


def between(value: Any, name: str, least: float, most: float) -> float:
    """A number within limits, both allowed."""
    out = number(value, name)
    if not least <= out <= most:
        raise UsageError(f"{name} is {value!r}; a number from {least:g} to {most:g} was expected")
    return out


def whole_between(value: Any, name: str, least: int, most: int) -> int:
    """A whole number within limits, both allowed."""
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool) or not least <= value <= most:
        raise UsageError(f"{name} is {value!r}; a whole number from {least} to {most} was expected")
    return int(value)
