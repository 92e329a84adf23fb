"""umov exposure: bands by name, and its page of figures."""
import math
import re
import time

import numpy as np
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


# Analysers: what share of unpolarized light they let through at once (of three lenses of their own, three halves), and E.
ANALYSERS = {"c11_imx250": (0.5, 300), "usafa16": (0.5, 1000), "mmt9_channel": (1.5, 100), "hwp_wollaston_1m": (1, math.inf),
             "moptop_2m": (1, math.inf), "full_stokes_3m6": (0.5, math.inf)}


@pytest.mark.parametrize("instrument", TELESCOPES)
def test_electrons_a_second_of_magnitude_8(umov, tmp_path, instrument):
    """The zero point of the anchors (bands.csv), the light inside one width (anchor moffat_1), and half of it behind one analyser,
    whichever it is: 37,301 a second for the camera behind k X = .2."""
    aperture, hole, throughput = TELESCOPES[instrument]
    photons = next(float(row["ab_zero_1e9_photons_s_m2"]) * 1e9 for row in anchors("bands") if row["name"] == "Bessell.V")
    inside = next(float(row["value"]) for row in anchors("observing_instrument") if row["name"] == "moffat_1")
    passed, extinction = ANALYSERS[instrument]
    bare = math.pi / 4 * aperture**2 * (1 - hole**2) * throughput * photons * 10 ** (-0.4 * 8)
    rows, _ = rows_of(umov, tmp_path, "--instrument", instrument, "--band", "Bessell.V", "--mag", 8)
    air = rows["rate_whole"] / bare
    assert 0.5 < air < 1
    assert rows["rate"] / (rows["rate_whole"] * inside * passed * (1 + 1 / extinction)) == pytest.approx(1, abs=2e-6)
    assert rows["electrons"] == pytest.approx(rows["rate"] * rows["time"], rel=1e-6)
    if instrument == "c11_imx250":
        assert bare * 10 ** (-0.4 * 0.2) * 0.84 / 2 == pytest.approx(37300.85, rel=1e-5)


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


def test_frames_that_no_camera_takes_are_told(umov):
    """Sun and full Moon as points: p is known to .01 in less than any shutter can do."""
    for mag, is_told in ((-26.8, True), (-12.0, True), (6.0, False)):
        done = umov("exposure", "--instrument", "c11_imx250", "--mag", str(mag))
        assert done.code == 0 and ("take a neutral filter" in done.out + done.err) == is_told, done.out + done.err


def test_magnitudes_of_vega(umov, tmp_path):
    """I = 8 (Vega) is I = 8.41 (AB): Willmer (2018), Table 4 by the curve's own zero; both are told, and the terms of both errors."""
    ask = ("--instrument", "c11_imx250", "--band", "Bessell.I")
    vega, done = rows_of(umov, tmp_path, *ask, "--mag", 8, "--mag-system", "Vega")
    ab = float(re.search(r"magnitude ([0-9.]+) AB above the air, 8 Vega", done.err)[1])
    assert ab - 8 == pytest.approx(0.41, abs=0.03)  # .38 to .45 in the literature, by the curve of I
    same, _ = rows_of(umov, tmp_path, *ask, "--mag", ab)
    assert vega["rate"] == pytest.approx(same["rate"], rel=2e-3)  # four digits are told
    assert "S/N is that of I" in done.err and "scintillation is the same in all channels" in done.err
    narrow = umov("exposure", "--instrument", "c11_imx250", "--mag-system", "Vega")
    assert narrow.code == 3 and "no zero point in the Vega system" in narrow.err, narrow.err


def test_the_aperture_that_is_summed(umov, tmp_path):
    """Two widths hold more light and four times the sky; Moffat's profile of exponent b holds 1 - (1 + (r / a)^2)^(1 - b) of it."""
    one, _ = rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--band", "Bessell.V")
    two, done = rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--band", "Bessell.V", "--aperture-fwhm", 2)
    exponent = 4.765  # Trujillo et al. (2001), docs/theory/observing.md
    a = 0.5 / math.sqrt(2 ** (1 / exponent) - 1)
    inside = [1 - (1 + (r / a) ** 2) ** (1 - exponent) for r in (1, 2)]
    assert two["rate"] / one["rate"] == pytest.approx(inside[1] / inside[0], rel=1e-4)
    assert "within 2 of a star's width" in done.err


