"""A geostationary box with wings through a night, behind a two metre telescope: its polarization comes back, smallest where the
phase angle is (as measured: Sanchez et al. 2001, Kosaka et al. 2020 found 10 to 40 per cent and a minimum there)."""
import numpy
from astropy.table import Table

from conftest import ROOT
from test_observe_pass import truth_of

# Black faces that turn with the Earth: phases of 20 to 95 deg within nine hours. Nothing of it is fitted to a satellite.
NIGHT = f"""umov = 1
seed = 3
instrument = "moptop_2m"
[observer]
name = "Kitt Peak"
[time]
start = 2018-02-10T03:23:20Z
stop = 2018-02-10T12:00:00Z
only = {{ alt_min_deg = 15, sun_alt_max_deg = -12 }}
[[object]]
name = "box with wings"
orbit = {{ file = "{ROOT}/data/tle/goes15.tle" }}
mesh = {{ file = "geo.obj", unit = "m", up = "+Z" }}
attitude = {{ point = "+Z", at = "nadir", then = "+Y", toward = "orbit_normal" }}
materials = {{ default = "paint_black" }}
[atmosphere]
seeing = {{ arcsec = 1.5 }}
[observation]
bands = ["nm:550"]
width_nm = 90
exposure_s = 4
cadence_s = 5
[polarimeter]
period_s = 80
[output]
dir = "out"
formats = ["ecsv"]
"""


def test_a_night_comes_back(umov, tmp_path):
    assert umov("mesh", "make", "box-wing", "--bus", 2.4, 2.4, 3, "--wing", 8, 2.4, "-o", "geo.obj").code == 0
    (tmp_path / "geo.toml").write_text(NIGHT)
    done = umov("observe", "geo.toml")
    assert done.code == 0, done.err
    done = umov("reduce", "out/counts.ecsv", "-o", "stokes.ecsv")
    assert done.code == 0, done.err
    stokes, truth = Table.read(tmp_path / "stokes.ecsv"), truth_of(Table.read(tmp_path / "out/truth.ecsv"))
    sets = numpy.array(stokes["set_id"], int)
    for name in "qu":
        pulls = (numpy.array(stokes[name]) - truth[name][sets]) / numpy.sqrt(numpy.array(stokes[f"cov_{name}{name}"]))
        # 1,500 sets: a mean to .026, an sd to .018.
        assert len(pulls) > 1400 and abs(pulls.mean()) < 0.1 and 0.95 < pulls.std() < 1.05, (name, pulls.mean(), pulls.std())
    p, phase = numpy.hypot(truth["q"], truth["u"])[sets], numpy.array(stokes["phase_angle"])
    found = numpy.array(stokes["p_debiased"])
    strong = p > 0.1
    assert strong.mean() > 0.4
    # Until the phase is 38 deg, early in the night, the range that others measured: 10 to 40 per cent.
    early = p[:numpy.argmax(phase < 38)]
    assert len(early) > 600 and 0.1 < early.min() < 0.11 and 0.38 < early.max() < 0.41, (early.min(), early.max())
    error = numpy.array(stokes["p_hi"] - stokes["p_lo"]) / 2 / 1.96
    assert numpy.median(abs(found - p)[strong] / error[strong]) < 1
    assert abs(phase[numpy.argmin(numpy.convolve(found, numpy.ones(25) / 25, "same")[25:-25]) + 25] - phase.min()) < 5
