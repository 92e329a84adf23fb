"""What umov reduce and calibrate refuse or warn of: every line tried."""
import math
import re
import warnings

import pytest
from astropy.table import Table

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


def test_times_of_an_object_that_go_back_between_those_of_another(umov, tmp_path):
    """Two objects in turn, each in the order of time or not; clouds are by the time between."""
    head, *rows = COUNTS.splitlines()

    def table(times):
        lines = [head.replace("time_utc", "name,time_utc")]
        for row, (a, b) in zip(rows, times):
            lines += [f"{name},2018-01-21T05:12:{second:02d}Z,{row.split(',', 1)[1]}" for name, second in (("A", a), ("B", b))]
        return "\n".join(lines) + "\n"

    cloud = ("--transparency-sd", ".1", "--transparency-time-s", "5", "-o", "s.csv")
    (tmp_path / "c.csv").write_text(table([(10, 0), (13, 1), (14, 2), (15, 3)]))
    assert umov("reduce", "c.csv", *cloud).code == 0
    assert all(float(row["I_err"]) > 0 for row in read_csv(tmp_path / "s.csv"))
    (tmp_path / "c.csv").write_text(table([(10, 0), (3, 1), (4, 2), (5, 3)]))
    done = umov("reduce", "c.csv", *cloud)
    assert done.code == 3 and "c.csv:4" in done.err and "times go back" in done.err and "05:12:03" in done.err, done.err


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
    for day, told in (("2017-11-01", "81 days older"), ("2018-01-01", None), ("2019-01-21", "365 days younger")):
        text = re.sub("made_utc = .*", f'made_utc = "{day}T00:00:00Z"', (calibrated / "own.toml").read_text())
        (calibrated / "then.toml").write_text(text)
        done = umov("reduce", "stars.csv", "--calibration", "then.toml")
        assert done.code == 0 and ((told in done.err) if told else "days" not in done.err), done.err


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


@pytest.mark.parametrize("line, told", [
    ("pupils: seperate", '"separate" or "common" was expected'), ("parameters: five", "1 (I), 3 (I, Q, U) or 4 (V too)"),
    ("parameters: 2", "1 (I), 3 (I, Q, U) or 4 (V too)"), ("zero_flux V: bright", "a flux above 0"), ("zero_flux V: -1e-11", "a flux above 0"),
    ("cloud_time_s: long", "a number of seconds"), ("cloud_time_s:long", "a number of seconds"), ("cloud_time_s = long", "a number of seconds"),
    ("site_lat_deg: abc", "a latitude"), ("site_lat_deg: 99", "a latitude"), ("site_lon_deg: 500", "a longitude"),
    ("site_alt_m: 1e9", "a height"), ("pol_frame:galactic", "pol_frame of the header")])
def test_headers_that_say_nothing_are_refused(umov, tmp_path, line, told):
    (tmp_path / "c.csv").write_text(f"# {line}\n" + COUNTS)
    done = umov("reduce", "c.csv")
    assert done.code == 3 and told in done.err and "c.csv" in done.err, done.err


@pytest.mark.parametrize("line", ["zero_flux: 3e-11", "zero_flux W: 3e-11"])
def test_zero_fluxes_of_no_band_are_told(umov, tmp_path, line):
    (tmp_path / "c.csv").write_text(f"# {line}\n" + COUNTS)
    done = umov("reduce", "c.csv")
    assert done.code == 0 and "is of no band of the counts" in done.err, done.err


@pytest.mark.parametrize("line", ["Cloud_Time_s: 60", "Pol_frame: altaz"])
def test_keys_of_the_header_in_other_letters_are_told(umov, tmp_path, line):
    (tmp_path / "c.csv").write_text(f"# {line}\n" + COUNTS)
    done = umov("reduce", "c.csv")
    assert done.code == 0 and "of the header says nothing" in done.err, done.err


def test_zero_fluxes_of_bands_that_were_taken_out_are_not_told(umov, tmp_path):
    (tmp_path / "c.csv").write_text("# zero_flux V: 3e-11\n# zero_flux R: 2e-11\n" + COUNTS)
    done = umov("reduce", "c.csv")
    assert done.code == 0 and "zero_flux" not in done.err, done.err


def changed(column, value):
    head, *rows = COUNTS.splitlines()
    names = head.split(",")
    if column not in names:
        return "\n".join([head + "," + column] + [f"{row},{value}" for row in rows]) + "\n"
    cells = rows[0].split(",")
    cells[names.index(column)] = value
    return "\n".join([head, ",".join(cells), *rows[1:]]) + "\n"


@pytest.mark.parametrize("column, value, told", [
    ("airmass", "-1.2", "airmass = -1.2; 1 or more was expected"), ("k_mag", "25", "k_mag = 25; -1 to 20"), ("phase_angle", "500", "phase_angle = 500"), ("dec", "95", "dec = 95"), ("range", "-5", "range = -5"), ("w1", "0.6", "less than no counts"), ("w3", "-0.7", "less than no counts")])
