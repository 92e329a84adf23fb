"""Standards of known magnitude: zero point, extinction and colour terms of `umov calibrate`, and what `umov reduce` makes of them."""
import re

import pytest

from conftest import read_csv

ZERO_FLUX = 3.6e-11
TRUTH = {"zero_mag": 0.05, "k_mag": 0.155, "colour_term": -0.03, "k2_mag": 0.02}
K_FILE = 0.12  # what the counts were written with
STARS = [("a", 8.0, 1.02, 0.05), ("b", 9.0, 1.21, 0.62), ("c", 8.5, 1.55, 1.10), ("d", 9.5, 1.08, 0.35), ("e", 9.1, 1.90, 0.71),
         ("f", 8.8, 1.37, -0.02), ("g", 9.3, 2.10, 1.25), ("h", 8.2, 1.15, 1.31)]


def counts_of(stars):
    """Counts without noise of stars (name, magnitude, air mass, colour) through the air and optics of TRUTH."""
    lines = [f"# zero_flux V: {ZERO_FLUX}", "# parameters: 1",
             "time_utc,set_id,name,band,counts,sky,sky_err,var_read,airmass,k_mag,w0,w1,w2,w3"]
    for number, (name, mag, x, colour) in enumerate(stars):
        behind = mag - TRUTH["zero_mag"] + TRUTH["k_mag"] * x + TRUTH["colour_term"] * colour - TRUTH["k2_mag"] * colour * x
        w0 = 1e25
        n = w0 * ZERO_FLUX * 10 ** (-0.4 * (behind - K_FILE * x))
        lines.append(f"2018-01-21T05:{number:02}:00Z,{number},{name},V,{n!r},0,0,0,{x},{K_FILE},{w0},0,0,0")
    return "\n".join(lines) + "\n"


def known(stars):
    return "name,mag,colour\n" + "".join(f"{name},{mag},{colour}\n" for name, mag, _, colour in stars)


def numbers_of(text):
    return {name: float(value) for name, value in re.findall(r"^(\w+) = (-?[\d.e-]+)$", text, re.M)}


def test_brightness_is_calibrated_and_taken_out(umov, tmp_path):
    (tmp_path / "stars.csv").write_text(counts_of(STARS))
    (tmp_path / "known.csv").write_text(known(STARS))
    done = umov("calibrate", "stars.csv", "--standards", "known.csv", "--second-order", "-o", "own.toml")
    assert done.code == 0, done.err
    text = (tmp_path / "own.toml").read_text()
    found = numbers_of(text)
    for name, value in TRUTH.items():  # counts without noise, of 1e11 electrons: rounding alone
        assert found[name] == pytest.approx(value, abs=1e-9), name
    assert "efficiency" not in text and found["residual_mag"] < 1e-9
    # Light of 9.4 mag, as red as 0.9, at an air mass of 1.7: not as the counts' own w0 has it.
    (tmp_path / "target.csv").write_text(counts_of([("it", 9.4, 1.7, 0.9)]))
    plain = umov("reduce", "target.csv", "-o", "plain.csv")
    done = umov("reduce", "target.csv", "--calibration", "own.toml", "--colour", "0.9", "-o", "own.csv")
    assert plain.code == 0 and done.code == 0, plain.err + done.err
    assert "Sun's colour" not in plain.err + done.err
    assert abs(float(read_csv(tmp_path / "plain.csv")[0]["mag"]) - 9.4) > 0.01
    row = read_csv(tmp_path / "own.csv")[0]
    assert float(row["mag"]) == pytest.approx(9.4, abs=1e-8)
    # What stands behind the air is what came: 9.4 mag and (k - k'' C) X.
    behind = 10 ** (-0.4 * (0.155 - 0.02 * 0.9) * 1.7)
    assert float(row["I_obs"]) / float(row["I"]) == pytest.approx(behind, rel=1e-9)
    assert float(row["airmass"]) == 1.7


def test_sets_without_light_are_left_out(umov, tmp_path):
    text = counts_of(STARS)
    dark = text.splitlines()[-1].split(",")
    dark[0], dark[1], dark[4], dark[5] = "2018-01-21T06:00:00Z", "99", "90", "100"  # less than its sky
    (tmp_path / "stars.csv").write_text(text + ",".join(dark) + "\n")
    (tmp_path / "known.csv").write_text(known(STARS))
    done = umov("calibrate", "stars.csv", "--standards", "known.csv", "--second-order")
    assert done.code == 0 and numbers_of(done.out)["k_mag"] == pytest.approx(TRUTH["k_mag"], abs=1e-9), done.err


