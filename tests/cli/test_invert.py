"""umov invert: from light curves back. Truth is made by rays in another attitude, on another tessellation where the body
is round, and by a second program text (noise and columns here); the fit looks light up in masks."""
import json
import math
import random
import re
import statistics

import pytest
from astropy.table import Table

from conftest import ROOT, read_csv

SCENE = """umov = 1
title = "test"
seed = 3
[observer]
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T05:08:00Z
stop = 2018-01-21T05:16:00Z
step_s = {step}
only = {{ alt_min_deg = 10, sunlit = true }}
[[object]]
name = "cubesat"
orbit = {{ file = "{root}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "{mesh}.obj", unit = "m", up = "+Z" }}
attitude = {{ mode = "inertial", quaternion = {q} }}
[object.materials]
{materials}
[bands]
set = "paper_rgb"
[render]
method = "{method}"
[output]
dir = "{out}"
formats = ["csv", "ecsv"]
pol_frame = "altaz"
"""
CUBESAT = """body_px = "aluminium_anodized"
body_mx = "cell_gaas"
body_py = "mli_kapton"
body_my = "paint_white"
body_pz = "mli_kapton"
body_mz = "aluminium_anodized"
panel_px_front = "cell_gaas"
panel_px_back = "paint_black"
panel_px_edge = "aluminium_anodized"
"""
KNOWN = ["--visibility", "masks", "--slope-sd", "0", "--reflectance-sd", "0", "--haze-sd", "0"]  # materials, shadows by look-up alone: a third of the time and less
TRUTHS = [[0.5, 0.5, -0.5, 0.5], [0.8, 0.0, 0.6, 0.0], [0.1, 0.7, 0.7, 0.1]]


@pytest.fixture
def scene(umov, tmp_path):
    """scene(q, method, ...) writes a scenario of a cubesat with one panel; returns its name."""
    assert umov("mesh", "make", "cubesat", "--panels", "1", "-o", "cubesat.obj", "-q").code == 0

    def write(q, method, out, step=12, mesh="cubesat", materials=CUBESAT):
        norm = math.sqrt(sum(x * x for x in q))
        (tmp_path / f"{out}.toml").write_text(
            SCENE.format(root=ROOT, q=[x / norm for x in q], method=method, out=out, step=step, mesh=mesh,
                         materials=materials))
        return f"{out}.toml"

    return write


def observe(folder, name, snr, seed):
    """What an observer at a signal-to-noise ratio has of a run: noise is ours, not umov's."""
    rng = random.Random(seed)
    rows = read_csv(folder / "truth/lightcurve.csv")
    out = ["# pol_frame: altaz", "time_utc,band,flux,flux_err,q,u,q_err,u_err"]
    median = statistics.median(float(r["I"]) for r in rows)
    for r in rows:
        true = float(r["I"])
        sd = math.sqrt((0.8 * true * median + 0.2 * median**2) / snr**2)
        seen = true + sd * rng.gauss(0, 1)
        line = f"{r['time_utc']},{r['band']},{seen * 1e12:.6f},{sd * 1e12:.6f},"
        if seen > 3 * sd and r["q"]:
            e = math.sqrt(2) * sd / seen
            line += f"{float(r['q']) + e * rng.gauss(0, 1):.5f},{float(r['u']) + e * rng.gauss(0, 1):.5f},{e:.5f},{e:.5f}"
        else:
            line += ",,,"
        out.append(line)
    (folder / name).write_text("\n".join(out) + "\n")


def apart(a, b):
    return math.degrees(2 * math.acos(min(1, abs(sum(x * y for x, y in zip(a, b)))
                                          / math.sqrt(sum(x * x for x in a) * sum(y * y for y in b)))))


def in_set(folder, truth):
    table = Table.read(folder / "set95.ecsv")
    return any(apart(truth, [r["qw"], r["qx"], r["qy"], r["qz"]]) <= r["radius_deg"] for r in table)


@pytest.mark.long
def test_blind_attitudes_are_found_or_lie_in_the_set(umov, scene, tmp_path):
    near = inside = 0
    for k, truth in enumerate(TRUTHS):
        assert umov("run", scene(truth, "rays", "truth"), "-q").code == 0
        observe(tmp_path, "obs.csv", 30, k)
        done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "-o", "answer",
                    "--force", "--json", "--grid", "30000")
        assert done.code == 0, done.err
        verdict = json.loads(done.out)
        near += any(apart(truth, m["q"]) < max(3, 3 * m["sd_deg"]) for m in verdict["modes"])
        inside += in_set(tmp_path / "answer", truth)
        assert sum(m["weight"] for m in verdict["modes"]) <= 1 + 1e-9
    assert near == 3
    assert inside >= 2  # of 3 at 95 %: one outside is one in seven such tests


