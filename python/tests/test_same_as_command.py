"""What Python computes has the bytes that the command writes."""
import csv
import json
import math
import warnings

import numpy as np
import pytest
import umov
from conftest import DATA, EXAMPLES
from umov import _toml

SHORT = {"time.start": "2018-01-21T05:05:00Z", "time.stop": "2018-01-21T05:15:00Z", "time.step_s": 20,
         "output.csv_digits": "all"}


def columns_of(path):
    """Columns of one of our CSV files as text."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {name: [row[name] for row in rows] for name in rows[0]}


def assert_same_numbers(ours, texts):
    """Bit for bit: the command writes the shortest decimals that give the numbers back."""
    theirs = np.array([float(text) if text else np.nan for text in texts])
    np.testing.assert_array_equal(np.ascontiguousarray(ours).ravel().view(np.int64)[~np.isnan(theirs)],
                                  theirs.view(np.int64)[~np.isnan(theirs)])
    assert np.isnan(ours.ravel()[np.isnan(theirs)]).all()


@pytest.mark.parametrize("example", ["hst_maui", "agena_maui"])
def test_run(example, command, tmp_path):
    path = EXAMPLES / f"{example}.toml"
    sets = [word for key, value in SHORT.items() for word in ("--set", f"{key}={value}")]
    command("run", path, *sets, "-o", tmp_path / "out", "-q")
    curve = umov.run(path, set=SHORT)
    curve.write(tmp_path / "ours.csv")
    curve.write(tmp_path / "ours.ecsv")
    curve.passes.write(tmp_path / "passes.ecsv")
    out = tmp_path / "out"
    assert (tmp_path / "ours.csv").read_bytes() == (out / "lightcurve.csv").read_bytes()
    assert (tmp_path / "ours.ecsv").read_bytes() == (out / "lightcurve.ecsv").read_bytes()
    assert (tmp_path / "passes.ecsv").read_bytes() == (out / "passes.ecsv").read_bytes()
    theirs = columns_of(out / "lightcurve.csv")
    for name in ("I", "q_scat", "mag", "range"):
        assert_same_numbers(curve[name], theirs[name])
    assert curve.table["time_utc"].tolist() == theirs["time_utc"]


@pytest.mark.parametrize("method", ["masks", "auto", "rays"])
def test_signature(method, command, tmp_path):
    path, poses = EXAMPLES / "hst_maui.toml", 4 if method == "rays" else 100
    command("signature", path, "--poses", poses, "--phase", "60", "--seed", 7, "--visibility", method,
            "-o", tmp_path / "t.csv")
    theirs = columns_of(tmp_path / "t.csv")
    engine = umov.Engine(path, method=method, set={"seed": 7})
    light = engine.light(*umov.random_poses(poses, phase_deg=60, seed=7))
    for k, name in enumerate(("intensity", "stokes_q", "stokes_u", "stokes_v")):
        assert_same_numbers(light.stokes[..., k], theirs[name])
        assert_same_numbers(light.half_width[..., k], theirs[f"{name}_err"])
    np.testing.assert_array_equal(engine.evaluate(*umov.random_poses(poses, 60, 7)), light.stokes)


def test_signature_of_directions_of_any_length(command, tmp_path):
    rows = [[0, 0, 2, 0, 1e-200, 1e-200], [1, 2, 3, -3, 1e5, 4], [1e300, 0, 0, 1e300, 1e299, 0]]
    head = "sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n"
    (tmp_path / "g.csv").write_text(head + "\n".join(",".join(map(repr, map(float, row))) for row in rows))
    path = EXAMPLES / "hst_maui.toml"
    command("signature", path, "--geometry", "g.csv", "--visibility", "masks", "-o", tmp_path / "t.csv")
    given = np.array(rows, dtype=float)
    ours = umov.Engine(path, method="masks").evaluate(given[:, :3], given[:, 3:])
    assert_same_numbers(ours[..., 0], columns_of(tmp_path / "t.csv")["intensity"])


def test_passes(command, tmp_path, hst):
    span = ("2018-01-21T00:00:00Z", "2018-01-22T00:00:00Z")
    tle = DATA / "tle/hst.tle"
    command("passes", "--orbit", tle, "-s", "maui", "--start", span[0], "--stop", span[1], "-o", tmp_path / "t.csv")
    table = umov.passes(tle, "maui", *span)
    theirs = columns_of(tmp_path / "t.csv")
    assert list(theirs) == table.colnames
    for name, texts in theirs.items():
        if table[name].dtype.kind == "f":
            assert_same_numbers(np.asarray(table[name].value if hasattr(table[name], "value") else table[name]),
                                texts)
        else:
            assert [str(one) for one in table[name]] == texts
    lit = umov.passes(hst, "maui", *span)
    scene = {key: value for key, value in hst.to_dict().items() if key != "orbit"}
    (tmp_path / "scene.toml").write_text(_toml.text_of({**hst.to_scenario_dict(), "object": [scene]}))
    command("passes", "--orbit", tle, "--norad", 20580, "-s", "maui", "--start", span[0], "--stop", span[1],
            "--scene", "scene.toml", "-o", tmp_path / "lit.csv")
    assert_same_numbers(np.asarray(lit["mag_min"].value), columns_of(tmp_path / "lit.csv")["mag_min"])
    assert np.isfinite(lit["mag_min"].value).any()
    # The brightest first, and only what is brighter than the second of them.
    limit = float(np.sort(lit["mag_min"].value[np.isfinite(lit["mag_min"].value)])[1])
    best = umov.passes(hst, "maui", *span, sort="mag", mag_max=limit)
    assert 0 < len(best) <= len(lit) and (np.diff(best["mag_min"].value) >= 0).all() and best["mag_min"].value[-1] <= limit
    high = umov.passes(tle, "maui", *span, sort="alt")["visible_alt"].value
    assert (np.diff(high[np.isfinite(high)]) <= 0).all()


def test_ephemeris(command, tmp_path):
    tle, span = DATA / "tle/hst.tle", ("2018-01-21T05:05:00Z", "2018-01-21T05:15:00Z")
    command("orbit", "ephemeris", "--orbit", tle, "--lat-deg", 20.7083, "--lon-deg", -156.2578, "--alt-m", 3058,
            "--start", span[0], "--stop", span[1], "--step-s", 60, "-o", tmp_path / "t.csv")
    site = umov.Site(lat_deg=20.7083, lon_deg=-156.2578, alt_m=3058)
    table = umov.ephemeris(tle, site, *span, step_s=60)
    assert_same_numbers(np.asarray(table["az"].value), columns_of(tmp_path / "t.csv")["az"])


def test_propagate(command, tmp_path):
    tle = DATA / "tle/hst.tle"
    times = ["2018-01-21T05:00:00Z", "2018-01-21T06:00:00Z"]
    command("orbit", "propagate", "--orbit", tle, "--at", ",".join(times), "-o", tmp_path / "t.csv")
    theirs = columns_of(tmp_path / "t.csv")
    states = umov.propagate(tle, times)
    assert_same_numbers(states.position_km[..., 0], theirs["teme_x"])
    assert_same_numbers(states.velocity_km_s[..., 2], theirs["teme_vz"])


@pytest.mark.parametrize("material", ["paper_au", "film_silvered", "mli_kapton", "paper_spectralon"])
def test_brdf(material, command, tmp_path):
    rng = np.random.default_rng(3)
    rows = np.column_stack([rng.choice([450.0, 550.0], 50), rng.uniform(0, 90, 50), rng.uniform(0, 90, 50),
                            rng.uniform(-180, 180, 50)])
    head = "wavelength_nm,theta_i_deg,theta_o_deg,phi_deg\n"
    (tmp_path / "b.csv").write_text(head + "\n".join(",".join(map(repr, row)) for row in rows.tolist()))
    command("brdf", material, "--batch", "b.csv", "-o", tmp_path / "t.csv")
    theirs = columns_of(tmp_path / "t.csv")
    ours = umov.brdf(material, *rows.T)
    for i in range(4):
        for j in range(4):
            assert_same_numbers(ours[:, i, j], theirs[f"m{i}{j}"])


def test_observe_and_reduce(command, tmp_path):
    path, few = EXAMPLES / "observe_hst.toml", {"observation.cadence_s": 10, "observation.exposure_s": 0.02}
    sets = [word for key, value in few.items() for word in ("--set", f"{key}={value}")]
    command("observe", path, *sets, "-o", tmp_path / "out", "-q")
    seen = umov.observe(path, set=few)
    seen.counts.write(tmp_path / "counts.ecsv")
    seen.truth.write(tmp_path / "truth.ecsv")
    for name in ("counts.ecsv", "truth.ecsv"):
        assert (tmp_path / name).read_bytes() == (tmp_path / "out" / name).read_bytes()
    command("reduce", tmp_path / "out/counts.ecsv", "-o", tmp_path / "stokes.ecsv")
    for counts in (seen, seen.counts, tmp_path / "counts.ecsv", seen.counts.to_qtable()):
        umov.reduce(counts).write(tmp_path / "ours.ecsv")
        assert (tmp_path / "ours.ecsv").read_bytes() == (tmp_path / "stokes.ecsv").read_bytes()
    known = ["--q0-sd", 0.002, "--angle-sd-deg", 0.5]
    command("reduce", tmp_path / "out/counts.ecsv", *known, "-o", tmp_path / "known.ecsv")
    umov.reduce(seen, q0_sd=0.002, angle_sd_deg=0.5).write(tmp_path / "ours.ecsv")
    assert (tmp_path / "ours.ecsv").read_bytes() == (tmp_path / "known.ecsv").read_bytes()
    assert (tmp_path / "known.ecsv").read_bytes() != (tmp_path / "stokes.ecsv").read_bytes()


def test_splines_and_what_others_take_of_them(command, tmp_path):
    path, few = EXAMPLES / "observe_hst.toml", {"observation.cadence_s": 10, "observation.exposure_s": 0.02}
    seen = umov.observe(path, set=few)
    seen.counts.write(tmp_path / "counts.ecsv")
    command("reduce", "counts.ecsv", "-o", "stokes.ecsv", "--tdm", "a.tdm", "--score", "a.csv")
    stokes = umov.reduce(seen)
    told = (tmp_path / "a.tdm").read_text()
    made = next(line.split("=")[1].strip() for line in told.splitlines() if line.startswith("CREATION_DATE"))
    assert umov.tdm(stokes, seen, ecsv="stokes.ecsv", created=made.rstrip("Z") + "Z") == told
    assert umov.score(stokes, tmp_path / "counts.ecsv") == (tmp_path / "a.csv").read_text()
    command("reduce", "counts.ecsv", "-o", "splined.ecsv", "--model", "spline:60")
    umov.reduce(seen, knot_s=60).write(tmp_path / "ours.ecsv")
    assert (tmp_path / "ours.ecsv").read_bytes() == (tmp_path / "splined.ecsv").read_bytes()


def test_frames(command, tmp_path):
    path = EXAMPLES / "observe_hst.toml"
    few = {"observation.level": "image", "observation.cadence_s": 120, "observation.exposure_s": 0.02}
    sets = [word for key, value in few.items() for word in ("--set", f"{key}={value}")]
    command("observe", path, *sets, "-o", tmp_path / "out", "-q")
    seen = umov.observe(path, set=few, frames=tmp_path / "ours")
    theirs = sorted((tmp_path / "out/frames").iterdir())
    assert seen.frames == len(theirs) > 0
    assert [one.name for one in theirs] == sorted(one.name for one in (tmp_path / "ours").iterdir())
    for one in theirs:
        assert one.read_bytes() == (tmp_path / "ours" / one.name).read_bytes()
    seen.counts.write(tmp_path / "counts.ecsv")
    assert (tmp_path / "counts.ecsv").read_bytes() == (tmp_path / "out/counts.ecsv").read_bytes()
    with pytest.raises(umov.DeviceError):  # they are there already
        umov.observe(path, set=few, frames=tmp_path / "ours")


AGENA, HST = EXAMPLES / "agena_maui.toml", EXAMPLES / "hst_maui.toml"


GREEN = {"bands.set": ["nm:550"]}


@pytest.mark.long
def test_tracking(command, tmp_path):
    """From the command's folder and from an answer in memory; then on from what it left."""
    still = {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "time.step_s": 20, **GREEN}
    times = (("first", "2018-01-21T05:18:00Z", "2018-01-21T05:20:00Z"), ("second", "2018-01-21T05:20:20Z", "2018-01-21T05:21:00Z"),
             ("third", "2018-01-21T05:21:20Z", "2018-01-21T05:22:00Z"))
    curves = {name: umov.run(AGENA, set={**still, "time.start": start, "time.stop": stop}) for name, start, stop in times}
    for name, curve in curves.items():
        curve.write(tmp_path / f"{name}.ecsv")
    ours = umov.invert_pose(curves["first"], AGENA, set=GREEN, fit=umov.Fit(grid=1000))
    options = ["--scenario", AGENA, "--set", 'bands.set=["nm:550"]', "-q"]
    command("invert", "pose", "first.ecsv", "--grid", 1000, *options, "-o", "pose")
    before = "pose"
    for name in ("second", "third"):
        command("invert", "track", f"{name}.ecsv", "--start", before, "--rate-noise", 2e-4, *options, "-o", name)
        for start in (tmp_path / before, ours):
            found = umov.invert_track(curves[name], AGENA, start, rate_noise=2e-4, set=GREEN)
            assert found.state == (tmp_path / name / "state.json").read_text()
            assert found.values == json.loads((tmp_path / name / "verdict.json").read_text())
            assert sorted(found.tables) == ["fit", "modes", "track"]
            # A fit that names no method leaves hiding to masks, as the command does.
            assert umov.invert_track(curves[name], AGENA, start, rate_noise=2e-4, set=GREEN, fit=umov.Fit(clouds=False)).state == found.state
            for table in found.tables:
                found.tables[table].write(tmp_path / "ours.ecsv")
                assert (tmp_path / "ours.ecsv").read_bytes() == (tmp_path / name / f"{table}.ecsv").read_bytes(), table
        before, ours = name, found
    other = umov.invert_track(curves["third"], AGENA, tmp_path / "second", rate_noise=2e-4, set=GREEN, fit=umov.Fit(method="auto"))
    assert other.state != found.state  # rays mend masks there: the test above can fail
    with pytest.raises(umov.UsageError, match="tilt_sd_deg is 0.5; .* 0 was expected"):
        umov.invert_track(curves["third"], AGENA, tmp_path / "second", set=GREEN, fit=umov.Fit(tilt_sd_deg=0.5))
    with pytest.raises(umov.UsageError, match="by_group is True; .* False was expected"):
        umov.invert_track(curves["third"], AGENA, tmp_path / "second", set=GREEN, fit=umov.Fit(by_group=True))


