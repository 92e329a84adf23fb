"""umov observe and reduce: from a scenario to counts and back, through every instrument."""
import json
import math
import re
import statistics

import pytest
from astropy.table import Table

from sphere_over_maui import make_sphere, write_scene

BAND = 'bands = ["nm:550"]\nwidth_nm = 50\n'


@pytest.fixture
def scene(umov, tmp_path):
    """scene(instrument, observation, ...) writes observe.toml for a small white sphere."""
    make_sphere(umov, 0.2)

    def write(instrument, observation, air="", frame="altaz", seconds=0):
        return write_scene(tmp_path, BAND + observation, instrument=instrument, seed=7, frame=frame,
                           atmosphere="seeing = { arcsec = 3 }\n" + air, stop=f"2018-01-21T05:12:{seconds:02}Z")

    return write


def observed(umov, tmp_path, scenario, *reduce):
    done = umov("observe", scenario, "--force")
    assert done.code == 0, done.err
    reduced = umov("reduce", "out/counts.ecsv", "-o", "stokes.ecsv", *reduce)
    assert reduced.code == 0, reduced.err
    return Table.read(tmp_path / "stokes.ecsv"), Table.read(tmp_path / "out/truth.ecsv"), done.err + reduced.err


def pulls(stokes, truth):
    """(found - true)/sd of I, q, u (and v), set by set."""
    out = {name: [] for name in ("I", "q", "u", "v")}
    sets = {}
    for number, *values in zip(truth["set_id"], truth["I"], truth["q"], truth["u"], truth["v"]):
        sets.setdefault(int(number), []).append(values)
    for row in stokes:
        if row["flags"]:
            continue
        own = sets[int(row["set_id"])]
        light = sum(values[0] for values in own) / len(own)
        out["I"].append((row["I"] - light) / row["I_err"])
        for k, name in enumerate("quv", 1):
            if not math.isnan(row[f"cov_{name}{name}"]):
                mean = sum(values[k] * values[0] for values in own) / len(own) / light
                out[name].append((row[name] - mean) / math.sqrt(row[f"cov_{name}{name}"]))
    return {name: values for name, values in out.items() if values}


CASES = [("c11_imx250", "exposure_s = 0.1", 3), ("hwp_wollaston_1m", "exposure_s = 0.02\ncadence_s = 0.1", 3),
         ("moptop_2m", "exposure_s = 0.02\ncadence_s = 0.1", 3), ("mmt9_channel", "exposure_s = 0.1", 3),
         ("full_stokes_3m6", "exposure_s = 0.005\ncadence_s = 0.1", 4)]


@pytest.mark.parametrize("instrument, observation, parameters", CASES)
def test_what_is_recorded_is_found_again(scene, umov, tmp_path, instrument, observation, parameters):
    extra = "" if instrument != "moptop_2m" else "\n[polarimeter]\nperiod_s = 1.6"
    path = scene(instrument, observation + extra, air="scintillation = { c_y = 0.3 }")
    stokes, truth, _ = observed(umov, tmp_path, path)
    found = pulls(stokes, truth)
    assert len(found) == parameters
    for name, values in found.items():
        if name == "I":  # scintillation of a set is drawn log-normal about 1
            continue
        n = len(values)
        assert n >= 150
        # Four standard errors of a mean and of a standard deviation.
        assert abs(statistics.mean(values)) < 4 / math.sqrt(n) + 0.02, name
        assert abs(statistics.stdev(values) - 1) < 4 / math.sqrt(2 * n) + 0.02, name
    dof = [row["chi2"] / row["dof"] for row in stokes if not row["flags"] and row["dof"] > 0]
    assert len(dof) > 0 or instrument in ("mmt9_channel", "full_stokes_3m6")  # as many states as unknowns
    assert not dof or abs(statistics.mean(dof) - 1) < 4 * math.sqrt(2 / len(dof)) + 0.02