@pytest.mark.slow
def test_a_fit_that_chance_does_not_explain_is_not_determined(umov, scene, tmp_path):
    """Errors told as two thirds of what they are more than double chi-square, to less than the 2 of a degree of freedom of no_fit."""
    truth = TRUTHS[0]
    assert umov("run", scene(truth, "rays", "truth"), "-q").code == 0
    observe(tmp_path, "obs.csv", 60, 1)
    lines = (tmp_path / "obs.csv").read_text().splitlines()
    for k, line in enumerate(lines[2:], 2):
        cells = line.split(",")
        for c in (3, 6, 7):
            cells[c] = f"{0.66 * float(cells[c]):.6f}" if cells[c] else ""
        lines[k] = ",".join(cells)
    (tmp_path / "small.csv").write_text("\n".join(lines) + "\n")
    fit = scene([1, 0, 0, 0], "masks", "fit")
    found = {}
    for name in ("obs.csv", "small.csv"):
        done = umov("invert", "pose", name, "--scenario", fit, "-o", "answer", "--force", "--json", "--grid", "30000",
                    "--floor", 0.002, "--largest-floor", 0)
        assert done.code == 0, done.err
        found[name] = json.loads(done.out)
    assert found["obs.csv"]["verdict"] == "determined" and found["obs.csv"]["p_value"] > 0.001
    assert found["small.csv"]["verdict"] == "undetermined" and found["small.csv"]["p_value"] < 0.001
    assert any("may have been passed by" in note for note in found["small.csv"]["notes"])


def test_a_dense_curve_is_searched_by_fewer_epochs_and_fitted_by_all(umov, scene, tmp_path):
    """Two rows a second: next to the same directions of Sun and observer are one epoch of the search."""
    assert umov("run", scene(TRUTHS[2], "masks", "truth", step=0.5), "-q").code == 0
    observe(tmp_path, "obs.csv", 20, 5)
    done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "-o", "answer", "--json", "--grid", "5000", *KNOWN)
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    times = {r["time_utc"] for r in read_csv(tmp_path / "truth/lightcurve.csv") if float(r["sunlit"]) >= 0.5}
    assert verdict["epochs"] == len(times)
    assert 20 < verdict["epochs_searched"] < verdict["epochs"] / 2
    assert any("are joined" in note for note in verdict["notes"])
    assert len(Table.read(tmp_path / "answer/fit.ecsv")) == 3 * verdict["epochs"]
    best = min(verdict["modes"], key=lambda m: apart(TRUTHS[2], m["q"]))
    assert apart(TRUTHS[2], best["q"]) < max(0.5, 3 * best["sd_deg"])
    assert sum(c["numbers"] for c in verdict["contributions"]) == verdict["dof"] + 4


