"""What umov observe, reduce and exposure refuse or warn of: every line tried."""
import math
import re
import signal
import subprocess
import time

import pytest
from astropy.io import fits
from astropy.table import Table

from conftest import UMOV, read_csv
from sphere_over_maui import make_sphere, write_scene


@pytest.fixture
def scene(umov, tmp_path):
    """scene(observation, ...) writes observe.toml for a small sphere, five seconds of it."""
    make_sphere(umov, 0.2)

    def write(observation, air="", **more):
        if "bands" not in observation:
            observation = 'bands = ["nm:550"]\n' + observation
        seeing = "" if "seeing" in air else "seeing = { arcsec = 3 }\n"
        return write_scene(tmp_path, observation, atmosphere=seeing + air, **more)

    return write


REFUSED = [
    ("exposure_s = 1\n[telescope]\nfocal_length_m = 2794", "is it in mm"),
    ("exposure_s = 1\n[telescope]\nfocal_length_m = 279", "is one of them in mm"),
    ("exposure_s = 1\n[telescope]\naperture_m = 279.4", "is it in mm"),
    ("exposure_s = 1\n[detector]\npixel_um = 3.45e-6", "is it in mm or m"),
    ("exposure_s = 1\n[detector]\npixel_um = 0.00345", "is it in mm or m"),
    ("exposure_s = 1\n[telescope]\nmount = \"equatorial\"\nport = \"nasmyth_left\"", "altitude axis"),
    ("exposure_s = 1\n[detector]\nbits = 6\nbias_adu = 100", "nothing for light"),
    ("exposure_s = 1\n[detector]\nmodel = \"emccd\"", "needs em_gain"),
    ("exposure_s = 1\n[polarimeter]\nlayout = [[90, 45, 135], [0]]", "[[90, 45], [135, 0]]"),
    ("exposure_s = 1\n[polarimeter]\nq0 = 0.9\nu0 = 0.9", "at most 1"),
    ("exposure_s = 1\naperture_fwhm = 4.5", "would hold the star"),
    ("exposure_s = 1\ntrail = \"slices\"", "trail is of frames"),
    ("exposure_s = 1\nlevel = \"image\"\nphotometry = \"image\"\ntrail = \"slices\"", "pieces of a trail are summed"),
    ("exposure_s = 1\nlevel = \"image\"\ntrail = \"pieces\"", "slices"),
    ("exposure_s = 1\nbands = []", "one or more were expected"),
    ("exposure_s = 1\n[polarimeter]\nretardance_deg = 90", "says nothing to a polarimeter of type \"mosaic\""),
    ("exposure_s = 1\n[polarimeter]\nangles_deg = [0, 60, 120]", "angles_deg says nothing"),
    ("exposure_s = 1\n[polarimeter]\nperiod_s = 2", "period_s says nothing"),
    ("exposure_s = 1\n[polarimeter]\ntype = \"none\"\nq0 = 0.1", "q0 says nothing"),
    ("exposure_s = 1\n[detector]\ndead_time_s = 1e-6", "only a counter"),
    ("exposure_s = 1\n[detector]\nmodel = \"counter\"\nparalyzable = true", "without a dead time"),
    ("exposure_s = 1\n[detector]\nline_time_s = 1e-5", 'shutter = "global"'),
    ("exposure_s = 1\n[telescope]\nthroughput = 0", "no light comes through"),
    ("exposure_s = 1\n[telescope]\nthroughput = { wavelength_nm = [400, 700], value = [0, 0] }", "no light comes through"),
    ('exposure_s = 1\nlevel = "image"\nframe_px = [256, 256]\n[detector]\nsize_px = [128, 512]', "size_px = [128, 512]"),
    ("exposure_s = 1\n[atmosphere.scintillation]\nc_y = 100", "sites have 1.3 to 1.67"),
    ("exposure_s = 1\n[atmosphere.sky]\ndark_mag = { V = 90 }", "V = 90; -5 to 40"),
    ("exposure_s = 1\nclock_error_s = 86400", "0 to 600 s"),
    ("exposure_s = 1\n[detector]\nread_e = 1e6", "cameras have 1 to 100"),
    ("exposure_s = 1\n[detector]\nsize_px = [10.5, 3]", "size_px = [10.5, 3]; [columns, rows], two whole numbers"),
    ('exposure_s = 1\n[telescope]\nmount = "equatorial"\nderotator = true', "on which no field turns"),
    ('exposure_s = 0.01\n[telescope]\ntracking = "sidereal"\n[detector]\nshutter = "rolling"\nline_time_s = 2e-4', "of what a rolling shutter"),
    ("exposure_s = 1\n[atmosphere.cloud]\nsd_mag = 50", "nothing is seen behind a cloud"),
    ("exposure_s = 1\n[atmosphere.cloud]\ntime_s = 60", "without sd_mag"),
    ("exposure_s = 1\n[atmosphere.sky]\nmag = 90", "-5 to 40 mag a square second of arc"),
    ("exposure_s = 1\n[polarimeter]\ntype = \"hwp_dual_beam\"\nretardance_deg = 1", "retardance_deg = 1 there hardly changes Q and U"),
    ("exposure_s = 1\n[polarimeter]\ntype = \"rotating_retarder\"\nretardance_deg = 1", "some 90 to 150 (131.8 tells all alike) was expected"),
    ('exposure_s = 1\nlevel = "image"\n[detector]\nmodel = "counter"\ndead_time_s = 1e-7', "detector.dead_time_s = 1e-07"),
    ('exposure_s = 1\nbands = ["nm:255"]\nwidth_nm = 40', "255 nm, 40 nm wide"),
    ('exposure_s = 1\nbands = ["nm:5500"]', "what air takes is known from 250 to 4000 nm"),
]