def test_rows_that_no_telescope_has(umov, tmp_path, column, value, told):
    (tmp_path / "c.csv").write_text(changed(column, value))
    done = umov("reduce", "c.csv")
    assert done.code == 3 and told in done.err and "c.csv:2" in done.err, done.err


def test_counts_without_sky_say_so(umov, tmp_path):
    (tmp_path / "c.csv").write_text(changed("sky", ""))
    done = umov("reduce", "c.csv")
    assert "without sky" in done.err and "without counts" not in done.err, done.err


def test_angles_that_no_instrument_has(umov, calibrated):
    text = re.sub("phi0_deg = .*", "phi0_deg = 900", (calibrated / "own.toml").read_text(), count=1)
    (calibrated / "wrong.toml").write_text(text)
    done = umov("reduce", "stars.csv", "--calibration", "wrong.toml")
    assert done.code == 3 and "phi0_deg = 900; an angle of -360 to 360" in done.err, done.err


def test_offsets_that_no_instrument_has(umov, calibrated):
    text = re.sub("q0 = .*", "q0 = 7", (calibrated / "own.toml").read_text(), count=1)
    (calibrated / "own.toml").write_text(text)
    done = umov("reduce", "stars.csv", "--calibration", "own.toml")
    assert done.code == 3 and re.search(r"own.toml:\d+", done.err) and "q0 = 7" in done.err, done.err


def test_options_of_reduce_and_calibrate_that_say_nothing(umov, calibrated):
    done = umov("reduce", "stars.csv", "--colour", "0.9")
    assert done.code == 2 and "without a calibration of brightness" in done.err, done.err
    done = umov("reduce", "stars.csv", "--transparency-time-s", "60")
    assert done.code == 2 and "without --transparency-sd" in done.err, done.err
    # In per cent: magnitudes were 17 too bright and errors of q a thousandth.
    done = umov("reduce", "stars.csv", "--transparency-sd", "10")
    assert done.code == 2 and "10 % is 0.1" in done.err, done.err
    done = umov("calibrate", "stars.csv", "--polarizer", "--second-order")
    assert done.code == 2, done.err
    (calibrated / "known.csv").write_text("name,mag,color\nnone,8,0.5\n")
    done = umov("calibrate", "stars.csv", "--standards", "known.csv")
    assert done.code == 3 and '"colour" was expected' in done.err and "known.csv:1" in done.err, done.err
    (calibrated / "known.csv").write_text("name,mag,colour,color\nnone,8,0.5,blue\n")  # ours is there; the other is somebody's own
    assert '"colour" was expected' not in umov("calibrate", "stars.csv", "--standards", "known.csv").err


def test_lamps_without_an_analyser_tell_no_angle(umov, tmp_path):
    rows = [f"{angle},10000" for angle in range(0, 360, 20)]
    (tmp_path / "lamp.csv").write_text("angle_deg,counts\n" + "\n".join(rows) + "\n")
    done = umov("calibrate", "lamp.csv", "--polarizer", "-o", "rows.csv")
    assert done.code == 0 and "no angle is told" in done.err, done.err
    row = read_csv(tmp_path / "rows.csv")[0]
    assert row["analyser_deg"] in ("", "nan") and row["analyser_err"] in ("", "nan")


def named_counts(name, time="2018-01-21T05:12:00Z"):
    notes = "# zero_flux V: 3e-11\n# site: Läck\n# site_lat_deg: 20\n# site_lon_deg: -156\n# site_alt_m: 3058\n"
    head, *rows = COUNTS.splitlines()
    return notes + "\n".join([head + ",name"] + [f"{row.replace('2018-01-21T05:12:00Z', time)},{name}" for row in rows]) + "\n"


def test_forms_for_others_are_in_their_letters_and_digits(umov, tmp_path):
    """A TDM is of ASCII (CCSDS 503.0-B-2); I = 5100 +- 54 (docs/theory/observing.md 6) is .0115 mag: three digits behind the point."""
    (tmp_path / "c.csv").write_text(named_counts("Müll 7 – Stück"), encoding="utf-8")
    done = umov("reduce", "c.csv", "-o", "s.csv", "--tdm", "s.tdm", "--score", "score.csv")
    assert done.code == 0, done.err
    text = (tmp_path / "s.tdm").read_bytes().decode("ascii")
    assert re.search(r"PARTICIPANT_2 += M\?ll 7 \? St\?ck\n", text) and re.search(r"PARTICIPANT_1 += L\?ck\n", text), text
    cells = dict(zip(*[line.split(",") for line in (tmp_path / "score.csv").read_text(encoding="utf-8").splitlines()[:2]]))
    assert re.fullmatch(r"-?\d+\.\d{3}", cells["apparent_magnitude"]) and cells["apparent_magnitude_uncertainty"] in ("0.011", "0.012"), cells


