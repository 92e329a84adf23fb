"""Bands with a curve: what each command makes of them, and that one wavelength stays what it was."""
import csv
import json
import math
import sys

import pytest

from conftest import ROOT, SCENARIO, anchors, read_csv

GOLD = """umov = 1
[[object]]
mesh = { file = "ball.obj", unit = "m", up = "+Z" }
[object.materials]
default = "gold"
[material.gold]
index = "Au_Johnson"
distribution = { model = "blinn_phong", m = 20 }
[bands]
set = ["Bessell.B", "Bessell.V", "sdss.g", "gaia.G", "nm:550"]
"""


@pytest.fixture
def gold(umov, tmp_path):
    assert umov("mesh", "make", "sphere", "-o", "ball.obj").code == 0
    (tmp_path / "gold.toml").write_text(GOLD)
    return tmp_path / "gold.toml"


def test_a_gold_ball_has_the_polarization_of_its_bands(umov, gold, tmp_path):
    done = umov("signature", gold, "--poses", 1, "--phase", "60,100,140", "-o", "s.csv")
    assert done.code == 0, done.err
    truth = {(row["band"], float(row["phase_deg"])): row for row in anchors("band_metals") if row["metal"] == "Au_Johnson"}
    rows = read_csv(tmp_path / "s.csv")
    seen = 0
    for row in rows:
        key = row["band"], round(float(row["phase_angle"]), 6)
        if key in truth:
            # One reflection has Q/I of the metal whatever the lobe; 1e-3 is what the sum may err by.
            assert float(row["q_scat"]) == pytest.approx(float(truth[key]["q"]), abs=1e-3), key
            assert 0 < float(row["band_err_i"]) < 2e-3 * float(row["intensity"])
            seen += 1
        else:
            assert row["band"] == "nm:550" and float(row["band_err_i"]) == 0
    assert seen == 12
    # Intensities of two bands are as the metal's, the lobe being the same.
    at = {row["band"]: float(row["intensity"]) for row in rows if float(row["phase_angle"]) > 139}
    b, v = (float(truth[band, 140]["intensity"]) for band in ("Bessell.B", "Bessell.V"))
    assert at["Bessell.B"] / at["Bessell.V"] == pytest.approx(b / v, rel=1e-3)


def test_one_wavelength_has_no_columns_of_bands(umov, gold, tmp_path):
    done = umov("signature", gold, "--poses", 1, "--phase", 60, "-o", "a.csv")
    assert done.code == 0, done.err
    (tmp_path / "mono.toml").write_text(GOLD.replace('"Bessell.B", "Bessell.V", "sdss.g", "gaia.G", ', ""))
    assert umov("signature", "mono.toml", "--poses", 1, "--phase", 60, "-o", "b.csv").code == 0
    one, other = read_csv(tmp_path / "a.csv"), read_csv(tmp_path / "b.csv")
    assert "band_err_i" in one[0] and "band_err_i" not in other[0]
    # The light at 550 nm does not depend on who else asks.
    assert {k: v for k, v in one[-1].items() if not k.startswith("band_err")} == other[-1]


def test_one_wavelength_is_what_it_was_before_there_were_curves(umov, tmp_path):
    assert umov("mesh", "make", "chamfered-cube", "-o", "cube.obj").code == 0
    (tmp_path / "nm.toml").write_text(GOLD.split("[material.gold]")[0].replace("ball.obj", "cube.obj").replace(
        '"gold"', '"film_silvered"') + '[bands]\nset = ["nm:440", "nm:550", "nm:640.5"]\n')
    done = umov("signature", "nm.toml", "--poses", 4, "--phase", "30,110", "--visibility", "rays", "--seed", 3, "-o", "s.csv")
    assert done.code == 0, done.err
    now = read_csv(tmp_path / "s.csv")
    with open(ROOT / "tests/data/bands/nm_wavelengths.csv", newline="") as file:
        before = list(csv.DictReader(file))
    assert now[0].keys() == before[0].keys() and len(now) == len(before)
    for one, other in zip(now, before):
        for name, cell in other.items():
            if name == "band" or not cell:
                assert one[name] == cell
            else: # the last bits of sine and cosine belong to the C library
                assert float(one[name]) == pytest.approx(float(cell), rel=1e-12, abs=1e-15), name