def test_lenses_of_their_own_flicker_apart(scene, umov, tmp_path):
    """Scintillation is drawn for each lens: taken for common to all, it would leave q and u with far too small errors."""
    path = scene("mmt9_channel", "exposure_s = 0.1", air="scintillation = { c_y = 6 }")
    stokes, truth, _ = observed(umov, tmp_path, path)
    found = pulls(stokes, truth)
    for name in "qu":
        n = len(found[name])
        # Four standard errors; a star four times as bright as another is not Gaussian: .1 besides.
        assert n >= 100 and abs(statistics.stdev(found[name]) - 1) < 4 / math.sqrt(2 * n) + 0.1, name


def test_frames_of_the_sky_tell_the_same(scene, umov, tmp_path):
    """A camera on an alt-azimuth mount: the same counts, and q_scat does not know the frame."""
    tables = {}
    for frame in ("altaz", "equatorial", "scattering"):
        path = scene("c11_imx250", "exposure_s = 1", frame=frame)
        stokes, _, _ = observed(umov, tmp_path, path)
        tables[frame] = (Table.read(tmp_path / "out/counts.ecsv"), stokes)
    counts, stokes = tables["altaz"]
    for other in ("equatorial", "scattering"):
        assert max(abs(counts["counts"] / tables[other][0]["counts"] - 1)) < 1e-12
        assert max(abs(stokes["q_scat"] - tables[other][1]["q_scat"])) < 1e-12
        assert max(abs(stokes["p"] - tables[other][1]["p"])) < 1e-12
    assert max(abs(tables["scattering"][1]["q_scat"] - tables["scattering"][1]["q"])) < 1e-12


def test_what_was_recorded_is_told_to_programs(scene, umov, tmp_path):
    done = umov("observe", scene("c11_imx250", "exposure_s = 1\n"), "--json")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    counts, truth = (Table.read(tmp_path / f"out/{name}.ecsv") for name in ("counts", "truth"))
    assert (told["rows"], told["exposures"], told["frames"]) == (len(counts), len(truth), 0)
    assert (tmp_path / told["folder"]).samefile(tmp_path / "out")


def test_the_same_seed_gives_the_same_bytes(scene, umov, tmp_path):
    path = scene("c11_imx250", "exposure_s = 1")
    for threads in (1, 2):
        assert umov("observe", path, "-o", f"t{threads}", "--threads", threads).code == 0
    one, two = ((tmp_path / f"t{n}/counts.ecsv").read_bytes() for n in (1, 2))
    assert one == two
    assert umov("observe", path, "-o", "other", "--set", "seed=8").code == 0
    assert (tmp_path / "other/counts.ecsv").read_bytes() != one


def test_the_locked_scenario_repeats_it(scene, umov, tmp_path):
    assert umov("observe", scene("usafa16", "exposure_s = 5"), "-o", "a").code == 0
    assert umov("observe", "a/scenario.lock.toml", "-o", "b").code == 0
    assert (tmp_path / "a/counts.ecsv").read_bytes() == (tmp_path / "b/counts.ecsv").read_bytes()


def test_counts_can_be_fitted_without_umov(scene, umov, tmp_path):
    """Rows of four orientations solved by hand: unweighted least squares is within the errors."""
    stokes, _, _ = observed(umov, tmp_path, scene("c11_imx250", "exposure_s = 1"))
    counts = Table.read(tmp_path / "out/counts.ecsv")
    import numpy
    first = counts[counts["set_id"] == counts["set_id"][0]]
    rows = numpy.array([[r["w0"], r["w1"], r["w2"]] for r in first])
    found = numpy.linalg.lstsq(rows, numpy.array(first["counts"] - first["sky"]), rcond=None)[0]
    assert abs(found[1] / found[0] - stokes["q"][0]) < 0.2 * math.sqrt(stokes["cov_qq"][0])


