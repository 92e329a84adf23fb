"""The main job."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from . import _umov
from ._jobs import Progress, Watch, job_options
from ._numbers import between, whole
from .engines import changed
from .errors import raise_stopped
from .light_curves import LightCurve
from .scenarios import AnyScenario, Scenario

__all__ = ["run"]


def run(scenario: AnyScenario, *, set: Mapping[str, Any] | None = None, seed: int | None = None,
        accuracy: float | None = None, threads: int = 0, cache: bool | str | os.PathLike[str] = True,
        progress: Progress = None, allow_bad_checksum: bool = False,
        allow_old_elements: bool = False, device: str = "cpu") -> LightCurve:
    """The light curve of a scenario, as the command `umov run` computes it, in memory.

    Ctrl-C raises `Interrupted`, an orbit that ends `NumericsError`, with the finished rows in `partial`.

    Parameters
    ----------
    scenario
        A path, dictionary or Scenario.
    set
        Changes of the scenario's keys, such as {"render.bounces": 2}.
    seed
        Over the scenario's: a whole number from 0.
    accuracy
        Over the scenario's: relative 95 % half-width asked of I.
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
    device
        Who adds up the light of the facets: "cpu"; "cuda", NVIDIA cards (`DeviceError` says what lacks); "auto", cards
        if they are there, with a warning if not. docs/theory/device.md.

    Examples
    --------
    >>> curve = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60})
    >>> print(repr(curve).splitlines()[0])
    <umov.LightCurve HST: 6 epochs x 3 bands (nm:425, nm:550, nm:650)
    """
    changes = changed(set, None) or {}
    if seed is not None:
        changes["seed"] = whole(seed, "seed", 2**63 - 1)
    if accuracy is not None:
        changes["render.accuracy"] = between(accuracy, "accuracy", 1e-6, 1)
    asked = Scenario(scenario, changes or None)
    asked._scenario.check_for_run()
    done = _umov.run(asked._scenario, job_options(threads, cache, allow_bad_checksum, allow_old_elements, device),
                     Watch(progress))
    curve = LightCurve._from_run(done, asked)
    if done.stopped is not None:
        raise_stopped(done.stopped, curve)
    return curve