def words_of(tmp_path):
    return {line.split(",")[0]: line for line in (tmp_path / "e.csv").read_text().splitlines() if line[0] != "#"}


def test_three_lenses_are_told_from_one(umov, tmp_path):
    """Rates behind three polaroids are of three lenses, what stands before polarizers is of one: more is detected than it says."""
    rows, done = rows_of(umov, tmp_path, "--instrument", "mmt9_channel", "--band", "Bessell.V")
    words = words_of(tmp_path)
    assert rows["rate"] > rows["rate_whole"]
    assert "of one of 3 lenses" in words["rate_whole"] and "of one of 3 lenses" in words["zero_point"]
    assert "detected in all channels" in words["rate"] and "each lens" in words["scintillation"]
    assert "which each lens has of its own" in done.err
    rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--band", "Bessell.V")
    assert "lens" not in "".join(words_of(tmp_path).values())


def test_flicker_of_three_lenses_averages(umov, tmp_path):
    """Of a star so bright that photons do not matter S/N is that of the air: each lens' own, over the square root of three."""
    rows, done = rows_of(umov, tmp_path, "--instrument", "mmt9_channel", "--band", "Bessell.V", "--mag", "-5", "--exposure-s", "0.1")
    # Osborn et al. 2015, Eq. 7, at 45 deg by Kasten & Young 1989: of .1 s, and of the .6142 D/V below which the air stands still.
    mass = 1 / (math.sin(math.radians(45)) + 0.50572 * (45 + 6.07995) ** -1.6364)
    flicker, still = (math.sqrt(1e-5 * 1.5 ** 2 * 0.0708 ** (-4 / 3) / t * mass ** 3) for t in (0.1, 0.6142005 * 0.0708 / 20))
    assert rows["time"] < 0.6142 * 0.0708 / 20 and rows["scintillation"] == pytest.approx(still, rel=1e-6)
    assert float(re.search(r"S/N ([0-9.]+)", done.out + done.err)[1]) == pytest.approx(math.sqrt(3) / flicker, rel=0.02)


def test_flicker_is_in_what_a_frame_is_said_to_reach(umov, tmp_path):
    """Of exposures one after the other sd q is s/sqrt 2, s of each (docs/theory/observing.md, 2); of three lenses sqrt(2/3) s."""
    for instrument, felt in (("usafa16", 1 / math.sqrt(2)), ("mmt9_channel", math.sqrt(2 / 3)), ("c11_imx250", None)):
        rows, done = rows_of(umov, tmp_path, "--instrument", instrument, "--band", "Bessell.V", "--exposure-s", "0.2")
        told = re.search(r"error of p (\S+?), with scintillation (\S+?);", done.err)
        assert (told is not None) == (felt is not None), done.err
        if told:
            flicker = felt * rows["scintillation"] * math.sqrt(rows["time"] / 0.2)
            assert float(told[2]) == pytest.approx(math.hypot(float(told[1]), flicker), rel=0.03)
            # As many as bring the sum to what is wanted, .01; two digits of it are told.
            assert int(re.search(r"(\d+) of them", done.err)[1]) == pytest.approx((float(told[2]) / 0.01) ** 2, rel=0.06, abs=1)


@pytest.mark.parametrize("instrument, is_felt", [("c11_imx250", False), ("hwp_wollaston_1m", False), ("moptop_2m", False),
                                                 ("usafa16", True), ("full_stokes_3m6", True), ("mmt9_channel", True)])
def test_where_flicker_gets_into_p(umov, tmp_path, instrument, is_felt):
    """Two beams share the air of each exposure as the orientations of a mosaic do; one beam and lenses of their own do not."""
    rows, done = rows_of(umov, tmp_path, "--instrument", instrument, "--band", "Bessell.V", "--change-per-s", "0.05")
    assert ("comes on top of it" in done.err) == is_felt and ("leaves p alone" in done.err) != is_felt
    assert ("false_p" in rows) == (is_felt and instrument != "mmt9_channel")
    if "false_p" in rows:
        # A drift r from state to state: sqrt(2) r of p behind analysers at 0 45 90 135. Four balanced states have unit vectors m with
        # sum m m^T = 4/3, so that (3/4) |sum m_k r (k - 3/2)| = sqrt(3/4 5) r, in any order.
        by_drift = math.sqrt(15) / 2 if instrument == "full_stokes_3m6" else math.sqrt(2)
        assert rows["false_p"] == pytest.approx(by_drift * 0.05 * rows["time"] / 4, rel=1e-5)