@pytest.mark.parametrize("fit", [umov.Fit(tilt_sd_deg=0.5), umov.Fit(by_group=True)])
@pytest.mark.parametrize("ask", [
    lambda fit: umov.invert_material("light.csv", AGENA, group="body", candidates=["aluminium"], fit=fit),
    lambda fit: umov.invert_health("light.csv", AGENA, drift={"body": "aluminium"}, fit=fit),
    lambda fit: umov.invert_plan(AGENA, {"one": {}, "other": {"object.materials.default": "paint_white"}}, fit=fit),
    lambda fit: umov.identify("light.csv", AGENA, "library", fit=fit)])
def test_what_only_searches_for_attitudes_ask_is_not_left_aside(ask, fit):
    with pytest.raises(umov.UsageError, match="only invert_pose and invert_spin"):
        ask(fit)


@pytest.mark.parametrize(("words", "scenario", "changes", "ours"), [
    pytest.param(
        ["pose", "--grid", 1000, "--outliers", 0.05, "--floor", 0.03], AGENA,
        {"object.attitude": {"mode": "inertial", "quaternion": [0.8, 0.0, 0.6, 0.0]}, "time.step_s": 40},
        lambda light: umov.invert_pose(light, AGENA, set=GREEN, fit=umov.Fit(grid=1000, outliers=0.05, floor=0.03)), marks=pytest.mark.long),
    # Materials that are known: each answer takes a third of the time.
    (["spin", "--period", 23.7, "--no-aliases", "--axis", "x", "--grid", 1000, "--intensity-only", "--slope-sd", 0, "--reflectance-sd", 0,
      "--haze-sd", 0], AGENA,
     {"object.attitude": {"mode": "spin", "axis": "+X", "period_s": 23.7}, "time.step_s": 3,
      "time.start": "2018-01-21T05:18:00Z", "time.stop": "2018-01-21T05:20:00Z"},
     lambda light: umov.invert_spin(light, AGENA, period_s=23.7, aliases=False, axis="x", set=GREEN,
                                    fit=umov.Fit(grid=1000, intensity_only=True, slope_sd=0, reflectance_sd=0, haze_sd=0))),
    (["material", "--group", "array_front", "--candidates", "cell_silicon,paint_white"], HST, {"time.step_s": 30},
     lambda light: umov.invert_material(light, HST, group="array_front", candidates=["cell_silicon", "paint_white"],
                                        set=GREEN)),
    (["health", "--drift", "array_front=paint_white", "--attitude-sd", 0.2, "--scale-sd", 0.1], HST, {"time.step_s": 30},
     lambda light: umov.invert_health(light, HST, drift={"array_front": "paint_white"}, attitude_sd_deg=0.2, set=GREEN,
                                      fit=umov.Fit(scale_sd=0.1)))])
