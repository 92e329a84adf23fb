"""What umov reduce and calibrate refuse or warn of: every line tried."""
import math
import re

import pytest

from conftest import read_csv
from sphere_over_maui import make_sphere, write_scene
from test_observe import COUNTS, standards

KNOWN = "name,p_percent,pa_deg\nnone,0,0\nHD 204827,4.893,59.10\n"


def sky_of(level):
    """The worked set under a sky of so many electrons."""
    head, *rows = COUNTS.splitlines()
    out = [head]
    for row in rows:
        cells = row.split(",")
        cells[3], cells[4] = f"{float(cells[3]) - 120 + level}", f"{level}"
        out.append(",".join(cells))
    return "\n".join(out) + "\n"


@pytest.fixture
def calibrated(umov, tmp_path):
    """stars.csv and own.toml, its calibration."""
    standards(tmp_path / "stars.csv")
    (tmp_path / "known.csv").write_text(KNOWN)
    assert umov("calibrate", "stars.csv", "--standards", "known.csv", "-o", "own.toml").code == 0
    return tmp_path


def test_more_polarized_than_light_can_be(umov, tmp_path):
    # q = (3000 - 400)/(.3 times 4080) with its sd of .015: far beyond 1.
    (tmp_path / "c.csv").write_text(COUNTS.replace(".4867,0", ".3,0").replace("-.5066,0", "-.3,0").replace("2210", "520"))
    done = umov("reduce", "c.csv")
    assert done.code == 0 and "|q| above 1 by more than five standard deviations" in done.err, done.err


def test_a_sky_brighter_than_ten_objects(umov, tmp_path):
    (tmp_path / "c.csv").write_text(sky_of(1e5))
    done = umov("reduce", "c.csv")
    assert done.code == 0 and "more than ten times as bright" in done.err, done.err
    (tmp_path / "c.csv").write_text(sky_of(120))
    assert "ten times" not in umov("reduce", "c.csv").err


def test_old_calibrations_are_told(umov, calibrated):
    for day, is_old in (("2017-11-01", True), ("2018-01-01", False)):
        text = re.sub("made_utc = .*", f'made_utc = "{day}T00:00:00Z"', (calibrated / "own.toml").read_text())
        (calibrated / "then.toml").write_text(text)
        done = umov("reduce", "stars.csv", "--calibration", "then.toml")
        assert done.code == 0 and ("81 days older" in done.err) == is_old, done.err


def test_a_calibration_in_another_frame(umov, calibrated):
    (calibrated / "own.toml").write_text((calibrated / "own.toml").read_text().replace('"equatorial"', '"altaz"'))
    done = umov("reduce", "stars.csv", "--calibration", "own.toml")
    assert done.code == 3 and "own.toml:" in done.err and '"equatorial" was expected' in done.err


def test_standards_at_one_angle(umov, tmp_path):
    """Told where the unpolarized star saves it, refused where nothing does."""
    (tmp_path / "known.csv").write_text(KNOWN)
    standards(tmp_path / "stars.csv")
    notes = [line for line in (tmp_path / "stars.csv").read_text().splitlines()]
    kept = notes[:3] + [line for line in notes[3:] if line.split(",")[4] == "10" or line.split(",")[4] == "0"]
    # One star each, both read as at 10 deg: an unpolarized one has no angle.
    (tmp_path / "one.csv").write_text("\n".join(line.replace(",V,0,", ",V,10,") for line in kept) + "\n")
    done = umov("calibrate", "one.csv", "--standards", "known.csv")
    assert done.code == 0 and "stand at one angle" in done.err, done.err
    alone = [line for line in kept if ",none," not in line]
    (tmp_path / "alone.csv").write_text("\n".join(alone + [line.replace(":04:00Z,4", ":09:00Z,9") for line in alone[3:]]) + "\n")
    done = umov("calibrate", "alone.csv", "--standards", "known.csv")
    assert done.code == 3 and "cannot be told apart" in done.err, done.err


def test_standards_that_disagree(umov, calibrated):
    known = umov("calibrate", "stars.csv", "--standards", "known.csv").err
    assert "disagree" not in known, known
    swapped = (calibrated / "stars.csv").read_text().replace(",V,40,", ",V,140,")
    (calibrated / "swapped.csv").write_text(swapped)
    done = umov("calibrate", "swapped.csv", "--standards", "known.csv")
    assert done.code == 0 and "disagree by more than their errors" in done.err, done.err
    assert "# warning: chi2" in done.out and "efficiency = " in done.out
    (calibrated / "known.toml").write_text(done.out)  # and can be read with it
    assert umov("reduce", "stars.csv", "--calibration", "known.toml").code == 0


