"""umov run: what it writes, and that the numbers hang together."""
import filecmp
import itertools
import json
import math
import warnings

import pytest
from astropy.table import Table
from astropy.time import Time

from conftest import ROOT


def files_of(folder, names):
    return [(folder / name).read_bytes() for name in names]


def test_the_folder_holds_what_the_guide_promises(umov, scenario, tmp_path):
    done = umov("run", scenario())
    assert done.code == 0, done.err
    out = tmp_path / "out"
    for name in ("lightcurve.ecsv", "lightcurve.csv", "passes.ecsv", "report.html",
                 "manifest.json", "scenario.lock.toml", "log.txt"):
        assert (out / name).stat().st_size > 0, name
    manifest = json.loads((out / "manifest.json").read_text())
    text = json.dumps(manifest)
    for word in ("seed", "threads", "sha256", "cube.obj", "hst.tle"):
        assert word in text, word


def test_ecsv_opens_with_astropy_and_has_units_everywhere(umov, scenario, tmp_path):
    assert umov("run", scenario()).code == 0
    table = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    assert len(table) == 3 * 13
    for name in table.colnames:
        assert table[name].unit is not None or table[name].dtype.kind in "USOb", name
    assert str(table["intensity"].unit) == "m2 / sr"
    assert table["I"].unit.is_equivalent("W / (m2 nm)")
    for name in ("time_utc mjd_utc name norad_cat_id band lambda_eff pass_id sunlit az alt ra dec "
                 "range range_rate phase_angle sun_alt airmass I intensity q u v p dop pa q_scat "
                 "u_scat pa_scat mag mag_limit mag_system glint qw qx qy qz elset_age intensity_err "
                 "stokes_q_err stokes_u_err stokes_v_err mag_err q_err u_err v_err p_err pa_err").split():
        assert name in table.colnames, name
    # The two clocks of a row say the same (mjd has about 1e-11 d of rounding).
    clock = Time([t.rstrip("Z") for t in table["time_utc"]], scale="utc")
    assert max(abs(clock.mjd - table["mjd_utc"])) < 1e-8


def test_polarization_columns_agree_with_each_other(umov, scenario, tmp_path):
    assert umov("run", scenario()).code == 0
    for row in Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv"):
        if row["intensity"] == 0:
            assert math.isnan(row["q"])
            continue
        # (q, u) in the sky is (q_scat, 0) turned by pa_scat: docs/conventions.md, 1e-12 rounding.
        turn = math.radians(2 * row["pa_scat"])
        assert row["q"] == pytest.approx(row["q_scat"] * math.cos(turn), abs=1e-12)
        assert row["u"] == pytest.approx(row["q_scat"] * math.sin(turn), abs=1e-12)
        assert row["p"] == pytest.approx(abs(row["q_scat"]), abs=1e-12)
        # Q > 0 for one reflection: the electric vector stands along the normal of the plane.
        assert abs((row["pa"] - row["pa_scat"] + 90) % 180 - 90) < 1e-6


