"""From a light curve back to what made it."""
from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple, Union

import numpy as np

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._numbers import between, path_text, whole_between
from ._words import in_python, told_in_python
from .errors import UsageError
from .light_curves import LightCurve
from .materials import Material, materials
from .observing import _text_of
from .periods import AnyLight
from .scenarios import AnyScenario, Scenario
from .tables import Table
from .times import AnyTime, utc

__all__ = ["Fit", "Inversion", "identify", "invert_health", "invert_material", "invert_plan", "invert_pose", "invert_spin"]

AnyCurves = Union[AnyLight, Sequence[AnyLight]]


class Fit(NamedTuple):
    """How a light curve is compared with the model: the options that all of `umov invert` take.

    >>> umov.Fit(clouds=True).floor
    0.02
    """

    grid: int = 60_000  #: attitudes that are looked at first, 1000 to 5,000,000
    floor: float = 0.02  #: error of the model, in parts of I; half of it in q and u and, 1 % at most, of the median I
    zero_point_sd: float = 0.02  #: how well the zero point of each band is known, relative
    scale_sd: float = 0.0  #: how well the absolute brightness is known, relative; 0: not at all
    clouds: bool = False  #: transparency is free at every epoch
    outliers: float = 0.0  #: share of measurements that are wrong, up to 0.5
    intensity_only: bool = False  #: q and u are left aside
    method: str | None = None  #: how hiding is decided: masks, auto or rays; None: auto, and for invert_track masks
    slope_sd: float = 0.2  #: invert_pose and invert_spin: how well the slopes of each material's lobe are known, in ln; 0: exactly
    reflectance_sd: float = 0.1  #: the same of what each lobe and each body reflects
    haze_sd: float = 0.3  #: the same of the haze of materials without a body
    largest_floor: float = 0.1  #: the same: the floor grows with the misfit of the best attitude, up to this; 0: it stays
    allow_old_elements: bool = False  #: elements over 30 days from the observations are taken all the same
    tilt_sd_deg: float = 0.0  #: invert_pose and invert_spin alone, others refuse it: how well the surfaces of each material are aligned to the body about each of its axes; 0: exactly, else it takes longer
    by_group: bool = False  #: invert_pose and invert_spin alone, others refuse it: what is not known of materials is of each group of the mesh by itself (areas and alignment of parts); takes longer


class Inversion(NamedTuple):
    """What a light curve tells: a verdict, and the tables of `umov invert`.

    >>> found = umov.Inversion("determined", {}, {"chi2": 1.0}, "one attitude", "")
    >>> found.verdict, str(found)
    ('determined', 'one attitude')
    """

    verdict: str  #: determined, ambiguous, undetermined or no_fit (none explains the data)
    tables: dict[str, Table]  #: by name, the answer first: modes, periods, set95, samples, twins, track, fit; materials; health, parts; identity; plan
    values: dict[str, Any]  #: numbers of the answer: verdict.json of the command
    summary: str  #: for a person
    page: str  #: report.html; "" where the question has none
    state: str = ""  #: of `invert_track`, what the next one goes on from to the last digit: state.json; else ""

    def posterior(self, draws: int = 1000, mode: int = 1) -> dict[str, np.ndarray]:
        """Draws of equal weight from the posterior of an attitude or a spin, as arviz and corner read them.

        Parameters
        ----------
        draws
            How many.
        mode
            Of which mode of `modes` turns are counted from: `turn_x`, `turn_y`, `turn_z` are the rotation vector in body
            axes from it [deg], up to 180 deg long; `rate_x` ... are there where the rate was asked for [deg/s].

        Returns
        -------
        dict
            Arrays of shape (1, draws): one chain. `arviz.from_dict(posterior=...)` takes it;
            `corner.corner(np.column_stack([v[0] for v in d.values()]), labels=list(d))` draws it.

        Examples
        --------
        >>> fixed = {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "time.step_s": 20}
        >>> green = {"bands.set": ["nm:550"]}
        >>> curve = umov.run(EXAMPLES / "agena_maui.toml", set={**fixed, **green})
        >>> found = umov.invert_pose(curve, EXAMPLES / "agena_maui.toml", set=green, fit=umov.Fit(grid=1000))
        >>> draws = found.posterior(500)
        >>> list(draws), draws["turn_x"].shape
        (['turn_x', 'turn_y', 'turn_z'], (1, 500))
        """
        if "samples" not in self.tables:
            raise UsageError("this answer has no samples; one of invert_pose, invert_spin or identify was expected")
        samples, modes = self.tables["samples"], self.tables["modes"]
        count = whole_between(draws, "draws", 1, 10_000_000)
        of = whole_between(mode, "mode", 1, max(len(modes), 1)) - 1
        # Even steps of the sum of the weights: no noise is added.
        total = np.cumsum(np.asarray(samples["weight"], float))
        rows = np.minimum(np.searchsorted(total / total[-1], (np.arange(count) + 0.5) / count), len(total) - 1)
        w, x, y, z = (np.asarray(samples[name], float)[rows] for name in ("qw", "qx", "qy", "qz"))
        a, b, c, d = (float(modes[name][of]) for name in ("qw", "qx", "qy", "qz"))
        turn = np.array([a * w + b * x + c * y + d * z, a * x - b * w - c * z + d * y, a * y + b * z - c * w - d * x,
                         a * z - b * y + c * x - d * w])  # conj(mode) q
        turn = np.where(turn[0] < 0, -turn, turn)
        sine = np.linalg.norm(turn[1:], axis=0)
        vector = np.degrees(turn[1:] * np.where(sine > 1e-12, 2 * np.arctan2(sine, turn[0]) / np.maximum(sine, 1e-300), 2.0))
        out = {f"turn_{axis}": vector[k][None, :] for k, axis in enumerate("xyz")}
        for name in ("rate_x", "rate_y", "rate_z"):
            if name in samples.names:
                out[name] = np.asarray(samples[name], float)[rows][None, :]
        return out

    def __str__(self) -> str:
        return self.summary.rstrip("\n")

    def __repr__(self) -> str:
        return f"<umov.Inversion: {self.verdict}; {', '.join(self.tables) or 'no tables'}>"


