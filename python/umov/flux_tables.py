"""Light curves as lightkurve and the archives of TESS and Kepler have them: time, flux, flux_err."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._jobs import Watch
from ._numbers import in_units, joined, path_text, text, truth
from .errors import InputError, UsageError
from .times import utc_list

if TYPE_CHECKING:
    from astropy.table import Table as AstropyTable
    from astropy.time import Time

__all__ = ["flux_table"]


def flux_table(light: Any, band: str, *, flux: str = "flux", is_barycentric: bool | None = None) -> AstropyTable:
    """A light curve with time, flux and flux_err as a table for `invert_pose` and the other questions.

    Parameters
    ----------
    light
        A lightkurve LightCurve, an astropy TimeSeries or Table, a DataFrame (times in a column time or as its index), or a FITS
        file of TESS or Kepler (TIME, SAP_FLUX, PDCSAP_FLUX). Names of columns may have either case.
    band
        Name of the band, as in the scenario's bands.set.
    flux
        Column of the flux; its error is the one with "_err" behind it. Any unit: the scale is free.
    is_barycentric
        Whether times are those of light at the barycentre of the solar system (BJD): None asks the data, whose header
        (TIMEREF) or time format (btjd, bkjd) says so. Such times are brought back by the column "timecorr".

    Returns
    -------
    astropy.table.Table
        Columns time_utc, band, flux, flux_err; rows without a flux or with a quality flag are left out, and what was
        assumed stands in a `UmovWarning`.

    Notes
    -----
    Times without a scale are taken for TDB in a file of TESS or Kepler. A satellite stands up to 8.3 min of light away
    from where a time at the barycentre would have it: `InputError` where such times have no "timecorr". The observer is
    that of the scenario, on the ground. Source: TESS Science Data Products Description Document, section 5.

    Examples
    --------
    >>> from astropy.timeseries import TimeSeries
    >>> series = TimeSeries({"flux": [1.0, 1.2], "flux_err": [0.1, 0.1]}, time=["2018-01-21T05:09:00", "2018-01-21T05:09:20"])
    >>> str(umov.flux_table(series, "nm:550")["time_utc"][0])
    '2018-01-21T05:09:00.000000Z'
    """
    from astropy.table import Table
    band, flux = text(band, "band"), text(flux, "flux")
    if isinstance(light, (str, os.PathLike)):
        light = _read(path_text(light, "light"))
    elif isinstance(light, Mapping) or (hasattr(light, "to_dict") and hasattr(light, "columns")):
        light = _of_columns(light)
    names = {name.lower(): name for name in getattr(light, "colnames", ())}
    if not names:
        raise UsageError(f"light is a {type(light).__name__}; a lightkurve LightCurve, an astropy TimeSeries or Table, a DataFrame or a FITS "
                         "file with time, flux and flux_err was expected")
    for wanted in ("time", flux.lower()):
        if wanted not in names:
            raise InputError(f"light has no column {wanted!r}; there are {', '.join(names.values())}. Name the flux by flux=...")
    time, assumed = _time_of(light, names)
    time, more = _at_the_observer(time, light, names, is_barycentric)
    error_name = flux.lower() + "_err"
    given = {name: light[names[column]] for name, column in (("flux", flux.lower()), ("flux_err", error_name)) if column in names}
    in_one_unit = in_units(Table(given, copy=False), "light")
    values = _numbers(in_one_unit["flux"], flux)
    errors = _numbers(in_one_unit["flux_err"], error_name) if error_name in names else np.full(len(values), np.nan)
    flags = _numbers(light[names["quality"]], "quality") if "quality" in names else np.zeros(len(values))
    kept = np.isfinite(values) & (flags == 0) & np.isfinite(_numbers(time.jd, "time"))
    if not kept.any():
        raise InputError(f"light has no row with a finite {flux} and quality 0; rows: {len(values)}")
    assumed += more
    if error_name not in names:
        assumed.append(f"no column {error_name}: the flux is taken as good as the fit's floor allows")
    if not kept.all():
        assumed.append(f"{len(kept) - kept.sum()} of {len(kept)} rows without a flux or with a quality flag are left out")
    if assumed:
        Watch(None).warn("; ".join(assumed))
    exact = time[kept].utc.replicate(format="isot")
    exact.precision = 6
    return Table({"time_utc": [f"{one}Z" for one in exact.value], "band": [band] * int(kept.sum()), "flux": values[kept],
                  "flux_err": errors[kept]})


def _of_columns(light: Any) -> AstropyTable:
    """A DataFrame or a dictionary of columns; moments and texts of its column of time as Times."""
    from astropy.table import QTable
    columns = {str(name): joined(light[name], str(name)) if isinstance(light, Mapping) else np.asarray(light[name])
               for name in (light if isinstance(light, Mapping) else light.columns)}
    index: Any = getattr(light, "index", None)
    if hasattr(index, "tz") and "time" not in {name.lower() for name in columns}:
        columns = {"time": np.asarray(index.astype(object)), **columns}
    try:
        return QTable({name: _moments(column) if name.lower() == "time" else column for name, column in columns.items()})
    except (TypeError, ValueError) as error:
        raise UsageError(f"light is a table of columns that are none ({error}); arrays of one length were expected") from error


def _moments(column: Any) -> Any:
    """Moments and texts as Times; all else as it is."""
    from astropy.time import Time
    if hasattr(column, "scale") or np.ma.isMaskedArray(column):
        return column
    given = np.asarray(column)
    is_time = given.dtype.kind in "UM" or (given.dtype.kind == "O" and not all(isinstance(one, (int, float)) for one in given.flat))
    return Time([one.removesuffix("Z") for one in utc_list(list(given))[0]], scale="utc") if is_time else column


def _read(path: str) -> AstropyTable:
    from astropy.io import fits
    from astropy.table import Table
    try:
        with fits.open(path) as file:
            tables = [one for one in file[1:] if getattr(one, "columns", None) is not None]
            if not tables:
                raise InputError(f"{path}: holds no table; a light curve with TIME and a flux was expected")
            out = Table(tables[0].data)
            out.meta.update({key: tables[0].header[key] for key in ("TIMEREF", "TIMESYS", "BJDREFI", "BJDREFF", "TIMEUNIT")
                             if key in tables[0].header})
            return out
    except OSError as error:
        raise InputError(f"{path}: cannot be read as FITS ({error}); a light curve of TESS or Kepler was expected") from error


def _numbers(column: Any, name: str, into: str | None = None) -> np.ndarray:
    """One number a row, NaN where there is none; in the unit `into`, which numbers without one are in."""
    values = np.ma.asarray(getattr(column, "value", column))
    if values.ndim != 1 or values.dtype.kind not in "fiub":
        raise UsageError(f"light's column {name} has shape {values.shape} of {values.dtype}; one number a row was expected")
    out = np.asarray(np.ma.filled(values.astype(float), np.nan), dtype=float)
    unit = getattr(column, "unit", None)
    if unit is None or into is None:
        return out
    try:
        return out * float(unit.to("" if unit.is_equivalent("") else into))
    except Exception as error:
        raise UsageError(f"light's column {name} is in {unit}; what goes into {into} was expected ({error})") from error


def _time_of(light: Any, names: dict[str, str]) -> tuple[Time, list[str]]:
    """Times, and what was assumed of them."""
    from astropy.time import Time
    column = light[names["time"]]
    if hasattr(column, "scale") and hasattr(column, "utc"):
        return column, ([] if column.scale == "utc" else [f"times are in {column.scale.upper()} and are brought to UTC"])
    meta = {str(key).upper(): value for key, value in getattr(light, "meta", {}).items()}
    if "BJDREFI" not in meta:
        raise InputError("light's column time holds numbers without a scale; astropy Times were expected, such as "
                         "Time(light['time'], format='mjd', scale='utc'), or the header's BJDREFI as in files of TESS")
    zero = float(meta["BJDREFI"]) + float(meta.get("BJDREFF", 0))
    scale = str(meta.get("TIMESYS", "TDB")).strip().lower()
    values = _numbers(column, "time")
    out = Time(np.where(np.isfinite(values), values, 0.0), zero, format="jd", scale=scale)
    out[~np.isfinite(values)] = np.ma.masked
    return out, [f"times are days of {scale.upper()} since JD {zero:.0f} and are brought to UTC"]


def _at_the_observer(time: Time, light: Any, names: dict[str, str], is_barycentric: bool | None) -> tuple[Time, list[str]]:
    """Times of light at the telescope, of times of light at the barycentre."""
    from astropy.time import TimeDelta
    meta = {str(key).upper(): value for key, value in getattr(light, "meta", {}).items()}
    if is_barycentric is not None:
        is_barycentric = truth(is_barycentric, "is_barycentric")
    else:
        is_barycentric = time.format in ("btjd", "bkjd") or "SOLARSYSTEM" in str(meta.get("TIMEREF", "")).upper().replace(" ", "")
    if not is_barycentric:
        return time, []
    if "timecorr" not in names:
        raise InputError("light's times are those at the barycentre of the solar system and there is no column timecorr to bring "
                         "them back, up to 8.3 min; add it, or give is_barycentric=False if they are the telescope's own")
    days = _numbers(light[names["timecorr"]], "timecorr", "d")
    return time - TimeDelta(np.nan_to_num(days), format="jd"), ["times at the barycentre are brought back by timecorr"]