@pytest.mark.parametrize("observation, told", REFUSED)
def test_what_is_refused(scene, umov, observation, told):
    done = umov("observe", scene(observation))
    assert done.code == 3, done.err
    assert told in done.err and "observe.toml:" in done.err


@pytest.mark.parametrize("air, told", [
    ("pressure_hpa = 0.7", "pressure_hpa = 0.7; 100 to 1200 hPa"), ("pressure_hpa = 101325", "100 to 1200 hPa"),
    ("ozone_du = 5000", "0 to 1000 Dobson units"), ("water_cm = 30", "is it in mm")])
def test_air_that_the_earth_has_not_is_refused(scene, umov, air, told):
    done = umov("observe", scene("exposure_s = 1", air=air + "\n"))
    assert done.code == 3 and told in done.err and re.search(r"observe.toml:\d+", done.err), done.err


def test_all_slips_of_a_table_are_told_at_once(scene, umov):
    observation = ("exposure_s = -1\nclock_error_s = 1e5\naperture_fwhm = 9\n[telescope]\nobstruction = 2\nthroughput = 3\nmount = \"pillar\"\n"
                   "[detector]\nread_e = -1\nbits = 99\nsize_px = [1]\n[polarimeter]\nq0 = 2\nx_axis_deg = 999\nperiod_s = 1")
    done = umov("observe", scene(observation, air="ozone_du = -1\nwater_cm = 99\ncloud = { time_s = 3 }\nsky = { mag = 99 }\n"))
    assert done.code == 3
    for told in ("exposure_s = -1", "clock_error_s = 100000", "aperture_fwhm = 9", "obstruction = 2", "throughput holds 3", "pillar", "read_e = -1",
                 "bits = 99", "size_px = [1]", "q0 = 2", "x_axis_deg = 999", "period_s says nothing", "ozone_du = -1", "water_cm = 99",
                 "without sd_mag", "mag = 99"):
        assert done.err.count(told) == 1, (told, done.err)


def test_numbers_of_an_emccd_are_those_behind_its_register(scene, umov, tmp_path):
    detector = '[detector]\nmodel = "emccd"\nem_gain = 200\ngain_e_adu = 10\nread_e = 40\nbits = 16\nwell_e = 1e6\n'
    for level in ("aperture", "image"):
        done = umov("observe", scene(f'exposure_s = 0.1\nlevel = "{level}"\n' + detector), "-o", level)
        assert done.code == 0, done.err
        counts = Table.read(tmp_path / level / "counts.ecsv")
        assert max(abs(counts["counts_adu"] * 10 / 200 / counts["counts"] - 1)) < 1e-9, level
    header = fits.getheader(next((tmp_path / "image/frames").glob("*.fits")))
    assert header["EMGAIN"] == 200 and header["GAIN"] == 10 and "behind the register" in header.comments["GAIN"]


