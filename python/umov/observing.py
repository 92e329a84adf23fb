"""What a telescope with a polarimeter records, and what its counts tell."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

from . import _toml, _umov
from ._jobs import Progress, Watch, job_options
from ._made import Made
from ._numbers import between, in_units, number, path_text, text as text_of, truth, whole
from .errors import DeviceError, InputError, UsageError
from .scenarios import AnyScenario, Scenario
from .tables import Table
from .times import plain_column, utc, utc_list

if TYPE_CHECKING:
    from astropy.table import QTable

__all__ = ["Calibration", "Observation", "calibrate", "exposure", "instrument", "instruments", "observe", "reduce"]


class Observation(NamedTuple):
    """What `umov.observe` simulated.

    >>> seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 20})
    >>> seen.exposures, "counts" in seen.counts, "q" in seen.truth
    (18, True, True)
    """

    counts: Table  #: a row per exposure and channel: electrons, sky, noise; the columns of counts.ecsv
    truth: Table  #: a row per exposure: what a reduction should find; the columns of truth.ecsv
    exposures: int  #: how many
    saturated: int  #: of them, with a channel that is full
    frames: int = 0  #: pictures that were made, with `level = "image"`

    def __repr__(self) -> str:
        return (f"<umov.Observation: {self.exposures} exposures, {self.saturated} of them saturated, {len(self.counts)} rows of "
                "counts; .counts and .truth are tables>")


AnyCounts = Union[str, "os.PathLike[str]", Observation, Table, "QTable", Mapping[str, Any]]


def observe(scenario: AnyScenario, *, set: Mapping[str, Any] | None = None,
            frames: str | os.PathLike[str] | None = None, threads: int = 0, cache: bool | str | os.PathLike[str] = True, progress: Progress = None,
            allow_bad_checksum: bool = False, allow_old_elements: bool = False, device: str = "cpu") -> Observation:
    """Counts that an instrument would record of a scenario: the tables of `umov observe`, in memory.

    Parameters
    ----------
    scenario
        With [observation] and an instrument; path, dictionary or Scenario.
    set
        Changes of its keys, such as {"observation.exposure_s": 0.1}.
    frames
        A folder, made if need be, for the frames of `observation.level = "image"`: a FITS file with its WCS for each
        exposure, which must not be there yet. None: counts are taken from frames that go nowhere.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier runs: True as the command keeps them, a folder, or False.
    progress
        True for a bar, or a callable (what, done, total).
    allow_bad_checksum
        Elements with a wrong checksum are read all the same.
    allow_old_elements
        Elements more than 30 days old are taken all the same.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.

    Notes
    -----
    `InputError` without an instrument, `NoResult` if no exposure falls in a pass, `NumericsError` if every one is
    saturated. Source: docs/theory/observing.md.

    Examples
    --------
    >>> umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 60}).counts.unit("counts")
    'electron'
    """
    asked = Scenario(scenario, set)
    done = _umov.observe(asked._scenario, job_options(threads, cache, allow_bad_checksum, allow_old_elements, device),
                         "" if frames is None else _folder(frames), Watch(progress))
    return Observation(Table(done.counts), Table(done.truth), done.exposures, done.saturated, done.frames)


def _folder(path: Any) -> str:
    """A folder that is there."""
    if not isinstance(path, (str, os.PathLike)):
        raise UsageError(f"frames is a {type(path).__name__}; the name of a folder was expected")
    try:
        os.makedirs(path_text(path, "frames"), exist_ok=True)
    except OSError as error:
        raise DeviceError(f"{os.fspath(path)}: cannot be made ({error}); a folder for frames was expected") from error
    return os.path.abspath(path)


def _text_in(path: str, what: str) -> tuple[str, str]:
    try:
        with open(path, "rb") as file:
            is_fits = file.read(9) == b"SIMPLE  ="
        if not is_fits:
            return pathlib.Path(path).read_text(encoding="utf-8"), path
    except (OSError, UnicodeDecodeError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error}); a file of {what} was expected") from error
    raise InputError(f"{path}: is FITS, which is not read here; {what} as ECSV or CSV was expected. Give the table itself, or what "
                     "its write('x.ecsv') wrote.")


def _text_of(table: Any, what: str) -> tuple[str, str]:
    """A table as the text of a file, and the name of that file in messages."""
    if isinstance(table, Observation):
        table = table.counts
    if hasattr(table, "_own_rows"):  # a light curve
        table = table._own_rows()
    if isinstance(table, (str, os.PathLike)):
        return _text_in(path_text(table, what), what)
    if isinstance(table, Table):
        return table._table.ecsv(), what
    notes: Any = None
    if hasattr(table, "to_dict") and hasattr(table, "columns"):  # pandas
        if not table.columns.is_unique:
            raise UsageError(f"{what} has two columns {table.columns[table.columns.duplicated()][0]}; a name for each was expected")
        notes = table.attrs.get("notes")
        table = {str(name): _of_pandas(table[name]) for name in table.columns} | _time_of_index(table)
    if isinstance(table, Mapping):
        from astropy.table import Table as Columns
        columns = {str(name): plain_column(one, str(name), what) for name, one in table.items()}
        try:
            table = Columns(columns, meta=notes)
        except (TypeError, ValueError) as error:
            raise UsageError(f"{what} is a table of columns that are none ({error}); arrays of one length were expected") from error
    if hasattr(table, "colnames") and hasattr(table, "write"):
        import io

        from ._shown import with_all_digits
        out = io.StringIO()
        table = with_all_digits(_without_objects(table, what))
        in_units(_with_time_utc(table, what), what).write(out, format="ascii.ecsv")
        try:
            out.getvalue().encode("utf-8")
        except UnicodeEncodeError as error:
            raise UsageError(f"{what} has a text that is no UTF-8 ({error.reason}); texts that can be written were expected") from error
        return out.getvalue(), what
    raise UsageError(f"{what} is a {type(table).__name__}; a file, a Table, an astropy table, a DataFrame or a dictionary of columns "
                     "was expected")


def _of_pandas(column: Any) -> Any:
    """A column of pandas as numpy has it; times with a zone in UTC."""
    if getattr(column.dtype, "tz", None) is not None:
        return [utc(one.to_pydatetime()) if one == one else "" for one in column]
    return column.to_numpy()


def _time_of_index(table: Any) -> dict[str, Any]:
    """Times that a DataFrame has for its index, where no column has them."""
    if not hasattr(table.index, "tz") or {"time_utc", "mjd_utc", "mjd"} & {str(name) for name in table.columns}:
        return {}
    return {"time_utc": _of_pandas(table.index.to_series())}


def _without_objects(table: Any, what: str) -> Any:
    """A table of astropy whose columns of objects can be written."""
    held = [name for name in table.colnames if getattr(table[name], "dtype", None) == object and len(table[name].shape) == 1]
    if not held:
        return table
    from astropy.table import Column
    out = table.copy()
    for name in held:
        out.replace_column(name, Column(plain_column(np.asarray(table[name]), name, what)))
    return out


def _with_time_utc(table: Any, what: str) -> Any:
    """A column of astropy Times, such as the first of a TimeSeries, as time_utc."""
    if several := [name for name in table.colnames if len(table[name].shape) > 1]:
        raise UsageError(f"{what} has the column {several[0]} of shape {table[several[0]].shape}; one value a row was expected. Give one "
                         "band of it, as to_timeseries(band) does.")
    timed = [name for name in table.colnames if hasattr(table[name], "sidereal_time")]
    if not timed:
        return table
    if len(timed) > 1:
        raise UsageError(f"{what} has the times {', '.join(timed)}; one of them was expected, as time_utc")
    from astropy.table import Table as Columns
    return Columns({"time_utc" if name == timed[0] else name: utc_list(table[name])[0] if name == timed[0] else table[name]
                    for name in table.colnames}, meta=table.meta)


class Calibration(Made):
    """Efficiency, angle and own polarization of an instrument in a band, as `umov calibrate` finds them.

    Parameters
    ----------
    path
        A TOML file that `to_toml` or the command wrote.

    Examples
    --------
    >>> text = '''instrument = "mine"
    ... band = "Bessell.V"
    ... efficiency = 0.98
    ... efficiency_sd = 0.01
    ... phi0_deg = 0.4
    ... q0 = 0.001
    ... u0 = 0
    ... q0_sd = 0.0005
    ... '''
    >>> umov.Calibration.from_toml(text).to_dict()["efficiency"]
    0.98
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._text, self._path = _text_of(path, "a calibration")
        self._check()

    @classmethod
    def from_toml(cls, text: str, path: str = "calibration.toml") -> Calibration:
        """From a text.

        Parameters
        ----------
        text
            As `to_toml` gives it.
        path
            The file that it stands for in messages.

        Notes
        -----
        `InputError` with line and column for what is no calibration.
        """
        out = cls.__new__(cls)
        out._text, out._path = text_of(text, "text"), text_of(path, "path")
        out._check()
        return out

    def _check(self) -> None:
        self.to_dict()  # TOML at all
        _umov.check_calibration(self._text, self._path)

    def to_toml(self) -> str:
        """As a file for `umov reduce --calibration`."""
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary; angles in degrees."""
        return _toml.tables_of(self._text, self._path)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Calibration) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        table = self.to_dict()
        return f"<umov.Calibration of {table.get('instrument', '')!r} in {table.get('band', '')!r}>"


def reduce(counts: AnyCounts, *, calibration: Calibration | str | os.PathLike[str] | None = None,
           period_s: float | None = None, harmonics: int = 3, knot_s: float | None = None, q0_sd: float = 0.0, gain_sd: float = 0.0,
           angle_sd_deg: float = 0.0, efficiency_sd: float = 0.0, sky_sd: float = 0.0, sky_p_sd: float = 0.0, transparency_sd: float = 0.0,
           transparency_time_s: float = 0.0, crosstalk_sd: float = 0.0, plate_sd_deg: float = 0.0, retardance_sd_deg: float = 0.0, time_sd_s: float = 0.0,
           aperture_sd: float = 0.0, zero_sd_mag: float = 0.0, colour: float | None = None, threads: int = 0,
           progress: Progress = None) -> Table:
    """Stokes parameters with their errors from counts: the rows of `umov reduce`, one per set.

    Parameters
    ----------
    counts
        What `observe` gave, or a file (ECSV, CSV), Table or astropy table with its columns: time_utc, set_id, band,
        counts, sky, sky_err, var_read [electron] and w0 ... w3, what a channel takes of I, Q, U, V.
    calibration
        Of `calibrate`, or its file: taken out of q and u, or of I.
    period_s
        Brightness as a Fourier series of this period [s], with q and u that stay: for one analyser after the other
        on a tumbling object. None: every set by itself.
    harmonics
        Of that series, 1 to 100.
    knot_s
        The same with splines, knots this far apart [s], where there is no period.
    q0_sd
        How well the instrument's own q and u are known (standard deviation).
    gain_sd
        How well the gain of each channel is known, relative.
    angle_sd_deg
        How well the angle of the instrument's x axis is known [deg].
    efficiency_sd
        How well the efficiency is known.
    sky_sd
        How well the whole sky is known, relative.
    sky_p_sd
        How well the sky's polarization along the normal of the scattering plane is known: counts with `pa_scat`.
    transparency_sd
        How much the air lets through changes from exposure to exposure, relative, beside scintillation: thin cloud.
    transparency_time_s
        In which that changes [s]: exposures share it as exp(-dt/this). 0: as the header's `cloud_time_s`, else each has its own.
    crosstalk_sd
        How much of Q and U mirrors may turn into V, and back: parts of them.
    plate_sd_deg
        How well the zero of a plate's angle is known [deg].
    retardance_sd_deg
        How well the retardance of a plate is known [deg].
    time_sd_s
        How well the clock is known [s]: the instrument's axes turn meanwhile in the sky.
    aperture_sd
        How well the share of the light in the apertures of an exposure is known, relative.
    zero_sd_mag
        How well the zero point is known [mag].
    colour
        Of the object, in the index of the photometric standards; None: B - V of the Sun, .653 (Ramirez et al. 2012).
    threads
        0 for all cores.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    q and u are fractions of I in the frame that the counts tell (`pol_frame`; IAU signs), pa in degrees.
    `InputError` where no set can be solved. Source: docs/theory/observing.md.

    Examples
    --------
    >>> seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 20})
    >>> found = umov.reduce(seen)
    >>> 0 < len(found) <= seen.exposures, found.unit("pa")
    (True, 'deg')
    """
    period = 0.0 if period_s is None else number(period_s, "period_s")
    if period_s is not None and not period > 0:
        raise UsageError(f"period_s is {period_s!r}; a number above 0 was expected")
    if not 1 <= whole(harmonics, "harmonics") <= 100:
        raise UsageError(f"harmonics is {harmonics}; 1 to 100 was expected")
    knot = 0.0 if knot_s is None else number(knot_s, "knot_s")
    if knot_s is not None and not knot > 0:
        raise UsageError(f"knot_s is {knot_s!r}; a number above 0 was expected")
    if knot and period:
        raise UsageError("period_s and knot_s were both given; one of them was expected")
    given = {"q0_sd": q0_sd, "gain_sd": gain_sd, "angle_sd_deg": angle_sd_deg, "efficiency_sd": efficiency_sd,
             "sky_sd": sky_sd, "sky_p_sd": sky_p_sd, "transparency_sd": transparency_sd, "transparency_time_s": transparency_time_s,
             "crosstalk_sd": crosstalk_sd, "plate_sd_deg": plate_sd_deg, "retardance_sd_deg": retardance_sd_deg, "time_sd_s": time_sd_s,
             "aperture_sd": aperture_sd, "zero_sd_mag": zero_sd_mag}
    errors = {name: number(value, name) for name, value in given.items()}
    if wrong := [f"{name} is {value!r}" for name, value in errors.items() if not 0 <= value <= 1e5]:
        raise UsageError(f"{wrong[0]}; a number from 0 to 100000 was expected")
    text, path = _text_of(counts, "counts")
    known = Calibration(calibration) if isinstance(calibration, (str, os.PathLike)) else calibration
    if known is not None and not isinstance(known, Calibration):
        raise UsageError(f"calibration is a {type(known).__name__}; a Calibration or its file was expected")
    options = _umov.ReduceOptions(period, int(harmonics), knot, errors, None if colour is None else number(colour, "colour"), whole(threads, "threads"))
    return Table(_umov.reduce(text, path, None if known is None else known._text, "" if known is None else known._path,
                              options, Watch(progress)))


def calibrate(counts: AnyCounts, standards: str | os.PathLike[str] | Table | QTable, *,
              second_order: bool = False) -> Calibration:
    """What standard stars tell of an instrument: `umov calibrate`.

    Parameters
    ----------
    counts
        Of the standards, as for `reduce`, with their names in the column `name`, in one band, frame equatorial.
    standards
        A name of `umov.standards()`, or a file or table with `name`, `p_percent` and `pa_deg` (from north through east); an unpolarized star has 0. With
        `p_err_percent` and `pa_err_deg` the instrument is not known better than the stars are. Stars with `mag` (and
        `colour`) tell zero point and extinction (and the colour term).
    second_order
        Also k'', the extinction's change with colour: of stars of many colours at many air masses.

    Notes
    -----
    `InputError` where names, bands or the choice of standards do not do.

    Examples
    --------
    >>> rows = ["time_utc,set_id,name,band,counts,sky,sky_err,var_read,w0,w1,w2,w3"]
    >>> for name, q in (("calm", 0.0), ("striped", 0.10)):
    ...     for k, (w1, w2) in enumerate(((1, 0), (-1, 0), (0, 1), (0, -1))):
    ...         n = 1e6 * (1 + 0.95 * q * w1)
    ...         rows.append(f"2018-01-21T05:00:00Z,{name == 'striped':d},{name},nm:550,{n},0,0,1,0.5,{w1 / 2},{w2 / 2},0")
    >>> with open("counts.csv", "w") as file: _ = file.write("\\n".join(rows) + "\\n")
    >>> with open("stars.csv", "w") as file: _ = file.write("name,p_percent,pa_deg\\ncalm,0,0\\nstriped,10,0\\n")
    >>> round(umov.calibrate("counts.csv", "stars.csv").to_dict()["efficiency"], 3)
    0.95
    """
    if isinstance(standards, str) and standards in _umov.standards_names():
        stars = _umov.standards_text(standards), standards
    else:
        stars = _text_of(standards, "standards")
    return Calibration.from_toml(_umov.calibrate(*_text_of(counts, "counts"), *stars, truth(second_order, "second_order"), Watch(None)))


def standards() -> list[str]:
    """Tables of polarimetric standard stars that come with umov, for `calibrate`.

    >>> umov.standards()
    ['schmidt1992']
    """
    return list(_umov.standards_names())


def calibrate_channels(counts: AnyCounts) -> Table:
    """What each channel of an instrument takes of I, Q, U: `umov calibrate --polarizer`.

    Parameters
    ----------
    counts
        Of a lamp behind a polarizer that is turned before the instrument: a file or table with `angle_deg` and `counts`
        [electron, without sky and dark], and `channel` (and `variance`) where there are several.

    Notes
    -----
    counts = w0 + w1 cos 2a + w2 sin 2a by least squares, errors from the mean variance of a channel. The efficiency has
    the polarizer's own in it, and angles are from where its circle begins: a polarized standard tells where that is on
    the sky. `InputError` where angles do not tell all three.

    Examples
    --------
    >>> import math
    >>> turned = [20 * k for k in range(9)]
    >>> lamp = {"angle_deg": turned, "counts": [1e4 * (1 + 0.99 * math.cos(2 * math.radians(a - 45))) for a in turned]}
    >>> found = umov.calibrate_channels(lamp)
    >>> [round(float(found[name][0]), 3) for name in ("efficiency", "analyser_deg")]
    [0.99, 45.0]
    """
    return Table(_umov.calibrate_channels(*_text_of(counts, "counts"), Watch(None)))


def exposure(instrument: str | os.PathLike[str], *, mag: float = 8.0, alt_deg: float = 45.0, height_m: float = 0.0,
             sd_p: float = 0.01, wavelength_nm: float = 550.0, width_nm: float = 80.0, sky_mag: float = 21.0,
             seeing_arcsec: float = 1.0, change_per_s: float = 0.0, exposure_s: float = 0.0, band: str = "",
             mag_system: str = "AB", aperture_fwhm: float = 1.0) -> Table:
    """How long an instrument must expose for an error of p: the rows of `umov exposure`.

    Parameters
    ----------
    instrument
        A name of `umov.instruments()` or a TOML file.
    mag
        Of the object, above the air.
    alt_deg
        Its apparent altitude [deg].
    height_m
        Of the site above the ellipsoid [m].
    sd_p
        Standard deviation of the degree of polarization that is wanted.
    wavelength_nm
        Middle of the band [nm].
    width_nm
        Its width [nm].
    sky_mag
        Of the sky, AB [mag / arcsec2].
    seeing_arcsec
        Width of a star at the zenith [arcsec].
    change_per_s
        Relative change of brightness in a second: what one analyser after the other takes for polarization.
    exposure_s
        Of a frame [s], of which the note `verdict` speaks; 0: until p is known, or half of what fills a pixel.
    band
        Instead of `wavelength_nm`: a name such as ``"Bessell.V"``, or ``"file:x.vot"``.
    mag_system
        Of `mag`: "AB", "ST", or "Vega" where `band` has a curve.
    aperture_fwhm
        Radius that is summed, in widths of a star; of `umov.observe` it is 2 unless told.

    Notes
    -----
    Rows are a quantity, its value and unit. `InputError` for an unknown instrument, `UsageError` for a number out of range.

    Examples
    --------
    >>> table = umov.exposure("c11_imx250", mag=6)
    >>> "time" in " ".join(table["quantity"])
    True
    """
    if mag_system not in ("AB", "ST", "Vega"):
        raise UsageError(f"mag_system is {mag_system!r}; AB, ST or Vega was expected")
    request = _umov.ExposureRequest()
    request.instrument = path_text(instrument, "instrument")
    request.mag, request.altitude_deg = number(mag, "mag", mag_system), between(alt_deg, "alt_deg", 3, 90)
    request.height_m, request.sd_p = number(height_m, "height_m"), number(sd_p, "sd_p")
    request.nm, request.width_nm = number(wavelength_nm, "wavelength_nm"), number(width_nm, "width_nm")
    request.sky_mag, request.seeing_arcsec = number(sky_mag, "sky_mag"), number(seeing_arcsec, "seeing_arcsec")
    request.change_per_s = number(change_per_s, "change_per_s")
    request.exposure_s, request.band = number(exposure_s, "exposure_s"), text_of(band, "band")
    request.magnitudes, request.aperture_fwhm = mag_system, number(aperture_fwhm, "aperture_fwhm")
    found = Table(_umov.exposure(request))
    if "warning" in found.notes:
        Watch(None).warn(found.notes["warning"])
    return found


def instruments() -> Table:
    """Telescopes with their polarimeters that come with umov: the rows of `umov instrument list`.

    >>> "c11_imx250" in umov.instruments()["name"]
    True
    """
    return Table(_umov.instrument_list())


def instrument(name: str | os.PathLike[str]) -> dict[str, Any]:
    """An instrument as tables of a scenario, to be changed and used: what `umov instrument show` prints.

    Parameters
    ----------
    name
        Of `umov.instruments()`, or a TOML file; `InputError` with the nearest name for what is neither.

    Examples
    --------
    >>> umov.instrument("c11_imx250")["telescope"]["aperture_m"]
    0.2794
    """
    import tomllib
    return tomllib.loads(_umov.instrument(path_text(name, "name")))