def test_a_drift_is_told_in_figures(scene, umov, tmp_path):
    _, _, said = observed(umov, tmp_path, scene("usafa16", "exposure_s = 2", air='scintillation = "none"'))
    assert "fourier:PERIOD" in said and "looks like p" in said


def test_a_drift_behind_a_retarder_is_told_in_figures(scene, umov, tmp_path):
    """One beam behind a retarder in four steps: a linear drift is odd in the angle, as V is. The states by their Mueller rows."""
    import numpy
    _, _, said = observed(umov, tmp_path, scene("full_stokes_3m6", "exposure_s = 0.1\ncadence_s = 0.5", air='scintillation = "none"', seconds=30))
    told = re.search(r"changes by (\S+) from exposure to exposure while the retarder turns: that alone looks like q, u, v of (\S+),", said)
    assert told, said
    c, s, d = *(f(numpy.radians(2 * numpy.array([-51.69, -15.12, 15.12, 51.69]))) for f in (numpy.cos, numpy.sin)), math.radians(131.8)
    rows = numpy.stack([numpy.ones(4), c * c + s * s * math.cos(d), c * s * (1 - math.cos(d)), s * math.sin(d)], axis=1)
    seeming = numpy.linalg.norm(numpy.linalg.solve(rows, numpy.arange(4) - 1.5)[1:])
    # Two digits are printed of each, and the mirror before it polarizes by some 3 %.
    assert float(told[2]) / float(told[1]) == pytest.approx(seeming, rel=0.1)


BAD = [("exposure_s = 0", "exposure_s = 0"), ("exposure_s = 1\ncadence_s = 0.5", "cannot overlap"),
       ("exposure_s = 1\n[telescope]\nobstruction = 1", "0 to below 1"),
       ("exposure_s = 1\n[telescope]\naperture_m = 0", "above 0"),
       ("exposure_s = 1\n[telescope]\nthroughput = 1.2", "0 to 1"),
       ("exposure_s = 1\n[telescope]\nfocal_length_m = 0", "above 0"),
       ("exposure_s = 1\n[detector]\ngain_e_adu = 0", "above 0"),
       ("exposure_s = 1\n[detector]\nbits = 33", "1 to 32"),
       ("exposure_s = 1\n[detector]\nread_e = -1", "0 to 10000 electrons"),
       ('exposure_s = 1\n[detector]\nmodel = "ccd"\nem_gain = 300', "only an emccd"),
       ('exposure_s = 1\n[detector]\nshutter = "rolling"', "line_time_s"),
       ("exposure_s = 1\n[polarimeter]\nlayout = [[90, 45], [135, 90]]", "[[90, 45], [135, 0]]"),
       ("exposure_s = 1\n[polarimeter]\nretardence_deg = 90", "retardance_deg")]


@pytest.mark.parametrize("observation, told", BAD)
def test_what_is_refused(scene, umov, observation, told):
    done = umov("observe", scene("c11_imx250", observation), "--force")
    assert done.code == 3, done.err
    assert told in done.err and "observe.toml:" in done.err


def test_what_a_scenario_must_have(scene, umov, tmp_path):
    path = scene("c11_imx250", "exposure_s = 1")
    text = path.read_text()
    path.write_text(text.replace("c11_imx250", "c11_imx25"))
    done = umov("observe", path)
    assert done.code == 3 and 'Did you mean "c11_imx250"' in done.err
    path.write_text(text.split("[observation]")[0])
    done = umov("observe", path)
    assert done.code == 3 and "umov instrument list" in done.err
    own = 'exposure_s = 1\n[polarimeter]\ntype = "hwp_dual_beam"'
    path.write_text(scene("c11_imx250", own).read_text().replace(
        'instrument = "c11_imx250"', "") + "\n[telescope]\naperture_m = 1\nfocal_length_m = 8\n[detector]\npixel_um = 9\n")
    done = umov("observe", path)
    assert done.code == 3 and "x_axis_deg" in done.err


