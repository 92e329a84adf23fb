"""Light behind the air in umov run and umov passes: [observer] atmosphere."""
import math
import re

import pytest
from astropy.table import Table

from conftest import ROOT
from sphere_over_maui import make_sphere, write_scene


def run(umov, scenario, tmp_path, *changes):
    changes += (('"ecsv", "csv", "html"', '"ecsv", "csv"'),)
    done = umov("run", scenario(("step_s = 20", "step_s = 60"), ('set = "paper_rgb"', 'set = ["nm:550", "Bessell.B"]'),
                                *changes), "--quiet")
    assert done.code == 0, done.err
    return Table.read(tmp_path / "out/lightcurve.ecsv"), (tmp_path / "out/lightcurve.csv").read_bytes()


def test_none_changes_nothing(umov, scenario, tmp_path):
    plain, bytes_plain = run(umov, scenario, tmp_path)
    none, bytes_none = run(umov, scenario, tmp_path, ("alt_m = 3058", 'alt_m = 3058\natmosphere = "none"'))
    assert bytes_plain == bytes_none and "I_obs" not in plain.colnames


def test_clear_air_takes_what_it_should(umov, scenario, tmp_path):
    table, _ = run(umov, scenario, tmp_path, ("alt_m = 3058", 'alt_m = 3058\natmosphere = "clear"'))
    for row in table:
        if not row["I"] > 0:
            continue
        # Refraction of 40" tan z (69 % of an atmosphere), Kasten & Young 1989 eq. 3.
        h = row["alt"] + 40 / 3600 / math.tan(math.radians(row["alt"]))
        x = 1 / (math.sin(math.radians(h)) + 0.50572 * (h + 6.07995) ** -1.6364)
        lost = -2.5 * math.log10(row["I_obs"] / row["I"])
        if row["band"] == "nm:550":
            # docs/theory/observing.md, test of the air: .1180925 at 3058 m, tau .02, 260 DU; no gas absorbs there.
            assert abs(lost / x - 0.1180925) < 2e-5
        else:  # the same in B in sunlight: .2082243 at X 1, .4124026 at 1.994: it grows slower than X
            assert 0.4124026 / 1.994293 < lost / x < 0.2082243 or x > 1.994293
        assert abs(row["mag_obs"] - row["mag"] - lost) < 1e-9


def test_numbers_of_the_air_and_what_is_refused(umov, scenario, tmp_path):
    own = ("alt_m = 3058", "alt_m = 3058\natmosphere = { pressure_hpa = 0, aerosol = { tau_550 = 0 }, ozone_du = 0, water_cm = 0 }")
    table, _ = run(umov, scenario, tmp_path, own)
    assert all(abs(row["I_obs"] - row["I"]) < 1e-12 * row["I"] for row in table if row["I"] > 0)
    assert umov("run", "out/scenario.lock.toml", "-o", "again", "--quiet").code == 0
    assert list(Table.read(tmp_path / "again/lightcurve.ecsv")["I_obs"]) == list(table["I_obs"])
    for what in ("0.118", "true", "[0.1, 0.2]", "[]"):  # there was no air then, and no word
        done = umov("run", scenario(("alt_m = 3058", f"alt_m = 3058\natmosphere = {what}")))
        assert done.code == 3 and "neither a name nor a table" in done.err and re.search(r"toml:\d+:\d+", done.err), done.err
    done = umov("run", scenario(("alt_m = 3058", 'alt_m = 3058\natmosphere = "hazy"')))
    assert done.code == 3 and "clear" in done.err
    done = umov("run", scenario(("alt_m = 3058", 'alt_m = 3058\natmosphere = "clear"'),
                                ("[bands]", "[atmosphere]\nozone_du = 300\n[bands]")))
    assert done.code == 3 and "leave one out" in done.err


TABLE = "wavelength_nm,k_mag\n340,0.6\n500,0.2\n600,0.1\n1100,0.05\n"