@pytest.mark.slow
def test_a_burst_is_searched_by_a_hundred_epochs(umov, scene, tmp_path):
    """Within a second directions move by less than the width of a glint, and what changes on its flank counts: a row more than a hundred must not say less."""
    burst = ["--set", "time.start=2018-01-21T05:11:46Z", "--set", "time.stop=2018-01-21T05:11:47.1Z"]
    assert umov("run", scene(TRUTHS[0], "masks", "truth", step=0.01), *burst, "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 6)
    done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--json", "--grid", "1000", *KNOWN)
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    assert verdict["epochs"] == len({r["time_utc"] for r in read_csv(tmp_path / "truth/lightcurve.csv")})
    assert 100 <= verdict["epochs_searched"] <= verdict["epochs"]


def test_folder_has_the_tables_and_says_what_it_is(umov, scene, tmp_path):
    assert umov("run", scene(TRUTHS[0], "rays", "truth", step=40), "-q").code == 0
    done = umov("invert", "pose", "truth/lightcurve.ecsv", "--scenario", "truth.toml", "-o", "answer", "--grid", "20000")
    assert done.code == 0, done.err
    assert "no error of I" in done.err  # a run's light has none
    modes = Table.read(tmp_path / "answer/modes.ecsv")
    assert {"qw", "qx", "qy", "qz", "weight", "cov_xx", "cov_xy", "cov_zz"} <= set(modes.colnames)
    assert str(modes["cov_xx"].unit) == "rad2"
    assert min(apart(TRUTHS[0], [m["qw"], m["qx"], m["qy"], m["qz"]]) for m in modes) < 3
    for name in ("set95.ecsv", "samples.ecsv", "twins.ecsv", "fit.ecsv", "verdict.json", "manifest.json",
                 "scenario.lock.toml", "report.html"):
        assert (tmp_path / "answer" / name).exists(), name
    assert abs(sum(Table.read(tmp_path / "answer/samples.ecsv")["weight"]) - 1) < 1e-6
    is_sure = json.loads((tmp_path / "answer/verdict.json").read_text())["verdict"] == "determined"
    assert ("this holds for materials that are right to --slope-sd" in done.out) == is_sure
    again = umov("invert", "pose", "truth/lightcurve.ecsv", "--scenario", "truth.toml", "-o", "answer", "--grid", "20000",
                 "--threads", "1")
    assert again.code == 0, again.err  # our own folder is replaced
    assert (Table.read(tmp_path / "answer/modes.ecsv")["qw"] == modes["qw"]).all()


@pytest.mark.slow
def test_one_epoch_is_undetermined_and_says_why(umov, scene, tmp_path):
    assert umov("run", scene(TRUTHS[1], "rays", "truth"), "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 1)
    lines = (tmp_path / "obs.csv").read_text().splitlines()
    (tmp_path / "one.csv").write_text("\n".join(lines[:5]) + "\n")  # three bands of one epoch
    done = umov("invert", "pose", "one.csv", "--scenario", "truth.toml", "-o", "answer", "--json")
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    assert verdict["verdict"] == "undetermined"
    assert any("one epoch" in note for note in verdict["notes"])
    assert in_set(tmp_path / "answer", TRUTHS[1])


@pytest.mark.slow
def test_a_sphere_tells_nothing(umov, scene, tmp_path):
    assert umov("mesh", "make", "sphere", "--radius", "0.2", "--facets", "500", "-o", "ball.obj", "-q").code == 0
    ball = scene([1, 0, 0, 0], "rays", "truth", mesh="ball", materials='default = "paint_white"', step=60)
    assert umov("run", ball, "-q").code == 0
    observe(tmp_path, "obs.csv", 30, 2)
    done = umov("invert", "pose", "obs.csv", "--scenario", "truth.toml", "--json", "--grid", "2000")
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    assert verdict["verdict"] == "undetermined"
    assert verdict["share_of_so3"] > 0.5


@pytest.mark.slow
def test_materials_that_are_nearly_known_give_the_answer_of_known_ones(umov, scene, tmp_path):
    """Light by material is summed in another way than the engine's: with next to no freedom both must say the same."""
    assert umov("run", scene(TRUTHS[0], "rays", "truth", step=40), "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 3)
    told = []
    for sd, *more in (("0", "--by-group"), ("1e-5",), ("1e-5", "--by-group")):
        done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--json", "--grid", "10000",
                    "--slope-sd", sd, "--reflectance-sd", sd, "--haze-sd", sd, "--tilt-sd", sd, *more)
        assert done.code == 0, done.err
        assert ("--by-group has nothing to ask of each group" in done.err) == (sd == "0")
        told.append(json.loads(done.out))
    for one in told[1:]:
        assert one["chi2"] == pytest.approx(told[0]["chi2"], abs=1)
        assert apart(told[0]["modes"][0]["q"], one["modes"][0]["q"]) < 0.3
    groups = {one["name"] for one in told[2]["nuisances"]} - {one["name"] for one in told[1]["nuisances"]}
    assert "tilt of the lobe of cell_gaas of panel_px_front about +X" in groups, groups
    own = re.findall(r"^(\w+) = ", CUBESAT, re.M)
    assert all(re.sub(r" about \+.$", "", name).rsplit(" of ", 1)[1] in own for name in groups), groups
    assert len(told[1]["nuisances"]) > len(told[0]["nuisances"])
    tilts = [one for one in told[1]["nuisances"] if one["name"].startswith("tilt of ")]
    assert len({one["name"] for one in tilts}) == len(tilts) > 0 == len(tilts) % 3  # three axes of each material, and no more
    assert all(one["unit"] == "deg" and abs(one["value"]) < 1e-3 for one in tilts)


@pytest.mark.slow
def test_what_one_of_six_groups_lacks_is_found_of_it_alone(umov, scene, tmp_path):
    """Six sides of one paint, of which one reflects a third less: of the material there is one number for all."""
    white = re.sub(r'^(body_..) = .*', r'\1 = "paint_white"', CUBESAT, flags=re.M)
    dim = (ROOT / "data/materials/paint_white.toml").read_text().replace("paint_white]", "dim]").replace("reflectance = 0.8,", "reflectance = 0.54,")
    name = scene(TRUTHS[0], "rays", "truth", step=20, materials=white.replace('body_pz = "paint_white"', 'body_pz = "dim"'))
    (tmp_path / name).write_text((tmp_path / name).read_text() + dim)
    assert umov("run", name, "-q").code == 0
    observe(tmp_path, "obs.csv", 200, 5)
    done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit", materials=white), "--json", "--grid", "10000",
                "--slope-sd", "0", "--haze-sd", "0", "--reflectance-sd", "0.5", "--by-group")
    assert done.code == 0, done.err
    off = {one["name"][-2:]: one["value"] for one in json.loads(done.out)["nuisances"] if one["name"].startswith("amount of the body of paint_white")}
    # docs/theory/lobes.md, equation 8: the body's light is in proportion to its reflectance. Beside the other two sides that were lit, as
    # the scale of all light is free; zero points of 2 %, a floor of 2 % and noise leave some .04.
    for side in ("mx", "py"):
        assert off["pz"] - off[side] == pytest.approx(math.log(0.54 / 0.8), abs=0.08)
    assert off["px"] == off["my"] == off["mz"] == 0  # nothing was seen of them


@pytest.mark.long
def test_other_materials_widen_the_set_until_it_holds_the_truth(umov, scene, tmp_path):
    """Lobes 30 % wider or narrower and paint 15 % darker than the fitted ones: 1.5 standard deviations."""
    text = (ROOT / "data/materials/aluminium_anodized.toml").read_text().replace("alpha = 0.25", "alpha = 0.325")
    text += (ROOT / "data/materials/mli_kapton.toml").read_text().replace("alpha = 0.2 ", "alpha = 0.15 ")
    text += (ROOT / "data/materials/paint_white.toml").read_text().replace("reflectance = 0.8", "reflectance = 0.69")
    own = re.sub(r"\[material\.(\w+)\]", r"[material.true_\1]", text)
    names = re.sub(r'"(aluminium_anodized|mli_kapton|paint_white)"', r'"true_\1"', CUBESAT)
    inside = 0
    for k, truth in enumerate(TRUTHS):
        name = scene(truth, "rays", "truth", step=20, materials=names)
        (tmp_path / name).write_text((tmp_path / name).read_text() + own)
        assert umov("run", name, "-q").code == 0
        observe(tmp_path, "obs.csv", 100, k)
        done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "-o", "answer", "--force", "--json",
                    "--grid", "20000")
        assert done.code == 0, done.err
        is_inside = in_set(tmp_path / "answer", truth)
        inside += is_inside
        assert is_inside or json.loads(done.out)["verdict"] != "determined"
    assert inside >= 2  # of 3 at 95 %