def test_full_wells_end_it(scene, umov):
    done = umov("observe", scene("c11_imx250", "exposure_s = 20", air='sky = { mag = 3.0 }'))
    assert done.code == 4 and "saturated" in done.err


def test_states_that_cannot_tell_a_parameter(scene, umov, tmp_path):
    own = ('exposure_s = 1\nsequence = [{ plate_deg = 0 }, { plate_deg = 45 }, { plate_deg = 90 }, { plate_deg = 135 }]'
           "\n[polarimeter]\nretardance_deg = 90")
    done = umov("observe", scene("full_stokes_3m6", own))
    assert done.code == 3 and "condition number" in done.err


COUNTS = """time_utc,set_id,band,counts,sky,sky_err,var_read,w0,w1,w2,w3
2018-01-21T05:12:00Z,1,V,3120,120,3.464,234,.49,.4867,0,0
2018-01-21T05:12:00Z,1,V,2705,120,3.464,234,.5,0,.4967,0
2018-01-21T05:12:00Z,1,V,2210,120,3.464,234,.51,-.5066,0,0
2018-01-21T05:12:00Z,1,V,2650,120,3.464,234,.505,0,-.5016,0
"""


def test_own_counts_are_reduced(umov, tmp_path):
    """The worked set of docs/theory/observing.md 6 (anchors: fit_q, fit_u, fit_sd_q), typed to four digits."""
    (tmp_path / "own.csv").write_text(COUNTS)
    done = umov("reduce", "own.csv", "-o", "own.ecsv")
    assert done.code == 0, done.err
    row = Table.read(tmp_path / "own.ecsv")[0]
    assert abs(row["q"] - 0.19940) < 2e-4 and abs(row["u"] - 0.01584) < 2e-4
    assert abs(math.sqrt(row["cov_qq"]) - 0.014814) < 2e-5


def test_magnitudes_for_others(scene, umov, tmp_path):
    """A TDM that umov reads again, and the columns of SCORE's template."""
    path = scene("c11_imx250", "exposure_s = 1")
    assert umov("observe", path).code == 0
    done = umov("reduce", "out/counts.ecsv", "-o", "s.ecsv", "--tdm", "s.tdm", "--score", "s.csv")
    assert done.code == 0, done.err
    stokes = Table.read(tmp_path / "s.ecsv")
    lines = (tmp_path / "s.tdm").read_text().splitlines()
    mags = [line.split() for line in lines if line.startswith("MAG ")]
    assert len(mags) == len(stokes) and abs(float(mags[0][3]) - stokes["mag"][0]) < 1e-5
    for word in ("CCSDS_TDM_VERS = 2.0", "ANGLE_TYPE", "RADEC", "INTEGRATION_REF", "MIDDLE", "s.ecsv"):
        assert word in "\n".join(lines)
    score = Table.read(tmp_path / "s.csv", format="ascii.csv")
    assert score.colnames[:3] == ["satellite_name", "norad_cat_id", "observation_time_utc"] and len(score.colnames) == 27
    assert score["norad_cat_id"][0] == 20580 and abs(score["observer_latitude_deg"][0] - 20.7083) < 1e-6
    assert abs(score["satellite_right_ascension_deg"][0] - stokes["ra"][0]) < 1e-5


def test_brightness_without_a_period(scene, umov, tmp_path):
    _, _, _ = observed(umov, tmp_path, scene("usafa16", "exposure_s = 2", seconds=59), "--model", "spline:20")
    row = Table.read(tmp_path / "stokes.ecsv")[0]
    assert 0 < row["mag"] < 20 and row["dof"] > 0
    assert umov("reduce", "out/counts.ecsv", "--model", "spline:0").code == 2