@contextmanager
def _files_of(*curves: AnyCurves) -> Iterator[list[list[str]]]:
    """Each as names of files: those of memory are written for as long as the job runs."""
    with tempfile.TemporaryDirectory(prefix="umov-") as folder:
        out: list[list[str]] = []
        for name, group in zip(("light", "baseline"), curves):
            several = list(group) if isinstance(group, (list, tuple)) else None
            named = [(f"{name}_{k}", one) for k, one in enumerate(several)] if several is not None else [(name, group)]
            out.append([_file_of(one, pathlib.Path(folder) / f"{file}.ecsv") for file, one in named])
        yield out


def _file_of(light: Any, made: pathlib.Path) -> str:
    if isinstance(light, (str, os.PathLike)):
        return path_text(light, "light")
    made.write_text(_text_of(light, "light")[0], encoding="utf-8")
    return str(made)


def _request(files: list[str] | None, fit: Fit | None, method: str = "auto", *, asks_parts: bool = False) -> _umov.InvertRequest:
    """`files` None: there is no light yet. `method`: where the fit names none. `asks_parts`: parts of the light are asked one by one, as
    `tilt_sd_deg` and `by_group` need it; nobody else leaves these aside in silence."""
    fit = Fit() if fit is None else fit
    if not isinstance(fit, Fit):
        raise UsageError(f"fit is a {type(fit).__name__}; a umov.Fit was expected, such as umov.Fit(clouds=True)")
    if fit.tilt_sd_deg and not asks_parts:
        raise UsageError(f"tilt_sd_deg is {fit.tilt_sd_deg}; this takes surfaces for aligned, so 0 was expected: only invert_pose and invert_spin ask it")
    if fit.by_group and not asks_parts:
        raise UsageError("by_group is True; this asks no group by itself, so False was expected: only invert_pose and invert_spin do")
    if fit.method not in (None, "masks", "auto", "rays"):
        raise UsageError(f"method is {fit.method!r}; auto, rays or masks was expected")
    if files is not None and not files:
        raise UsageError("there is no light curve; a LightCurve, a file or a table was expected, or several of them")
    out = _umov.InvertRequest(files or [], whole_between(fit.grid, "grid", 1000, 5_000_000), fit.method or method, bool(fit.allow_old_elements))
    out.set_errors(between(fit.floor, "floor", 0, 1), between(fit.zero_point_sd, "zero_point_sd", 1e-6, 100),
                   between(fit.scale_sd, "scale_sd", 0, 100), bool(fit.clouds), between(fit.outliers, "outliers", 0, 0.5),
                   not fit.intensity_only)
    out.set_material_errors(between(fit.slope_sd, "slope_sd", 0, 2), between(fit.reflectance_sd, "reflectance_sd", 0, 2),
                            between(fit.haze_sd, "haze_sd", 0, 2), between(fit.tilt_sd_deg, "tilt_sd_deg", 0, 2), bool(fit.by_group),
                            between(fit.largest_floor, "largest_floor", 0, 1))
    return out