@pytest.mark.parametrize("sky, told", [
    ("p = 0.3", "p without mag"), ("mag = 20, p = 1.5", "p = 1.5; 0 to 1"), ('mag = 20, twilight = "none"', "twilight beside mag"),
    ("mag = 20, dark_mag = { V = 21 }", "dark_mag beside mag"), ('mag = 20, moon = "none"', "moon beside mag"),
    ("mag = 20, dilution = { sun = 0.5 }", "dilution beside mag"), ("dilution = { sun = 1.2 }", "sun = 1.2; 0 to 1"),
    ("dilution = { moon = -0.1 }", "moon = -0.1; 0 to 1")])
def test_skies_that_are_refused(scene, umov, sky, told):
    done = umov("observe", scene("exposure_s = 1", air=f"sky = {{ {sky} }}"))
    assert done.code == 3 and told in done.err and re.search(r"observe.toml:\d+", done.err), done.err


def test_no_air_has_no_wavelengths(scene, umov, tmp_path):
    file = tmp_path / scene('exposure_s = 1\nbands = ["nm:5500"]')
    assert "what air takes" in umov("observe", file).err
    text, count = re.subn(r"\[atmosphere\][^\[]*", "", file.read_text())
    assert count == 1
    file.write_text(text)
    done = umov("observe", file, "--set", 'observer.atmosphere="none"')
    assert done.code == 0, done.err


def test_bands_that_are_not_observed_may_lie_where_air_is_unknown(scene, umov):
    done = umov("observe", scene('exposure_s = 1\nbands = ["Bessell.V"]'), "--set", 'bands.set=["nm:10000"]')
    assert "what air takes" not in done.err and done.code == 0, done.err


@pytest.mark.parametrize("sky", ["p = 0", 'mag = 20, twilight = "patat2006", moon = "ks1991", dilution = { sun = 0.8, moon = 0.6 }, p = 0.1'])
def test_skies_of_earlier_locks_are_read(scene, umov, sky):
    """They spelt every key out, with what it is where nobody gives it."""
    done = umov("observe", scene("exposure_s = 1", air=f"sky = {{ {sky} }}"))
    assert done.code == 0, done.err


@pytest.mark.parametrize("sky", ["mag = 20, p = 0.3", 'twilight = "none"', "dilution = { sun = 0.5 }"])
def test_locks_of_skies_and_own_instruments_are_read_again(scene, umov, tmp_path, sky):
    head = umov("instrument", "show", "c11_imx250").out
    (tmp_path / "garage.toml").write_text(head)
    assert umov("observe", scene("exposure_s = 1", air=f"sky = {{ {sky} }}", instrument="garage.toml")).code == 0
    first = Table.read(tmp_path / "out/counts.ecsv")
    assert first.meta["instrument"] == "garage"
    lock = next((tmp_path / "out").glob("*.lock*"))
    done = umov("observe", str(lock), "-o", "again")
    assert done.code == 0, done.err
    second = Table.read(tmp_path / "again/counts.ecsv")
    assert second.meta["instrument"] == "garage" and list(first["counts"]) == list(second["counts"])


def test_day_is_refused(scene, umov):
    day = dict(start="2018-01-21T01:40:00Z", stop="2018-01-21T03:40:00Z")  # some pass before sunset at 04:15
    done = umov("observe", scene("exposure_s = 10", **day), "--set", "time.only={ sunlit = false }")
    assert done.code == 3 and "sun_alt_max_deg" in done.err and "observe.toml:" in done.err, done.err
    done = umov("observe", scene("exposure_s = 10", air="sky = { mag = 8 }", **day))
    assert done.code == 0, done.err