def test_half_turns_of_a_plate_test_each_other(scene, umov, tmp_path):
    plates = ", ".join(f"{{ plate_deg = {22.5 * k} }}" for k in range(8))
    stokes, _, _ = observed(umov, tmp_path, scene("hwp_wollaston_1m", f"exposure_s = 0.02\ncadence_s = 0.1\nsequence = [{plates}]",
                                                  air='scintillation = "none"'))
    # Two independent halves: half their difference is as uncertain as their mean.
    pulls_of = [row["null_q"] / math.sqrt(row["cov_qq"]) for row in stokes]
    assert umov("reduce", "out/counts.ecsv", "--page", "s.html", "-o", "s.ecsv").code == 0
    assert "Null tests: one half turn" in (tmp_path / "s.html").read_text()
    n = len(pulls_of)
    assert n > 50 and abs(statistics.mean(pulls_of)) < 4 / math.sqrt(n) + 0.1
    assert abs(statistics.stdev(pulls_of) - 1) < 4 / math.sqrt(2 * n) + 0.1


def test_thin_cloud_leaves_two_beams_alone(scene, umov, tmp_path):
    """A tenth of a magnitude that wanders: told, q and u are within their errors, and no fit is called bad."""
    path = scene("hwp_wollaston_1m", "exposure_s = 0.02\ncadence_s = 0.1",
                 air='scintillation = "none"\ncloud = { sd_mag = 0.1, time_s = 0.05 }')
    stokes, truth, said = observed(umov, tmp_path, path)
    assert "cloud (--transparency-sd)" in said
    stokes, truth, said = observed(umov, tmp_path, path, "--transparency-sd", 0.1)
    assert "misfit" not in said
    found = pulls(stokes, truth)
    for name in "qu":
        n = len(found[name])
        assert n >= 140 and abs(statistics.stdev(found[name]) - 1) < 4 / math.sqrt(2 * n), name
        assert abs(statistics.mean(found[name])) < 4 / math.sqrt(n), name
    assert umov("reduce", "out/counts.ecsv", "--transparency-sd", "-1").code == 2


def test_gaps_are_told(umov, tmp_path):
    rows = COUNTS.splitlines()
    late = [row.replace("05:12:00", f"05:{minute}") for row, minute in
            zip(rows[1:], ("12:00", "12:01", "12:02", "12:03"))]
    more = [row.replace("05:12:00Z,1", f"05:{minute}Z,2") for row, minute in
            zip(rows[1:], ("12:04", "12:05", "12:06", "32:07"))]
    (tmp_path / "gap.csv").write_text("\n".join([rows[0], *late, *more]) + "\n")
    done = umov("reduce", "gap.csv")
    assert done.code == 0 and "1 gap of up to" in done.err, done.err


BAD_COUNTS = [(COUNTS.replace(",var_read", ",read"), "var_read"), (COUNTS.replace("234", "-234"), "variances"),
              (COUNTS.replace("05:12:00Z,1,V,2650", "05:11:00Z,1,V,2650"), "times go back"),
              (COUNTS.replace("2705", "many"), "no number"), (COUNTS.replace("2705", "1e200"), "electrons"),
              ("\n".join(COUNTS.splitlines()[:3]) + "\n", "cannot tell"), ("", "holds no table")]


@pytest.mark.parametrize("text, told", BAD_COUNTS)
def test_counts_that_are_refused(umov, tmp_path, text, told):
    (tmp_path / "bad.csv").write_text(text)
    done = umov("reduce", "bad.csv")
    assert done.code == 3 and told in done.err, done.err


def test_counts_that_are_no_number_are_left_out(umov, tmp_path):
    (tmp_path / "gap.csv").write_text(COUNTS.replace("2650", "nan"))
    done = umov("reduce", "gap.csv")
    assert done.code == 0 and "rows left out: without counts" in done.err