def test_an_instrument_is_known_no_better_than_its_stars(umov, calibrated):
    """1e8 electrons tell the efficiency to .0015; HD 204827 is known to .029 % of its 4.893 (Schmidt et al. 1992), and to .17 deg."""
    (calibrated / "known.csv").write_text("name,p_percent,p_err_percent,pa_deg,pa_err_deg\nnone,0,,0,\nHD 204827,4.893,.029,59.10,.17\n")
    done = umov("calibrate", "stars.csv", "--standards", "known.csv")
    assert done.code == 0, done.err
    plain = float(re.search(r"efficiency_sd = (\S+)", (calibrated / "own.toml").read_text())[1])
    found = float(re.search(r"efficiency_sd = (\S+)", done.out)[1])
    star = 0.985 * math.sqrt((0.029 / 4.893) ** 2 / 2 + (2 * math.radians(0.17)) ** 2 / 2)  # mean square of along and across
    assert found == pytest.approx(math.hypot(plain, star), rel=1e-6)
    (calibrated / "known.csv").write_text("name,p_percent,p_err_percent,pa_deg\nnone,0,0,0\nHD 204827,4.893,-1,59.10\n")
    done = umov("calibrate", "stars.csv", "--standards", "known.csv")
    assert done.code == 3 and "known.csv:3" in done.err and "p_err_percent" in done.err, done.err


def test_standards_without_polarization(umov, calibrated):
    (calibrated / "flat.csv").write_text("name,p_percent,pa_deg\nnone,0,0\nHD 204827,0,0\n")
    done = umov("calibrate", "stars.csv", "--standards", "flat.csv")
    assert done.code == 3 and "no polarized one among them" in done.err


def test_full_channels_are_left_out_of_a_series_aloud(umov, tmp_path):
    """Analysers in turn on a steady source, .25 s each; three counts are full, and far too low."""
    lines = ["time_utc,set_id,band,counts,sky,sky_err,var_read,saturated,w0,w1,w2,w3"]
    for k in range(240):
        w1, w2 = ((.5, 0), (0, .5), (-.5, 0), (0, -.5))[k % 4]
        is_full = k in (30, 31, 32)
        counts = 40 if is_full else 8000 * (.5 + .1 * w1 - .05 * w2)
        lines.append(f"2018-01-21T05:0{k // 240}:{k / 4 % 60:06.3f}Z,{k // 4},nm:550,{counts},0,0,0,{is_full},.5,{w1},{w2},0")
    (tmp_path / "c.csv").write_text("\n".join(lines) + "\n")
    for model in ("spline:10", "fourier:20:2"):
        done = umov("reduce", "c.csv", "--model", model, "-o", "s.csv")
        assert done.code == 0 and "3 counts of 240 left out of the series: they are saturated" in done.err, done.err
        row = read_csv(tmp_path / "s.csv")[0]
        assert float(row["q"]) == pytest.approx(.1, abs=1e-6) and float(row["u"]) == pytest.approx(-.05, abs=1e-6)
    (tmp_path / "c.csv").write_text("\n".join(lines).replace("False", "True") + "\n")
    done = umov("reduce", "c.csv", "--model", "spline:10")
    assert done.code == 4 and "every channel is saturated" in done.err


@pytest.mark.parametrize("spoil, words", [
    (lambda text: text + text.splitlines()[-1] + "\n", ":6: the same row a second time"),
    (lambda text: "# retardance_deg V: lots\n" + text, "retardance_deg V of the header is \"lots\""),
    (lambda text: "", "holds no table"),
])
def test_tables_that_are_refused(umov, tmp_path, spoil, words):
    (tmp_path / "c.csv").write_text(spoil(COUNTS))
    done = umov("reduce", "c.csv")
    assert done.code == 3 and words in done.err, done.err


def test_a_channel_twice_is_refused(umov, tmp_path):
    """Two rows of one channel would make errors too small by the square root of two; of other exposures they are not the same."""
    head, *rows = COUNTS.splitlines()
    named = [head + ",channel,exposure"] + [row + f",{k},0" for k, row in enumerate(rows)]
    (tmp_path / "c.csv").write_text("\n".join(named) + "\n")
    assert umov("reduce", "c.csv").code == 0
    (tmp_path / "c.csv").write_text("\n".join(named + [rows[0] + ",0,0"]) + "\n")
    done = umov("reduce", "c.csv")
    assert done.code == 3 and 'channel "0" a second time in this exposure' in done.err, done.err
    (tmp_path / "c.csv").write_text("\n".join(named + [row + f",{k},1" for k, row in enumerate(rows)]) + "\n")
    assert umov("reduce", "c.csv").code == 0


def test_counts_below_nothing_are_told(umov, tmp_path):
    (tmp_path / "c.csv").write_text(COUNTS.replace("2210", "-2210"))
    done = umov("reduce", "c.csv")
    assert "1 of 4 counts below 0 by more than reading does" in done.err, done.err


INSTRUMENTS = ["c11_imx250", "usafa16", "mmt9_channel", "hwp_wollaston_1m", "moptop_2m", "full_stokes_3m6"]
OWN = {"flc": 'type = "flc"', "pem": 'type = "pem"', "wheel": 'type = "polarizer_wheel"'}


@pytest.mark.parametrize("instrument, polarimeter, telescope", [(name, "", "") for name in INSTRUMENTS] + [
    ("hwp_wollaston_1m", OWN["flc"], ""), ("hwp_wollaston_1m", OWN["pem"], ""), ("c11_imx250", "", 'port = "nasmyth_left"'),
    ("c11_imx250", "", 'port = { mirrors = ["left", "down"] }'), ("usafa16", OWN["wheel"], 'mount = "altaz"\nport = "nasmyth_right"'),
    ("usafa16", "", 'mount = "altaz"')])
