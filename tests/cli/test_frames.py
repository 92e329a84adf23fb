"""umov observe with level = "image": frames as FITS files, and the counts that are taken from them."""
import math
import re
import statistics

import numpy
import pytest
from astropy.io import fits
from astropy.table import Table
from astropy.wcs import WCS

from conftest import ROOT
from sphere_over_maui import make_sphere, write_scene
from test_observe import pulls

BAND = 'bands = ["nm:550"]\nwidth_nm = 50\n'


@pytest.fixture
def scene(umov, tmp_path):
    """scene(observation, ...) writes observe.toml for a small white sphere."""
    make_sphere(umov, 1)

    def write(observation, telescope="", instrument="c11_imx250", stop="10", seeing=1):
        air = f'seeing = {{ arcsec = {seeing} }}\nscintillation = "none"\nsky = {{ mag = 20.0, p = 0.3 }}'
        return write_scene(tmp_path, BAND + observation, instrument=instrument, seed=11, atmosphere=air,
                           telescope=telescope, stop=f"2018-01-21T05:11:{stop}Z")

    return write


def frames(tmp_path):
    return sorted((tmp_path / "out/frames").glob("frame_*.fits"))


# A tracked star, a trail of some 70 px, and a fit of the image where it is two pixels wide.
AGREE = [("c11_imx250", 'exposure_s = 0.02\nframe_px = [72, 72]', "", 1, "30"),
         pytest.param("c11_imx250", 'exposure_s = 0.01\nframe_px = [160, 160]', 'tracking = "sidereal"', 1, "20", marks=pytest.mark.slow),
         ("c11_imx250", 'exposure_s = 0.02\nframe_px = [72, 72]\nphotometry = "image"', "", 0.6, "30"),
         pytest.param("hwp_wollaston_1m", 'exposure_s = 0.004\ncadence_s = 0.01\nframe_px = [64, 64]', "", 1.6, "45", marks=pytest.mark.slow)]


@pytest.mark.parametrize("instrument, observation, telescope, seeing, stop", AGREE)
def test_frames_tell_what_apertures_tell(scene, umov, tmp_path, instrument, observation, telescope, seeing, stop):
    path = scene(observation + '\nlevel = "image"', telescope, instrument, seeing=seeing, stop=stop)
    if telescope:  # a hundred and forty epochs to a trail
        make_sphere(umov, 2, 24)
    done = umov("observe", path)
    assert done.code == 0, done.err
    counts, truth = Table.read(tmp_path / "out/counts.ecsv"), Table.read(tmp_path / "out/truth.ecsv")
    light = {row["exposure"]: (row["I"], row["I"] * row["q"], row["I"] * row["u"]) for row in truth}
    expected = [sum(row[f"w{k}"] * light[row["exposure"]][k] for k in range(3)) for row in counts]
    found = sum(counts["counts"] - counts["sky"])
    assert 4 / math.sqrt(found) < 1e-3 and abs(found / sum(expected) - 1) < 1e-3
    assert umov("reduce", "out/counts.ecsv", "-o", "stokes.ecsv").code == 0
    for name, values in pulls(Table.read(tmp_path / "stokes.ecsv"), truth).items():
        n = len(values)
        # Four standard errors, and .05 of a pull: a box of pixels leaves .0004 in q. An sd is known to .018 to .022.
        assert n >= 1000 and abs(statistics.mean(values)) < 4 / math.sqrt(n) + 0.05, name
        assert abs(statistics.stdev(values) - 1) < 0.05, name


@pytest.mark.parametrize("tracking", ["sidereal", "fixed"])
def test_apertures_know_trails(scene, umov, tmp_path, tracking):
    """Of some 70 px of a trail frames and apertures hold the same light, pixels and sky."""
    observation = 'exposure_s = 0.01\ncadence_s = 0.1\nframe_px = [160, 160]\nlevel = "image"\n[detector]\nbits = 24\nwell_e = 0\ndark_e_s = 100'
    path = scene(observation, f'tracking = "{tracking}"', stop="01")
    make_sphere(umov, 20, 24)
    found = {}
    for level, changes in (("image", ()), ("aperture", ("--set", 'observation.level="aperture"'))):
        text = path.read_text() if level == "image" else path.read_text().replace('level = "image"', "").replace("frame_px = [160, 160]\n", "")
        (tmp_path / "now.toml").write_text(text)
        done = umov("observe", "now.toml", "-o", level)
        assert done.code == 0, done.err
        found[level] = Table.read(tmp_path / level / "counts.ecsv")
    image, aperture = found["image"], found["aperture"]
    mean = {level: {name: statistics.mean(table[name]) for name in ("n_pixel", "sky", "sky_err", "var_read")} for level, table in found.items()}
    assert mean["image"]["n_pixel"] > 300  # 70 px by two widths of 3 px on either side, a quarter of them
    # Whole pixels whose centres lie within: a part of a pixel at the edge of each.
    for name in ("n_pixel", "var_read"):
        assert abs(mean["aperture"][name] / mean["image"][name] - 1) < 0.02, (name, mean)
    # Four standard errors of the difference.
    sky_err = mean["image"]["sky_err"] * math.sqrt(2 / len(image))
    assert abs(mean["aperture"]["sky"] - mean["image"]["sky"]) < 4 * sky_err + 0.02 * mean["image"]["sky"], mean
    assert abs(mean["aperture"]["sky_err"] / mean["image"]["sky_err"] - 1) < 0.1, mean  # what a ring of some thousand pixels tells of its own scatter
    light = [sum(table["counts"] - table["sky"]) for table in (image, aperture)]
    # Square pixels widen images, so that a thousandth more is beyond two widths.
    assert abs(light[0] / light[1] - 1) < 2e-3, light
    assert max(abs(image["w0"] / aperture["w0"] - 1)) < 2e-3


