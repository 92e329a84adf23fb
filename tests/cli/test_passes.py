"""umov passes: one object, a catalogue, what is refused."""
import json
import os
import re
import signal
import subprocess
import time

import pytest
from astropy.time import Time

from conftest import ROOT, UMOV, read_csv

HST = ROOT / "data/tle/hst.tle"
MIXED = ROOT / "tests/data/tle/mixed_979_2018-01-20.tle"
SITE = "20.7083,-156.2578,3058"
DAY = ("--start", "2018-01-21T00:00:00Z", "--stop", "2018-01-22T00:00:00Z")


def test_objects_left_out_are_named(umov, tmp_path):
    (tmp_path / "all.tle").write_text(HST.read_text() + (ROOT / "data/tle/explorer27.tle").read_text())
    done = umov("passes", "--orbit", "all.tle", "-s", SITE, *DAY, "-o", "p.csv")
    assert done.code == 0 and "1 object left out, with elements more than 30 d from the span: EXPLORER 27" in done.err, done.err


def test_passes_agree_with_the_ephemeris(umov, tmp_path):
    done = umov("passes", "--orbit", HST, "-s", SITE, *DAY, "-o", "p.csv")
    assert done.code == 0, done.err
    rows = read_csv(tmp_path / "p.csv")
    assert len(rows) == 7
    row = next(r for r in rows if r["pass_id"] == "20580-20180121T051147Z")
    for key, altitude in (("rise_utc", 10), ("set_utc", 10),
                          ("culmination_utc", float(row["culmination_alt"]))):
        done = umov("orbit", "ephemeris", "--orbit", HST, "--lat-deg", 20.7083, "--lon-deg", -156.2578,
                    "--alt-m", 3058, "--start", row[key], "--stop", row[key], "-o", "e.csv")
        assert done.code == 0, done.err
        seen = read_csv(tmp_path / "e.csv")[0]
        assert abs(float(seen["alt"]) - altitude) < 1e-3
    # Half of the Sun is gone at the entry into the shadow.
    done = umov("orbit", "ephemeris", "--orbit", HST, "--lat-deg", 20.7083, "--lon-deg", -156.2578,
                "--alt-m", 3058, "--start", row["shadow_entry_utc"], "--stop",
                row["shadow_entry_utc"], "-o", "e.csv")
    assert abs(float(read_csv(tmp_path / "e.csv")[0]["sunlit"]) - 0.5) < 1e-3
    assert 0 < float(row["sunlit_share"]) < 1 and row["shadow_exit_utc"] == ""


def test_a_catalogue_the_same_for_any_threads(umov, tmp_path):
    ask = ("passes", "--orbit", MIXED, "--lat-deg", 20.7083, "--lon-deg", -156.2578, "--alt-m", 3058,
           "--start", "2018-01-21T05:00:00Z", "--stop", "2018-01-21T06:00:00Z", "--visible")
    for threads in (1, 2, 8):
        done = umov(*ask, "--threads", threads, "-o", f"{threads}.csv")
        assert done.code == 0, done.err
    one = (tmp_path / "1.csv").read_bytes()
    assert one == (tmp_path / "2.csv").read_bytes() == (tmp_path / "8.csv").read_bytes()
    rows = read_csv(tmp_path / "1.csv")
    assert len(rows) > 20 and all(float(row["visible"]) > 0 for row in rows)
    begins = [Time(row["rise_utc"] or "2018-01-21T05:00:00Z") for row in rows]
    assert all(a <= b for a, b in zip(begins, begins[1:]))


@pytest.mark.parametrize("change, code, words", [
    (("-s", "20.7"), 2, ["latitude, longitude"]),
    (("-s", "95,0,0"), 3, ["lat_deg = 95", "-90 to 90"]),
    (("-s", SITE, "--norad", 1), 3, ["1"]),
    ((), 2, ["where?", "--site"]),
    (("-s", "80,0,0"), 5, ["no pass above 10 deg"]),
    (("-s", SITE, "--lat-deg", 3), 2, ["--site"]),
])
def test_passes_refuse(umov, tmp_path, change, code, words):
    done = umov("passes", "--orbit", HST, *DAY, "-o", "p.csv", *change)
    assert done.code == code and all(word in done.err for word in words), done.err
    assert not (tmp_path / "p.csv").exists()


def test_old_elements_are_left_out(umov, tmp_path):
    ask = ("passes", "--orbit", HST, "-s", SITE, "--start", "2018-04-21T00:00:00Z", "--stop",
           "2018-04-22T00:00:00Z")
    done = umov(*ask)
    assert done.code == 3 and "--allow-old-elements" in done.err
    done = umov(*ask, "--allow-old-elements", "-o", "p.csv")
    # From 2018-01-20.44 to the end of the span, 91.56 d: what is minutes off then is no matter of seconds.
    assert done.code == 0 and "more than 7 d from the span, the farthest 92 d; passes may be minutes off" in done.err, done.err
    near = ("--start", "2018-01-30T00:00:00Z", "--stop", "2018-01-31T00:00:00Z")
    assert "passes may be seconds off" in umov(*ask[:5], *near, "-o", "q.csv").err


