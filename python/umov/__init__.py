"""Polarized light curves of satellites and space debris.

Everything that is computed is computed by the C++ library; this package gives it the manners of Python.

>>> import umov
>>> curve = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60})
>>> curve.bands
['nm:425', 'nm:550', 'nm:650']
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._umov import conventions_version, source_revision
from ._umov import version as __version__
from .abundances import Abundances, Coloured, Column, Sums
from .engines import Engine, Light, random_poses
from .errors import (DeviceError, Error, InputError, InternalError, Interrupted, NoResult, NumericsError,
                     UmovWarning, UsageError, Where)
from .flux_tables import flux_table
from .inversions import Fit, Inversion, identify, invert_health, invert_material, invert_plan, invert_pose, invert_spin
from .libraries import build_library
from .light_curves import LightCurve
from .materials import Material, brdf, materials
from .measurements import score, tdm
from .observing import (Calibration, Observation, calibrate, calibrate_channels, exposure, instrument, instruments, observe,
                        reduce, standards)
from .orbits import States, ephemeris, passes, propagate
from .passbands import Bands, band, bands
from .periods import period
from .pictures import Mesh, Picture, mesh, render
from .runs import run
from .samples import example
from .satellites import Satellite
from .scenarios import Scenario, schema
from .sites import Site, site_names
from .tables import Table
from .times import utc
from .tracking import invert_track

if TYPE_CHECKING:
    from . import plot, scale, turnable

__all__ = ["Abundances", "Bands", "Calibration", "Coloured", "Column", "DeviceError", "Engine", "Error", "Fit",
           "InputError", "InternalError", "Interrupted", "Inversion", "Light", "LightCurve", "Material", "Mesh",
           "NoResult", "NumericsError", "Observation", "Picture", "Satellite", "Scenario", "Site", "States", "Sums",
           "Table", "UmovWarning", "UsageError", "Where", "__version__", "band", "bands", "brdf", "build_library",
           "calibrate", "calibrate_channels", "conventions_version", "ephemeris", "example", "exposure", "flux_table", "identify",
           "instrument", "instruments", "invert_health", "invert_material", "invert_plan", "invert_pose", "invert_spin", "invert_track",
           "materials", "mesh", "observe", "passes", "period", "plot", "propagate", "random_poses", "reduce", "render", "run",
           "scale", "schema", "score", "site_names", "source_revision", "standards", "tdm", "turnable", "utc"]


def __getattr__(name: str) -> Any:
    """`umov.plot`, `umov.scale` and `umov.turnable`, loaded when they are asked for."""
    if name in ("plot", "scale", "turnable"):
        import importlib
        return importlib.import_module("." + name, __name__)
    raise AttributeError(f"module 'umov' has no attribute {name!r}")