@pytest.mark.long
def test_another_object_is_no_fit(umov, scene, tmp_path):
    assert umov("run", scene(TRUTHS[2], "rays", "truth"), "-q").code == 0
    observe(tmp_path, "obs.csv", 200, 4)
    mirror = "\n".join(line.split("=")[0] + '= "aluminium"' for line in CUBESAT.splitlines())
    done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit", materials=mirror),
                "--grid", "10000", "--floor", "0.01")
    assert done.code == 4
    assert "no_fit" in done.out


@pytest.mark.parametrize("text, code, message", [
    ("time_utc,band,I\n2018-01-21T05:12:00Z,nm:551,1\n", 3, 'obs.csv:2: band "nm:551" is not among those of'),
    ("time_utc,band,I\n2018-01-21T05:12:00Z,nm:550,x\n", 3, "obs.csv:2:29: I = "),
    ("time_utc,band,I,site\n2018-01-21T05:12:00Z,nm:550,1,nowhere\n", 3, "obs.csv:2: "),
    ("time_utc,band,I\n2018-01-21T05:30:00Z,nm:550,1\n", 3, "no row is of a time at which the object stood in sunlight"),
    ("time_utc,band,I\n", 3, "obs.csv: no row of observations"),
    ("time_utc,band,mag\n2018-01-21T05:12:00Z,nm:550,-500\n", 3, "obs.csv:2:29: mag = -500: a magnitude from -40 to 60"),
    ("time_utc,band,mag,mag_limit\n2018-01-21T05:12:00Z,nm:550,10,perhaps\n", 3, 'obs.csv:2:32: mag_limit = "perhaps"'),
    ("time_utc,band,mag,mag_limit\n2018-01-21T05:12:00Z,nm:550,10,TRUE\n", 3, "no row holds a measurement"),
    ("time_utc,band,I,flags\n2018-01-21T05:12:00Z,nm:550,1,SATURATED\n", 3, "no row holds a measurement"),
    ("# pol_frame: altaz\ntime_utc,band,q,u\n2018-01-21T05:12:00Z,nm:550,10,5\n", 3, "obs.csv:3:29: q = 10, u = 5: parts of I"),
    ("time_utc,band,I\n2018-01-21T05:12:00Z,nm:550,0\n", 3, "no row has light"),
    ("time_utc,band,I\n1975-01-21T05:12:00Z,nm:550,1\n", 3, "d from the span asked for; 30 d is the limit"),
])
def test_bad_observations_have_their_place(umov, scene, tmp_path, text, code, message):
    (tmp_path / "obs.csv").write_text(text)
    done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"))
    assert done.code == code
    assert message in done.err, done.err


