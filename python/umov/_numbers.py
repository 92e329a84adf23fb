"""Numbers of arguments: what is none, or has another unit, is told of."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._units import ARGUMENTS, KEYS
from .errors import UsageError

def plain(value: Any, name: str, system: str = "AB") -> Any:
    """A Quantity in the unit of the argument `name`, a list of them too; all else as it is. `system`: of magnitudes."""
    return _in_unit_of(value, name, ARGUMENTS.get(name), system)


def plain_key(value: Any, key: str) -> Any:
    """The same of a key of a scenario, such as "observation.exposure_s"."""
    table, _, last = key.rpartition(".")
    is_sky = table.rpartition(".")[2] == "dark_mag"  # whose keys are filters
    return _in_unit_of(value, key, ARGUMENTS["sky_mag"] if is_sky else KEYS.get(last), "AB")


def _in_unit_of(value: Any, name: str, unit: str | None, system: str) -> Any:
    value = joined(value, name)
    if not hasattr(value, "to_value") or not hasattr(value, "unit"):  # a length of time or a Time is none: whoever reads numbers says so
        return value
    if unit is None:
        raise UsageError(f"{name} is {_short(value)}, with a unit; a plain number was expected")
    if hasattr(value, "physical"):  # magnitudes and the like of a known zero
        return _of_system(value, name, unit, system)
    if unit in _MAGNITUDES:
        return _of_magnitudes(value, name, unit)
    return in_unit(value, name, unit)


#: Units of plain magnitudes for each unit wanted. astropy takes a dex (-2.5 mag), a decibel, and the mag/deg2 of a sky for the
#: same kind: their numbers would be scaled, and are none.
_MAGNITUDES = {"mag": ("mag", "mmag"), "mag / arcsec2": ("mag / arcsec2", "mmag / arcsec2", "mag", "mmag")}


def _of_magnitudes(value: Any, name: str, unit: str) -> Any:
    for one in _MAGNITUDES[unit]:
        if value.unit == one:
            return value.value * (1e-3 if one.startswith("mmag") else 1.0)
    raise UsageError(f"{name} is {_short(value)}; a magnitude was expected, in {' or '.join(_MAGNITUDES[unit])}, or a plain number in {unit}")


def in_unit(value: Any, name: str, *units: str) -> Any:
    """A Quantity in the first unit that it goes into; `UsageError` where it goes into none."""
    for unit in units:
        if value.unit.is_equivalent(unit):
            return value.to_value(unit)
    told = _UNIT_WORDS.get(units[0], units[0])
    raise UsageError(f"{name} is {_short(value)}, which does not go into {told}; that was expected, or a plain number in it")


_UNIT_WORDS = {"": "a number without a unit (per cent is one)", "mag": "a magnitude"}


def _of_system(value: Any, name: str, unit: str, system: str) -> Any:
    """A magnitude with its zero, as astropy and our own tables have it: AB is no other system's."""
    from astropy import units
    zero = {"AB": units.AB, "ST": units.ST}.get(system)
    flux = value.unit.physical_unit
    wanted = None if zero is None else [zero, zero / units.arcsec**2] if unit == "mag / arcsec2" else [zero]
    if unit not in ("mag", "mag / arcsec2") or not isinstance(value.unit, units.MagUnit):
        raise UsageError(f"{name} is {_short(value)}; {_UNIT_WORDS.get(unit, unit)} was expected")
    if flux != units.dimensionless_unscaled and not any(flux.is_equivalent(one) for one in wanted or []):
        raise UsageError(f"{name} is {_short(value)}; a magnitude of {system} was expected, which is the system asked for")
    into = next((one for one in wanted or [] if flux.is_equivalent(one)), flux)
    return value.to_value(units.mag(into))


def joined(value: Any, name: str) -> Any:
    """A list of Quantities as one; all else as it is."""
    no_foreign(value, name)
    if not isinstance(value, (list, tuple)) or not value or not all(hasattr(one, "to_value") for one in value):
        return value
    from astropy.units import Quantity
    try:
        return Quantity(value)
    except Exception as error:
        raise UsageError(f"{name} is {_short(value)}; quantities of one kind and shape were expected ({error})") from error