def test_no_less_than_a_pixel_is_read(umov, tmp_path):
    """Of a lens whose pixels are 16 arcsec wide, the sky of a whole pixel and its reading come with a star 1 arcsec wide."""
    rows, _ = rows_of(umov, tmp_path, "--instrument", "mmt9_channel", "--band", "Bessell.V", "--mag", 8, "--sky-mag", 20)
    bare = 10 ** (0.4 * (rows["zero_point"] - 8))
    inside = next(float(row["value"]) for row in anchors("observing_instrument") if row["name"] == "moffat_1")
    pixel = math.degrees(6.5e-6 / 0.0838) * 3600
    assert rows["share_sky"] / rows["share_star"] == pytest.approx(
        10 ** (-0.4 * (20 - 8)) * pixel**2 / (rows["rate_whole"] / bare * inside), rel=1e-4)
    # Three pixels of 1.5 e and of rounding to .5 e, once; F^2 is 1.
    assert rows["share_read"] / rows["share_star"] == pytest.approx(3 * (1.5**2 + 0.5**2 / 12) / rows["electrons"], rel=1e-4)


def test_the_sky_fills_pixels_too(umov, tmp_path):
    """A sky of AB 10 a square arc second fills pixels long before a star of magnitude 20 does."""
    def fills_s(sky):
        return rows_of(umov, tmp_path, "--instrument", "c11_imx250", "--mag", "20", "--sky-mag", sky)[0]["saturation"]

    # 2.5 magnitudes are a factor of 10; dark current, 1 e/s, is a fiftieth of the darker of these skies.
    assert fills_s("12.5") == pytest.approx(10 * fills_s("10"), rel=0.03)
    assert fills_s("22") > 20 * fills_s("12.5")


# What polarimeters really tell: numbers follow from the rows of docs/theory/observing.md, 4, by numpy.


def instrument_file(umov, tmp_path, name, **changes):
    """A built-in instrument with keys of [polarimeter] changed."""
    head, body = umov("instrument", "show", name).out.split("[polarimeter]")
    for key, value in changes.items():
        body = re.sub(rf"^{key} = .*\n", "", body, flags=re.M) + f"{key} = {value}\n"
    (tmp_path / "own.toml").write_text(head + "[polarimeter]" + body)
    return ("--instrument", "own.toml", "--band", "nm:550", "--width-nm", "10")


def plate_rows(plates_deg, retardance_deg=180.0, extinction=math.inf, turn_deg=0.0):
    """Beams o and x behind a plate, averaged over its turn (midpoints)."""
    d = (1 - 1 / extinction) / (1 + 1 / extinction)
    cosine, n = math.cos(math.radians(retardance_deg)), 400
    rows = []
    for plate in plates_deg:
        turned = np.radians(plate + turn_deg * ((np.arange(n) + 0.5) / n - 0.5))
        c, s = np.cos(2 * turned), np.sin(2 * turned)
        q, u = np.mean(c**2 + s**2 * cosine), np.mean(c * s * (1 - cosine))
        rows += [[0.5 * (1 + 1 / extinction) * x for x in (1, sign * d * q, sign * d * u)] for sign in (1, -1)]
    return np.array(rows)


def electrons_for(rows, sd_p):
    """Photons alone: a row has n/rows electrons of the n, I is n over what all rows take of it."""
    variance = np.diag(np.linalg.inv(rows.T @ rows))
    return len(rows) * np.mean(variance[1:]) * (np.mean(rows[:, 0]) / sd_p) ** 2


BRIGHT = ("--mag", "0")  # what sky and reading add, 1/share_star, is taken off


