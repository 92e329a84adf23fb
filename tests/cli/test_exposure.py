"""umov exposure: bands by name, and its page of figures."""
import math
import re

import pytest

from conftest import anchors


def rows_of(umov, tmp_path, *options):
    done = umov("exposure", *options, "-o", "e.csv")
    assert done.code == 0, done.err
    return {line.split(",")[0]: float(line.split(",")[1])
            for line in (tmp_path / "e.csv").read_text().splitlines() if line[0] not in "#q"}, done


# Aperture, obstruction and throughput as data/instruments has them.
TELESCOPES = {"c11_imx250": (0.2794, 0.34, 0.35), "usafa16": (0.4064, 0.35, 0.5), "mmt9_channel": (0.0708, 0, 0.4),
              "hwp_wollaston_1m": (1.04, 0.3, 0.4), "moptop_2m": (2.0, 0.31, 0.4), "full_stokes_3m6": (3.67, 0.22, 0.15)}


@pytest.mark.parametrize("instrument", TELESCOPES)
def test_zero_points_in_v(umov, tmp_path, instrument):
    """Area and throughput times the photons of AB 0 in V (anchor: bands.csv, seven digits)."""
    shown = umov("instrument", "show", instrument).out
    read = [float(re.search(rf"^{key} = (\S+)", shown, re.M)[1])
            for key in ("aperture_m", "obstruction", "throughput")] if "\nobstruction" in shown else None
    aperture, hole, throughput = read or TELESCOPES[instrument]
    photons = next(float(row["ab_zero_1e9_photons_s_m2"]) * 1e9 for row in anchors("bands") if row["name"] == "Bessell.V")
    expected = 2.5 * math.log10(math.pi / 4 * aperture**2 * (1 - hole**2) * throughput * photons)
    rows, _ = rows_of(umov, tmp_path, "--instrument", instrument, "--band", "Bessell.V")
    assert abs(rows["zero_point"] - expected) < 2e-6
    if read:
        assert read == list(TELESCOPES[instrument])


def test_one_wavelength_is_the_same_by_name(umov, tmp_path):
    by_name, _ = rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--band", "nm:650", "--width-nm", 40)
    by_number, _ = rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--nm", 650, "--width-nm", 40)
    assert by_name == by_number


def test_colour_of_the_air_in_a_wide_band(umov, tmp_path):
    """Of Gaia's G the air takes less, the lower the star: its blue is gone (docs/theory/observing.md, 2)."""
    lost = []
    for altitude in (90, 10):
        rows, _ = rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--band", "gaia.G", "--alt", altitude, "--mag", 0)
        lost.append(-2.5 * math.log10(rows["rate_whole"]) + rows["zero_point"])
    assert lost[1] / 5.586 < 0.95 * lost[0]


@pytest.mark.parametrize("options, code, told", [
    (["--band", "Bessell"], 2, "group of 5 bands"), (["--band", "Bessell.V", "--nm", 500], 2, "--nm"),
    (["--band", "Bessell.V", "--width-nm", 50], 2, "--width-nm"), (["--band", "Bessel.V"], 3, "Bessell.V"),
    (["--page", "x.pdf"], 2, ".html")])
def test_bands_that_are_refused(umov, tmp_path, options, code, told):
    done = umov("exposure", "--instrument", "c11_imx250", *options)
    assert done.code == code and told in done.err, done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("instrument", ["c11_imx250", "full_stokes_3m6"])
def test_page_of_figures(umov, tmp_path, instrument):
    rows, done = rows_of(umov, tmp_path, "--instrument", instrument, "--band", "Bessell.V", "--page", "e.html")
    page = (tmp_path / "e.html").read_text()
    for title in ("Error of p", "Signal to noise", "How long until p is known", "What makes the error of p", "growth curve", "magnitude 8",
                  "Lines end where the brightest pixel is full"):
        assert title in page
    verdict = done.err.strip() or done.out
    assert verdict.splitlines()[-1].split(":")[0] in page