def test_a_satellite_in_a_band_is_the_sum_of_its_wavelengths(umov, tmp_path):
    """Every 5 nm, with weights of their own (tools/anchors): through hiding, films and all other lobes."""
    sys.path.insert(0, str(ROOT / "tools/anchors"))
    import numpy as np
    import passbands
    nm = np.arange(470., 700.1, 5)
    ask = ["--poses", 3, "--phase", "40,100,140", "--visibility", "masks"]
    for name, bands in (("fine", [f"nm:{x:g}" for x in nm]), ("band", ["Bessell.V"])):
        done = umov("signature", ROOT / "examples/hst_maui.toml", "--set", f"bands.set={json.dumps(bands)}", *ask,
                    "-o", f"{name}.csv")
        assert done.code == 0, done.err
    x, response, sun = passbands.points("Bessell.V", .25)
    hats = [np.interp(x, nm, np.eye(len(nm))[k]) for k in range(len(nm))]
    weights = np.array([passbands.trapezoid(response * sun * x * hat, x) for hat in hats])
    weights /= weights.sum()
    fine, band = read_csv(tmp_path / "fine.csv"), read_csv(tmp_path / "band.csv")
    for column in ("intensity", "stokes_q", "stokes_u"):
        sums = np.array([float(row[column]) for row in fine]).reshape(-1, len(nm)) @ weights
        for row, expected in zip(band, sums, strict=True):
            assert float(row[column]) == pytest.approx(expected, abs=1e-3 * float(row["intensity"])), column


@pytest.mark.slow
def test_run_in_vega_magnitudes(umov, tmp_path):
    assert umov("mesh", "make", "sphere", "-o", "ball.obj").code == 0
    text = (ROOT / "examples/hst_maui.toml").read_text()
    assert "[bands]" in text
    sets = ["--set", "time.step_s=60", "--set", "output.formats=[\"csv\", \"html\"]", "--set", 'output.csv_digits="all"']
    for system, name in (("Vega", "a"), ("AB", "b")):
        done = umov("run", ROOT / "examples/hst_maui.toml", *sets, "--set", 'bands.set=["Bessell.V", "Bessell.I"]',
                    "--set", f"bands.mag_system={system}", "-o", name)
        assert done.code == 0, done.err
    vega, ab = read_csv(tmp_path / "a/lightcurve.csv"), read_csv(tmp_path / "b/lightcurve.csv")
    assert {row["mag_system"] for row in vega} == {"Vega"} and {row["mag_system"] for row in ab} == {"AB"}
    sun = {row["name"]: row for row in anchors("bands")}
    for one, other in zip(vega, ab):
        assert one["I"] == other["I"] and float(one["lambda_eff"]) == pytest.approx(
            float(sun[one["band"]]["effective_nm"]), abs=1e-5)
        if one["mag_limit"] == "false" and one["mag"]:
            # Two zeros of one scale: they differ by what they differ for the Sun.
            step = float(sun[one["band"]]["vega"]) - float(sun[one["band"]]["ab"])
            assert float(one["mag"]) - float(other["mag"]) == pytest.approx(step, abs=2e-6)
    page = (tmp_path / "a/report.html").read_text()
    assert '"mag_system":"Vega"' in page and "Bessell.V" in page


