"""Trains of mirrors between telescope and instrument, and shutters that roll."""
import math
import statistics

import pytest
from astropy.table import Table

from sphere_over_maui import make_sphere, write_scene
from test_observe import pulls

BAND = 'bands = ["nm:550"]\nwidth_nm = 50\n'
QUIET = 'seeing = { arcsec = 1 }\nscintillation = "none"\nsky = { mag = 20.0, p = 0.3 }'


def rows_of(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


def observe(umov, tmp_path, out, observation, telescope, **more):
    path = write_scene(tmp_path, BAND + observation, telescope=telescope, atmosphere=QUIET, **more)
    done = umov("observe", path, "-o", out)
    assert done.code == 0, done.err
    return tmp_path / out


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_train_of_one_mirror_is_a_nasmyth_port(umov, tmp_path, side):
    """Traced axes against the closed rule, to the last digits of the rows (drawn counts are whole numbers)."""
    make_sphere(umov, 1)
    named = observe(umov, tmp_path, "named", "exposure_s = 0.1", f'port = "nasmyth_{side}"')
    traced = observe(umov, tmp_path, "traced", "exposure_s = 0.1", f'port = {{ mirrors = ["{side}"] }}')
    a, b = Table.read(named / "counts.ecsv"), Table.read(traced / "counts.ecsv")
    assert len(a) > 100 and list(a["counts"]) == list(b["counts"]) and list(a["sky"]) == pytest.approx(list(b["sky"]), rel=1e-9)
    for name in ("w0", "w1", "w2", "w3"):
        assert list(a[name]) == pytest.approx(list(b[name]), rel=1e-12, abs=1e-12 * max(a["w0"]))
    # A mirror polarizes: .031 at 550 nm (the anchor aluminium_q_550), across its plane of incidence.
    assert max(abs(row["w3"]) for row in a) > 0.05 * max(a["w0"])


@pytest.mark.parametrize("port, instrument, observation", [
    ('{ mirrors = ["right", "back", "down", "east"] }', "c11_imx250", "exposure_s = 0.05"),
    ('{ mirrors = ["left", { to = "down", mirror = "Ag_Johnson" }, "south"], x_from = "down" }', "c11_imx250", "exposure_s = 0.05"),
    pytest.param('{ mirrors = ["right", "down"], x_from = "north" }', "moptop_2m", "exposure_s = 0.02", marks=pytest.mark.slow)])
def test_what_went_through_a_train_is_found_again(umov, tmp_path, port, instrument, observation):
    make_sphere(umov, 1)
    out = observe(umov, tmp_path, "out", observation, f"port = {port}", instrument=instrument, frame="equatorial",
                  stop="2018-01-21T05:12:00Z")
    assert umov("reduce", "out/counts.ecsv", "-o", "stokes.ecsv").code == 0
    truth = Table.read(out / "truth.ecsv")
    for name, values in pulls(Table.read(tmp_path / "stokes.ecsv"), truth).items():
        n = len(values)
        assert n >= 60 and abs(statistics.mean(values)) < 4 / math.sqrt(n), name
        assert abs(statistics.stdev(values) - 1) < 4 / math.sqrt(2 * n), name
    done = umov("observe", "out/scenario.lock.toml", "-o", "again")
    assert done.code == 0, done.err
    assert rows_of(tmp_path / "again/counts.ecsv") == rows_of(out / "counts.ecsv")


@pytest.mark.parametrize("port, told", [
    ("{ mirrors = [] }", "without mirrors"), ("{ }", "mirrors"), ("7", "was expected"), ('"coude"', "nasmyth_left"),
    ('{ mirrors = ["down"] }', "along the altitude axis"), ('{ mirrors = ["right", "left"] }', "on that line already"),
    ('{ mirrors = ["right", "north"] }', "azimuth axis"), ('{ mirrors = ["right", "down", "east", "up", "back"] }', "left the fork"),
    ('{ mirrors = ["right", "sideways"] }', "forward"), ('{ mirrors = ["right", 3] }', "neither a text nor a table"),
    ('{ mirrors = ["right"], x_from = "north" }', "up or down"), ('{ mirrors = ["right", "down"], x_from = "up" }', "horizontal"),
    ('{ mirrors = [{ to = "right", mirror = "Unobtainium" }] }', "Unobtainium"), ('{ mirrors = ["right"], x = 1 }', "x_from"),
    ('{ mirrors = ["right"] }\nmount = "equatorial"', "altitude axis")])
def test_trains_that_are_refused(umov, tmp_path, port, told):
    make_sphere(umov, 1, 24)
    done = umov("observe", write_scene(tmp_path, BAND + "exposure_s = 1", telescope=f"port = {port}"))
    assert done.code == 3 and told in done.err and "observe.toml:" in done.err, done.err


ROLLING = "[detector]\nmodel = \"ideal\"\nbits = 24\nwell_e = 0\nshutter = \"rolling\"\nline_time_s = 9.24e-6\n[polarimeter]\nx_axis_deg = {}\n"


def light_of(out):
    counts = Table.read(out / "counts.ecsv")
    return sum(counts["counts"] - counts["sky"])


def test_a_rolling_shutter_exposes_what_runs_along_longer(umov, tmp_path):
    """1/(1 - v line time) times as long, for v rows a second: of two axes at right angles both v make the motion over the sky."""
    make_sphere(umov, 60, 24)
    span = dict(stop="2018-01-21T05:11:00.01Z")
    plain = observe(umov, tmp_path, "plain", "exposure_s = 0.01", 'tracking = "fixed"\n[detector]\nmodel = "ideal"', **span)
    lines = {}
    for axis in (0, 90, 180, 270):
        out = observe(umov, tmp_path, f"axis{axis}", "exposure_s = 0.01", 'tracking = "fixed"\n' + ROLLING.format(axis), **span)
        lines[axis] = 1 - light_of(plain) / light_of(out)
    # 1e7 electrons: .0004 of two of them.
    assert abs(lines[0] + lines[180]) < 2e-3 and abs(lines[90] + lines[270]) < 2e-3
    rate = Table.read(plain / "truth.ecsv")["rate"][0]  # 0.526 deg/s: test_observe_pass.py
    expected = rate * 3600 / (math.degrees(3.45e-6 / 2.794) * 3600) * 9.24e-6
    assert 0.05 < expected and abs(math.hypot(lines[0], lines[90]) / expected - 1) < 0.02
    # Of rows read ten times as slowly, more than half of which is refused: by the motion along the rows' order alone.
    answers = set()
    for axis in range(0, 180, 20):
        along = 10 * abs(lines[0] * math.cos(math.radians(axis)) + lines[90] * math.sin(math.radians(axis)))
        path = write_scene(tmp_path, BAND + "exposure_s = 0.01", atmosphere=QUIET,
                           telescope='tracking = "fixed"\n' + ROLLING.format(axis).replace("9.24e-6", "9.24e-5"), **span)
        if abs(along - 0.5) > 0.02:
            done = umov("observe", path, "-o", f"slow{axis}")
            answers.add(done.code)
            assert done.code == (3 if along > 0.5 else 0) and ("rows a second" in done.err) == (along > 0.5), (axis, along, done.err)
    assert answers == {0, 3}
    framed = observe(umov, tmp_path, "framed", "exposure_s = 0.01\nlevel = \"image\"\nframe_px = [200, 200]",
                     'tracking = "fixed"\ntracking_error_arcsec = 0\n' + ROLLING.format(90), **span)

    def of_what_the_rows_say(out):  # rows know how much of the image is in the aperture, and nothing of the shutter
        return light_of(out) / sum(Table.read(out / "counts.ecsv")["w0"])

    assert abs(of_what_the_rows_say(framed) / of_what_the_rows_say(tmp_path / "axis90") - 1) < 2e-3


def test_a_rolling_shutter_leaves_alone_what_is_followed(umov, tmp_path):
    make_sphere(umov, 10, 24)
    for name, lines in (("rolling", ROLLING.format(30)), ("global", "[detector]\nmodel = \"ideal\"\nbits = 24\nwell_e = 0\n")):
        observe(umov, tmp_path, name, "exposure_s = 0.01", 'tracking = "satellite"\n' + lines, stop="2018-01-21T05:11:00.05Z")
    assert rows_of(tmp_path / "rolling/counts.ecsv") == rows_of(tmp_path / "global/counts.ecsv")