@pytest.mark.parametrize("extinction", [1.5, 300, 1e5])
def test_poor_analysers_take_longer(umov, tmp_path, extinction):
    """sd p = sqrt(2/N)/D, D = (E - 1)/(E + 1): 25 times the light at E = 1.5."""
    rows, _ = rows_of(umov, tmp_path, *instrument_file(umov, tmp_path, "c11_imx250", extinction=extinction), *BRIGHT)
    assert rows["electrons"] * rows["share_star"] == pytest.approx(2 / (0.01 * (extinction - 1) / (extinction + 1)) ** 2, rel=1e-4)


@pytest.mark.parametrize("retardance, extinction", [(180, 1e9), (150, 1e9), (120, 30), (225, 1e9)])
def test_retardance_of_a_plate_costs_time(umov, tmp_path, retardance, extinction):
    ask = instrument_file(umov, tmp_path, "hwp_wollaston_1m", retardance_deg=retardance, extinction=extinction)
    rows, _ = rows_of(umov, tmp_path, *ask, *BRIGHT)
    expected = electrons_for(plate_rows((0, 45, 22.5, 67.5), retardance, extinction), 0.01)
    assert rows["electrons"] * rows["share_star"] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("per_turn", [16, 12, 40])
def test_a_plate_that_turns_blurs(umov, tmp_path, per_turn):
    """16 frames a turn: efficiency sin(2a)/(2a) = .9003 (Shrestha et al. 2020); longer frames are worse, shorter better."""
    seconds = 6.4 / per_turn
    rows, done = rows_of(umov, tmp_path, "--instrument", "moptop_2m", "--band", "Bessell.V", "--mag", "4", "--exposure-s", seconds)
    turn = math.radians(360 / per_turn)
    assert rows["electrons"] * rows["share_star"] == pytest.approx(2 / (0.01 * math.sin(2 * turn) / (2 * turn)) ** 2, rel=2e-3)
    assert "at each angle of a quarter turn" in done.err


def test_frames_that_are_too_long_for_a_turning_plate(umov):
    """Two frames in a quarter turn tell u alone: observe refuses them too."""
    done = umov("exposure", "--instrument", "moptop_2m", "--exposure-s", "0.8")
    assert done.code == 3 and "cannot tell Q" in done.err and "shorten the exposures" in done.err, done.err


def test_pages_of_a_turning_plate_end(umov, tmp_path):
    """Frames of a page last up to millions of turns; those end at once, and their lines where q or u is no longer told."""
    begun = time.monotonic()
    done = umov("exposure", "--instrument", "moptop_2m", "--mag", "18", "--page", "e.html")
    assert done.code == 0, done.err
    fast = instrument_file(umov, tmp_path, "moptop_2m", period_s=1e-4)
    done = umov("exposure", *fast, "--exposure-s", "100")
    assert done.code == 3 and "cannot tell" in done.err, done.err
    assert time.monotonic() - begun < 10  # a fraction of a second; it was minutes


def test_what_tells_no_p_is_refused(umov, tmp_path):
    head = umov("instrument", "show", "c11_imx250").out.split("[polarimeter]")[0]
    (tmp_path / "bare.toml").write_text(head)
    done = umov("exposure", "--instrument", "bare.toml")
    assert done.code == 3 and "counts I alone" in done.err, done.err
    # An analyser that lets all through, and a plate of a whole wave.
    for name, changes in (("c11_imx250", {"extinction": 1}), ("hwp_wollaston_1m", {"retardance_deg": 360})):
        done = umov("exposure", *instrument_file(umov, tmp_path, name, **changes))
        assert done.code == 3 and "cannot tell" in done.err and "own.toml" in done.err, done.err


def test_mirrors_of_the_port_take_light(umov, tmp_path):
    """Aluminium at 45 deg reflects .90 to .92 at 550 nm (Rakic 1995: n 1.01, k 6.63: .916 at normal incidence)."""
    rows, _ = rows_of(umov, tmp_path, "--instrument", "full_stokes_3m6", "--band", "nm:550")
    text = umov("instrument", "show", "full_stokes_3m6").out
    (tmp_path / "straight.toml").write_text(re.sub(r"^port = .*\n", "", text, flags=re.M))
    straight, _ = rows_of(umov, tmp_path, "--instrument", "straight.toml", "--band", "nm:550")
    assert 0.89 < rows["rate_whole"] / straight["rate_whole"] < 0.93
    assert "mirrors of the port" not in words_of(tmp_path)["rate_whole"]