def test_inversions(words, scenario, changes, ours, command, tmp_path):
    """Of a file and of a light curve in memory: verdict, every table and the page."""
    curve = umov.run(scenario, set={**changes, **GREEN})
    curve.write(tmp_path / "light.ecsv")
    command("invert", words[0], "light.ecsv", "--scenario", scenario, *words[1:], "--set", 'bands.set=["nm:550"]',
            "-o", "theirs", "-q")
    theirs = tmp_path / "theirs"
    for light in (tmp_path / "light.ecsv", curve):
        found = ours(light)
        assert sorted(one.stem for one in theirs.glob("*.ecsv")) == sorted(found.tables)
        for name, table in found.tables.items():
            table.write(tmp_path / "ours.ecsv")
            assert (tmp_path / "ours.ecsv").read_bytes() == (theirs / f"{name}.ecsv").read_bytes(), name
        assert found.values == json.loads((theirs / "verdict.json").read_text())
        assert found.verdict == found.values["verdict"]
        assert not found.page or found.page == (theirs / "report.html").read_text()


def test_a_plan(command, tmp_path):
    """Alternatives by a key and by another file, a span, a stated noise: every table and the page."""
    (tmp_path / "other.toml").write_text(umov.Scenario(HST, set={"object.materials.array_back": "gold"}).to_toml())
    command("invert", "plan", "--scenario", HST, "--set", "time.step_s=40", "--start", "2018-01-21T04:30:00Z", "--snr", 30,
            "--floor", 0.1, "--alternative", "new", "--alternative", "painted:object.materials.array_back=paint_white",
            "--alternative", "gold:other.toml", "-o", "theirs", "-q")
    found = umov.invert_plan(HST, {"new": {}, "painted": {"object.materials.array_back": "paint_white"}, "gold": tmp_path / "other.toml"},
                             start="2018-01-21T04:30:00Z", snr=30, set={"time.step_s": 40}, fit=umov.Fit(floor=0.1))
    theirs = tmp_path / "theirs"
    assert sorted(one.stem for one in theirs.glob("*.ecsv")) == sorted(found.tables)
    for name, table in found.tables.items():
        table.write(tmp_path / "ours.ecsv")
        assert (tmp_path / "ours.ecsv").read_bytes() == (theirs / f"{name}.ecsv").read_bytes(), name
    assert found.values == json.loads((theirs / "verdict.json").read_text())
    assert found.page == (theirs / "report.html").read_text()


