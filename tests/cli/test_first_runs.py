"""A newcomer's first runs: what they say before, while and after they run."""
import json
import math
import os
import pty
import re
import subprocess

import pytest
from astropy.table import Table

from conftest import ROOT, UMOV, read_csv

HST = ROOT / "data/tle/hst.tle"


def test_a_spin_starts_with_the_scenario(umov, scenario, tmp_path):
    name = scenario(('attitude = { mode = "nadir" }',
                     'attitude = { mode = "spin", axis = "+X", period_s = 20, start = { mode = "nadir" } }'))
    done = umov("run", name)
    assert done.code == 0, done.err
    assert "epoch = 2018-01-21T05:08:00" in (tmp_path / "out/scenario.lock.toml").read_text()


def test_a_run_says_which_one_it_replaces(umov, scenario):
    name = scenario()
    assert "in place of" not in umov("run", name).out
    assert re.search(r"in place of the run of 20\d\d-\d\d-\d\dT", umov("run", name).out)


def test_a_run_tells_programs_what_it_found(umov, scenario, tmp_path):
    done = umov("run", scenario(), "--json", "-o", "told")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    rows = Table.read(tmp_path / "told/lightcurve.ecsv")
    one, bands = told["objects"][0], len(set(rows["band"]))
    assert told["complete"] and told["folder"].endswith("told")
    assert one["epochs"] * bands == len(rows) and one["dark"] >= 0
    first = one["passes"][0]
    # One band, the middle one: a range over several would mix the colour into it.
    known = [row["mag"] for row in rows if row["pass_id"] == first["pass_id"] and row["band"] == one["band_of_passes"] and str(row["mag_limit"]) == "False"]
    assert one["band_of_passes"] == one["bands"][len(one["bands"]) // 2]
    assert first["mag_min"] == pytest.approx(min(known), abs=1e-9)
    assert re.search(r"550 nm: mag \d", umov("run", scenario(), "-o", "other").out)


def test_a_dry_run_as_json_says_what_the_run_will_do(umov, scenario, tmp_path):
    done = umov("run", scenario(), "--dry-run", "--json")
    assert done.code == 0, done.err
    plan = json.loads(done.out)
    assert not (tmp_path / "out").exists()
    made = json.loads(umov("run", scenario(), "--json").out)
    planned, found = plan["objects"], made["objects"]
    assert [one["epochs"] for one in planned] == [one["epochs"] for one in found]
    assert [[p["pass_id"] for p in one["passes"]] for one in planned] == [[p["pass_id"] for p in one["passes"]] for one in found]
    assert plan["bands"] == found[0]["bands"] and plan["folder"] == made["folder"] and plan["method"] == "auto"
    # 05:08 to 05:12 in steps of 20 s, both ends included; a row for each epoch and band
    assert plan["cost"] == {"epochs_searched": 13, "epochs_lit": found[0]["epochs"], "rows": 3 * found[0]["epochs"]}
    part = json.loads(umov("run", scenario(), "--dry-run", "--json", "--shard", "0/1").out)
    assert part["objects"] == planned


def test_a_dry_run_looks_at_the_folder_last(umov, scenario, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.txt").write_text("x")
    done = umov("run", scenario(), "--dry-run", "-o", "mine", "--set", "object.materials.default=paper_all")
    assert done.code == 3 and "paper_all" in done.err, done.err
    done = umov("run", scenario(), "--dry-run", "-o", "mine")
    assert done.code == 6 and "fine;" in done.err, done.err


def test_a_long_search_is_told_before_it_starts(umov, scenario):
    span = ("--set", "time.start=2018-01-21", "--set", "time.stop=2018-01-25", "--set", "time.only.alt_min_deg=88")
    done = umov("run", scenario(), *span, "--set", "time.step_s=1")
    assert "looking for passes among 345601 epochs" in done.err, done.err


def hazy(scenario, haze, *more):
    """HST's orbit with a sphere that reflects nothing but by its haze."""
    return scenario(("cube.obj", "sphere.obj"), ('default = "paper_al"', 'default = "mine"'),
                    ('[bands]\nset = "paper_rgb"', '[material.mine]\nindex = { n = 1.0001, k = 0 }\n'
                     'distribution = { model = "beckmann", alpha = 0.3 }\n'
                     f'haze = {haze}\n[bands]\nset = "nm:550"'), *more)


def test_the_spread_over_the_range_of_haze(umov, scenario, tmp_path):
    """White haze alone is a Lambert surface: light goes with its albedo, magnitudes by 2.5 log10 of it (Pogson)."""
    assert umov("mesh", "make", "sphere", "-o", "sphere.obj").code == 0
    vary = ("[output]", '[materials]\nvary = ["haze"]\n[output]')
    done = umov("run", hazy(scenario, "{ albedo = 0.1, range = [0.05, 0.25] }", vary))
    assert done.code == 0 and "over the ranges of haze: magnitudes change by 1.75" in done.out, done.out + done.err
    rows = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    # The interface reflects 2.5e-9; three runs, each to the half-width of its light.
    for row in rows:
        share = row["intensity_err"] / row["intensity"]
        assert row["intensity_low"] / row["intensity"] == pytest.approx(0.5, rel=2 * share + 1e-4)
        assert row["intensity_high"] / row["intensity"] == pytest.approx(2.5, rel=2 * share + 1e-4)
        assert row["mag"] - row["mag_low"] == pytest.approx(2.5 * math.log10(2.5), abs=3 * share + 2e-4)
        assert row["mag_high"] - row["mag"] == pytest.approx(2.5 * math.log10(2), abs=3 * share + 2e-4)
    plain = hazy(scenario, "{ albedo = 0.1, range = [0.05, 0.25] }")
    assert umov("run", plain, "--set", "output.dir=plain").code == 0
    other = Table.read(tmp_path / "plain/lightcurve.ecsv", format="ascii.ecsv")
    assert "mag_low" not in other.colnames and list(other["intensity"]) == list(rows["intensity"])
    assert umov("run", "out/scenario.lock.toml", "--set", "output.dir=again").code == 0
    assert (tmp_path / "again/lightcurve.ecsv").read_bytes() == (tmp_path / "out/lightcurve.ecsv").read_bytes()


def test_a_spread_that_cannot_be_is_told(umov, scenario):
    assert umov("mesh", "make", "sphere", "-o", "sphere.obj").code == 0
    vary = ("[output]", '[materials]\nvary = ["haze"]\n[output]')
    done = umov("run", hazy(scenario, "{ albedo = 0.1 }", vary))
    assert done.code == 0 and "no material of HST states a range of its haze" in done.err, done.err
    done = umov("run", scenario(("[output]", '[materials]\nvary = ["roughness"]\n[output]')), "--dry-run")
    assert done.code == 3 and '"haze" was expected' in done.err and ":" in done.err, done.err


def test_a_csv_has_as_many_digits_as_its_errors_leave(umov, scenario, tmp_path):
    done = umov("run", scenario())
    assert done.code == 0, done.err
    assert umov("run", "scenario.toml", "--set", "output.dir=all", "--set", "output.csv_digits=all").code == 0
    short, full = (read_csv(tmp_path / f"{name}/lightcurve.csv") for name in ("out", "all"))
    exact = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    assert (tmp_path / "out/lightcurve.ecsv").read_bytes() == (tmp_path / "all/lightcurve.ecsv").read_bytes()
    for few, many, row in zip(short, full, exact, strict=True):
        for name in ("intensity", "mag", "q", "u", "p", "pa"):
            assert float(many[name]) == row[name]
            error = row[f"{name}_err"]
            # Half of the last digit, which is the second one of the error, or the tenth of the value.
            assert abs(float(few[name]) - row[name]) <= max(0.0501 * error, 5.01e-10 * abs(row[name]))
            assert float(few[f"{name}_err"]) == pytest.approx(error, rel=0.05 + 1e-9)
        for name, bound in (("alt", 5e-8), ("range", 5e-7), ("mjd_utc", 5e-9), ("qw", 5e-10)):
            assert abs(float(few[name]) - row[name]) <= 1.001 * bound
        assert few["time_utc"] == many["time_utc"]
    assert (tmp_path / "out/lightcurve.csv").stat().st_size < 0.75 * (tmp_path / "all/lightcurve.csv").stat().st_size


def test_a_folder_with_its_inputs_runs_elsewhere(umov, scenario, tmp_path):
    (tmp_path / "nk.csv").write_text("wavelength_nm,n,k\n400,1.5,0.1\n700,1.5,0.1\n")
    (tmp_path / "foil.toml").write_text('[material.foil]\nindex = "nk.csv"\ndistribution = { model = "beckmann", alpha = 0.1 }\n')
    changed = scenario(('default = "paper_al"', 'default = "foil.toml"'),
                       ("[output]", "[output]\nkeep_inputs = true"))
    done = umov("run", changed)
    assert done.code == 0, done.err
    kept = {path.name for path in (tmp_path / "out/inputs").rglob("*") if path.is_file()}
    assert {"hst.tle", "cube.obj", "nk.csv", "foil.toml"} <= kept
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (tmp_path / "out").rename(elsewhere / "sent")
    for name in ("nk.csv", "foil.toml", "cube.obj", changed):
        (tmp_path / name).unlink()
    done = umov("run", "elsewhere/sent/scenario.lock.toml", "-o", "again")
    assert done.code == 0, done.err
    assert (tmp_path / "again/lightcurve.ecsv").read_bytes() == (elsewhere / "sent/lightcurve.ecsv").read_bytes()
    # The folder is umov's as a whole, until somebody puts a file of his own among the inputs.
    assert umov("run", "again/scenario.lock.toml", "-o", "again").code == 0
    (tmp_path / "again/inputs/mine.txt").write_text("x")
    done = umov("run", "elsewhere/sent/scenario.lock.toml", "-o", "again")
    assert done.code == 6 and "inputs" in done.err, done.err


def test_a_step_that_is_too_long_for_a_turn_is_told(umov, scenario):
    spin = ('attitude = { mode = "nadir" }',
            'attitude = { mode = "spin", axis = "+Y", period_s = 50, epoch = 2018-01-21T05:00:00Z }')
    done = umov("run", scenario(spin), "--dry-run")  # a step of 20 s
    assert done.code == 0 and "turns in 50 s (spin)" in done.err and "step_s = 20" in done.err, done.err
    done = umov("run", scenario(spin), "--dry-run", "--set", "time.step_s=5")
    assert done.code == 0 and "turns in" not in done.err, done.err


def test_a_mesh_behind_a_link_and_dots_is_found(umov, scenario, tmp_path):
    """`link/../x` is beside what the link points to."""
    path, mesh = tmp_path / scenario(), tmp_path / "cube.obj"
    there = tmp_path / "elsewhere" / "deep"
    there.mkdir(parents=True)
    for one in (mesh, mesh.with_suffix(".mtl")):
        one.rename(there.parent / one.name)
    (tmp_path / "link").symlink_to(there)
    path.write_text(path.read_text().replace(f'"{mesh.name}"', f'"link/../{mesh.name}"'))
    done = umov("run", path.name, "-o", "out")
    assert done.code == 0, done.err
    assert umov("run", "out/scenario.lock.toml", "--dry-run").code == 0  # and by its lock again


def on_a_terminal(*arguments, cwd):
    """What umov draws on a terminal."""
    here, there = pty.openpty()
    run = subprocess.Popen([UMOV, *map(str, arguments)], cwd=cwd, stdout=subprocess.DEVNULL, stderr=there)
    os.close(there)
    drawn = b""
    while True:
        try:
            part = os.read(here, 4096)
        except OSError:
            break
        if not part:
            break
        drawn += part
    run.wait()
    os.close(here)
    return run.returncode, drawn.decode()


HEAVY = """umov = 1
[[object]]
name = "box-wing"
orbit = {{ file = "{tle}", norad = 20580 }}
mesh = {{ file = "heavy.obj", unit = "m", up = "+Z" }}
attitude = {{ point = "+Z", at = "observer" }}
[object.materials]
bus = "film_aluminized"
panels = "film_aluminized"
dish = "film_aluminized"
tank = "film_aluminized"
[observer]
name = "maui"
lat_deg = 20.7084
lon_deg = -156.2571
alt_m = 3058
[time]
start = 2018-01-21T05:00:00Z
stop = 2018-01-21T05:30:00Z
step_s = 60
"""


@pytest.mark.slow
def test_a_first_run_moves_and_says_why_on_a_terminal_only(umov, tmp_path):
    """A line every quarter of a second: the masks of so many facets take several seconds on any machine."""
    made = umov("mesh", "make", "box-wing", "--facets", 200000, "--crumple", 0.02, "-o", "heavy.obj")
    assert made.code == 0, made.err
    (tmp_path / "heavy.toml").write_text(HEAVY.format(tle=ROOT / "data/tle/hst.tle"))
    run = ("run", "heavy.toml", "--no-cache")
    code, drawn = on_a_terminal(*run, "-o", "a", cwd=tmp_path)
    assert code == 0 and "light curve [" in drawn, drawn
    assert "the first run of a shape traces what hides what" in drawn, drawn
    done = umov(*run, "-o", "b")
    assert done.code == 0 and "light curve" not in done.err and "\r" not in done.err, done.err


def test_an_attitude_without_epoch_says_from_when_it_turns(umov, scenario, tmp_path):
    """The lock keeps it: a trimmed span has the same attitude, and umov passes sees what umov run computes."""
    spin = 'attitude = { mode = "spin", axis = [1, 2, 0.5], period_s = 97 }'
    done = umov("run", scenario(('attitude = { mode = "nadir" }', spin)))
    assert done.code == 0 and "no epoch" in done.err and "epoch = 2018-01-21T05:08:00.000Z" in done.err, done.err
    whole = {row["time_utc"]: row["mag"] for row in read_csv(tmp_path / "out/lightcurve.csv") if row["band"] == "nm:550"}
    trimmed = umov("run", "out/scenario.lock.toml", "--set", "time.start=2018-01-21T05:10:00Z", "--set", "output.dir=late")
    assert trimmed.code == 0 and "no epoch" not in trimmed.err, trimmed.err
    late = {row["time_utc"]: row["mag"] for row in read_csv(tmp_path / "late/lightcurve.csv") if row["band"] == "nm:550"}
    assert late and all(late[time] == whole[time] for time in late)
    done = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:00:00Z", "--stop", "2018-01-21T05:20:00Z",
                "--scene", "scenario.toml", "--band", "nm:550", "-o", "p.csv")
    assert done.code == 0 and "no epoch" in done.err, done.err
    other = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:04:00Z", "--stop", "2018-01-21T05:20:00Z",
                 "--scene", "out/scenario.lock.toml", "--band", "nm:550", "-o", "other.csv")
    assert other.code == 0 and "no epoch" not in other.err, other.err
    one, same = (float(read_csv(tmp_path / name)[0]["mag_min"]) for name in ("p.csv", "other.csv"))
    assert one == pytest.approx(same, abs=1e-4)  # searches of two spans end at times that differ a little