WARNED = [
    # Some .6 deg/s over pixels of .25 arcsec are 8,000 rows a second: 8 % of each exposure.
    ('exposure_s = 0.01\n[telescope]\ntracking = "sidereal"\n[detector]\nshutter = "rolling"\nline_time_s = 1e-5', {}, "under a rolling shutter"),
    # .526 deg/s (test_observe_pass.py) for half a second over pixels of .255 arcsec: 3,700 of them.
    ('exposure_s = 0.5\n[telescope]\ntracking = "fixed"', {}, "detector.size_px = [2448, 2048] (3192 px across)"),
    ("exposure_s = 1\n[detector]\nwell_e = 1e5", {}, "numbers fill first"),
    ("exposure_s = 0.1", {"air": "seeing = { arcsec = 0.5 }"}, "under 3 px"),
    ("exposure_s = 0.1\naperture_fwhm = 1", {}, "cuts the four orientations unevenly"),
    ("exposure_s = 1", {"alt_m": 10033}, "is in metres"),
    ('exposure_s = 1\n[telescope]\nmirror = "Ag_Johnson"', {}, "says nothing at a Cassegrain focus"),
    ("exposure_s = 1\n[detector]\ngain_e_adu = 12\nread_e = 2", {}, "dark pixels fall on one number"),
    ("exposure_s = 1\n[detector]\nnonlinearity = 0.02", {}, 'says nothing to level = "aperture"'),
    ('exposure_s = 1\nwidth_nm = 40\nbands = ["Bessell.V"]', {}, "says nothing to bands with a curve"),
    ("exposure_s = 1", {"air": "sky = { mag = 9 }"}, "more than ten times"),
    ("exposure_s = 1\nsequence = [{ analyser_deg = 45 }]", {}, "says nothing to a polarimeter"),
    ("exposure_s = 1\nsequence = [{ analyser_deg = 0 }]", {}, "which takes everything at once"),
    ("exposure_s = 0.5\nsequence = [{ analyser_deg = 0 }, { analyser_deg = 4 }, { analyser_deg = 8 }]\n"
     '[polarimeter]\ntype = "polarizer_wheel"', {}, "condition number"),
    ("exposure_s = 1", {"start": "2018-01-21T05:09:30Z", "stop": "2018-01-21T05:09:40Z"}, "40 deg from the zenith"),
]


@pytest.mark.parametrize("observation, change, told", WARNED)
def test_what_is_warned_of(scene, umov, tmp_path, observation, change, told):
    done = umov("observe", scene(observation, **change))
    assert done.code == 0 and told in done.err, done.err
    assert "nan" not in (done.out + done.err)
    notes = Table.read(tmp_path / "out/counts.ecsv").meta
    assert any(told in str(value) for key, value in notes.items() if key.startswith("warning_")), notes


CURVES = [("500 0.5\n550 -1\n600 0.5\n", "band.csv:4: response -1"), ("500 0.5\n600 1\n550 0.5\n", "band.csv:5: wavelength 550"),
          ("500 0.5\n", "one point"), (".5 0.5\n.55 1\n.6 .5\n", "micrometres"), ("105 0.5\n118 1\n125 0.5\n", "solar spectrum")]


def test_short_exposures_see_the_air_stand_still(scene, umov, tmp_path):
    short = "exposure_s = 1e-4\ncadence_s = 1"
    done = umov("observe", scene(short), "-o", "short")
    assert done.code == 0 and "the air's pattern takes 0.0086 s to cross the aperture" in done.err, done.err
    done = umov("observe", scene("exposure_s = 0.0085803785\ncadence_s = 1"), "-o", "limit")  # .6142005 x .2794 m/(20 m/s)
    assert done.code == 0, done.err
    sd = [Table.read(tmp_path / f"{name}/counts.ecsv")["scint_sd"][0] for name in ("short", "limit")]
    assert abs(sd[0] / sd[1] - 1) < 1e-3, sd  # the air mass changes by less within half of so short an exposure
    assert "cross the aperture" not in umov("observe", scene("exposure_s = 1"), "-o", "long").err
    air = 'scintillation = "none"\n'
    assert "cross the aperture" not in umov("observe", scene(short, air=air), "-o", "still").err


def test_light_that_flickers_much_is_told(scene, umov):
    done = umov("observe", scene("exposure_s = 0.01\ncadence_s = 1", air="scintillation = { c_y = 8 }\n"))
    assert done.code == 0 and "flickers by more than half of itself" in done.err, done.err


@pytest.mark.parametrize("points, told", CURVES)
def test_curves_that_are_refused(scene, umov, tmp_path, points, told):
    (tmp_path / "band.csv").write_text("# unit: nm\n# detector: photon\n" + points)
    done = umov("observe", scene('exposure_s = 1\nbands = ["file:band.csv"]'))
    assert done.code == 3 and told in done.err and "observation.bands" in done.err, done.err