def test_instruments_say_what_was_assumed(umov, tmp_path):
    names = [line.split()[0] for line in umov("instrument", "list").out.splitlines()[1:]]
    assert "c11_imx250" in names and len([n for n in names if "_" in n]) >= 5
    shown = umov("instrument", "show", "moptop_2m", "-o", "own.toml")
    assert shown.code == 0
    again = umov("instrument", "show", "own.toml")
    assert again.out == (tmp_path / "own.toml").read_text()
    assert "assumed" in again.out


def standards(path, q0=0.0042, u0=-0.0018, efficiency=0.985, phi0=0.8):
    """Counts of four ideal orientations, 1e8 electrons: an unpolarized star and HD 204827, instrument turned."""
    lines = ["# instrument: own", "# pol_frame: equatorial",
             "time_utc,set_id,name,band,x_axis_pa,counts,sky,sky_err,var_read,w0,w1,w2,w3"]
    for number, (name, p, axis) in enumerate([("none", 0, a) for a in (0, 30, 60, 90)] +
                                             [("HD 204827", 0.04893, a) for a in (10, 40, 70, 100)]):
        x = 2 * math.radians(59.10 - axis)
        turn = 2 * math.radians(phi0)
        q = efficiency * p * math.cos(x + turn) + q0
        u = efficiency * p * math.sin(x + turn) + u0
        for angle in (0, 45, 90, 135):
            a = 2 * math.radians(angle)
            b = 2 * math.radians(angle + axis)
            counts = 2.5e7 * (1 + q * math.cos(a) + u * math.sin(a))
            lines.append(f"2018-01-21T05:{number:02}:00Z,{number},{name},V,{axis},{counts!r},0,0,0,"
                         f".25,{math.cos(b) / 4!r},{math.sin(b) / 4!r},0")
    path.write_text("\n".join(lines) + "\n")


def test_standards_calibrate_an_instrument(umov, tmp_path):
    standards(tmp_path / "stars.csv")
    (tmp_path / "known.csv").write_text("name,p_percent,pa_deg\nnone,0,0\nHD 204827,4.893,59.10\n")
    done = umov("calibrate", "stars.csv", "--standards", "known.csv", "-o", "own.toml")
    assert done.code == 0, done.err
    found = dict(line.split(" = ") for line in (tmp_path / "own.toml").read_text().splitlines() if " = " in line
                 and not line.startswith("#"))
    # What the counts were made with; 1e8 electrons would leave 1.4e-4 of noise, these have none.
    assert abs(float(found["efficiency"]) - 0.985) < 1e-6 and abs(float(found["phi0_deg"]) - 0.8) < 1e-4
    assert abs(float(found["q0"]) - 0.0042) < 1e-7 and abs(float(found["u0"]) + 0.0018) < 1e-7
    done = umov("reduce", "stars.csv", "--calibration", "own.toml", "-o", "back.ecsv")
    assert done.code == 0, done.err
    for row in Table.read(tmp_path / "back.ecsv"):
        if row["name"] != "none":
            assert abs(row["p"] - 0.04893) < 1e-6 and abs(row["pa"] - 59.10) < 1e-3


def test_calibrations_that_are_refused(umov, tmp_path):
    standards(tmp_path / "stars.csv")
    (tmp_path / "none.csv").write_text("name,p_percent,pa_deg\nnone,0,0\n")
    done = umov("calibrate", "stars.csv", "--standards", "none.csv")
    assert done.code == 3 and "polarized" in done.err
    (tmp_path / "other.csv").write_text("name,p_percent,pa_deg\nVega,0,0\n")
    assert umov("calibrate", "stars.csv", "--standards", "other.csv").code == 3
    (tmp_path / "known.csv").write_text("name,p_percent,pa_deg\nnone,0,0\nHD 204827,4.893,59.10\n")
    assert umov("calibrate", "stars.csv", "--standards", "known.csv", "-o", "own.toml").code == 0
    for key, other in (("instrument", "own"), ("band", "V")):
        text = (tmp_path / "own.toml").read_text().replace(f'{key} = "{other}"', f'{key} = "another"')
        (tmp_path / "wrong.toml").write_text(text)
        done = umov("reduce", "stars.csv", "--calibration", "wrong.toml")
        assert done.code == 3 and "another" in done.err