@pytest.mark.slow
def test_errors_of_0_have_an_end(umov, scene, tmp_path):
    """q and u without errors at --floor 0: an answer, and materials that polarization alone does not tell apart."""
    rows = "".join(f"2018-01-21T05:{m}:00Z,nm:550,0.1,0.05\n" for m in range(10, 15))
    (tmp_path / "obs.csv").write_text("# pol_frame: altaz\ntime_utc,band,q,u\n" + rows)
    fit = scene([1, 0, 0, 0], "masks", "fit")
    done = umov("invert", "pose", "obs.csv", "--scenario", fit, "--grid", "1000", "--floor", "0")
    assert done.code in (0, 4)
    assert "nan" not in done.out
    done = umov("invert", "material", "obs.csv", "--scenario", fit, "--group", "body_px", "--candidates", "paint_white,cell_gaas")
    assert done.code == 3 and "no row has light" in done.err


def spinning(text, rate_deg_s, step):
    """The same scenario with a body that turns about an axis of its own."""
    at = text.index("attitude = ")
    end = text.index("\n", at)
    law = (f'attitude = {{ mode = "tumble", inertia = [1, 1, 1], rate_deg_s = {rate_deg_s}, epoch = 2018-01-21T05:08:00Z, '
           f'start = {{ mode = "inertial", quaternion = [0.5, 0.5, -0.5, 0.5] }} }}')
    return text[:at] + law + text[end:].replace("step_s = 12", f"step_s = {step}")