def test_a_fits_table_has_the_names_of_light_curves(umov, tmp_path):
    """As lightkurve reads them: time (MJD), flux and its error; 05:12:00 is .216666... of a day, of MJD 58139."""
    (tmp_path / "c.csv").write_text(named_counts("ball"))
    assert umov("reduce", "c.csv", "-o", "s.fits").code == 0 and umov("reduce", "c.csv", "-o", "s.ecsv").code == 0
    fits, plain = Table.read(tmp_path / "s.fits"), Table.read(tmp_path / "s.ecsv")
    assert fits["time"][0] == pytest.approx(58139 + (5 + 12 / 60) / 24, abs=1e-9)
    assert fits["flux"][0] == plain["I"][0] and fits["flux_err"][0] == plain["I_err"][0]
    assert "flux" not in plain.colnames


def test_times_keep_their_microseconds(umov, tmp_path):
    (tmp_path / "c.csv").write_text(named_counts("ball", "2018-01-21T05:12:00.000250Z"))
    assert umov("reduce", "c.csv", "-o", "s.csv").code == 0
    assert read_csv(tmp_path / "s.csv")[0]["time_utc"] == "2018-01-21T05:12:00.000250Z"


def test_a_set_that_comes_again(umov, tmp_path):
    """Tables of two nights that were put together, each with its sets from 0: light of both would be one set."""
    head, *rows = COUNTS.splitlines()
    names = head.split(",")

    def with_set(row, number, day):
        cells = row.split(",")
        cells[names.index("set_id")] = str(number)
        cells[names.index("time_utc")] = cells[names.index("time_utc")].replace("2018-01-21", f"2018-01-{day}")
        return ",".join(cells)

    night = [[with_set(row, number, day) for row in rows] for number, day in ((0, 21), (1, 22), (0, 23), (2, 23))]
    (tmp_path / "c.csv").write_text("\n".join([head, *night[0], *night[1], *night[2]]) + "\n")
    done = umov("reduce", "c.csv")
    line = 2 + len(rows) * 2
    assert done.code == 3 and f"c.csv:{line}" in done.err and "set_id = 0 again after rows of set 1" in done.err, done.err
    assert "number the sets of each on" in done.err
    (tmp_path / "c.csv").write_text("\n".join([head, *night[0], *night[1], *night[3]]) + "\n")
    assert umov("reduce", "c.csv", "-o", "s.csv").code == 0 and len(read_csv(tmp_path / "s.csv")) == 3


@pytest.mark.parametrize("how", ["COMMENT pol_frame:altaz", "COMMENT pol_frame = altaz", "COMMENT pol_frame: altaz", "HISTORY pol_frame:altaz", "meta"])
def test_headers_of_fits_as_people_write_them(umov, tmp_path, how):
    """Of FITS as of text; astropy puts what Table.meta holds into keywords of its own."""
    (tmp_path / "c.csv").write_text(COUNTS)
    table = Table.read(tmp_path / "c.csv", format="ascii.csv")
    if how == "meta":
        table.meta = {"pol_frame": "altaz", "pupils": "neither"}
    else:
        table.meta = {how[:7].strip() if how.startswith("HISTORY") else "comments": [how[8:]]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # astropy tells of each long keyword
        table.write(tmp_path / "c.fits")
    done = umov("reduce", "c.fits", "-o", "s.ecsv")
    if how == "meta":
        assert done.code == 3 and 'pupils of the header is "neither"' in done.err, done.err
        table.meta = {"pol_frame": "altaz", "pupils": "separate"}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            table.write(tmp_path / "c.fits", overwrite=True)
        done = umov("reduce", "c.fits", "-o", "s.ecsv")
    assert done.code == 0 and Table.read(tmp_path / "s.ecsv").meta["pol_frame"] == "altaz", done.err


def test_the_axis_of_the_sky_must_be_known(umov, tmp_path):
    """An error of the sky's polarization widens q and u along the normal of the scattering plane, which counts must tell; q_scat of
    counts that do not is no number (it was q)."""
    (tmp_path / "c.csv").write_text(COUNTS)
    done = umov("reduce", "c.csv", "--sky-p-sd", ".02")
    assert done.code == 3 and "pa_scat" in done.err and "sky_p_sd" in done.err, done.err
    assert umov("reduce", "c.csv", "-o", "s.csv").code == 0
    assert read_csv(tmp_path / "s.csv")[0]["q_scat"] in ("", "nan")

    def errors(axis, sd):
        head, *rows = COUNTS.splitlines()
        (tmp_path / "c.csv").write_text("\n".join([head + ",pa_scat", *(f"{row},{axis}" for row in rows)]) + "\n")
        assert umov("reduce", "c.csv", "--sky-p-sd", sd, "-o", "s.csv").code == 0
        row = read_csv(tmp_path / "s.csv")[0]
        return float(row["cov_qq"]), float(row["cov_uu"])

    plain = errors(0, 0)
    # b = 120 e in each of four channels of w0 about .5: a sky of 240 e against I = 5100 e (worked set): .02 x 240/5100.
    along, across = errors(0, .02), errors(45, .02)
    added = (.02 * 240 / 5100) ** 2
    for found, index in ((along, 0), (across, 1)):
        assert found[index] - plain[index] == pytest.approx(added, rel=.05)  # channels' gains differ by 2 %
        assert abs(found[1 - index] - plain[1 - index]) < .05 * added