def test_no_memory_is_asked_for_a_billion_rows(scene, umov):
    done = umov("observe", scene("exposure_s = 1e-6", start="2018-01-21T05:09:00Z", stop="2018-01-21T05:14:05Z"))
    assert done.code == 3 and "the limit is" in done.err and re.search(r"observe.toml:\d+", done.err), done.err


def test_what_lies_below_the_horizon_is_counted(scene, umov):
    """Hubble rises over Maui within this span."""
    done = umov("observe", scene("exposure_s = 10", start="2018-01-21T05:01:00Z", stop="2018-01-21T05:06:00Z"))
    told = re.search(r"observe.toml:\d+:\d+: ball: (\d+) of 30 exposures left out: (\d+) below the horizon", done.err)
    assert done.code == 0 and told and told[1] == told[2], done.err
    taken = int(re.search(r"(\d+) exposures, ", done.err + done.out)[1])
    assert taken + int(told[1]) == 30


def test_why_there_is_nothing_to_observe(scene, umov):
    done = umov("observe", scene("exposure_s = 10", start="2018-01-21T04:50:00Z", stop="2018-01-21T04:52:00Z"))
    assert done.code == 5 and "12 of 12 exposures left out: 12 below the horizon" in done.err, done.err
    asked = umov("observe", scene("exposure_s = 10"), "--set", "time.only={ alt_min_deg = 80 }", "--set",
                 "time.stop=2018-01-21T05:11:30Z")
    assert asked.code == 5 and "3 of 3 exposures left out: 3 below 80 deg (time.only.alt_min_deg)" in asked.err, asked.err


def test_what_filters_leave_out_is_said_once(scene, umov):
    """The shadow of the Earth at the end of the pass: asked for, so no warning."""
    done = umov("observe", scene("exposure_s = 10", start="2018-01-21T05:09:00Z", stop="2018-01-21T05:18:00Z"))
    said = done.out + done.err
    assert done.code == 0 and said.count("left out") == 1 and "in the Earth's shadow (time.only.sunlit)" in said, said
    assert "warning: ball" not in said


SEQUENCES = [
    ('sequence = [{ analyser_deg = 0 }, { analyser_deg = 45 }]\n[polarimeter]\ntype = "polarizer_wheel"',
     "2 rows", "I, Q, U apart", "3 or more are needed"),
    ('sequence = [{ analyser_deg = 0 }, { analyser_deg = 90 }, { analyser_deg = 180 }]\n[polarimeter]\n'
     'type = "polarizer_wheel"', "3 rows", "cannot tell U (", "give other angles"),
    ('sequence = [{ analyser_deg = 0, band = "nm:551" }]\n[polarimeter]\ntype = "polarizer_wheel"',
     'band "nm:551"', "none of those observed", "nm:550"),
]


@pytest.mark.parametrize("case", SEQUENCES)
def test_sequences_are_refused_where_they_stand(scene, umov, case):
    sequence, *told = case
    path = scene("exposure_s = 0.5\n" + sequence)
    line = 1 + path.read_text()[:path.read_text().index("sequence =")].count("\n")
    done = umov("observe", path)
    assert done.code == 3 and f"observe.toml:{line}:" in done.err, done.err
    assert all(word in done.err for word in told), done.err


def test_an_exposure_longer_than_the_span(scene, umov):
    done = umov("observe", scene("exposure_s = 20"))
    assert done.code == 3 and re.search(r"observe.toml:\d+:\d+: exposure_s = 20 is longer", done.err), done.err


def test_air_near_the_horizon_is_told(scene, umov):
    done = umov("observe", scene("exposure_s = 10", start="2018-01-21T05:04:00Z", stop="2018-01-21T05:07:00Z"))
    assert done.code == 0 and "air mass is extrapolated" in done.err, done.err


@pytest.mark.parametrize("air", ['"clear"', '"none"', "{ ozone_du = 300 }"])
def test_air_is_described_once(scene, umov, air):
    path = scene("exposure_s = 1")
    path.write_text(path.read_text().replace("alt_m = 3058", f"alt_m = 3058\natmosphere = {air}"))
    for verb in ("observe", "run"):
        done = umov(verb, path)
        assert done.code == 3 and "observe.toml:9:" in done.err and "beside [atmosphere]: leave one out" in done.err, done.err