def test_angles_and_rows_of_observe_agree(umov, tmp_path, instrument, polarimeter, telescope):
    """Whatever turns the light before the analysers, no table of umov observe contradicts itself."""
    make_sphere(umov, 0.2)
    path = write_scene(tmp_path, 'bands = ["nm:550"]\nexposure_s = 0.1' + (polarimeter and "\n[polarimeter]\n" + polarimeter),
                       instrument=instrument, telescope=telescope)
    done = umov("observe", path)
    assert done.code == 0, done.err
    done = umov("reduce", "out/counts.ecsv", "-o", "s.ecsv")
    assert done.code == 0 and "analyser_deg" not in done.err, done.err


def test_angles_that_contradict_their_rows_are_told(umov, tmp_path):
    """Names of two orientations exchanged: the weights are what is fitted, and one of the two is wrong."""
    make_sphere(umov, 0.2)
    assert umov("observe", write_scene(tmp_path, 'bands = ["nm:550"]\nexposure_s = 1')).code == 0
    lines = (tmp_path / "out/counts.ecsv").read_text().splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("time_utc"))
    at = lines[head].split().index("analyser_deg")
    for k in range(head + 1, len(lines)):
        cells = lines[k].split()
        cells[at] = {"45": "90", "90": "45"}.get(cells[at], cells[at])
        lines[k] = " ".join(cells)
    (tmp_path / "swapped.ecsv").write_text("\n".join(lines) + "\n")
    done = umov("reduce", "swapped.ecsv", "-o", "s.ecsv")
    told = re.search(r"swapped.ecsv:(\d+): analyser_deg = (\d+), but w1 = \S+, w2 = \S+ are those of an analyser at (\d+) deg", done.err)
    assert done.code == 0 and told, done.err
    assert int(told[1]) == head + 2 and {told[2], told[3]} == {"45", "90"}


FIELD_TURNS = """time_utc,set_id,band,counts,sky,sky_err,var_read,w0,w1,w2,w3,exposure
2018-01-21T05:00:00Z,1,nm:550,399992,0,0,36,0.5,0.137818678,0.480630848,0,0
2018-01-21T05:00:00Z,1,nm:550,400243,0,0,36,0.5,-0.137818678,-0.480630848,0,0
2018-01-21T05:00:05Z,1,nm:550,398822,0,0,36,0.5,0.137818124,0.480631007,0,1
2018-01-21T05:00:05Z,1,nm:550,401601,0,0,36,0.5,-0.137818124,-0.480631007,0,1
"""


def test_a_field_that_hardly_turns_tells_no_second_parameter(umov, tmp_path):
    """One axis of the analyser, and a second of arc: q of 1165 came of it, or a crash."""
    (tmp_path / "c.csv").write_text(FIELD_TURNS)
    for more in ((), ("--transparency-sd", "0.1")):
        done = umov("reduce", "c.csv", *more)
        assert done.code == 3 and "cannot tell Q, U" in done.err, done.err


def test_analysers_at_times_of_their_own_share_no_cloud(umov, tmp_path):
    """A table without a column `exposure` has one for each time: errors are those of a table that numbers them."""
    rows = [(k, axis) for k, axis in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1)))]
    head = "time_utc,set_id,band,counts,sky,sky_err,var_read,w0,w1,w2,w3"
    text = [f"2018-01-21T05:00:0{k}Z,1,nm:550,100000,0,0,25,0.5,{q / 2},{u / 2},0" for k, (q, u) in rows]
    (tmp_path / "told.csv").write_text("\n".join([head + ",exposure", *(f"{row},{k}" for k, row in enumerate(text))]) + "\n")
    (tmp_path / "untold.csv").write_text("\n".join([head, *text]) + "\n")
    errors = []
    for name in ("told", "untold"):
        assert umov("reduce", f"{name}.csv", "--transparency-sd", "0.1", "-o", f"{name}_s.csv").code == 0
        errors.append(math.sqrt(float(read_csv(tmp_path / f"{name}_s.csv")[0]["cov_qq"])))
    assert errors[0] == errors[1]
    # q is the difference of two exposures over their sum: .1/sqrt 2 of it, but for photons (.003).
    assert errors[1] == pytest.approx(0.1 / math.sqrt(2), rel=0.08)


def test_no_output_is_an_input(umov, calibrated):
    before = (calibrated / "stars.csv").read_bytes()
    for words in (("reduce", "stars.csv", "-o", "stars.csv"), ("reduce", "stars.csv", "-o", "a.csv", "--score", "./a.csv"),
                  ("calibrate", "stars.csv", "--standards", "known.csv", "-o", "known.csv")):
        done = umov(*words)
        assert done.code == 2 and "another name was expected" in done.err, done.err
    assert (calibrated / "stars.csv").read_bytes() == before and not (calibrated / "a.csv").exists()