def test_a_telescope_that_stands_follows_what_stands(umov, tmp_path):
    """GOES 15, .08 deg from the equator, in 10 s: an image without a trail for a telescope that stands, and 15.041 arcsec/s cos(dec)
    against the stars. Turned the wrong way a standing one would see twice that."""
    make_sphere(umov, 1, 24)
    pixels = {}
    for tracking in ("satellite", "fixed", "sidereal"):
        path = write_scene(tmp_path, BAND + "exposure_s = 10", atmosphere="seeing = { arcsec = 2 }", alt_m=2096,
                           telescope=f'tracking = "{tracking}"', start="2018-02-10T06:00:00Z", stop="2018-02-10T06:01:00Z")
        text = re.sub(r"orbit = .*", f'orbit = {{ file = "{ROOT}/data/tle/goes15.tle" }}', path.read_text())
        path.write_text(re.sub(r"lat_deg = .*\nlon_deg = .*", "lat_deg = 31.9584\nlon_deg = -111.5967", text).replace("Maui", "Kitt"))
        done = umov("observe", path, "-o", tracking)
        assert done.code == 0, done.err
        pixels[tracking] = Table.read(tmp_path / tracking / "counts.ecsv")
    n = {name: statistics.mean(table["n_pixel"]) for name, table in pixels.items()}
    radius = math.sqrt(4 * n["satellite"] / math.pi)  # a quarter of pi r^2 + 2 r L is each orientation's
    trail = 4 * (n["sidereal"] - n["satellite"]) / (2 * radius)
    rate = 15.041 * math.cos(math.radians(statistics.mean(pixels["sidereal"]["dec"])))
    # Focal length and pixel of the instrument. By itself it moves by .025 arcsec/s at most, .08 deg and an eccentricity of 1.6e-4 from a
    # smaller distance than the Earth's middle: 1 px, .002 of the trail. The Earth is turned about the pole of 2000, .1 deg off: 1 px more.
    assert abs(trail / (rate * 10 / math.degrees(3.45e-6 / 2.794) / 3600) - 1) < 0.003, (n, trail)
    assert abs(4 * (n["fixed"] - n["satellite"]) / (2 * radius)) < 2.1, n


@pytest.mark.parametrize("tracking", ["sidereal", "satellite"])
def test_bright_frames_have_the_light_of_the_aperture(scene, umov, tmp_path, tracking):
    """The same to 1e-4, for trails and for what is followed: a camera without limits, 3e9 electrons in all."""
    path = scene('exposure_s = 0.01\nframe_px = [160, 160]\nlevel = "image"\n[detector]\nbits = 24\nwell_e = 0', f'tracking = "{tracking}"',
                 stop="02")
    make_sphere(umov, 60, 24)
    done = umov("observe", path)
    assert done.code == 0, done.err
    counts, truth = Table.read(tmp_path / "out/counts.ecsv"), Table.read(tmp_path / "out/truth.ecsv")
    light = {row["exposure"]: (row["I"], row["I"] * row["q"], row["I"] * row["u"]) for row in truth}
    expected = sum(row[f"w{k}"] * light[row["exposure"]][k] for row in counts for k in range(3))
    found = sum(counts["counts"] - counts["sky"])
    assert 4 / math.sqrt(found) < 1e-4 and abs(found / expected - 1) < 1e-4