@pytest.mark.parametrize("unit, told", [(0.01, "efficiency = 98.5"), (20, "efficiency = 0.00985")])
def test_standards_in_another_unit_are_refused(umov, tmp_path, unit, told):
    standards(tmp_path / "stars.csv", efficiency=0.985 if unit < 1 else 0.00985)
    p = 4.893 * unit if unit < 1 else 4.893
    (tmp_path / "known.csv").write_text(f"name,p_percent,pa_deg\nnone,0,0\nHD 204827,{p},59.10\n")
    done = umov("calibrate", "stars.csv", "--standards", "known.csv", "-o", "own.toml")
    assert done.code == 3 and "in per cent" in done.err and not (tmp_path / "own.toml").exists(), done.err
    assert told in done.err, done.err


def test_a_wrong_polarization_leaves_the_photometry(umov, tmp_path):
    """What hinders one of both fits is a warning: p as a fraction is none of the magnitudes."""
    standards(tmp_path / "stars.csv")
    lines = (tmp_path / "stars.csv").read_text().splitlines()
    text = ["# zero_flux V: 3e-11", *lines[:2], lines[2] + ",airmass,k_mag"]
    text += [f"{line},{1 + k // 4 / 10},0.12" for k, line in enumerate(lines[3:])]
    (tmp_path / "stars.csv").write_text("\n".join(text) + "\n")
    (tmp_path / "known.csv").write_text("name,p_percent,pa_deg,mag\nnone,0,0,8\nHD 204827,0.04893,59.10,9\n")
    done = umov("calibrate", "stars.csv", "--standards", "known.csv", "-o", "own.toml")
    assert done.code == 0 and "in per cent" in done.err, done.err
    own = (tmp_path / "own.toml").read_text()
    assert "\nzero_mag = " in own and "\nefficiency" not in own, own


def test_how_long_to_expose(umov, tmp_path):
    """C11 at magnitude 8: 2/D^2 electrons for a variance of p of 1e-4, D = 299/301 of the camera's 300, and a little noise of the camera."""
    done = umov("exposure", "--instrument", "c11_imx250", "--mag", 8, "-o", "e.csv")
    assert done.code == 0, done.err
    rows = {line.split(",")[0]: float(line.split(",")[1])
            for line in (tmp_path / "e.csv").read_text().splitlines() if line[0] not in "#q"}
    assert abs(rows["electrons"] * rows["share_star"] - 2e4 * (301 / 299) ** 2) < 1
    assert abs(rows["time"] * rows["rate"] / rows["electrons"] - 1) < 1e-6
    assert abs(rows["share_star"] + rows["share_sky"] + rows["share_dark"] + rows["share_read"] - 1) < 1e-6
    assert umov("exposure", "--instrument", "c11_imx250", "--alt", 1).code == 2
    # Wind of 20 m/s crosses .279 m in 8.6 ms (.614 D/V).
    for seconds, is_told in ((0.001, True), (0.1, False)):
        done = umov("exposure", "--instrument", "c11_imx250", "--mag", 8, "--exposure-s", seconds)
        assert done.code == 0 and ("takes 0.0086 s to cross" in done.err) == is_told, done.err


def test_names_of_light_above_and_behind_the_air_mean_it(scene, umov, tmp_path):
    """I above, I_obs behind: apart by the extinction that the counts state."""
    stokes, _, _ = observed(umov, tmp_path, scene("c11_imx250", "exposure_s = 0.05"))
    counts = Table.read(tmp_path / "out/counts.ecsv")
    row, first = stokes[0], counts[0]
    lost = -2.5 * math.log10(row["I_obs"] / row["I"])
    assert lost > 0.05 and lost == pytest.approx(first["k_mag"] * first["airmass"], rel=1e-3)
