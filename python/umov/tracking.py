"""Attitudes that are followed through a light curve."""
from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._numbers import between, path_text
from .errors import UsageError
from .inversions import AnyCurves, Fit, Inversion, _files_of, _inversion, _request
from .scenarios import AnyScenario, Scenario

__all__ = ["invert_track"]


@contextmanager
def _start_of(start: Any) -> Iterator[str]:
    """The name of a folder or file; an answer of memory is one for as long as the job runs."""
    if isinstance(start, (str, os.PathLike)):
        yield path_text(start, "start")
        return
    if not isinstance(start, Inversion) or not (start.state or "modes" in start.tables):
        raise UsageError(f"start is a {type(start).__name__}; an answer of invert_pose, invert_spin or invert_track, or the name of its "
                         "folder or of its modes.ecsv was expected")
    with tempfile.TemporaryDirectory(prefix="umov-") as folder:
        if start.state:
            (pathlib.Path(folder) / "state.json").write_text(start.state, encoding="utf-8")
        else:
            for name in ("modes", "samples"):
                if name in start.tables:
                    start.tables[name].write(pathlib.Path(folder) / f"{name}.ecsv")
        yield folder


def invert_track(light: AnyCurves, scenario: AnyScenario, start: Inversion | str | os.PathLike[str], *, rate_noise: float = 1e-4,
                 rate_sd: float = 0.01, set: Mapping[str, Any] | None = None, fit: Fit | None = None, threads: int = 0,
                 cache: bool | str | os.PathLike[str] = True, device: str = "cpu", progress: Progress = None) -> Inversion:
    """Follows attitudes that are known through later observations, each by a filter with a weight: `umov invert track`.

    Parameters
    ----------
    light
        As for `invert_pose`; what is not later than the data of the start is left aside.
    scenario
        Object, materials, orbit, site and bands; its attitude is not used.
    start
        The answer of `invert_pose`, `invert_spin` or `invert_track` about earlier observations, or its folder or modes.ecsv.
    rate_noise
        Random walk of the rate about each body axis [deg/s/sqrt(s)], 0 to 10; 0: it is constant.
    rate_sd
        How well it is known that attitudes of `invert_pose` stand still [deg/s], 1e-9 to 10.
    set
        Changes of the scenario's keys.
    fit
        How both are compared; None: `Fit()`. Hiding is decided by masks unless it names a method; its grid and largest_floor
        are not looked at.
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
    The table "track" has a row for each epoch and filter: attitude, rate, their errors, weight, chi-square of what came
    against what was expected; "modes" what is known at the end. The verdict is "no_fit" where the likeliest filter no
    longer explains the light (from `values["lost_utc"]` on). `InputError` for a start that is none, and where no observation is later than its data.
    Source: docs/theory/inverse.md, section 14.

    Examples
    --------
    >>> still = {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "time.step_s": 20}
    >>> green = {"bands.set": ["nm:550"]}
    >>> curve = umov.run(EXAMPLES / "agena_maui.toml", set={**still, **green, "time.stop": "2018-01-21T05:20:00Z"})
    >>> found = umov.invert_pose(curve, EXAMPLES / "agena_maui.toml", set=green, fit=umov.Fit(grid=1000))
    >>> later = umov.run(EXAMPLES / "agena_maui.toml", set={**still, **green, "time.start": "2018-01-21T05:20:20Z", "time.stop": "2018-01-21T05:22:00Z"})
    >>> held = umov.invert_track(later, EXAMPLES / "agena_maui.toml", found, set=green)
    >>> list(held.tables), held.values["lost_utc"]
    (['modes', 'track', 'fit'], None)
    """
    walk = between(rate_noise, "rate_noise", 0, 10)
    sd = between(rate_sd, "rate_sd", 1e-9, 10)
    asked = Scenario(scenario, set)
    with _files_of(light) as (files,), _start_of(start) as named:
        return _inversion(_umov.invert_track(asked._scenario, _request(files, fit, "masks"), named, walk, sd,
                                             job_options(threads, cache, device=device), Watch(progress)))