@pytest.mark.parametrize("mount", ["altaz", "equatorial"])
def test_world_coordinates_are_those_of_the_field(scene, umov, tmp_path, mount):
    """Stars at known places, while the telescope follows the stars or the object; astropy reads the header."""
    base = 'exposure_s = 0.01\nlevel = "image"\nframe_px = [200, 200]'
    steady = f'tracking_error_arcsec = 0\nmount = "{mount}"\n'
    assert umov("observe", scene(base, steady, stop="00.01")).code == 0
    with fits.open(frames(tmp_path)[0]) as file:
        world = WCS(file[0].header)
    places = [(40.3, 150.2), (160.7, 60.4)]
    lines = ["ra_deg,dec_deg,mag"]
    for x, y in places:
        sky = world.pixel_to_world(x, y)
        lines.append(f"{float(sky.ra.deg)!r},{float(sky.dec.deg)!r},3.5")
    (tmp_path / "stars.csv").write_text("\n".join(lines) + "\n")
    path = scene(base + '\nstars = "stars.csv"', steady + 'tracking = "sidereal"', stop="00.01")
    done = umov("observe", path, "--force")
    assert done.code == 0, done.err
    with fits.open(frames(tmp_path)[0]) as file:
        data = file[0].data.astype(float) - file[0].header["BIASLVL"]
        assert file[0].header["EXPTIME"] == 0.01 and file[0].header["INSTRUME"] == "c11_imx250"
    rows, columns = numpy.mgrid[0:200, 0:200]
    for x, y in places:
        near = (abs(columns - x) < 12) & (abs(rows - y) < 12)
        light = numpy.where(near, data - numpy.median(data), 0)
        # The object's trail is a straight line through the middle; a star of 3.5 mag is 3e4 electrons here.
        assert abs((light * columns).sum() / light.sum() - x) < 0.3
        assert abs((light * rows).sum() / light.sum() - y) < 0.3


def test_what_is_not_followed_trails(scene, umov, tmp_path):
    observation = 'exposure_s = 0.02\nlevel = "image"\nframe_px = [256, 256]'
    assert umov("observe", scene(observation, 'tracking_error_arcsec = 0\ntracking = "fixed"', stop="00.02")).code == 0
    with fits.open(frames(tmp_path)[0]) as file:
        data = file[0].data.astype(float) - numpy.median(file[0].data)
        scale = file[0].header["PIXSCALE"]
    truth = Table.read(tmp_path / "out/truth.ecsv")[0]
    rows, columns = numpy.nonzero(data > 0.3 * data.max())
    places = numpy.stack([columns - columns.mean(), rows - rows.mean()], axis=1)
    along = places @ numpy.linalg.svd(places, full_matrices=False)[2][0]
    expected = truth["rate"] * 3600 * 0.02 / scale  # the mount stands still: all of the motion over the sky
    assert abs(numpy.ptp(along) - expected) < 6  # beyond its ends the trail fades over a width of 4 px


def test_frames_do_not_depend_on_threads_and_replace_older_ones(scene, umov, tmp_path):
    path = scene('exposure_s = 0.05\ncadence_s = 1\nlevel = "image"', stop="06")
    assert umov("observe", path, "--threads", 1).code == 0
    one = [file.read_bytes() for file in frames(tmp_path)]
    assert umov("observe", path, "--threads", 2).code == 0
    assert one == [file.read_bytes() for file in frames(tmp_path)] and len(one) == 6
    assert umov("observe", path, "--set", "observation.cadence_s=2").code == 0
    assert len(frames(tmp_path)) == 3
    (tmp_path / "out/frames/mine.txt").write_text("x")
    done = umov("observe", path)
    assert done.code != 0 and (tmp_path / "out/frames/mine.txt").exists()
    assert [file for file in tmp_path.iterdir() if file.name.startswith(".out")] == []


def test_frames_of_the_locked_scenario(scene, umov, tmp_path):
    (tmp_path / "stars.csv").write_text("ra_deg,dec_deg,mag\n10,20,5\n")
    path = scene('exposure_s = 0.05\ncadence_s = 1\nlevel = "image"\nstars = "stars.csv"\nframe_px = [64, 80]', stop="02")
    assert umov("observe", path).code == 0
    assert umov("observe", "out/scenario.lock.toml", "-o", "again").code == 0
    assert [f.read_bytes() for f in frames(tmp_path)] == \
        [f.read_bytes() for f in sorted((tmp_path / "again/frames").glob("*.fits"))]


REFUSED = [("exposure_s = 1\nframe_px = [64, 64]", "level"), ('exposure_s = 1\nlevel = "image"\nframe_px = [64]', "rows"),
           ('exposure_s = 1\nlevel = "image"\nframe_px = [4, 4]', "16"),
           ('exposure_s = 1\nlevel = "picture"', "image"), ('exposure_s = 1\nlevel = "image"\nphotometry = "sum"', "aperture")]


@pytest.mark.parametrize("observation, told", REFUSED)
def test_what_is_refused(scene, umov, observation, told):
    done = umov("observe", scene(observation))
    assert done.code == 3 and told in done.err and "observe.toml:" in done.err, done.err


