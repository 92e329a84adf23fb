"""umov calibrate: standards that come with umov, and a polarizer that is turned before the instrument."""
import math

import pytest
from astropy.table import Table

from conftest import ROOT
from test_observe import standards


# Angles of a lamp's polarizer, and what four orientations of a camera take of it.
def lamp(angles, rows, shift=0.0):
    lines = ["angle_deg,channel,counts"]
    for angle in angles:
        for name, (w0, w1, w2) in rows.items():
            twice = 2 * math.radians(angle)
            lines.append(f"{angle},{name},{w0 + w1 * math.cos(twice) + w2 * math.sin(twice) + shift * (angle == 60)!r}")
    return "\n".join(lines) + "\n"


def test_a_turned_polarizer_tells_what_channels_take(umov, tmp_path):
    """Least squares of 18 even angles: variances n/18, n/9, n/9; the angle to .0961 deg, at 1e4 electrons and E = 300."""
    d = 299 / 301
    rows = {str(a): (1e4, 1e4 * d * math.cos(2 * math.radians(a)), 1e4 * d * math.sin(2 * math.radians(a))) for a in (0, 45, 90, 135)}
    (tmp_path / "lamp.csv").write_text(lamp(range(0, 360, 20), rows))
    done = umov("calibrate", "lamp.csv", "--polarizer", "-o", "rows.ecsv")
    assert done.code == 0 and not done.err, done.err
    table = Table.read(tmp_path / "rows.ecsv")
    assert [str(name) for name in table["channel"]] == list(rows)
    for row in table:
        assert [row["w0"], row["w1"], row["w2"]] == pytest.approx(rows[str(row["channel"])], abs=1e-6)
        assert row["w0_err"] == pytest.approx(100 / math.sqrt(18), rel=1e-9) and row["w1_err"] == pytest.approx(100 / 3, rel=1e-9)
        assert row["efficiency"] == pytest.approx(d, rel=1e-9)
        # sd of w1/w0 is .003333; that of w0 adds to what is a ratio.
        assert row["efficiency_err"] == pytest.approx(math.hypot(1 / 300, d / (100 * math.sqrt(18))), rel=1e-9)
        assert abs(row["analyser_err"] - 0.0961) < 5e-5
        assert abs((row["analyser_deg"] - float(row["channel"]) + 90) % 180 - 90) < 1e-9
    (tmp_path / "bad.csv").write_text(lamp(range(0, 360, 20), rows, shift=3000))
    done = umov("calibrate", "bad.csv", "--polarizer", "--json")
    assert done.code == 0 and "cosine" in done.err


@pytest.mark.parametrize("text, told", [
    ("angle_deg,count\n0,1\n", '"counts"'), ("counts\n1\n", '"angle_deg"'), ("angle_deg,counts\n", "no counts"),
    ("angle_deg,counts\n0,-5\n", "electrons"), ("angle_deg,counts\n0,nan\n", "electrons"), ("angle_deg,counts\nx,5\n", "an angle"),
    ("angle_deg,counts\n0,0\n", "variance of 0"), ("angle_deg,counts\n0,10\n90,10\n", "2 angles"),
    ("angle_deg,counts,channel\n0,10,a\n90,10,a\n180,10,a\n", 'channel "a"')])
def test_lamps_that_are_refused(umov, tmp_path, text, told):
    (tmp_path / "lamp.csv").write_text(text)
    done = umov("calibrate", "lamp.csv", "--polarizer")
    assert done.code == 3 and told in done.err and "lamp.csv" in done.err, done.err


def test_calibrate_wants_one_of_both(umov, tmp_path):
    assert umov("calibrate", "counts.csv").code == 2
    assert umov("calibrate", "counts.csv", "--standards", "schmidt1992", "--polarizer").code == 2
    assert umov("calibrate", "counts.csv", "--standards", "schmidt1992", "--json").code == 2


# Per cent, deg: as the reduction of the RoboPol group has them of Schmidt et al. 1992.
SCHMIDT = {"BD+59 389": (6.43, 98.14), "BD+64 106": (5.15, 96.74), "HD 155197": (4.274, 102.88), "HD 161056": (4.012, 67.33),
           "HD 204827": (4.893, 59.1), "HD 236633": (5.376, 93.04), "Hiltner 960": (5.21, 54.54), "VI Cyg 12": (7.893, 116.23),
           "BD+28 4211": (0.054, 54.22), "BD+32 3739": (0.025, 35.79), "G191-B2B": (0.061, 147.65), "HD 14069": (0.022, 156.57),
           "HD 21447": (0.051, 171.49), "HD 212311": (0.034, 50.99)}


def test_standards_that_come_with_umov(umov, tmp_path):
    shipped = Table.read(ROOT / "data/standards/schmidt1992.csv", format="ascii.csv", comment="#")
    assert {row["name"]: (row["p_percent"], row["pa_deg"]) for row in shipped} == SCHMIDT
    assert all(0 < row["p_err_percent"] < 0.1 and row["pa_err_deg"] > 0 for row in shipped)
    standards(tmp_path / "stars.csv")  # HD 204827 at four angles of the instrument
    done = umov("calibrate", "stars.csv", "--standards", "schmidt1992", "-o", "own.toml")
    assert done.code == 0, done.err
    text = (tmp_path / "own.toml").read_text()
    found = dict(line.split(" = ") for line in text.splitlines() if " = " in line and not line.startswith("#"))
    # The star is not known better than the paper knows it, .029 of 4.893; noise of 1e8 electrons adds a little.
    assert abs(float(found["efficiency"]) - 0.985) < 1e-6 and abs(float(found["phi0_deg"]) - 0.8) < 1e-4
    assert 1 < float(found["efficiency_sd"]) / (0.985 * 0.029 / 4.893) < 1.1, text
    done = umov("calibrate", "stars.csv", "--standards", "schmid1992")
    assert done.code == 3 and '"schmidt1992"' in done.err