def test_without_air_nothing_is_taken_away(scene, umov, tmp_path):
    """atmosphere = "none" beside [observation]: light as above the air, steady, under a sky that nothing lights up; the lock says so too."""
    path = scene("exposure_s = 1", air='')
    clear = path.read_text().replace("[atmosphere]\nseeing = { arcsec = 3 }\n", "")
    path.write_text(clear)
    assert umov("observe", path, "-o", "clear").code == 0
    path.write_text(clear.replace("alt_m = 3058", 'alt_m = 3058\natmosphere = "none"'))
    assert umov("observe", path, "-o", "none").code == 0
    seen, airless = (Table.read(tmp_path / name / "counts.ecsv") for name in ("clear", "none"))
    assert set(airless["k_mag"]) == {0} and set(airless["scint_sd"]) == {0} and min(seen["scint_sd"]) > 0
    for behind, above in zip(seen, airless):
        # The air's part by the columns of the other table: nothing but extinction lies between the two.
        assert behind["w0"] / above["w0"] == pytest.approx(10 ** (-0.4 * behind["k_mag"] * behind["airmass"]), rel=2e-4)
    assert umov("observe", "none/scenario.lock.toml", "-o", "again").code == 0
    for name in ("counts.ecsv", "scenario.lock.toml"):
        assert (tmp_path / "none" / name).read_bytes() == (tmp_path / "again" / name).read_bytes().replace(b"again", b"none")
    # umov run has the columns behind the air where umov observe looks through it.
    for folder, has_air in (("clear", True), ("none", False)):
        assert umov("run", f"{folder}/scenario.lock.toml", "-o", "run_" + folder, "--set", "time.step_s=1").code == 0
        assert ("I_obs" in Table.read(tmp_path / f"run_{folder}/lightcurve.ecsv").colnames) == has_air


def test_a_table_is_no_folder(scene, umov, tmp_path):
    done = umov("observe", scene("exposure_s = 1"), "-o", "x.csv")
    assert done.code == 2 and "folder" in done.err
    assert not (tmp_path / "x.csv").exists()


@pytest.mark.parametrize("option, value", [("--mag", "nan"), ("--mag", "1e9"), ("--change-per-s", "-1"),
                                           ("--sky-mag", "inf"), ("--height-m", "3e6"), ("--seeing", "nan")])
def test_exposures_of_nonsense(umov, option, value):
    done = umov("exposure", "--instrument", "usafa16", f"{option}={value}")
    assert done.code == 2 and option in done.err, done.err


def test_a_stop_does_not_wait_for_the_block(scene, umov, tmp_path):
    # Some 100 exposures of three nodes each by rays to one in 100,000: minutes.
    path = scene('exposure_s = 1\n[render]\nmethod = "rays"\naccuracy = 1e-5', stop="2018-01-21T05:12:40Z")
    assert umov("mesh", "make", "dish", "-o", "sphere.obj").code == 0
    running = subprocess.Popen([UMOV, "observe", path, "--threads", "1"], cwd=tmp_path, stderr=subprocess.PIPE,
                               text=True)
    time.sleep(2)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate(timeout=60)
    assert running.returncode == 130 and "stopped" in said, said
    assert not (tmp_path / "out").exists()


def test_wavelengths_stand_closer_where_colours_ask_for_it(scene, umov, tmp_path):
    """Gold through B: light above the air as umov run has it, which halves the nodes (docs/theory/bands.md)."""
    path = scene('exposure_s = 1\nbands = ["Bessell.B"]', material="gold", stop="2018-01-21T05:11:02Z")
    assert umov("observe", path).code == 0
    truth = Table.read(tmp_path / "out/truth.ecsv")
    path.write_text(path.read_text().replace("[output]", '[bands]\nset = ["Bessell.B"]\n[output]')
                    .replace("05:11:00Z", "05:11:00.5Z"))
    assert umov("run", path, "-o", "run").code == 0
    curve = Table.read(tmp_path / "run/lightcurve.ecsv")
    # Three nodes of one second against its middle: the light of a sphere is smooth.
    assert abs(truth["I"][0] / curve["I"][0] - 1) < 2e-5
    assert abs(truth["q"][0] - curve["q"][0]) < 2e-5