def no_foreign(value: Any, name: str) -> None:
    """Quantities of pint, unyt and others, whose unit an array of numbers would lose: `UsageError`."""
    for one in value if isinstance(value, (list, tuple)) else (value,):
        kind = type(one)
        if any(hasattr(kind, has) for has in ("units", "dimensionality")) and not hasattr(one, "unit"):
            raise UsageError(f"{name} is {_short(value)}, a {kind.__name__} of {kind.__module__.partition('.')[0]}, whose unit is not read; a Quantity "
                             "of astropy or a plain number was expected: value.to_astropy() of unyt, value.magnitude * "
                             "astropy.units.Unit(str(value.units)) of pint")
        told = getattr(one, "attrs", None)
        if isinstance(told, Mapping) and told.get("units") not in (None, "", "1"):  # what xarray takes from a netCDF file
            raise UsageError(f"{name} has attrs[\"units\"] = {told['units']!r}, which is not read; a Quantity of astropy or a plain number "
                             "was expected: value.values * astropy.units.Unit(value.attrs[\"units\"])")


def lengths(value: Any, name: str) -> Any:
    """The numbers of a Quantity of lengths, or of a list of them, whose unit does not matter; all else as it is."""
    value = joined(value, name)
    if not hasattr(value, "to_value") or not hasattr(value, "unit"):
        return value
    if value.unit.physical_type not in ("length", "dimensionless"):
        raise UsageError(f"{name} is in {value.unit}; a direction was expected, (..., 3) of lengths or plain numbers")
    return value.to_value(value.unit)


def _is_masked(value: Any) -> bool:
    """Of numpy or astropy, with something behind the mask: an array would show what nobody is to see."""
    mask = getattr(value, "mask", None)
    return isinstance(mask, (bool, np.bool_, np.ndarray)) and bool(np.any(mask))


#: What float() takes for numbers.
_NO_NUMBERS = (str, bytes, bool, np.bool_)


def real_array(value: Any, name: str, expected: str = "numbers") -> NDArray[np.float64]:
    """Numbers as float64. Texts, dates and truth values are none, although numpy would take them; what is masked has no
    value."""
    no_foreign(value, name)
    if _is_masked(value) or (isinstance(value, (list, tuple)) and any(_is_masked(one) for one in value)):
        raise UsageError(f"{name} has masked values; {expected} were expected. Leave them out first.")
    try:
        with np.errstate(over="ignore"):
            given = np.asarray(value)
            if given.dtype.kind not in "fiuO" or (given.dtype.kind == "O" and any(isinstance(one, _NO_NUMBERS) for one in given.flat)):
                raise TypeError(given.dtype)
            return given.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"{name} is {_short(value)}; {expected} were expected") from error


def _short(value: Any) -> str:
    try:
        text = repr(value.item() if isinstance(value, np.generic) else value)
    except RecursionError:  # lists in lists without number
        text = "[" * 201
    return text if len(text) <= 200 else f"{text[:200]} ... ({type(value).__name__})"


def number_array(value: ArrayLike, name: str, system: str = "AB") -> NDArray[np.float64]:
    """Finite numbers as float64, a Quantity in the unit that _units.py has for that argument."""
    out = real_array(plain(value, name, system), name)
    if not np.isfinite(out).all():
        raise UsageError(f"{name} is {_short(value)}; a finite number was expected" if out.ndim == 0 else
                         f"{name} has values that are not finite; finite numbers were expected")
    return out


def number(value: Any, name: str, system: str = "AB") -> float:
    """One finite number. Texts are none, although float() would take them."""
    if isinstance(value, (str, bytes)):
        raise UsageError(f"{name} is {value!r}; a number was expected")
    out = number_array(value, name, system)
    if out.ndim:
        raise UsageError(f"{name} has shape {out.shape}; a single number was expected")
    return float(out)


def whole(value: Any, name: str, last: int = 2**31 - 1) -> int:
    """A whole number from 0 on."""
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool) or not 0 <= value <= last:
        raise UsageError(f"{name} is {value!r}; a whole number from 0 to {last} was expected")
    return int(value)