def test_passes_take_a_band(umov):
    table = {}
    for band in ("Bessell.V", "nm:550"):
        done = umov("passes", "--orbit", ROOT / "data/tle/hst.tle", "--norad", 20580, "-s", "maui", "--start",
                    "2018-01-21T04:00Z", "--stop", "2018-01-21T16:00Z", "--model", "sphere", "--material", "paper_al",
                    "--band", band, "--json")
        assert done.code == 0, done.err
        table[band] = [row["mag_min"] for row in json.loads(done.out)]
    lit = [(a, b) for a, b in zip(*table.values()) if a is not None]
    assert lit
    for curve, wavelength in lit: # a grey metal: the Sun's colour between V and 550 nm
        assert abs(curve - wavelength) < 0.1


def test_a_file_of_ones_own(umov, gold, tmp_path):
    (tmp_path / "green.csv").write_text("# unit: nm\n# detector: photon\n500,0\n510,1\n590,1\n600,0\n")
    (tmp_path / "bare.txt").write_text("5000 0\n5100 1\n5900 1\n6000 0\n")
    text = GOLD.replace('"Bessell.B", "Bessell.V", "sdss.g", "gaia.G"',
                        '"file:green.csv", { file = "bare.txt", unit = "Angstrom", detector = "photon" }')
    gold.write_text(text)
    assert umov("signature", gold, "--poses", 1, "--phase", 60, "-o", "s.csv").code == 0
    rows = {row["band"]: row for row in read_csv(tmp_path / "s.csv")}
    assert rows["file:green.csv"]["intensity"] == rows["file:bare.txt"]["intensity"]
    gold.write_text(GOLD.replace('"Bessell.B"', '"file:bare.txt"'))
    done = umov("signature", gold, "--poses", 1, "--phase", 60)
    assert done.code == 3 and "bare.txt" in done.err and "unit" in done.err, done.err
    (tmp_path / "um.csv").write_text("# unit: nm\n# detector: photon\n0.50,0\n0.55,1\n0.60,0\n")
    gold.write_text(GOLD.replace('"Bessell.B"', '"file:um.csv"'))
    done = umov("signature", gold, "--poses", 1, "--phase", 60)
    assert done.code == 3 and "micrometres" in done.err, done.err


def test_tables_that_do_not_cover_a_band(umov, gold):
    gold.write_text(GOLD.replace('"Au_Johnson"', "{ wavelength_nm = [500, 600], n = [1, 1], k = [1, 1] }"))
    done = umov("signature", gold, "--poses", 1, "--phase", 60)
    assert done.code == 3 and '"Bessell.B"' in done.err and "500-600 nm" in done.err, done.err
    gold.write_text(GOLD.replace('default = "gold"', 'default = "paper_au"'))
    done = umov("signature", gold, "--poses", 1, "--phase", 60, "-o", "s.csv")
    assert done.code == 0 and "425-650 nm" in done.err, done.err
    done = umov("signature", gold, "--poses", 1, "--phase", 60, "--source", "laser")
    assert done.code == 3 and "laser" in done.err, done.err


def test_list_and_show(umov):
    rows = {row["band"]: row for row in json.loads(umov("bands", "list", "--json").out)}
    for row in anchors("bands"):
        assert rows[row["name"]]["sun_ab"] == pytest.approx(float(row["ab"]), abs=1e-6)
    done = umov("bands", "show", "Bessell.V")
    assert done.code == 0 and "-26.761" in done.out and "Willmer" in done.out, done.out
    assert umov("bands", "show", "gaia").code == 2
    done = umov("bands", "show", "Besell.V")
    assert done.code == 3 and "Bessell.V" in done.err
    curve = json.loads(umov("bands", "show", "sdss.r", "--json").out)
    assert max(row["response"] for row in curve) == pytest.approx(0.501219)
    assert math.isclose(json.loads(umov("bands", "show", "nm:550", "--json").out)[0]["wavelength"], 550)


def test_pictures_are_taken_through_a_band(umov, gold, tmp_path):
    done = umov("render", gold, "--sun", 1, 0, 0, "--observer", 0.5, 0.8, 0, "--band", "Bessell.V", "-o", "v.png")
    assert done.code == 0, done.err
    assert (tmp_path / "v.png").stat().st_size > 1000