def _inversion(found: _umov.Inversion) -> Inversion:
    import json
    tables = {name: Table(found.table(k)) for k, name in enumerate(found.names)}
    return Inversion(found.verdict, tables, told_in_python(json.loads(found.json)), in_python(found.summary), found.page, found.state)


def invert_pose(light: AnyCurves, scenario: AnyScenario, *, set: Mapping[str, Any] | None = None, fit: Fit | None = None,
                threads: int = 0, cache: bool | str | os.PathLike[str] = True, device: str = "cpu",
                progress: Progress = None) -> Inversion:
    """Which fixed attitudes explain a light curve, and how surely: `umov invert pose`.

    Parameters
    ----------
    light
        A LightCurve, file, Table or astropy table with time_utc, band, brightness and its error, and q and u if there
        are any; or a list of them, which is one fit of all.
    scenario
        Object, materials, orbit, site and bands; its attitude is not used.
    set
        Changes of its keys.
    fit
        How both are compared; None: `Fit()`.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    A verdict of "no_fit" is an answer, not an exception. `InputError` for a curve or scenario that does not do.
    Source: docs/theory/inverse.md.

    Examples
    --------
    >>> fixed = {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "time.step_s": 20}
    >>> green = {"bands.set": ["nm:550"]}
    >>> curve = umov.run(EXAMPLES / "agena_maui.toml", set={**fixed, **green})
    >>> umov.invert_pose(curve, EXAMPLES / "agena_maui.toml", set=green, fit=umov.Fit(grid=1000))
    <umov.Inversion: determined; modes, set95, samples, twins, fit, contributions>
    """
    asked = Scenario(scenario, set)
    with _files_of(light) as (files,):
        return _inversion(_umov.invert_pose(asked._scenario, _request(files, fit, asks_parts=True), job_options(threads, cache, device=device), Watch(progress)))


def invert_spin(light: AnyCurves, scenario: AnyScenario, *, period_s: float | None = None, aliases: bool = True,
                axis: str = "any", set: Mapping[str, Any] | None = None, fit: Fit | None = None, threads: int = 0,
                cache: bool | str | os.PathLike[str] = True, device: str = "cpu",
                progress: Progress = None) -> Inversion:
    """Which constant spins explain a light curve: period with aliases, axis, attitude: `umov invert spin`.

    Parameters
    ----------
    light
        As for `invert_pose`.
    scenario
        Object, materials, orbit, site and bands; its attitude is not used.
    period_s
        Of a whole turn [s], good to a few per cent; None: from the periodogram.
    aliases
        Half, twice and four times the period are tried too.
    axis
        Of the body: x, y, z (either sense), or any.
    set
        Changes of the scenario's keys.
    fit
        How both are compared; None: `Fit()`.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    `InputError` where no period is given and the curve tells none. Source: docs/theory/inverse.md.

    Examples
    --------
    >>> spinning = {"object.attitude": {"mode": "spin", "axis": "+X", "period_s": 23.7}, "time.step_s": 3,
    ...             "time.start": "2018-01-21T05:18:00Z", "time.stop": "2018-01-21T05:20:00Z"}
    >>> green = {"bands.set": ["nm:550"]}
    >>> curve = umov.run(EXAMPLES / "agena_maui.toml", set={**spinning, **green})
    >>> found = umov.invert_spin(curve, EXAMPLES / "agena_maui.toml", period_s=23.7, aliases=False, axis="x", set=green,
    ...                          fit=umov.Fit(grid=1000))
    >>> found.verdict, list(found.tables)
    ('determined', ['modes', 'periods', 'set95', 'samples', 'fit', 'contributions'])
    """
    if axis not in ("x", "y", "z", "any"):
        raise UsageError(f"axis is {axis!r}; x, y, z or any was expected")
    period = 0.0 if period_s is None else between(period_s, "period_s", 1e-3, 1e7)
    asked = Scenario(scenario, set)
    with _files_of(light) as (files,):
        return _inversion(_umov.invert_spin(asked._scenario, _request(files, fit, asks_parts=True), period, bool(aliases),
                                            "" if axis == "any" else axis, job_options(threads, cache, device=device), Watch(progress)))