def test_a_material_may_end_where_the_band_ends(scene, umov, tmp_path):
    (tmp_path / "band.csv").write_text("# unit: nm\n# detector: photon\n400 0.5\n500 1\n600 0.5\n")
    (tmp_path / "film.yml").write_text(
        "REFERENCES: made for a test\nDATA:\n  - type: tabulated nk\n    data: |\n"
        "        0.4 1.5 0.1\n        0.5 1.6 0.1\n        0.6 1.5 0.1\n")
    text = scene('exposure_s = 1\nbands = ["file:band.csv"]', material="own").read_text()
    (tmp_path / "observe.toml").write_text(text + '\n[material.own]\nindex = "film.yml"\ndistribution = { model = "beckmann", alpha = 0.3 }\n')
    done = umov("observe", "observe.toml")
    assert done.code == 0, done.err
    (tmp_path / "band.csv").write_text("# unit: nm\n# detector: photon\n340 0.5\n500 1\n600 0.5\n")
    done = umov("observe", "observe.toml", "-o", "b")
    assert done.code == 3 and "340" in done.err


def test_angles_of_a_sequence_are_of_its_middle(scene, umov, tmp_path):
    """Ten seconds of a wheel while the axis of scattering turns."""
    text = 'exposure_s = 5\nsequence = [{ analyser_deg = 0 }, { analyser_deg = 60 }, { analyser_deg = 120 }]\n'
    path = scene(text + '[polarimeter]\ntype = "polarizer_wheel"', air='scintillation = "none"',
                 stop="2018-01-21T05:11:15Z")
    assert umov("observe", path).code == 0
    counts = Table.read(tmp_path / "out/counts.ecsv")
    assert umov("reduce", "out/counts.ecsv", "-o", "s.ecsv").code == 0
    row = Table.read(tmp_path / "s.ecsv")[0]
    assert abs(row["phase_angle"] - counts["phase_angle"][1]) < 1e-9
    twice = 2 * math.radians(counts["pa_scat"][1])
    assert abs(row["q_scat"] - (row["q"] * math.cos(twice) + row["u"] * math.sin(twice))) < 1e-12
    assert abs(counts["pa_scat"][0] - counts["pa_scat"][1]) > 0.5


def test_pages_of_plots(scene, umov, tmp_path):
    path = scene("exposure_s = 0.2")
    path.write_text(path.read_text().replace('["ecsv"]', '["ecsv", "html"]'))
    assert umov("observe", path).code == 0
    page = (tmp_path / "out/report.html").read_text()
    for title in ("Counts in the aperture", "What the model leaves", "How often counts miss by how many errors", "Noise of the first channel",
                  "What was there"):
        assert title in page
    assert umov("reduce", "out/counts.ecsv", "-o", "s.ecsv", "--page", "s.html").code == 0
    page = (tmp_path / "s.html").read_text()
    for title in ("Polarization", "Degree of linear polarization", "Brightness", "chi2/dof", "q and u against time"):
        assert title in page
    assert "Below: " not in page and "q, u and v against time" not in page


def test_pixels_wider_than_stars_are_read_whole(scene, umov, tmp_path):
    """16 arcsec a pixel and stars of 1 arcsec: one pixel for each lens, its reading and the sky of 256 arcsec2; a fine camera has its circle."""
    for instrument, pixels in (("mmt9_channel", 1), ("usafa16", None)):
        path = scene("exposure_s = 0.1", air="seeing = { arcsec = 1, outer_scale_m = 0 }\nsky = { mag = 18 }", instrument=instrument)
        assert umov("observe", path, "--force").code == 0
        row = Table.read(tmp_path / "out/counts.ecsv")[0]
        if pixels is None:  # F X^.6 lambda^-.2 (docs/theory/observing.md, 3), two widths about it
            width = row["airmass"] ** 0.6 * (550 / 500) ** -0.2 / math.degrees(13e-6 / 3.3325) / 3600
            pixels = math.pi * (2 * width) ** 2
        assert row["n_pixel"] == pytest.approx(pixels, rel=1e-6)
        if instrument == "mmt9_channel":
            assert row["var_read"] == pytest.approx(1.5**2 + 0.5**2 / 12, rel=1e-9)
            # Of 18 mag/arcsec2 (AB) in 10 nm at 550 nm: 5.48e10 dlnlambda photons s-1 m-2 of AB 0, 3.14 e by 1.57e-3 m2 behind half a polaroid.
            mean = 5.47986954e10 * 10 / 550 * 10 ** (-0.4 * 18) * (6.5e-6 / 0.0838 * 206264.806) ** 2
            mean *= math.pi / 4 * 0.0708**2 * 0.4 * (1 + 1 / 100) / 2 * 0.1
            skies = Table.read(tmp_path / "out/counts.ecsv")["sky"]
            errors = Table.read(tmp_path / "out/counts.ecsv")["sky_err"]
            assert abs(sum(skies) / len(skies) - mean - 0.05) < 4 * max(errors) / math.sqrt(len(skies))