@pytest.mark.slow
def test_a_spin_comes_back_with_its_period_and_axis(umov, scene, tmp_path):
    rate = [0.0, 0.0, 9.0]  # 40 s about the body's +Z
    text = (tmp_path / scene([1, 0, 0, 0], "rays", "truth", step=4)).read_text()
    (tmp_path / "truth.toml").write_text(spinning(text, rate, 4))
    assert umov("run", "truth.toml", "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 7)
    done = umov("invert", "spin", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--axis", "z", "--period",
                "40.3", "-o", "answer", "--json")
    assert done.code == 0, done.err
    periods = Table.read(tmp_path / "answer/periods.ecsv")
    # The heaviest period is the true one, not an alias; 1 % is what a body with four alike sides may leave.
    assert abs(periods["period_s"][0] - 40) < 0.4
    assert periods["alias"][0] == 1
    mode = Table.read(tmp_path / "answer/modes.ecsv")[0]
    assert abs(abs(mode["rate_z"]) - 9) < 0.1
    assert abs(mode["rate_x"]) < 0.3 and abs(mode["rate_y"]) < 0.3
    assert str(Table.read(tmp_path / "answer/modes.ecsv")["rate_z"].unit) == "deg / s"


def test_a_curve_without_a_period_says_so(umov, scene, tmp_path):
    (tmp_path / "obs.csv").write_text("time_utc,band,I\n2018-01-21T05:12:00Z,nm:550,1\n")
    done = umov("invert", "spin", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"))
    assert done.code == 3
    assert "tells no period" in done.err


def test_one_time_tells_no_spin(umov, scene, tmp_path):
    (tmp_path / "obs.csv").write_text("time_utc,band,I\n" + "".join(f"2018-01-21T05:12:00Z,nm:{nm},1\n" for nm in (425, 550, 650)))
    done = umov("invert", "spin", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--period", "47")
    assert done.code == 3 and "all is of one time" in done.err


def test_a_measurement_counts_once(umov, scene, tmp_path):
    rows = "".join(f"2018-01-21T05:{m}:00Z,nm:550,1,.1\n" for m in range(10, 15))
    for name, text in (("a.csv", rows), ("same.csv", rows), ("more.csv", rows[-33:] + "2018-01-21T05:15:30Z,nm:550,1,.1\n")):
        (tmp_path / name).write_text("time_utc,band,I,I_err\n" + text)
    ask = ("--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--group", "body_my", "--candidates", "paint_white,paint_black")
    assert "a.csv: is named twice" in umov("invert", "material", "a.csv", "a.csv", *ask).err
    assert "same.csv: holds what a.csv holds" in umov("invert", "material", "a.csv", "same.csv", *ask).err
    done = umov("invert", "material", "a.csv", "more.csv", *ask)
    assert done.code == 3 and "more.csv:2: what was measured at 2018-01-21T05:14:00.000Z stands in a.csv too" in done.err
    # Another telescope at the same time says another number.
    (tmp_path / "more.csv").write_text((tmp_path / "more.csv").read_text().replace(",1,.1", ",1.02,.1"))
    assert umov("invert", "material", "a.csv", "more.csv", *ask).code in (0, 4)


@pytest.mark.parametrize("question", [("pose", "--grid", "1000"), ("material", "--group", "body_my", "--candidates", "paint_white,paint_black"),
                                      ("health", "--drift", "body_my=paint_black")])
def test_nothing_above_the_sky_has_one_answer(umov, scene, tmp_path, question):
    rows = "".join(f"2018-01-21T05:{m}:00Z,nm:550,-1,.1\n" for m in range(10, 15))
    (tmp_path / "obs.csv").write_text("time_utc,band,I,I_err\n" + rows)
    done = umov("invert", question[0], "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), *question[1:])
    assert done.code == 3 and "no row has light above 0: nothing was seen of the object, or the sky that was taken off" in done.err


def test_errors_beyond_all_light_tell_nothing(umov, scene, tmp_path):
    rows = "".join(f"2018-01-21T05:{m}:00Z,nm:550,1e-13,1e-4,.1,.1,10,10\n" for m in range(10, 15))
    (tmp_path / "obs.csv").write_text("# pol_frame: altaz\ntime_utc,band,I,I_err,q,u,q_err,u_err\n" + rows)
    fit = scene(TRUTHS[0], "masks", "fit")
    for words in (("material", "--group", "body_my", "--candidates", "paint_white,paint_black"), ("health", "--drift", "body_my=paint_black")):
        done = umov("invert", words[0], "obs.csv", "--scenario", fit, *words[1:], "--json")
        assert json.loads(done.out)["verdict"] == "undetermined"


def test_the_material_of_a_group_is_told_from_others(umov, scene, tmp_path):
    q = TRUTHS[0]
    assert umov("run", scene(q, "rays", "truth"), "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 8)
    answers = {}
    for group in ("body_my", "body_py", "panel_px_front"):
        done = umov("invert", "material", "obs.csv", "--scenario", scene(q, "rays", "fit"), "--group", group,
                    "--candidates", "paint_white,mli_kapton,cell_gaas", "--json", "-o", group)
        assert done.code in (0, 4), done.err
        fit_is_of_the_data(Table.read(tmp_path / group / "fit.ecsv"), tmp_path / "obs.csv")
        parts = Table.read(tmp_path / group / "parts.ecsv")
        assert sum(parts["fraction"][(parts["bands"] == "all") & (parts["measured"] == "I,q,u")]) == pytest.approx(1)
        answers[group] = json.loads(done.out)
    for group, truth in (("body_my", "paint_white"), ("body_py", "mli_kapton"), ("panel_px_front", "cell_gaas")):
        rows = answers[group]["materials"]
        holder = next(r for r in rows if truth in r["materials"])
        # The truth is never excluded; where the group is seen it is found.
        assert holder["probability"] > 0.01 or len(rows) == 1
        assert holder["fraction"] > 1 - max(5 * holder["fraction_err"], 0.1)
    assert any(a["verdict"] == "determined" for a in answers.values())


def test_unknown_groups_and_materials_are_named(umov, scene, tmp_path):
    (tmp_path / "obs.csv").write_text("time_utc,band,I\n2018-01-21T05:12:00Z,nm:550,1\n")
    fit = scene([1, 0, 0, 0], "masks", "fit")
    done = umov("invert", "material", "obs.csv", "--scenario", fit, "--group", "bodi", "--candidates", "paint_white")
    assert done.code == 3 and '"bodi" is no material of' in done.err
    done = umov("invert", "material", "obs.csv", "--scenario", fit, "--group", "body_py", "--candidates", "paint_wite")
    assert done.code == 2 and 'Did you mean "paint_white"?' in done.err


def constant(path, snr, seed, bands=("nm:425", "nm:550", "nm:650")):
    rng = random.Random(seed)
    rows = [f"2018-01-21T05:{10 + k // 4:02d}:{15 * (k % 4):02d}Z,{b},{1 + rng.gauss(0, 1) / snr:.5f},{1 / snr:.5f}"
            for k in range(16) for b in bands]
    path.write_text("time_utc,band,flux,flux_err\n" + "\n".join(rows) + "\n")


@pytest.mark.parametrize("seed, snr, known", [(0, 3, KNOWN), pytest.param(1, 20, [], marks=pytest.mark.slow)])
def test_constant_light_is_never_a_sure_attitude(umov, scene, tmp_path, seed, snr, known):
    constant(tmp_path / "obs.csv", snr, seed)
    done = umov("invert", "pose", "obs.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--grid", "10000", "--json", *known)
    assert done.code in (0, 4), done.err
    verdict = json.loads(done.out)
    assert verdict["verdict"] in ("undetermined", "no_fit", "ambiguous")


@pytest.mark.parametrize("known", [KNOWN, pytest.param([], marks=pytest.mark.slow)])
def test_a_band_without_numbers_changes_nothing(umov, scene, tmp_path, known):
    assert umov("run", scene(TRUTHS[0], "rays", "truth", step=40), "-q").code == 0
    observe(tmp_path, "obs.csv", 50, 1)
    lines = (tmp_path / "obs.csv").read_text().splitlines()
    kept = [line for line in lines if ",nm:650," not in line]
    empty = [line if ",nm:650," not in line else ",".join(line.split(",")[:2]) + ",nan,nan,,,," for line in lines]
    answers = []
    for rows in (kept, empty):
        (tmp_path / "some.csv").write_text("\n".join(rows) + "\n")
        done = umov("invert", "pose", "some.csv", "--scenario", scene([1, 0, 0, 0], "masks", "fit"), "--grid", "10000", "--json", *known)
        assert done.code == 0, done.err
        answers.append(json.loads(done.out))
    assert answers[0]["modes"] == answers[1]["modes"]
    assert "left out" in done.err or "no measurement" in done.err


def test_times_that_contradict_are_refused_or_left_out(umov, scene, tmp_path):
    fit = scene([1, 0, 0, 0], "masks", "fit")
    (tmp_path / "obs.csv").write_text("time_utc,band,I,I_err\n2018-01-21T05:12:00Z,nm:550,1,.1\n2018-01-21T05:12:00Z,nm:550,9,.1\n")
    done = umov("invert", "pose", "obs.csv", "--scenario", fit)
    assert done.code == 3 and "obs.csv:3" in done.err  # one time, two brightnesses
    rows = "".join(f"2018-01-21T06:{m}:00Z,nm:550,1,.1\n" for m in range(20, 30))  # the other side of the Earth
    (tmp_path / "obs.csv").write_text("time_utc,band,I,I_err\n" + rows)
    done = umov("invert", "pose", "obs.csv", "--scenario", fit)
    assert done.code == 3 and "do times, orbit and site belong together?" in done.err


def variant(text, name):
    """The same scene with other materials: another object."""
    swap = {"metal": [("mli_kapton", "aluminium"), ("paint_white", "aluminium_anodized")],
            "dark": [("mli_kapton", "paint_black"), ("aluminium_anodized", "paint_black")],
            "white": [("mli_kapton", "paint_white"), ("aluminium_anodized", "paint_white"), ("cell_gaas", "paint_white")]}
    for old, new in swap[name]:
        text = text.replace(f'"{old}"', f'"{new}"')
    return text


@pytest.fixture
def library(umov, scene, tmp_path):
    """Four cubesats, in tmp_path/lib."""
    text = (tmp_path / scene([1, 0, 0, 0], "masks", "plain")).read_text()
    for name in ("metal", "dark", "white"):
        (tmp_path / f"{name}.toml").write_text(variant(text, name))
    done = umov("library", "build", "plain.toml", "metal.toml", "dark.toml", "white.toml", "-o", "lib", "--json")
    assert done.code == 0, done.err
    return json.loads(done.out)


def test_a_library_is_built_in_ranges_and_goes_on(umov, library, tmp_path):
    assert [row["state"] for row in library] == ["made"] * 4
    assert all(row["poses"] == 97461 and 0 < row["error"] < 1 for row in library)
    first = {name: (tmp_path / "lib" / f"{name}.umovsig").read_bytes() for name in ("plain", "white")}
    again = umov("library", "build", "plain.toml", "metal.toml", "dark.toml", "white.toml", "-o", "lib", "--json")
    assert [row["state"] for row in json.loads(again.out)] == ["was there"] * 4
    names = ["plain.toml", "metal.toml", "dark.toml", "white.toml"]
    for part in (("--range", "0:1"), ("--shard", "3/4")):  # as two machines would
        assert umov("library", "build", *names, "-o", "parts", *part, "-q", "--threads", "1").code == 0
    assert sorted(p.name for p in (tmp_path / "parts").iterdir()) == ["plain.umovsig", "white.umovsig"]
    for name, data in first.items():
        assert (tmp_path / "parts" / f"{name}.umovsig").read_bytes() == data
    for words, code in ((["--range", "3:9"], 2), (["--range", "x"], 2), (["--shard", "4/4"], 2), (["--shard", "4/5"], 5)):
        assert umov("library", "build", *names, "-o", "parts", *words).code == code


def test_other_colours_come_from_the_abundances(umov, scene, tmp_path):
    """Sums of lobes serve any optical constants; another lobe is another sum."""
    (tmp_path / "film.yml").write_text(
        "REFERENCES: made for a test\nDATA:\n  - type: tabulated nk\n    data: |\n"
        "        0.4 1.2 3.1\n        0.55 0.9 6.2\n        0.8 1.6 7.4\n")
    head, materials, rest = re.split(r"(?s)(\[object\.materials\]\n.*?\n)(?=\[)",
                                     (tmp_path / scene([1, 0, 0, 0], "masks", "plain")).read_text(), maxsplit=1)
    text = (head + re.sub(r'"\w+"', '"own"', materials) + rest +
            '\n[material.own]\nindex = "film.yml"\ndistribution = { model = "beckmann", alpha = 0.15 }\n')

    def state(changed):
        (tmp_path / "metal.toml").write_text(changed)
        done = umov("library", "build", "metal.toml", "-o", "lib", "--json")
        assert done.code == 0, done.err
        return json.loads(done.out)[0]["state"]

    assert state(text) == "made"
    assert state(text.replace('"beckmann"', '"ggx"')) == "made"
    assert state(text) == "made"
    old = (tmp_path / "lib/metal.umovsig").read_bytes()
    assert state(text.replace('set = "paper_rgb"', 'set = ["nm:450", "nm:550", "nm:700"]')) == "recoloured"
    recoloured = (tmp_path / "lib/metal.umovsig").read_bytes()
    assert umov("library", "build", "metal.toml", "-o", "fresh", "-q").code == 0
    fresh = (tmp_path / "fresh/metal.umovsig").read_bytes()
    assert len(fresh) == len(recoloured) and recoloured != old
    # Codes of I apart by sums kept as floats (1e-7) at most: one step of 3e-4.
    begin = 80 + int.from_bytes(fresh[32:40], "little")
    count = 97461 * 3 * 2
    a, b = (memoryview(data[begin:begin + 2 * count]).cast("H") for data in (fresh, recoloured))
    assert max(abs(x - y) for x, y in zip(a, b)) <= 2


def parts_add_up(parts, health):
    """All data say what health.ecsv says; no part of them says it better (Fisher's information adds up)."""
    whole = {row["parameter"]: row for row in health}
    for row in parts:
        error = whole[row["parameter"]]["change_err"]
        if (row["bands"], row["measured"]) == ("all", "I,q,u"):
            assert row["change_err"] == error or math.isnan(error)
        elif not math.isnan(row["change_err"]):
            # Errors are to first order about each part's own best fit: not to the last digit.
            assert row["change_err"] > 0.9 * error
    assert {row["bands"] for row in parts} == {"all", "nm:425", "nm:550", "nm:650"}
    assert {row["measured"] for row in parts} == {"I", "I,q,u"}


def fit_is_of_the_data(fit, observations):
    """Rows of the table are those of the file, and what is left over is noise: S/N 50, a floor of 2 %."""
    rows = sum(1 for line in observations.read_text().splitlines() if line[:2] == "20")
    assert rows - 6 <= len(fit) <= rows  # an epoch or two in the penumbra are left out
    error = [math.hypot(r["intensity_err"], 0.02 * r["intensity"]) for r in fit]
    left = [abs(r["intensity"] - r["intensity_model"]) / e for r, e in zip(fit, error)]
    assert statistics.median(left) < 1.5  # 0.67 of normal errors; zero points of 2 % are not taken off


def test_health_tells_a_drift_from_none_and_what_would_show(umov, scene, tmp_path):
    q = TRUTHS[0]
    fit = scene(q, "rays", "fit")
    words = ["--scenario", fit, "--drift", "body_my=paint_black", "--drift", "panel_px_front=paint_white", "--json"]
    found = {}
    for state, materials in (("new", CUBESAT), ("old", CUBESAT.replace('panel_px_front = "cell_gaas"',
                                                                       'panel_px_front = "paint_white"'))):
        assert umov("run", scene(q, "rays", "truth", materials=materials), "-q").code == 0
        observe(tmp_path, f"{state}.csv", 50, 4)
        done = umov("invert", "health", f"{state}.csv", *words, "-o", state)
        assert done.code in (0, 4), done.err
        found[state] = {row["parameter"]: row for row in json.loads(done.out)["health"]}
        table = Table.read(tmp_path / state / "health.ecsv")
        assert list(table["parameter"]) == ["body_my=paint_black", "panel_px_front=paint_white"]
    assert all(abs(row["sigma"]) < 4 for row in found["new"].values())
    panel = found["old"]["panel_px_front=paint_white"]
    if panel["visible"]:
        assert panel["sigma"] > 3
        assert abs(panel["change"] - 1) < 5 * panel["detectable"]
    parts_add_up(Table.read(tmp_path / "new/parts.ecsv"), Table.read(tmp_path / "new/health.ecsv"))
    fit_is_of_the_data(Table.read(tmp_path / "old/fit.ecsv"), tmp_path / "old.csv")
    same = umov("invert", "health", "new.csv", *words, "--baseline", "new.csv")
    assert all(abs(row["sigma"]) < 1e-6 for row in json.loads(same.out)["health"])
    assert umov("invert", "health", "new.csv", "--scenario", fit, "--drift", "body_my").code == 2
    assert umov("invert", "health", "new.csv", "--scenario", fit, "--drift", "bodi=paint_black").code == 3
