"""Passes, ephemerides and catalogues."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence, Set
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _umov, adapters
from ._jobs import Progress, Watch, job_options
from ._numbers import number, path_text, text, truth, whole
from .errors import Stopped, UsageError, raise_stopped
from .passbands import Bands
from .satellites import AnyBands, Satellite
from .scenarios import Scenario
from .sites import AnySite, Site
from .tables import Table
from .times import AnyTime, seconds, utc, utc_list

if TYPE_CHECKING:
    from astropy.table import QTable

__all__ = ["States", "ephemeris", "passes", "propagate"]

AnyOrbit = Union[Satellite, str, "os.PathLike[str]", Sequence[str], Any]
Numbers = Union[None, int, Sequence[int]]


def _orbit(orbit: AnyOrbit) -> tuple[str, adapters.Files | None]:
    """The file of an orbit, and the object that keeps it if it was made."""
    if isinstance(orbit, Satellite):
        if orbit.orbit_file is None:
            raise UsageError("the satellite has no file of an orbit; give it one")
        return orbit.orbit_file, orbit._files
    orbit = adapters.out_of_array(orbit)
    made = adapters.orbit_texts(orbit)
    if made is None:
        if not isinstance(orbit, (str, os.PathLike)):
            raise UsageError(f"orbit is a {type(orbit).__name__}; a file, TLE lines, a Satellite, a Satrec or an EarthSatellite "
                             "was expected")
        return path_text(orbit, "orbit"), None
    files = adapters.Files(made)
    return str(files.folder / next(iter(made))), files


def _numbers(norad: Numbers, orbit: AnyOrbit) -> list[int]:
    if norad is None:
        own = orbit.norad if isinstance(orbit, Satellite) else None
        return [] if own is None else [own]
    if hasattr(norad, "__iter__") and not isinstance(norad, (str, bytes, Mapping, Set)) and np.ndim(norad) == 1:
        return [whole(one, "norad") for one in norad]
    return [whole(norad, "norad")]


def _make_ready() -> None:
    """What the rows go into is loaded before the work: after Ctrl-C it would take longer than anybody waits."""
    import astropy.table  # noqa: F401


def _table(rows: _umov.Rows) -> QTable:
    table = Table(rows.table).to_qtable()
    if rows.stopped is not None:
        raise_stopped(rows.stopped, table)
    return table


def passes(orbit: AnyOrbit, site: AnySite, start: AnyTime, stop: AnyTime, *, norad: Numbers = None,
           alt_min_deg: float = 10.0, sun_alt_max_deg: float = -6.0, visible_only: bool = False,
           mag_max: float | None = None, sort: str = "rise", shadow: str = "ellipsoid", bands: AnyBands | None = None, band: str = "", threads: int = 0,
           cache: bool | str | os.PathLike[str] = True, progress: Progress = None,
           allow_bad_checksum: bool = False, allow_old_elements: bool = False) -> QTable:
    """Passes over a site as an astropy QTable with the columns of `umov passes`. `orbit` is a Satellite,
    whose magnitudes and glints are then told too, or a file, TLE lines, a Satrec or an EarthSatellite; a file
    may hold a whole catalogue. No pass is `NoResult`.

    Parameters
    ----------
    orbit
        A file (TLE, 3LE, OMM, OEM), the lines of a TLE, a Satellite, an sgp4 Satrec, a skyfield EarthSatellite, or a list of
        these two.
    site
        A name of `umov.site_names()`, a Site, an astropy EarthLocation, a skyfield topos or a table with lat_deg,
        lon_deg and alt_m.
    start
        ISO 8601 with an offset or Z, an aware datetime or an astropy Time (any scale).
    stop
        The same; it is included, and may equal `start`.
    norad
        Catalogue number, or several, of a file that holds more; None: all.
    alt_min_deg
        Rise and set are at this altitude, airless [deg].
    sun_alt_max_deg
        Visible is what passes while the Sun is below [deg].
    visible_only
        Only passes that are sunlit in a dark sky at some time.
    mag_max
        Only passes that get as bright as this magnitude while sunlit; `orbit` is a Satellite. Light is looked at 5 s apart,
        in glints and beside the brightest samples: a flash that comes and goes in between is missed.
    sort
        What comes first: "rise", the earliest, "mag", the brightest, or "alt", what stands highest while visible.
    shadow
        The Earth's: "ellipsoid" (default) or "sphere".
    bands
        Of the magnitudes, where `orbit` is a Satellite: as for `Engine`; None: paper_rgb.
    band
        Whose magnitudes are told; "": the middle one.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    progress
        True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that called;
        what it raises comes through.
    allow_bad_checksum
        Elements with a wrong checksum are read all the same.
    allow_old_elements
        Elements more than 30 days old are taken all the same.

    Examples
    --------
    >>> table = umov.passes(DATA / "tle/hst.tle", "maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z")
    >>> print(table["culmination_utc"][0], table["culmination_alt"][0].round(1))
    2018-01-21T05:11:47.051Z 56.8 deg
    """
    if shadow not in ("ellipsoid", "sphere"):
        raise UsageError(f"shadow is {shadow!r}; ellipsoid or sphere was expected")
    if sort not in ("rise", "mag", "alt"):
        raise UsageError(f"sort is {sort!r}; rise, mag or alt was expected")
    file, kept = _orbit(orbit)
    scene = None
    if isinstance(orbit, Satellite):
        scene = Scenario(_scene_of(orbit, bands or "paper_rgb"))._scenario
    elif bands is not None or band or mag_max is not None or sort == "mag":
        raise UsageError("bands, band, mag_max and sort='mag' are of the magnitudes of a Satellite; none was given")
    _make_ready()
    rows = _umov.passes(file, _numbers(norad, orbit), Site(site)._tuple(), utc(start), utc(stop),
                        number(alt_min_deg, "alt_min_deg"), number(sun_alt_max_deg, "sun_alt_max_deg"), shadow, truth(visible_only, "visible_only"),
                        None if mag_max is None else number(mag_max, "mag_max", bands.mag_system if isinstance(bands, Bands) else "AB"), sort, scene, text(band, "band"),
                        job_options(threads, cache, allow_bad_checksum, allow_old_elements), Watch(progress))
    del kept
    return _table(rows)


def _scene_of(satellite: Satellite, bands: AnyBands) -> dict[str, Any]:
    """The scene stands for whatever the file holds: without an orbit."""
    scene = satellite.to_scenario_dict(bands)
    scene["object"] = [{key: value for key, value in scene["object"][0].items() if key != "orbit"}]
    return scene


def ephemeris(orbit: AnyOrbit, site: AnySite, start: AnyTime, stop: AnyTime, *, step: Any = None,
              step_s: float | None = None, norad: int | None = None, shadow: str = "ellipsoid",
              threads: int = 0, progress: Progress = None, allow_bad_checksum: bool = False,
              allow_old_elements: bool = False) -> QTable:
    """Where an object stands as seen from a site: the rows of `umov orbit ephemeris`.

    Parameters
    ----------
    orbit
        A file (TLE, 3LE, OMM, OEM), the lines of a TLE, a Satellite, an sgp4 Satrec, a skyfield EarthSatellite, or a list of
        these two.
    site
        A name of `umov.site_names()`, a Site, an astropy EarthLocation, a skyfield topos or a table with lat_deg,
        lon_deg and alt_m.
    start
        ISO 8601 with an offset or Z, an aware datetime or an astropy Time (any scale).
    stop
        The same; it is included, and may equal `start`.
    step
        Between epochs, an astropy Quantity of time or a timedelta.
    step_s
        The same as a plain number [s]; one of the two.
    norad
        Catalogue number, where the file holds several.
    shadow
        The Earth's: "ellipsoid" (default) or "sphere".
    threads
        0 for all cores; the bytes do not depend on it.
    progress
        True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that called;
        what it raises comes through.
    allow_bad_checksum
        Elements with a wrong checksum are read all the same.
    allow_old_elements
        Elements more than 30 days old are taken all the same.

    Notes
    -----
    Angles in degrees, azimuth from north through east, airless; range in km; TEME and ITRS in km and km/s.

    Examples
    --------
    >>> table = umov.ephemeris(DATA / "tle/hst.tle", "maui", "2018-01-21T05:10Z", "2018-01-21T05:11Z",
    ...                        step_s=30)
    >>> len(table), table["range"].unit.to_string()
    (3, 'km')
    """
    if (step is None) == (step_s is None):
        raise UsageError("step (a Quantity) or step_s; one of them was expected")
    length = seconds(step) if step_s is None else number(step_s, "step_s")
    file, kept = _orbit(orbit)
    numbers = _numbers(norad, orbit)
    _make_ready()
    rows = _umov.ephemeris(file, numbers[0] if numbers else 0, Site(site)._tuple(), utc(start), utc(stop),
                           length, shadow, job_options(threads, False, allow_bad_checksum, allow_old_elements),
                           Watch(progress))
    del kept
    return _table(rows)


class States(NamedTuple):
    """States of a catalogue, [object, time]; read-only views of the library's memory. "time" has the shape of the times
    that were given: none is (object, 0, 3), an astropy Time of shape (2, 2) is (object, 2, 2, 3).

    >>> states = umov.propagate(DATA / "tle/hst.tle", ["2018-01-21T05:00Z", "2018-01-21T05:10Z"])
    >>> states.position_km.shape, states.error.tolist()
    ((1, 2, 3), [[0, 0]])
    """

    norad_cat_id: NDArray[np.int32]  #: per object
    position_km: NDArray[np.float64]  #: (object, time, 3), TEME; NaN where `error` is not 0
    velocity_km_s: NDArray[np.float64]  #: (object, time, 3), TEME
    error: NDArray[np.int32]  #: (object, time): 0, the code of SGP4, or -1 where Ctrl-C came before


def propagate(orbit: AnyOrbit, times: AnyTime | Sequence[AnyTime], *, threads: int = 0,
              progress: Progress = None, allow_bad_checksum: bool = False,
              allow_old_elements: bool = False) -> States:
    """SGP4 for every object of a file at every time: the numbers of `umov orbit propagate`. Objects that
    fail have a code and a warning; `NumericsError` if all of them do.

    Parameters
    ----------
    orbit
        A file (TLE, 3LE, OMM, OEM), the lines of a TLE, a Satellite, an sgp4 Satrec, a skyfield EarthSatellite, or a list of
        these two.
    times
        One time, a list of them, or an astropy Time of any shape (ISO 8601 with offset, aware datetime, Time).
    threads
        0 for all cores; the bytes do not depend on it.
    progress
        True for a bar, or a callable (what, done, total), called about 20 times a second in the thread that called;
        what it raises comes through.
    allow_bad_checksum
        Elements with a wrong checksum are read all the same.
    allow_old_elements
        Elements more than 30 days old are taken all the same.

    Examples
    --------
    >>> umov.propagate(DATA / "tle/hst.tle", "2018-01-21T05:00Z").velocity_km_s.shape
    (1, 1, 3)
    """
    file, kept = _orbit(orbit)
    texts, _ = utc_list(times)
    shape: tuple[int, ...] = getattr(times, "shape", ()) or (len(texts),)
    done = _umov.propagate(file, texts, job_options(threads, False, allow_bad_checksum, allow_old_elements),
                           Watch(progress))
    del kept
    teme = done.teme
    teme = teme.reshape(len(teme), *shape, 6) if len(texts) else np.empty((len(teme), *shape, 6))
    out = States(done.norad_cat_id, teme[..., :3], teme[..., 3:], done.error.reshape(teme.shape[:-1]))
    stopped: Stopped | None = done.stopped
    if stopped is not None and texts:  # at no time at all nothing failed
        raise_stopped(stopped, out)
    return out