@pytest.mark.parametrize("frame", ["equatorial", "altaz", "scattering"])
def test_errors_stand_in_the_frame_of_their_value(umov, scenario, tmp_path, frame):
    """Each Stokes parameter at either end of its interval, carried to the sky anew: the errors told contain all
    eight corners to first order (the second is 1 % here), and are reached by one of them."""
    done = umov("run", scenario(("step_s = 20", "step_s = 30"), ('default = "paper_al"', 'default = "paint_white"')),
                "--set", f"output.pol_frame={frame}")
    assert done.code == 0, done.err
    rows = [row for row in Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv") if row["intensity"] > 0]
    assert rows
    for row in rows:
        turn, i0, worst = math.radians(2 * row["pa_scat"]), row["intensity"], {}
        for corner in itertools.product((-1, 1), repeat=4):
            i = i0 + corner[0] * row["intensity_err"]
            q, u, v = (row[f"{name}_scat" if name != "v" else "v"] * i0 + sign * row[f"stokes_{name}_err"]
                       for name, sign in zip("quv", corner[1:]))
            sky = {"q": (q * math.cos(turn) - u * math.sin(turn)) / i,
                   "u": (q * math.sin(turn) + u * math.cos(turn)) / i, "v": v / i, "p": math.hypot(q, u) / i,
                   "mag": row["mag"] - 2.5 * math.log10(i / i0)}
            sky["pa"] = math.degrees(math.atan2(sky["u"], sky["q"]) / 2)
            for name, value in sky.items():
                off = abs(value - row[name])
                worst[name] = max(worst.get(name, 0), min(off, 180 - off) if name == "pa" else off)
        for name, off in worst.items():
            assert off <= 1.01 * row[f"{name}_err"] + 1e-12, (name, off, row[f"{name}_err"])
            assert row[f"{name}_err"] <= 1.01 * off + 1e-12, (name, off, row[f"{name}_err"])


def test_what_is_fainter_than_magnitude_30_is_a_limit(umov, scenario, tmp_path):
    """A lobe of a degree without haze: off it there are tails such as 1e-300, which are no light."""
    needle = '[material.needle]\nindex = "Al_Rakic"\ndistribution = { model = "blinn_phong", m = 5000 }\n[bands]'
    done = umov("run", scenario(('default = "paper_al"', 'default = "needle"'), ("[bands]", needle)))
    assert done.code == 0, done.err
    rows = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    faint = [row for row in rows if row["mag_limit"] == "True" or row["mag_limit"] is True or row["mag_limit"] == 1]
    assert faint and all(row["mag"] == 30 for row in faint)
    assert all(row["mag"] <= 30 for row in rows if row["intensity"] > 0)
    assert "> 30.0 AB" in done.out or "too faint for a magnitude throughout: see mag_limit" in done.out, done.out


def test_same_bytes_for_any_number_of_threads(umov, scenario, tmp_path):
    name = scenario()
    results = []
    for threads in (1, 2, 8):
        assert umov("run", name, "--threads", threads, "--force").code == 0
        results.append(files_of(tmp_path / "out", ("lightcurve.ecsv", "lightcurve.csv",
                                                   "passes.ecsv", "report.html",
                                                   "scenario.lock.toml")))
    assert results[0] == results[1] == results[2]


def test_the_locked_scenario_repeats_the_run(umov, scenario, tmp_path):
    assert umov("run", scenario()).code == 0
    lock = tmp_path / "again.toml"
    lock.write_bytes((tmp_path / "out/scenario.lock.toml").read_bytes())
    done = umov("run", lock.name, "--set", 'output.dir="second"')
    assert done.code == 0, done.err
    assert filecmp.cmp(tmp_path / "out/lightcurve.csv", tmp_path / "second/lightcurve.csv",
                       shallow=False)


def test_a_foreign_folder_is_not_touched(umov, scenario, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out/thesis.tex").write_text("mine")
    done = umov("run", scenario())
    assert done.code in (3, 6)
    assert "--force" in done.err
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["thesis.tex"]


def test_no_pass_says_when_the_next_one_is(umov, scenario, tmp_path):
    name = scenario(("2018-01-21T05:08:00Z", "2018-01-21T06:00:00Z"),
                    ("2018-01-21T05:12:00Z", "2018-01-21T06:10:00Z"))
    done = umov("run", name)
    assert done.code == 5
    assert "20580" in done.err and "The next one: 2018-01-2" in done.err
    assert not (tmp_path / "out").exists()


def test_a_step_longer_than_the_pass_is_told(umov, scenario):
    done = umov("run", scenario(("step_s = 20", "step_s = 7200"),
                                ("2018-01-21T05:08:00Z", "2018-01-21T04:20:00Z"),
                                ("2018-01-21T05:12:00Z", "2018-01-21T06:30:00Z")))
    assert done.code == 5, done.err
    assert "step_s = 7200 is longer than the pass" in done.err, done.err


def test_a_cut_pass_keeps_its_name(umov, scenario, tmp_path):
    # The span ends before, or begins after, the highest point at 05:12:0x.
    names = set()
    for start, stop in (("05:08:00", "05:12:00"), ("05:08:00", "05:09:00"), ("05:13:00", "05:13:20")):
        done = umov("run", scenario(("2018-01-21T05:08:00Z", f"2018-01-21T{start}Z"),
                                    ("2018-01-21T05:12:00Z", f"2018-01-21T{stop}Z")))
        assert done.code == 0, done.err
        names |= set(Table.read(tmp_path / "out/passes.ecsv", format="ascii.ecsv")["pass_id"])
    assert len(names) == 1, names


def test_an_interrupt_keeps_what_is_done(scenario, tmp_path):
    import signal
    import subprocess
    import time
    from conftest import UMOV
    # Ray-traced HST at 50 epochs a second: a minute of work.
    name = scenario(("step_s = 20", "step_s = 0.02"), ("cube.obj", f"{ROOT}/data/mesh/hst.obj"),
                    ("[bands]", '[render]\nmethod = "rays"\n[bands]'))
    process = subprocess.Popen([UMOV, "run", name, "--threads", "1"], cwd=tmp_path, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=120)
    if process.returncode == 0:
        pytest.fail("the run ended before the interrupt: give it more to do")
    assert process.returncode == 130, err
    assert "The finished rows are in out" in err or "before the first row" in err
    if (tmp_path / "out").exists():
        rows = len(Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv"))
        assert 0 < rows < 3 * 12001
        assert json.loads((tmp_path / "out/manifest.json").read_text())["status"] == "stopped early"
        assert "stopped early" in (tmp_path / "out/lightcurve.ecsv").read_text()
        assert "PARTIAL" in (tmp_path / "out/report.html").read_text()


def test_a_stopped_rerun_spares_the_complete_folder(umov, scenario, tmp_path):
    name = scenario()
    assert umov("run", name).code == 0
    before = (tmp_path / "out/lightcurve.ecsv").read_bytes()
    stopped = decaying(scenario, tmp_path)
    done = umov("run", stopped)
    assert done.code == 4 and "out.partial" in done.err, done.err
    assert (tmp_path / "out/lightcurve.ecsv").read_bytes() == before
    assert b"stopped early" in (tmp_path / "out.partial/lightcurve.ecsv").read_bytes()
    assert umov("run", stopped).code == 4  # a second one replaces the first partial folder
    assert sorted(p.name for p in tmp_path.glob("out*")) == ["out", "out.partial"]


def decaying(scenario, tmp_path):
    # An orbit low enough to decay soon after its epoch: HST's set with a huge drag term.
    first, second = (ROOT / "data/tle/hst.tle").read_text().splitlines()[-2:]
    first = first[:53] + " 99999+0" + first[61:]
    digits = sum(int(c) if c.isdigit() else c == "-" for c in first[:68])
    (tmp_path / "low.tle").write_text(first[:68] + str(digits % 10) + "\n" + second + "\n")
    name = scenario((f"{ROOT}/data/tle/hst.tle", "low.tle"),
                    ("2018-01-21T05:08:00Z", "2018-01-20T12:00:00Z"),
                    ("2018-01-21T05:12:00Z", "2018-02-10T12:00:00Z"), ("step_s = 20", "step_s = 300"),
                    ("alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true",
                     "alt_min_deg = 0, sunlit = false"))
    return name


def test_a_decayed_orbit_keeps_the_finished_rows(umov, scenario, tmp_path):
    done = umov("run", decaying(scenario, tmp_path), "--set", "time.step_s=60")
    assert done.code == 4, done.err
    assert "SGP4 fails at" in done.err and "Shorten [time] or give newer elements." in done.err
    rows = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    assert len(rows) > 3 * 64, "all up to the failure, not one block of them"


@pytest.mark.parametrize("example", ["hst_maui", "agena_maui"])
def test_examples_are_well_formed(umov, example):
    done = umov("run", ROOT / f"examples/{example}.toml", "--dry-run")
    assert done.code == 0, done.err


def test_files_of_others_survive_a_rerun(umov, scenario, tmp_path):
    name = scenario()
    assert umov("run", name).code == 0
    (tmp_path / "out/notes.txt").write_text("mine")
    done = umov("run", name)
    assert done.code == 6 and "notes.txt" in done.err and "--force" in done.err, done.err
    assert umov("run", name, "--force").code == 0
    assert (tmp_path / "out/notes.txt").read_text() == "mine"


def test_the_working_folder_and_links_can_take_the_output(umov, scenario, tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real")
    assert umov("run", scenario(), "--set", "output.dir=link").code == 0
    assert (tmp_path / "link").is_symlink() and (tmp_path / "real/report.html").exists()
    assert umov("run", scenario(), "--set", "output.dir=link").code == 0
    assert (tmp_path / "link").is_symlink()
    done = umov("run", scenario(), "--set", "output.dir=.", "--force")
    assert done.code == 0 and (tmp_path / "report.html").exists(), done.err


def test_the_manifest_has_the_command_and_the_lock_the_exact_times(umov, scenario, tmp_path):
    name = scenario(("2018-01-21T05:08:00Z", "2018-01-21T05:08:00.000250Z"))
    done = umov("run", name, "--accuracy", 0.01, "--seed", 5)
    assert done.code == 0, done.err
    words = json.loads((tmp_path / "out/manifest.json").read_text())["command_line"]
    assert words[1:] == ["run", name, "--accuracy", "0.01", "--seed", "5"]
    assert "05:08:00.000250Z" in (tmp_path / "out/scenario.lock.toml").read_text()


def test_run_writes_fits_with_the_numbers_of_the_ecsv(umov, scenario, tmp_path):
    name = scenario(('formats = ["ecsv", "csv", "html"]', 'formats = ["ecsv", "fits"]'))
    assert umov("run", name, "--quiet").code == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fits = Table.read(tmp_path / "out/lightcurve.fits")
    ecsv = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    assert fits.colnames == ecsv.colnames and len(fits) == len(ecsv) > 0
    for column in ("intensity", "phase_angle", "range"):
        if column in ecsv.colnames:
            assert list(fits[column]) == list(ecsv[column])
            assert str(fits[column].unit) == str(ecsv[column].unit)
    # Run again over its own folder.
    assert umov("run", name, "--quiet").code == 0