def test_extinction_as_a_site_has_measured_it(umov, scenario, tmp_path):
    """At 550 nm half way between .2 and .1 mag, by the air mass; nothing else is taken."""
    (tmp_path / "k.csv").write_text(TABLE)
    own = ("alt_m = 3058", 'alt_m = 3058\natmosphere = { file = "k.csv" }')
    table, _ = run(umov, scenario, tmp_path, own)
    for row in table:
        if row["I"] > 0 and row["band"] == "nm:550":
            h = row["alt"] + 40 / 3600 / math.tan(math.radians(row["alt"]))
            x = 1 / (math.sin(math.radians(h)) + 0.50572 * (h + 6.07995) ** -1.6364)
            assert abs(-2.5 * math.log10(row["I_obs"] / row["I"]) / x - 0.15) < 2e-5
    assert "k.csv" in (tmp_path / "out/manifest.json").read_text()
    lock = (tmp_path / "out/scenario.lock.toml").read_text()
    assert f'file = "{tmp_path}/k.csv"' in lock and "aerosol" not in lock
    assert umov("run", "out/scenario.lock.toml", "-o", "again", "--quiet").code == 0
    assert list(Table.read(tmp_path / "again/lightcurve.ecsv")["I_obs"]) == list(table["I_obs"])
    # ECSV tells the same.
    lines = ["# %ECSV 1.0", "# ---", "# datatype:", "# - {name: wavelength_nm, datatype: float64}", "# - {name: k_mag, datatype: float64}",
             *TABLE.replace(",", " ").splitlines()]
    (tmp_path / "k.csv").write_text("\n".join(lines) + "\n")
    assert list(run(umov, scenario, tmp_path, own)[0]["I_obs"]) == list(table["I_obs"])


@pytest.mark.parametrize("table, told", [
    ("340 0.6\n500 0.2\n", 'without the column "wavelength_nm"'), ("wavelength_nm,mag\n340,0.6\n", 'without the column "k_mag"'),
    ("wavelength_nm,k_mag\n340,0.6\n", "two wavelengths or more"), ("wavelength_nm,k_mag\n0.34,0.6\n0.5,.2\n", "is it in um"),
    ("wavelength_nm,k_mag\n340,0.6\n500,\n", 'k_mag = ""'), ("wavelength_nm,k_mag\n340,0.6\n330,0.7\n", "rising wavelengths"),
    ("wavelength_nm,k_mag\n340,-0.6\n500,.2\n", "0 to 10 magnitudes per air mass"), ("wavelength_nm,k_mag\n340,.6\n500,.2\n", "reaches from 550"),
    ("wavelength_nm,k_mag\n500,.6\n600,.2\n", 'band "Bessell.B" reaches from'), ("wavelength_nm,k_mag\n340,nan\n500,.2\n", 'k_mag = "nan"')])
def test_extinctions_that_are_refused(umov, scenario, tmp_path, table, told):
    (tmp_path / "k.csv").write_text(table)
    done = umov("run", scenario(("alt_m = 3058", 'alt_m = 3058\natmosphere = { file = "k.csv" }'),
                                ('set = "paper_rgb"', 'set = ["nm:550"]' if "550" in told else 'set = ["Bessell.B"]')))
    assert done.code == 3 and told in done.err and ("k.csv" in done.err or "scenario.toml:" in done.err), done.err


@pytest.mark.parametrize("width, code", [(10, 0), (40, 3)])
def test_a_table_reaches_over_the_width_of_a_band(umov, tmp_path, width, code):
    """nm:550 of 40 nm ends at 570, beyond a table that ends at 560."""
    make_sphere(umov, 1, 24)
    (tmp_path / "k.csv").write_text("wavelength_nm,k_mag\n500,0.2\n560,0.14\n")
    done = umov("observe", write_scene(tmp_path, f'bands = ["nm:550"]\nwidth_nm = {width}\nexposure_s = 1',
                                       atmosphere='file = "k.csv"\nseeing = { arcsec = 3 }'))
    assert done.code == code and ("from 530 to 570 nm" in done.err) == (code == 3), done.err


def test_a_table_of_extinction_is_all_of_it(umov, scenario, tmp_path):
    (tmp_path / "k.csv").write_text(TABLE)
    done = umov("run", scenario(("alt_m = 3058", 'alt_m = 3058\natmosphere = { file = "k.csv", ozone_du = 300, water_cm = 1 }')))
    assert done.code == 3 and "ozone_du beside file" in done.err and "water_cm beside file" in done.err, done.err
    done = umov("run", scenario(("alt_m = 3058", 'alt_m = 3058\natmosphere = { file = "none.csv" }')))
    assert done.code in (2, 3, 5) and "none.csv" in done.err and "scenario.toml:" in done.err, done.err


def test_passes_behind_the_air(umov, scenario, tmp_path):
    name = scenario(("alt_m = 3058", 'alt_m = 3058\natmosphere = "clear"'))
    done = umov("passes", "--orbit", f"{ROOT}/data/tle/hst.tle", "-s", "20.7083,-156.2578,3058", "--start",
                "2018-01-21T05:00:00Z", "--stop", "2018-01-21T05:20:00Z", "--scene", name, "-o", "p.ecsv")
    assert done.code == 0, done.err
    row = Table.read(tmp_path / "p.ecsv")[0]
    # A zenith of 35 deg at the best, .118 mag per air mass in the middle band; 5.6 air masses at 10 deg.
    assert 0.1 < row["mag_obs_min"] - row["mag_min"] < 0.7
    assert row["mag_obs_max"] - row["mag_max"] < 0.7