def test_the_sun_is_the_colour_where_none_is_given(umov, tmp_path):
    (tmp_path / "stars.csv").write_text(counts_of(STARS))
    (tmp_path / "known.csv").write_text(known(STARS))
    assert umov("calibrate", "stars.csv", "--standards", "known.csv", "--second-order", "-o", "own.toml").code == 0
    (tmp_path / "target.csv").write_text(counts_of([("it", 9.4, 1.7, 0.653)]))  # B - V of the Sun, Ramirez et al. 2012
    done = umov("reduce", "target.csv", "--calibration", "own.toml", "-o", "own.csv")
    assert done.code == 0 and "taken to have the Sun's colour" in done.err, done.err
    assert float(read_csv(tmp_path / "own.csv")[0]["mag"]) == pytest.approx(9.4, abs=1e-8)


def test_errors_of_the_zero_point_reach_brightness(umov, tmp_path):
    """A zero point known to .02 mag, apertures to .02: .0184 and .02 of I, beside 4e-6 of photons."""
    (tmp_path / "target.csv").write_text(counts_of([("it", 9.4, 1.7, 0.9)]))
    for option, error in (("--zero-sd-mag", 0.018420681), ("--aperture-sd", 0.02)):  # ln 10/2.5 of .02
        assert umov("reduce", "target.csv", option, "0.02", "-o", "own.csv").code == 0
        row = read_csv(tmp_path / "own.csv")[0]
        assert float(row["I_err"]) / float(row["I"]) == pytest.approx(error, rel=1e-5)


@pytest.mark.parametrize("table, words", [
    ("name,mag\na,8\nb,9\n", ["2 measurements of standards do not tell zero point and extinction", "at least 3"]),
    ("name,mag,colour\na,8,\nb,9,.5\nc,9,.5\n", ["a colour stands beside 2 of 3"]),
    ("name,mag\na,bright\n", ["known.csv:2", "mag = \"bright\"", "a magnitude from -30 to 40"]),
    ("name,colour\na,.5\n", ["known.csv:1", "tells nothing of them"]),
    ("name,p_percent,mag\na,5,8\n", ["known.csv:1", "without the column \"pa_deg\""]),
    ("name,p_percent,pa_deg,mag\na,,,\n", ["known.csv:2", "tells nothing of the star"]),
    ("name,p_percent,pa_deg\na,5,\n", ["known.csv:2", "p_percent = 5 without pa_deg"]),
    ("mag\n8\n", ["known.csv:1", "without the column \"name\""]),
])
def test_standards_that_are_refused(umov, tmp_path, table, words):
    (tmp_path / "stars.csv").write_text(counts_of(STARS))
    (tmp_path / "known.csv").write_text(table)
    done = umov("calibrate", "stars.csv", "--standards", "known.csv")
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err


def test_counts_without_air_are_refused(umov, tmp_path):
    (tmp_path / "known.csv").write_text(known(STARS))
    text = counts_of(STARS)
    for gone, words in (("k_mag", "columns airmass and k_mag"), ("airmass", "an air mass of")):
        (tmp_path / "stars.csv").write_text(text.replace(f",{gone},", f",my_{gone},"))
        done = umov("calibrate", "stars.csv", "--standards", "known.csv")
        assert done.code == 3 and words in done.err, done.err
    (tmp_path / "stars.csv").write_text(text)
    assert umov("calibrate", "stars.csv", "--standards", "known.csv", "-o", "own.toml").code == 0
    (tmp_path / "stars.csv").write_text(text.replace(",airmass,", ",my_airmass,"))
    done = umov("reduce", "stars.csv", "--calibration", "own.toml")
    assert done.code == 3 and "calibration of brightness on counts without air mass" in done.err
    own = (tmp_path / "own.toml").read_text()
    for spoiled, words in ((re.sub("covariance = .*", "covariance = [1, 2]", own), "16 numbers"),
                           (re.sub("k_mag = .*", "k_mag = 1e9", own), "at most 100 magnitudes"),
                           (re.sub("covariance = .*", "covariance = [1, 2, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]", own), "correlations")):
        (tmp_path / "spoiled.toml").write_text(spoiled)
        done = umov("reduce", "stars.csv", "--calibration", "spoiled.toml")
        assert done.code == 3 and words in done.err, done.err


def test_plates_that_are_not_there(umov, tmp_path):
    (tmp_path / "target.csv").write_text(counts_of(STARS))
    for option in ("--plate-sd-deg", "--retardance-sd-deg"):
        done = umov("reduce", "target.csv", option, "0.1")
        assert done.code == 3 and "their plate_deg is one and the same" in done.err, done.err