def test_changes_are_counted_from_a_baseline():
    nights = [umov.run(HST, set={"time.step_s": 30, "time.start": start}) for start in ("2018-01-21T05:00:00Z", "2018-01-21T05:00:15Z")]
    found = umov.invert_health(nights, HST, drift={"array_front": "paint_white"}, baseline=nights)
    assert abs(found.tables["health"]["sigma"][0]) < 1e-6


def test_a_library(command, tmp_path):
    for name in ("one", "two"):
        (tmp_path / f"{name}.toml").write_text(umov.Scenario(HST).to_toml())
    command("library", "build", "one.toml", "two.toml", "-o", "theirs", "--cells", 4, "-q")
    paths = [tmp_path / "one.toml", tmp_path / "two.toml"]
    made = umov.build_library(paths, tmp_path / "ours", cells=4, count=1)
    assert list(made["state"]) == ["made"] and list(made["name"]) == ["one"]
    made = umov.build_library(paths, tmp_path / "ours", cells=4)
    assert list(made["state"]) == ["was there", "made"] and set(made["poses"]) == {325}
    for name in ("one", "two"):
        assert (tmp_path / f"ours/{name}.umovsig").read_bytes() == (tmp_path / f"theirs/{name}.umovsig").read_bytes()


@pytest.mark.parametrize(("words", "ours"), [
    (("bands", "list"), lambda: umov.bands()),
    (("bands", "show", "Bessell.V"), lambda: umov.band("Bessell.V")),
    (("instrument", "list"), lambda: umov.instruments()),
    (("material", "list"), lambda: umov.materials()),
    (("exposure", "--instrument", "c11_imx250", "--mag", 6, "--alt", 30, "--nm", 650),
     lambda: umov.exposure("c11_imx250", mag=6, alt_deg=30, wavelength_nm=650))])