def truth(value: Any, name: str) -> bool:
    """True or False, and nothing that only counts as one of them."""
    if not isinstance(value, (bool, np.bool_)):
        raise UsageError(f"{name} is {value!r}; True or False was expected")
    return bool(value)


def text(value: Any, name: str) -> str:
    """A text that can be written."""
    if not isinstance(value, str):
        raise UsageError(f"{name} is {value!r}; a text was expected")
    return utf8(value, name)


def path_text(value: Any, name: str, wanted: str = "the name of a file") -> str:
    """The path of a file as text. A name that is no UTF-8 cannot stand in a scenario, a table or a message; one with the
    character 0 would be another file's."""
    if not isinstance(value, (str, os.PathLike)):
        raise UsageError(f"{name} is a {type(value).__name__}; {wanted} was expected")
    try:
        text = os.fsdecode(value)
    except TypeError as error:
        raise UsageError(f"{name} is a {type(value).__name__} that names no file ({error}); {wanted} was expected") from error
    if not text:
        raise UsageError(f"{name} is \"\"; {wanted} was expected")
    if "\0" in text:  # the system takes a name to end there: another file
        raise UsageError(f"{name} is {text!r}; {wanted} without the character 0 was expected")
    return utf8(text, name)


def utf8(text: str, name: str) -> str:
    """The text itself, if it can be written."""
    try:
        text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise UsageError(f"{name} is {text!r}, which is no UTF-8; a text was expected that can be written. Rename a file "
                         "that is named so.") from error
    return text


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


_COUNTS = ("counts", "sky", "sky_err")
_LIGHT = ("flux", "flux_err", "I", "I_err", "I_obs")


def _wanted(name: str, unit: Any) -> tuple[Any, str]:
    """The unit that a column of light or counts is to have, None where it may stay; and, where it is another quantity,
    what was expected instead."""
    from astropy import units
    if unit.is_equivalent(units.dimensionless_unscaled):
        return None, ""
    if name in ("mjd_utc", "mjd"):
        return (units.d, "") if unit.is_equivalent(units.d) else (None, "days")
    if name in ("mag", "mag_err"):
        if isinstance(unit, units.MagUnit):
            return None, ""
        return (units.mag, "") if unit in (units.mag, units.mmag) else (None, "magnitudes")
    if name in _COUNTS:
        return None, "" if unit in (units.ct, units.electron, units.adu, units.photon, units.DN) else "electrons or other counts"
    if name in _LIGHT:
        others = (units.mag, units.s, units.m, units.rad)
        wrong = isinstance(unit, units.MagUnit) or any(unit.is_equivalent(one) for one in others)
        return None, "a flux, linear in light, (magnitudes in a column mag)" if wrong else ""
    if name in ("q", "u", "q_err", "u_err"):
        return None, "a part of I without a unit"
    if name.endswith("_deg"):
        return (units.deg, "") if unit.is_equivalent(units.deg) else (None, "an angle")
    return None, ""


def in_units(table: Any, what: str) -> Any:
    """A table of astropy with the columns in the units in which they are read, where they have one at all."""
    out = table
    for name in table.colnames:
        column = table[name]
        unit = getattr(column, "unit", None)
        if unit is None:
            continue
        into, expected = _wanted(name, unit)
        if expected:
            raise UsageError(f"{what} has the column {name} in {unit}; {expected} was expected. Convert it, or take the unit off if it "
                             "is wrong.")
        if name.endswith("_err") and name[:-4] in _LIGHT and name[:-4] in table.colnames:
            into = getattr(table[name[:-4]], "unit", None)
            if into is not None and not unit.is_equivalent(into):
                raise UsageError(f"{what} has the column {name} in {unit} and {name[:-4]} in {into}; the same unit was expected")
        if into is not None and into != unit:
            out = out.copy() if out is table else out
            out[name] = column.to(into) if hasattr(column, "to_value") else _scaled(column, unit.to(into), into)
    return out


def _scaled(column: Any, factor: float, unit: Any) -> Any:
    """A plain column, with its mask, which its own `to` drops."""
    out = column * factor
    out.unit = unit
    return out