def cpu_of(pid):
    """Seconds of the processor that a process has had."""
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_a_stop_keeps_what_is_found(umov, tmp_path):
    running = subprocess.Popen(
        [UMOV, "passes", "--orbit", MIXED, "-s", SITE, "--start", "2018-01-21T00:00:00Z", "--stop",
         "2018-12-20T00:00:00Z", "--allow-old-elements", "-o", "p.csv", "--threads", "1"], cwd=tmp_path,
        stderr=subprocess.PIPE, text=True)
    while running.poll() is None and cpu_of(running.pid) < 2.5:  # a busy machine has not found any after seconds of the clock
        time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate(timeout=60)
    assert running.returncode == 130 and "stopped by the user" in said
    assert not (tmp_path / "p.csv").exists()
    assert len(read_csv(tmp_path / "p.partial.csv")) > 0


def test_magnitudes_of_a_sphere_are_those_of_a_run(umov, scenario, tmp_path):
    """umov passes with a model against the rows of umov run for the same sphere."""
    assert umov("mesh", "make", "sphere", "--radius", 0.5, "--facets", 5000, "-o", "cube.obj").code == 0
    name = scenario(('normals = "flat"', 'normals = "smooth"'), ("step_s = 20", "step_s = 2"),
                    ("alt_min_deg = 10, sun_alt_max_deg = -6", "alt_min_deg = 10"),
                    ("05:08:00Z", "05:00:00Z"), ("05:12:00Z", "05:20:00Z"),
                    ('set = "paper_rgb"', 'set = ["nm:550"]'))
    done = umov("run", name, "--quiet")
    assert done.code == 0, done.err
    rows = read_csv(tmp_path / "out/lightcurve.csv")
    done = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:00:00Z", "--stop",
                "2018-01-21T05:20:00Z", "--model", "sphere", "--size-m", 0.5, "--material", "paper_al", "-o",
                "p.csv")
    assert done.code == 0, done.err
    found, = read_csv(tmp_path / "p.csv")
    # Penumbra apart, the faint end is at the rise; samples are 5 s apart, the table of phases 0.5 deg.
    assert abs(float(found["mag_min"]) - min(float(row["mag"]) for row in rows)) < 0.01
    assert abs(float(found["p_max"]) - max(float(row["p"]) for row in rows)) < 0.01
    assert found["glints"] == ""


def test_glints_of_a_spinning_plate_stand_in_the_run(umov, scenario, tmp_path):
    """At the times that umov passes finds, a run's rows have a glint, and nothing else is as bright."""
    assert umov("mesh", "make", "plate", "-o", "cube.obj").code == 0
    spin = 'mode = "spin", axis = [1, 1, 1], period_s = 37, epoch = 2018-01-21T05:00:00Z'
    sky = ("alt_min_deg = 10, sun_alt_max_deg = -6", "alt_min_deg = 10")
    base = [('mode = "nadir"', spin), sky, ('set = "paper_rgb"', 'set = ["nm:550"]')]
    name = scenario(*base, ("05:08:00Z", "05:08:00Z"), ("05:12:00Z", "05:13:00Z"),
                    ("step_s = 20", "step_s = 0.25"))
    done = umov("run", name, "--quiet")
    assert done.code == 0, done.err
    rows = read_csv(tmp_path / "out/lightcurve.csv")
    done = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:00:00Z", "--stop",
                "2018-01-21T05:20:00Z", "--scene", name, "--chart", "sky.html", "-o", "p.csv")
    assert done.code == 0, done.err
    found, = read_csv(tmp_path / "p.csv")
    times = [Time(text) for text in found["glints"].split(";") if text]
    widths = [float(text) for text in found["glint_widths"].split(";") if text]
    flagged = [Time(row["time_utc"]) for row in rows if row["glint"] == "True"]
    assert times and len(times) == len(widths) and flagged
    for time in flagged:  # a row in glint lies within the width of one that was found
        assert any(abs((time - t).sec) <= w for t, w in zip(times, widths)), time
    page = (tmp_path / "sky.html").read_text()
    data = json.loads(re.search(r'id="data">(.*?)</script>', page).group(1))
    assert "Passes over Maui" in page
    track, = data["tracks"]
    # Hundredths of a degree: the track rises at the altitude limit and reaches the table's culmination.
    assert track["alt100"][0] == pytest.approx(1000, abs=2) and track["id"] == found["pass_id"]
    assert max(track["alt100"]) / 100 == pytest.approx(float(found["culmination_alt"]), abs=0.3)
    assert track["mag"] == pytest.approx(float(found["mag_min"]), abs=1e-3)
    # A spinning plate is brightest in one of its glints.
    assert track["brightest"] == found["brightest_utc"]
    assert any(abs((Time(found["brightest_utc"]) - t).sec) <= w for t, w in zip(times, widths))
    assert "://" not in re.sub(r"http://www.w3.org/2000/svg", "", page), "nothing is loaded from anywhere"