def test_lists(words, ours, command, tmp_path):
    command(*words, "-o", tmp_path / "theirs.csv")
    ours().write(tmp_path / "ours.csv")
    assert (tmp_path / "ours.csv").read_bytes() == (tmp_path / "theirs.csv").read_bytes()


def test_a_turned_polarizer(command, tmp_path):
    rows = [f"{a},{c},{1000 + 900 * math.cos(2 * math.radians(a - c))!r}" for a in range(0, 180, 20) for c in (0, 45, 90, 135)]
    (tmp_path / "lamp.csv").write_text("\n".join(["angle_deg,channel,counts", *rows]) + "\n")
    command("calibrate", tmp_path / "lamp.csv", "--polarizer", "-o", tmp_path / "theirs.ecsv")
    umov.calibrate_channels(tmp_path / "lamp.csv").write(tmp_path / "ours.ecsv")
    assert (tmp_path / "ours.ecsv").read_bytes() == (tmp_path / "theirs.ecsv").read_bytes()
    assert umov.standards() == ["schmidt1992"]


def test_errors_have_the_text_of_the_command(command, tmp_path):
    (tmp_path / "bad.toml").write_text("umov = 1\n[observer]\nnaem = \"maui\"\n")
    told = command("run", tmp_path / "bad.toml", code=3)
    with pytest.raises(umov.InputError) as caught:
        umov.run(tmp_path / "bad.toml")
    assert told.strip() == f"error: {caught.value}"
    assert caught.value.where == umov.Where(str(tmp_path / "bad.toml"), 3, 1)


def test_warnings_have_the_text_of_the_command(command):
    tle = DATA / "tle/hst.tle"
    words = ("orbit", "ephemeris", "--orbit", tle, "-s", "maui", "--start", "2018-02-12T05:05:00Z", "--stop",
             "2018-02-12T05:05:00Z", "--step-s", 1)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        umov.ephemeris(tle, "maui", "2018-02-12T05:05:00Z", "2018-02-12T05:05:00Z", step_s=1)
    ours = [str(one.message) for one in caught if issubclass(one.category, umov.UmovWarning)]
    assert ours and all(one.filename == __file__ for one in caught if one.category is umov.UmovWarning)
    import subprocess
    from conftest import UMOV
    told = subprocess.run([UMOV, *map(str, words)], capture_output=True, text=True).stderr
    assert [f"warning: {text}" for text in ours] == [line for line in told.splitlines() if line.startswith("warning")]
