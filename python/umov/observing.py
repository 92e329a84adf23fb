"""What a telescope with a polarimeter records, and what its counts tell."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Union

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._numbers import number, whole
from .errors import DeviceError, InputError, UsageError
from .scenarios import AnyScenario, Scenario
from .tables import Table

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


AnyCounts = Union[str, "os.PathLike[str]", Observation, Table, "QTable"]


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
        os.makedirs(path, exist_ok=True)
    except (OSError, ValueError) as error:
        raise DeviceError(f"{os.fspath(path)}: cannot be made ({error}); a folder for frames was expected") from error
    return os.path.abspath(path)


def _text_of(table: Any, what: str) -> tuple[str, str]:
    """A table as the text of a file, and the name of that file in messages."""
    if isinstance(table, Observation):
        table = table.counts
    if isinstance(table, (str, os.PathLike)):
        path = os.fspath(table)
        try:
            return pathlib.Path(path).read_text(encoding="utf-8"), str(path)
        except (OSError, UnicodeDecodeError, ValueError) as error:
            raise InputError(f"{path}: cannot be read ({error}); a file of {what} was expected") from error
    if isinstance(table, Table):
        return table._table.ecsv(), what
    if hasattr(table, "colnames") and hasattr(table, "write"):
        import io
        out = io.StringIO()
        table.write(out, format="ascii.ecsv")
        return out.getvalue(), what
    raise UsageError(f"{what} is a {type(table).__name__}; a file, a Table or an astropy table was expected")


class Calibration:
    """Efficiency, angle and own polarization of an instrument in a band, as `umov calibrate` finds them.

    Parameters
    ----------
    path
        A TOML file that `to_toml` or the command wrote.

    Examples
    --------
    >>> text = 'instrument = "mine"\\nband = "Bessell.V"\\nefficiency = 0.98\\n'
    >>> umov.Calibration.from_toml(text).to_dict()["efficiency"]
    0.98
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._text, self._path = _text_of(path, "a calibration")

    @classmethod
    def from_toml(cls, text: str, path: str = "calibration.toml") -> Calibration:
        """From a text.

        Parameters
        ----------
        text
            As `to_toml` gives it.
        path
            The file that it stands for in messages.
        """
        out = cls.__new__(cls)
        out._text, out._path = str(text), str(path)
        return out

    def to_toml(self) -> str:
        """As a file for `umov reduce --calibration`."""
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary; angles in degrees."""
        import tomllib
        return tomllib.loads(self._text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Calibration) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        table = self.to_dict()
        return f"<umov.Calibration of {table.get('instrument', '')!r} in {table.get('band', '')!r}>"


def reduce(counts: AnyCounts, *, calibration: Calibration | str | os.PathLike[str] | None = None,
           period_s: float | None = None, harmonics: int = 3, knot_s: float | None = None, q0_sd: float = 0.0, gain_sd: float = 0.0,
           angle_sd_deg: float = 0.0, efficiency_sd: float = 0.0, sky_sd: float = 0.0, transparency_sd: float = 0.0, threads: int = 0,
           progress: Progress = None) -> Table:
    """Stokes parameters with their errors from counts: the rows of `umov reduce`, one per set.

    Parameters
    ----------
    counts
        What `observe` gave, or a file (ECSV, CSV), Table or astropy table with its columns: time_utc, set_id, band,
        counts, sky, sky_err, var_read [electron] and w0 ... w3, what a channel takes of I, Q, U, V.
    calibration
        Of `calibrate`, or its file: taken out of q and u.
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
    transparency_sd
        How much the air lets through changes from exposure to exposure, relative, beside scintillation: thin cloud.
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
             "sky_sd": sky_sd, "transparency_sd": transparency_sd}
    errors = {name: number(value, name) for name, value in given.items()}
    if wrong := [f"{name} is {value!r}" for name, value in errors.items() if not 0 <= value <= 1e3]:
        raise UsageError(f"{wrong[0]}; a number from 0 to 1000 was expected")
    text, path = _text_of(counts, "counts")
    known = Calibration(calibration) if isinstance(calibration, (str, os.PathLike)) else calibration
    if known is not None and not isinstance(known, Calibration):
        raise UsageError(f"calibration is a {type(known).__name__}; a Calibration or its file was expected")
    options = _umov.ReduceOptions(period, int(harmonics), knot, errors["q0_sd"], errors["gain_sd"],
                                  errors["angle_sd_deg"], errors["efficiency_sd"], errors["sky_sd"],
                                  errors["transparency_sd"], whole(threads, "threads"))
    return Table(_umov.reduce(text, path, None if known is None else known._text, "" if known is None else known._path,
                              options, Watch(progress)))


def calibrate(counts: AnyCounts, standards: str | os.PathLike[str] | Table | QTable) -> Calibration:
    """What standard stars tell of an instrument: `umov calibrate`.

    Parameters
    ----------
    counts
        Of the standards, as for `reduce`, with their names in the column `name`, in one band, frame equatorial.
    standards
        File or table with `name`, `p_percent` and `pa_deg` (from north through east); an unpolarized star has 0. With
        `p_err_percent` and `pa_err_deg` the instrument is not known better than the stars are.

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
    return Calibration.from_toml(_umov.calibrate(*_text_of(counts, "counts"), *_text_of(standards, "standards"),
                                                 Watch(None)))


def exposure(instrument: str | os.PathLike[str], *, mag: float = 8.0, alt_deg: float = 45.0, height_m: float = 0.0,
             sd_p: float = 0.01, wavelength_nm: float = 550.0, width_nm: float = 80.0, sky_mag: float = 21.0,
             seeing_arcsec: float = 1.0, change_per_s: float = 0.0, exposure_s: float = 0.0, band: str = "") -> Table:
    """How long an instrument must expose for an error of p: the rows of `umov exposure`.

    Parameters
    ----------
    instrument
        A name of `umov.instruments()` or a TOML file.
    mag
        Of the object, AB, above the air.
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

    Notes
    -----
    Rows are a quantity, its value and unit. `InputError` for an unknown instrument or a number out of range.

    Examples
    --------
    >>> table = umov.exposure("c11_imx250", mag=6)
    >>> "time" in " ".join(table["quantity"])
    True
    """
    request = _umov.ExposureRequest()
    request.instrument = str(instrument)
    request.mag, request.altitude_deg = number(mag, "mag"), number(alt_deg, "alt_deg")
    request.height_m, request.sd_p = number(height_m, "height_m"), number(sd_p, "sd_p")
    request.nm, request.width_nm = number(wavelength_nm, "wavelength_nm"), number(width_nm, "width_nm")
    request.sky_mag, request.seeing_arcsec = number(sky_mag, "sky_mag"), number(seeing_arcsec, "seeing_arcsec")
    request.change_per_s = number(change_per_s, "change_per_s")
    request.exposure_s, request.band = number(exposure_s, "exposure_s"), band
    return Table(_umov.exposure(request))


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
    return tomllib.loads(_umov.instrument(str(name)))