def test_fields_that_are_refused(scene, umov, tmp_path):
    path = scene('exposure_s = 1\nlevel = "image"\nstars = "stars.csv"')
    for text, told in (("ra_deg,dec_deg\n1,2\n", "mag"), ("ra_deg,dec_deg,mag\n1,95,3\n", "-90 to 90"),
                       ("ra_deg,dec_deg,mag\n1,x,3\n", "stars.csv:2")):
        (tmp_path / "stars.csv").write_text(text)
        done = umov("observe", path)
        assert done.code == 3 and told in done.err, done.err


def test_troubles_are_told(scene, umov, tmp_path):
    path = scene('exposure_s = 0.02\nlevel = "image"\nframe_px = [64, 64]', 'tracking = "sidereal"', stop="00.06")
    done = umov("observe", path)
    assert done.code == 0 and "frame_px" in done.err, done.err


def test_a_trail_cut_into_pieces_is_a_light_curve(scene, umov, tmp_path):
    """Pieces hold the counts of the whole trail between them, each with the light of its own time."""
    observation = 'exposure_s = 0.02\ncadence_s = 0.05\nframe_px = [256, 256]\nlevel = "image"'
    whole = scene(observation, 'tracking = "sidereal"', stop="04")
    make_sphere(umov, 5, 24)
    assert umov("observe", whole, "-o", "whole").code == 0
    cut = scene(observation + '\ntrail = "slices"', 'tracking = "sidereal"', stop="04")
    done = umov("observe", cut)
    assert done.code == 0, done.err
    all_of_it, counts = Table.read(tmp_path / "whole/counts.ecsv"), Table.read(tmp_path / "out/counts.ecsv")
    truth = Table.read(tmp_path / "out/truth.ecsv")
    pieces = len(truth) / (len(all_of_it) / 4)
    # 0.53 deg/s over 0.02 s is 149 px of 0.2547", and a star 4 to 5 px wide: 1" at the zenith, 35 deg from it.
    assert 25 < pieces < 40 and len(counts) == 4 * len(truth)
    assert sum(counts["counts"]) == pytest.approx(sum(all_of_it["counts"]), rel=1e-12)
    assert sum(counts["n_pixel"]) == sum(all_of_it["n_pixel"])
    assert sum(counts["sky"]) == pytest.approx(sum(all_of_it["sky"]), rel=1e-9)
    # What a piece has lost to its neighbours they have gained: shares add up, but for the ring's .00004.
    assert sum(counts["w0"]) == pytest.approx(sum(all_of_it["w0"]), rel=2e-4)
    assert umov("reduce", "out/counts.ecsv", "-o", "stokes.ecsv").code == 0
    for name, values in pulls(Table.read(tmp_path / "stokes.ecsv"), truth).items():
        n = len(values)
        assert n > 2000 and abs(statistics.mean(values)) < 4 / math.sqrt(n) + 0.05, name
        assert abs(statistics.stdev(values) - 1) < 0.05, name


def test_pieces_of_a_trail_follow_the_light(scene, umov, tmp_path):
    """A plate that turns three times in a second, in one exposure of the stars: its pieces against short exposures of what is followed."""
    assert umov("mesh", "make", "plate", "--width", 2, "--height", 2, "--two-sided", "-o", "sphere.obj").code == 0

    def turning(path):
        text = path.read_text()
        path.write_text(text.replace("materials =", 'attitude = { mode = "spin", axis = "+X", rate_deg_s = 1080 }\nmaterials ='))
        return path

    frame = 'exposure_s = 0.1\nframe_px = [1024, 1024]\nlevel = "image"\ntrail = "slices"'
    done = umov("observe", turning(scene(frame, 'tracking = "sidereal"\ntracking_error_arcsec = 0', stop="00.1")))
    assert done.code == 0, done.err
    cut = Table.read(tmp_path / "out/truth.ecsv")
    done = umov("observe", turning(scene("exposure_s = 0.0006", 'tracking = "satellite"', stop="00.1")), "-o", "short")
    assert done.code == 0, done.err
    short = Table.read(tmp_path / "short/truth.ecsv")
    times = numpy.array([float(text[17:].rstrip("Z")) for text in cut["time_utc"]])
    inside = slice(1, -1)  # ends have half a star
    expected = numpy.interp(times[inside], 0.0006 * (numpy.arange(len(short)) + 0.5), short["I"])
    found = numpy.array(cut["I"])[inside]
    assert max(expected) > 1.5 * min(expected)
    # A piece is as long as a star is wide, .4 deg of the plate's turn: what bends over that is lost.
    assert numpy.abs(found - expected).max() < 0.01 * max(expected)