def invert_material(light: AnyCurves, scenario: AnyScenario, *, group: str, candidates: Sequence[str | Material],
                    set: Mapping[str, Any] | None = None, fit: Fit | None = None, threads: int = 0,
                    cache: bool | str | os.PathLike[str] = True, device: str = "cpu",
                    progress: Progress = None) -> Inversion:
    """What a part is made of, in the scenario's attitude: which, or how much of each: `umov invert material`.

    Parameters
    ----------
    light
        As for `invert_pose`.
    scenario
        Object, materials, orbit, site and bands; its attitude is taken as known.
    group
        Of the mesh; `InputError` for what is none.
    candidates
        Materials by name, of the scenario or the library, or Materials.
    set
        Changes of the scenario's keys.
    fit
        How both are compared; None: `Fit()`.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    Candidates that these data cannot tell apart are joined by "|". Source: docs/theory/inverse.md.

    Examples
    --------
    >>> curve = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 30})
    >>> found = umov.invert_material(curve, EXAMPLES / "hst_maui.toml", group="array_front",
    ...                              candidates=["cell_silicon", "paint_white"])
    >>> found.tables["materials"]["material"].tolist()  # a dozen epochs tell neither from the other
    ['cell_silicon|paint_white']
    """
    if isinstance(candidates, (str, Material)) or not isinstance(candidates, Sequence) or not candidates:
        raise UsageError(f"candidates is {candidates!r}; a list of names of materials, or of Materials, was expected")
    asked, words = _with_materials(Scenario(scenario, set), candidates, "candidates")
    with _files_of(light) as (files,):
        return _inversion(_umov.invert_material(asked._scenario, _request(files, fit), str(group), words,
                                                job_options(threads, cache, device=device), Watch(progress)))


def invert_health(light: AnyCurves, scenario: AnyScenario, *, drift: Mapping[str, str | Material], baseline: AnyCurves = (),
                  attitude_sd_deg: float = 0.1, set: Mapping[str, Any] | None = None, fit: Fit | None = None, threads: int = 0,
                  cache: bool | str | os.PathLike[str] = True, device: str = "cpu",
                  progress: Progress = None) -> Inversion:
    """What has changed on the body, in the scenario's attitude, and the least that shows: `umov invert health`.

    Parameters
    ----------
    light
        As for `invert_pose`.
    scenario
        Object, materials, orbit, site and bands; its attitude is taken as known.
    drift
        By group of the mesh, the material that it may be turning into, a name or a Material; several groups are asked at once.
    baseline
        Light of before, one or several: changes are counted from it. Without it from the scenario's materials.
    attitude_sd_deg
        How well the attitude is known, about each axis [deg], 0 to 30.
    set
        Changes of the scenario's keys.
    fit
        How both are compared; None: `Fit()`.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    `change` of the table is 1 where all of a group has turned, `detectable` the smallest part that would have shown.
    `InputError` for a group, `UsageError` for a material that there is not. Source: docs/theory/inverse.md.

    Examples
    --------
    >>> curve = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 30})
    >>> found = umov.invert_health(curve, EXAMPLES / "hst_maui.toml", drift={"array_front": "paint_white"})
    >>> str(found.tables["health"]["parameter"][0]), bool(abs(found.tables["health"]["sigma"][0]) < 3)
    ('array_front=paint_white', True)
    """
    if not isinstance(drift, Mapping) or not drift:
        raise UsageError(f"drift is {drift!r}; {{group: material}} was expected, such as {{\"array_front\": \"paint_white\"}}")
    asked, names = _with_materials(Scenario(scenario, set), list(drift.values()), "drift")
    drifts = [f"{group}={material}" for group, material in zip(drift, names)]
    sd = between(attitude_sd_deg, "attitude_sd_deg", 0, 30)
    with _files_of(light, baseline) as (files, before):
        return _inversion(_umov.invert_health(asked._scenario, _request(files, fit), drifts, before, sd,
                                              job_options(threads, cache, device=device), Watch(progress)))