ISS = ("passes", "--orbit", ROOT / "data/tle/iss.tle", "-s", "maui", "--start", "2018-01-20T12:00:00Z", "--stop", "2018-01-27T00:00:00Z")
BALL = ("--model", "sphere", "--material", "paint_white", "--size-m", 5)


def test_the_brightest_and_the_highest_first(umov, tmp_path):
    """--mag-max, --sort and visible_alt, which no other option of the search changes."""
    told = {}
    for name, options in {"all": (), "mag": ("--sort", "mag", "--chart", "mag.html"), "alt": ("--sort", "alt"), "bright": ("--mag-max", 1, "--sort", "mag")}.items():
        done = umov(*ISS, *BALL, *options, "-o", f"{name}.csv")
        assert done.code == 0, done.err
        told[name] = read_csv(tmp_path / f"{name}.csv")
    by_id = {row["pass_id"]: row for row in told["all"]}
    bright = [row for row in told["all"] if row["mag_min"] and float(row["mag_min"]) <= 1]
    assert 0 < len(bright) < len(by_id)
    assert sorted(row["pass_id"] for row in bright) == sorted(row["pass_id"] for row in told["bright"])
    mags = [float(row["mag_min"] or "inf") for row in told["mag"]]
    alts = [float(row["visible_alt"] or "-inf") for row in told["alt"]]
    assert mags == sorted(mags) and alts == sorted(alts, reverse=True) and len(mags) == len(alts) == len(by_id)
    assert all(by_id[row["pass_id"]] == row for row in told["mag"])
    assert '"order":"mag"' in (tmp_path / "mag.html").read_text()  # the chart's table begins so too
    assert "sphere of radius 5 m" in (tmp_path / "all.csv").read_text()
    done = umov(*ISS, *BALL, "--mag-max", -30)
    assert done.code == 5 and "as bright as magnitude -30" in done.err
    for options in (("--mag-max", 3), ("--sort", "mag")):
        done = umov(*ISS, *options)
        assert done.code == 2 and options[0] in done.err and "--model sphere" in done.err, done.err


def test_the_greatest_altitude_while_visible(umov, tmp_path):
    """Beside the rows of an ephemeris 2 s apart: sunlit, and the Sun 6 deg below the horizon."""
    done = umov(*ISS, "-o", "p.csv", "--chart", "sky.html")
    assert done.code == 0, done.err
    rows = read_csv(tmp_path / "p.csv")
    lower = [row for row in rows if row["visible_alt"] and float(row["visible_alt"]) < float(row["culmination_alt"]) - 2]
    assert lower and all(bool(row["visible_alt"]) == (float(row["visible"]) > 0) for row in rows)
    for row in lower[:2]:
        done = umov("orbit", "ephemeris", "--orbit", ROOT / "data/tle/iss.tle", "--lat-deg", 20.7083, "--lon-deg", -156.2578, "--alt-m", 3058,
                    "--start", row["rise_utc"], "--stop", row["set_utc"], "--step-s", 2, "-o", "e.csv")
        assert done.code == 0, done.err
        seen = [float(one["alt"]) for one in read_csv(tmp_path / "e.csv") if float(one["sunlit"]) > 0 and float(one["sun_alt"]) < -6]
        assert float(row["visible_alt"]) == pytest.approx(max(seen), abs=0.6)  # 4 s apart at a quarter of a degree a second, half lit
    track = next(one for one in json.loads(re.search(r'id="data">(.*?)</script>', (tmp_path / "sky.html").read_text()).group(1))["tracks"]
                 if one["id"] == lower[0]["pass_id"])
    assert track["alt_visible"] == pytest.approx(float(lower[0]["visible_alt"]), abs=0.01)


def test_a_geostationary_satellite_that_never_rises_is_explained(umov, scenario):
    """GOES 15 stood over 135 W in January 2018, 122 deg of arc from Calar Alto; above 10 deg it is seen from 71 deg."""
    day = ("--start", "2018-01-21T00:00:00Z", "--stop", "2018-01-22T00:00:00Z")
    done = umov("passes", "--orbit", ROOT / "data/tle/goes15.tle", "-s", "calar alto", *day)
    assert done.code == 5 and re.search(r"over longitude 13[45]\.\d W: above 10 deg it is seen within 71 deg", done.err), done.err
    assert "122 deg away" in done.err
    # HST over the pole of the same search is another matter: it goes round.
    assert "longitude" not in umov("passes", "--orbit", HST, "-s", "80,0,0", *day).err


