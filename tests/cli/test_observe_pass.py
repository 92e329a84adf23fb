"""HST over Maui, recorded through four instruments and reduced: what comes back is what was there, within its errors."""
import math

import numpy
import pytest
from astropy.table import Table

from conftest import ROOT

# Light is dimmed so that no pixel is full, and wheels are quick: HST's own changes within a set of exposures would be
# taken for noise.
QUICK = ["observation.exposure_s=0.01", "observation.cadence_s=0.012", "time.start=2018-01-21T05:10:20Z",
         "time.stop=2018-01-21T05:13:00Z"]
CASES = [("c11_imx250", ["telescope.throughput=0.2"], 3),
         ("hwp_wollaston_1m", [*QUICK, "telescope.throughput=0.05"], 3),
         ("moptop_2m", [*QUICK, "telescope.throughput=0.02", "polarimeter.period_s=0.192"], 3),
         ("full_stokes_3m6", [*QUICK, "telescope.throughput=0.006", "observation.sequence=["
                              + ", ".join(f"{{plate_deg={a}}}" for a in (-51.69, -15.12, 15.12, 51.69, 38.31, 74.88))
                              + "]"], 4)]


def truth_of(truth):
    """I, q, u and v of each set: the mean light of its exposures."""
    ids, light = numpy.array(truth["set_id"], int), numpy.array(truth["I"])
    whole = numpy.bincount(ids, light)
    out = {"I": whole / numpy.maximum(1, numpy.bincount(ids))}
    for name in "quv":
        out[name] = numpy.bincount(ids, light * numpy.nan_to_num(numpy.array(truth[name]))) / numpy.maximum(whole, 1e-300)
    return out


@pytest.mark.parametrize("instrument, changes, parameters", CASES)
def test_the_pass_comes_back(umov, tmp_path, instrument, changes, parameters):
    options = [word for change in [f'instrument="{instrument}"', 'observation.bands=["nm:550"]', "seed=1", *changes]
               for word in ("--set", change)]
    done = umov("observe", ROOT / "examples/observe_hst.toml", "-o", "out", *options)
    assert done.code == 0, done.err
    done = umov("reduce", "out/counts.ecsv", "-o", "stokes.ecsv")
    assert done.code == 0, done.err
    stokes, truth = Table.read(tmp_path / "stokes.ecsv"), truth_of(Table.read(tmp_path / "out/truth.ecsv"))
    is_sound = numpy.array([flags is numpy.ma.masked or not str(flags) for flags in stokes["flags"]])
    sets = numpy.array(stokes["set_id"], int)
    known = 0
    for name in "Iquv":
        error = numpy.array(stokes["I_err"]) if name == "I" else numpy.sqrt(numpy.array(stokes[f"cov_{name}{name}"]))
        pulls = ((numpy.array(stokes[name]) - truth[name][sets]) / error)[is_sound]
        pulls = pulls[numpy.isfinite(pulls)]
        if len(pulls) == 0:
            continue
        known += 1
        # 1,500 sets know an sd to .018, 4,500 to .011.
        assert len(pulls) > 1500 and 0.95 < pulls.std() < 1.05, name
        # Four standard errors. An error that grows with the I that was found makes low ones surer: 1/(2 sqrt(100 e)).
        assert abs(pulls.mean()) < 4 / math.sqrt(len(pulls)) + (0.05 if name == "I" else 0.0), name
    assert known == parameters
    dof = numpy.array(stokes["dof"], float)[is_sound].sum()
    chi2 = numpy.array(stokes["chi2"], float)[is_sound].sum()
    assert abs(chi2 / dof - 1) < 0.03  # known to .011 to .021