@contextmanager
def _modes_of(answer: Any) -> Iterator[str]:
    """The name of a folder or table of modes; those of memory are one for as long as the job runs."""
    if answer is None or isinstance(answer, (str, os.PathLike)):
        yield "" if answer is None else path_text(answer, "modes")
        return
    if not isinstance(answer, Inversion) or "modes" not in answer.tables:
        raise UsageError(f"modes is a {type(answer).__name__}; an answer of invert_pose or invert_spin, or the name of its folder or of its "
                         "modes.ecsv was expected")
    with tempfile.TemporaryDirectory(prefix="umov-") as folder:
        file = pathlib.Path(folder) / "alternatives.ecsv"
        answer.tables["modes"].write(file)
        yield str(file)


def invert_plan(scenario: AnyScenario, alternatives: Mapping[str, AnyScenario] | None = None, *,
                modes: Inversion | str | os.PathLike[str] | None = None, start: AnyTime | None = None,
                stop: AnyTime | None = None, snr: float | None = None, sky_mag: float = 21.0,
                priors: Mapping[str, float] | None = None, set: Mapping[str, Any] | None = None, fit: Fit | None = None,
                threads: int = 0, cache: bool | str | os.PathLike[str] = True, device: str = "cpu",
                progress: Progress = None) -> Inversion:
    """Before the night: which passes, bands and Stokes components would tell alternatives apart: `umov invert plan`.

    Parameters
    ----------
    scenario
        Orbit, site, time, bands, and the object that the alternatives change. Every step of its time is a row.
    alternatives
        By name, what may be the case: changes of the scenario's keys as a dictionary ({}: the scenario as it is), or
        another scenario (a file, a Scenario, a Satellite), of which object and attitude are taken. With those of `modes`
        two to 32.
    modes
        The answer of `invert_pose` or `invert_spin`, its folder or its modes.ecsv: each attitude above 1 % of the
        probability is an alternative too, "mode 1" on, with its weight as chance before.
    start
        Begin of the span, in place of time.start.
    stop
        End of it, in place of time.stop.
    snr
        Signal to noise of I in a row of median brightness; None: what the scenario's [observation] and its instrument
        reach, or 100 without one.
    sky_mag
        Sky of that instrument, AB in the band [mag / arcsec2], -5 to 40.
    priors
        By name, chances before, relative to each other; 1 for those that are not named.
    set
        Changes of the scenario's keys, of all alternatives.
    fit
        How well model and sky will be known; None: `Fit()`. Its grid, outliers and intensity_only are not looked at.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    The table "plan" has a row for each pass, best first; "choices" each band and I alone; "pairs" every pair; "sequence"
    passes together; "light" what every alternative would give, with an observer's errors. The verdict is "determined"
    where one pass decides with a chance of 95 %, "ambiguous" where only several do. `NoResult` where nothing can be
    observed. Source: docs/theory/inverse.md, section 13.

    Examples
    --------
    >>> found = umov.invert_plan(EXAMPLES / "hst_maui.toml", {"new": {}, "painted": {"object.materials.array_back": "paint_white"}},
    ...                          set={"time.step_s": 30})
    >>> found.verdict, list(found.tables["plan"].names)[:3]
    ('determined', ['pass_id', 'first_utc', 'last_utc'])
    """
    alternatives = {} if alternatives is None and modes is not None else alternatives
    if not isinstance(alternatives, Mapping) or (len(alternatives) < 2 and modes is None):
        raise UsageError(f"alternatives is {alternatives!r}; two or more by name were expected, such as "
                         '{"new": {}, "painted": {"object.materials.array_back": "paint_white"}}')
    chances = dict(priors or {})
    for name in chances:
        if name not in alternatives:
            raise UsageError(f"priors names {name!r}, which is no alternative; there are {', '.join(map(str, alternatives))}")
    span = {f"time.{key}": utc(when) for key, when in (("start", start), ("stop", stop)) if when is not None}
    changes = {**(set or {}), **span}
    asked = Scenario(scenario, changes)
    others = [Scenario(scenario, {**changes, **one}) if isinstance(one, Mapping) else Scenario(one) for one in alternatives.values()]
    ratio = 0.0 if snr is None else between(snr, "snr", 0.1, 1e6)
    weights = [between(chances.get(name, 1.0), "priors", 1e-9, 1e9) for name in alternatives]
    with _modes_of(modes) as answer:
        return _inversion(_umov.invert_plan(asked._scenario, [str(name) for name in alternatives], [one._scenario for one in others],
                                            weights, answer, _request(None, fit), ratio, between(sky_mag, "sky_mag", -5, 40),
                                            job_options(threads, cache, device=device), Watch(progress)))