def test_a_page_of_all_four_parameters(scene, umov, tmp_path):
    """V has its points where it is known, and the answer says how much stands in doubt below."""
    assert umov("observe", scene("exposure_s = 0.01\ncadence_s = 0.5", instrument="full_stokes_3m6", stop="2018-01-21T05:11:20Z")).code == 0
    done = umov("reduce", "out/counts.ecsv", "-o", "s.ecsv", "--page", "s.html")
    page, warned = (tmp_path / "s.html").read_text(), done.err.count("warning: ")
    assert done.code == 0 and "q, u and v against time" in page and "v nm:550" in page and "tell q, u and v, to " in page, done.err
    assert (f"Below: {warned} warning" in page) == (warned > 0), done.err


def test_magnitudes_of_the_vega_system(umov, tmp_path):
    """[bands] mag_system beside [observation]: of its bands, whatever the default of [bands] would be."""
    make_sphere(umov, 1)
    light = {}
    for system in ("AB", "Vega"):
        path = write_scene(tmp_path, 'bands = ["Bessell.V"]\nexposure_s = 0.05\ncadence_s = 1\n[bands]\nmag_system = "' + system + '"',
                           instrument="c11_imx250", seed=11, atmosphere="", telescope="", stop="2018-01-21T05:11:05Z")
        done = umov("observe", path, "--force")
        assert done.code == 0, done.err
        assert umov("reduce", "out/counts.ecsv", "-o", "s.csv", "--tdm", "s.tdm").code == 0
        truth, stokes = Table.read(tmp_path / "out/truth.ecsv"), read_csv(tmp_path / "s.csv")
        assert {row["mag_system"] for row in stokes} == {system} == {truth.meta["mag_system"]}
        assert f"MAG: {system} magnitude" in (tmp_path / "s.tdm").read_text()
        light[system] = truth["mag"][0], float(stokes[0]["mag"])
    # The Sun in V, AB and by Willmer's zero flux (2018, ApJS 236, 47): -26.76973 and -26.7610.
    for ab, vega in zip(light["AB"], light["Vega"]):
        assert vega - ab == pytest.approx(-26.7610 + 26.76973, abs=1e-4)
    locked = umov("observe", "out/scenario.lock.toml", "-o", "again")
    assert locked.code == 0, locked.err
    path.write_text(path.read_text().replace("Bessell.V", "nm:550"))
    done = umov("observe", path, "--force")
    assert done.code == 3 and '"nm:550" has no zero point in the Vega system' in done.err and "observation.bands" in done.err
    assert "observe.toml:" in done.err
    done = umov("run", path, "-o", "run")
    assert done.code == 3 and "has no zero point in the Vega system" in done.err
    assert "observe.toml:" in done.err and "observation.bands" in done.err


def test_stamps_of_fast_exposures_differ(scene, umov, tmp_path):
    done = umov("observe", scene("exposure_s = 0.0004\nclock_error_s = 0", start="2018-01-21T05:11:00Z", stop="2018-01-21T05:11:00.01Z"))
    assert done.code == 0, done.err
    counts = Table.read(tmp_path / "out/counts.ecsv")
    assert len(set(counts["time_utc"])) == len(set(counts["exposure"])) > 10


def test_how_badly_a_weak_plate_tells_is_a_number(scene, umov):
    """cos 2a sin^2(d/2) of d = 1 deg: V is told by sin d, U by 7.6e-5: a condition number of thousands, not of infinity."""
    done = umov("observe", scene('exposure_s = 1\n[polarimeter]\ntype = "rotating_retarder"\nretardance_deg = 1'))
    number = re.search(r"condition number (\S+?)\)", done.err)[1]
    assert done.code == 3 and 1e3 < float(number) < 1e6, done.err