def test_changes_that_all_channels_see_are_told(umov):
    for name, is_told in (("c11_imx250", True), ("hwp_wollaston_1m", True), ("usafa16", False)):
        done = umov("exposure", "--instrument", name, "--change-per-s", "0.05")
        assert done.code == 0 and ("--change-per-s 0.05 says nothing" in done.err) == is_told, done.err


def error_of_p(umov, *options):
    done = umov("exposure", *options)
    assert done.code == 0, done.err
    return float(re.search(r"error of p (\S+?)[,;]", done.err + done.out)[1])


@pytest.mark.parametrize("exposure_s", [0.05, 0.1, 0.2])
def test_short_frames_of_a_turning_plate_fill_its_turn(umov, exposure_s):
    """umov observe takes them one after the other: a quarter turn in .05 s frames tells as much as one in .2 s frames. .97e-3 is what
    observe and reduce gave of a steady sphere in each of them (300 sets, 4 %; two digits are printed)."""
    found = error_of_p(umov, "--instrument", "moptop_2m", "--mag", 9.45706, "--alt", 56.9198, "--band", "Bessell.V", "--height-m", 4205,
                       "--aperture-fwhm", 2, "--exposure-s", exposure_s)
    assert found == pytest.approx(0.97e-3, rel=0.08)


def test_a_changing_brightness_is_told_in_the_verdict(umov):
    done = umov("exposure", "--instrument", "usafa16", "--mag", 8, "--exposure-s", 0.05, "--change-per-s", 5)
    # Four exposures of .05 s: sqrt(2) 5 .2/4 (docs/theory/observing.md).
    assert "false p of 0.35" in done.err + done.out, (done.err, done.out)
    steady = umov("exposure", "--instrument", "usafa16", "--mag", 8, "--exposure-s", 0.05)
    assert "false p" not in steady.err + steady.out


def test_hopeless_and_too_brief_exposures_are_called_so(umov):
    done = umov("exposure", "--instrument", "c11_imx250", "--mag", 30)
    assert "nobody waits" in done.err + done.out
    done = umov("exposure", "--instrument", "c11_imx250", "--exposure-s", 1e-9)
    told = done.err + done.out
    assert "expose longer" in told and "more aperture" not in told, told


def test_one_bound_for_the_radius_that_is_summed(umov):
    """umov observe refuses 4 widths and more, where the ring of the sky begins."""
    at = ("exposure", "--instrument", "c11_imx250", "--aperture-fwhm")
    assert umov(*at, "3.9").code == 0
    for width in ("4", "6", "0.001"):
        done = umov(*at, width)
        assert done.code == 2 and f"--aperture-fwhm {width}: 0.01 to less than 4 was expected" in done.err, done.err


@pytest.mark.parametrize("instrument, states", [("c11_imx250", 1), ("usafa16", 4), ("hwp_wollaston_1m", 4), ("moptop_2m", 4)])
def test_time_in_whole_exposures(umov, tmp_path, instrument, states):
    """Exposures far longer than p needs: one set of them; far shorter: as many sets as the verdict says."""
    at = ("--instrument", instrument, "--sd-p", "0.01")
    seconds = 0.4 if instrument == "moptop_2m" else 30  # of 6.4 s: a quarter turn is four of .4 s
    rows, _ = rows_of(umov, tmp_path, *at, "--exposure-s", seconds)
    assert rows["time"] < rows["time_of_frames"] == pytest.approx(states * seconds)
    rows, done = rows_of(umov, tmp_path, *at, "--exposure-s", "1e-4", "--mag", "12")
    frames = re.search(r"(\d+) of them", done.err + done.out)
    sets = rows["time_of_frames"] / 1e-4 / int(frames[1])
    assert sets == pytest.approx(states if instrument != "moptop_2m" else 16000, rel=1e-6)
    assert rows["time_of_frames"] > rows["time"]
    if instrument != "moptop_2m":
        rows, _ = rows_of(umov, tmp_path, *at)
        assert "time_of_frames" not in rows