def test_the_next_pass_is_as_high_as_it_is_seen(umov, tmp_path):
    """The ISS rises over Calar Alto at 19:42:33 and goes dark ten seconds later, at 11 deg; at 58 deg it is in the shadow."""
    assert umov("mesh", "make", "chamfered-cube", "-o", "cube.obj").code == 0
    (tmp_path / "s.toml").write_text(f'''umov = 1
[observer]
name = "Calar Alto"
[time]
start = 2018-01-22T05:00:00Z
stop = 2018-01-22T07:00:00Z
only = {{ alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true }}
[[object]]
orbit = {{ file = "{ROOT}/data/tle/iss.tle" }}
mesh = {{ file = "cube.obj", unit = "m", up = "+Z" }}
attitude = {{ mode = "nadir" }}
[object.materials]
default = "paint_white"
[bands]
set = "nm:550"
''')
    done = umov("run", "s.toml")
    assert done.code == 5 and re.search(r"The next one: 2018-01-22T19:42Z, max alt 1[01]\.", done.err), done.err


@pytest.mark.parametrize("change, words", [
    (("--model", "sphere"), ["--material"]),
    (("--model", "ball", "--material", "paper_al"), ["sphere"]),
    (("--band", "nm:550"), ["--scene or --model"]),
    (("--model", "sphere", "--material", "nothing"), ["nothing"]),
    (("-s", "Mauii"), ['Did you mean "maui"?']),
])
def test_models_refuse(umov, tmp_path, change, words):
    site = () if "-s" in change else ("-s", "maui")
    done = umov("passes", "--orbit", HST, *DAY, *site, "-o", "p.csv", *change)
    assert done.code in (2, 3) and all(word in done.err for word in words), done.err
    assert not (tmp_path / "p.csv").exists()


def test_a_site_by_name_in_a_scenario(umov, scenario, tmp_path):
    name = scenario(("lat_deg = 20.7083\nlon_deg = -156.2578\nalt_m = 3058", 'name = "Maui"'))
    done = umov("run", name, "--quiet")
    assert done.code == 0, done.err
    lock = (tmp_path / "out/scenario.lock.toml").read_text()
    assert "lat_deg = 20.7083" in lock and "alt_m = 3058" in lock


def test_keys_of_the_scene_can_be_set(umov, scenario, tmp_path):
    ask = ("passes", "--orbit", HST, "-s", SITE, *DAY, "--scene", scenario())
    rows = {}
    for method in ("rays", "masks"):
        done = umov(*ask, "--set", f"render.method={method}", "-o", f"{method}.csv")
        assert done.code == 0, done.err
        rows[method] = read_csv(tmp_path / f"{method}.csv")
    lit = [(float(a["mag_min"]), float(b["mag_min"])) for a, b in zip(rows["rays"], rows["masks"])
           if a["mag_min"]]
    assert lit and all(abs(a - b) < 0.01 for a, b in lit)
    assert umov(*ask, "--set", "render.methd=rays").code == 3
    assert umov("passes", "--orbit", HST, "-s", SITE, *DAY, "--set", "render.method=rays").code == 2


def test_the_ephemeris_takes_sites_as_passes_do(umov):
    ask = ("orbit", "ephemeris", "--orbit", HST, "--start", "2018-01-21T05:00:00Z", "--stop",
           "2018-01-21T05:01:00Z", "--json")
    by_name = umov(*ask, "-s", SITE)
    assert by_name.code == 0, by_name.err
    by_numbers = umov(*ask, "--lat-deg", 20.7083, "--lon-deg", -156.2578, "--alt-m", 3058)
    assert by_name.out == by_numbers.out
    for where in ((), ("--lat-deg", 20.7083), ("-s", SITE, "--alt-m", 0)):
        assert umov(*ask, *where).code == 2


def test_the_faint_end_of_a_pass_is_a_limit_where_its_light_is_not_known(umov):
    """HST dims to slivers of 16.4 in this pass (by rays), which the defaults do not resolve: 13.1 stood there, the faintest of
    what was resolved, as if it were the faintest of all. A magnitude fainter than the limit must be marked as possible."""
    def last(method):
        done = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:00:00Z", "--stop", "2018-01-21T06:00:00Z",
                    "--scene", ROOT / "examples/hst_maui.toml", "--set", f"render.method={method}", "--json")
        assert done.code == 0, done.err
        return json.loads(done.out)[0]
    limit, exact = last("masks"), last("rays")
    assert limit["mag_max_limit"] is True and exact["mag_max_limit"] is False
    assert exact["mag_max"] > limit["mag_max"] - 0.02  # 2 % of I: the accuracy of passes