def identify(light: AnyCurves, scenario: AnyScenario, library: str | os.PathLike[str], *,
             objects: Sequence[str | os.PathLike[str]] = (), none_prior: float = 0.05, set: Mapping[str, Any] | None = None,
             fit: Fit | None = None, threads: int = 0, cache: bool | str | os.PathLike[str] = True,
             device: str = "cpu", progress: Progress = None) -> Inversion:
    """Which object of a library made a light curve, in whatever attitude and at whatever range, or none: `umov identify`.

    Parameters
    ----------
    light
        As for `invert_pose`.
    scenario
        Orbit, site and bands; it needs no mesh, and if it has one that is not read.
    library
        Folder of `build_library`.
    objects
        Scenarios of objects of the library, by their file names: the best of them are judged by their own light.
    none_prior
        Chance, before any data, that it is none of the library: 1e-6 to 0.999.
    set
        Changes of the scenario's keys.
    fit
        How light and data are compared; None: `Fit()`.
    threads
        0 for all cores; the bytes do not depend on it.
    cache
        Masks of earlier jobs: True as the command keeps them, a folder, or False.
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.
    progress
        True for a bar, or a callable (what, done, total).

    Notes
    -----
    The table "identity" has the columns name, probability, by ("look": left behind at a glance, "table": its signature,
    "model": its own light, "kin": the row "none of these"), log_evidence, chi2 and log_look. `InputError` for a folder
    without signatures and for a band that they lack; `UsageError` for objects that the library does not have.
    Source: docs/theory/inverse.md, section 12.

    Examples
    --------
    >>> still = {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "time.step_s": 20}
    >>> curve = umov.run(EXAMPLES / "agena_maui.toml", set=still)
    >>> made = umov.build_library([EXAMPLES / "agena_maui.toml", EXAMPLES / "hst_maui.toml"], "two", cells=8)
    >>> found = umov.identify(curve, EXAMPLES / "agena_maui.toml", "two")
    >>> str(found.tables["identity"]["name"][0])
    'agena_maui'
    """
    if not isinstance(library, (str, os.PathLike)):
        raise UsageError(f"library is {library!r}; the name of a folder was expected")
    if isinstance(objects, (str, os.PathLike)):
        objects = [objects]
    if not isinstance(objects, Sequence) or not all(isinstance(one, (str, os.PathLike)) for one in objects):
        raise UsageError(f"objects is {objects!r}; a list of scenario files was expected")
    prior = between(none_prior, "none_prior", 1e-6, 0.999)
    asked = Scenario(scenario, set)
    with _files_of(light) as (files,):
        return _inversion(_umov.identify(asked._scenario, _request(files, fit), path_text(library, "library"),
                                         [path_text(one, "objects") for one in objects], prior, job_options(threads, cache, device=device),
                                         Watch(progress)))


def _with_materials(scenario: Scenario, given: Sequence[Any], what: str) -> tuple[Scenario, list[str]]:
    """The scenario with the Materials that are given, under their names, and the names of all."""
    own: dict[str, Material] = {}
    names = []
    there = scenario.to_dict().get("material", {})
    for one in given:
        if isinstance(one, Material):
            if own.setdefault(one.name, one) != one:
                raise UsageError(f"{what} has two different materials of the name {one.name}; a name of its own for each was expected")
            if not one.is_named and one.name not in there and one.name in materials()["material"] and Material(one.name) != one:
                raise UsageError(f"the library has another material of the name {one.name}, which the scenario's parts of that name would lose; "
                                 "a name of its own was expected")
            names.append(one.name)
        elif isinstance(one, str):
            names.append(one)
        else:
            raise UsageError(f"{what} has a {type(one).__name__}; names of materials, or Materials, were expected")
        if isinstance(one, Material) and one.name in there and Material.from_dict(one.name, there[one.name]) != one:
            raise UsageError(f"the scenario has another material of the name {one.name}; a name of its own was expected")
    new = {name: one.to_dict() for name, one in own.items() if not one.is_named}
    return (Scenario(scenario, {"material": {**there, **new}}) if new else scenario), names


def _names(given: Any, name: str, what: str) -> list[str]:
    if isinstance(given, str) or not isinstance(given, Sequence) or not given or not all(isinstance(x, str) for x in given):
        raise UsageError(f"{name} is {given!r}; a list of {what} was expected")
    return list(given)
