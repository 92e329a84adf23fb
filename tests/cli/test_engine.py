"""Many poses at once: masks against rays, binary tables, the benchmark's mesh."""
import math
import signal
import subprocess
import time
import warnings

import pytest
from astropy.table import Table

from conftest import UMOV, read_csv


@pytest.fixture
def wing(umov, scenario, tmp_path):
    """A scene of the benchmark's satellite."""
    assert umov("mesh", "make", "box-wing", "--facets", 3000, "-o", "wing.obj").code == 0
    return scenario(
        ("cube.obj", "wing.obj"),
        ('default = "paper_al"',
         'bus = "paper_au"\npanels = "paper_asi"\ndish = "paper_spectralon"\ntank = "paper_al"'))


def test_masks_agree_with_rays_within_what_both_say(umov, wing, tmp_path):
    for method in ("masks", "rays"):
        done = umov("signature", wing, "--poses", 40, "--phase", "40,90,130", "--visibility", method,
                    "--accuracy", 0.004, "-o", f"{method}.csv")
        assert done.code == 0, done.err
    masks, rays = read_csv(tmp_path / "masks.csv"), read_csv(tmp_path / "rays.csv")
    assert len(masks) == len(rays) == 40 * 3 * 3
    covered = 0
    for m, r in zip(masks, rays):
        assert m["pose"] == r["pose"] and m["sun_x"] == r["sun_x"]
        apart = abs(float(m["intensity"]) - float(r["intensity"]))
        covered += apart <= float(m["intensity_err"]) + float(r["intensity_err"])
    # Two 95 % half-widths added: 90 % of 360 rows leaves room for poses that share their error.
    assert covered >= 0.9 * len(masks)


def test_fits_table_opens_with_units_and_the_same_numbers(umov, wing, tmp_path):
    for name in ("a.csv", "a.fits"):
        done = umov("signature", wing, "--poses", 200, "--phase", "60", "--visibility", "masks",
                    "--seed", 3, "-o", name)
        assert done.code == 0, done.err
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = Table.read(tmp_path / "a.fits")
    rows = read_csv(tmp_path / "a.csv")
    assert len(table) == len(rows) == 600
    assert str(table["intensity"].unit) == "m2 / sr" and str(table["phase_angle"].unit) == "deg"
    assert table.meta["POLCCONV"] == "IAU"
    assert any("visibility: direction masks" in line for line in table.meta["comments"])
    for row, ours in zip(table, rows):
        assert row["band"].strip() == ours["band"] and row["pose"] == int(ours["pose"])
        assert row["intensity"] == float(ours["intensity"])
        assert math.isnan(row["q_scat"]) if ours["q_scat"] == "" else \
            row["q_scat"] == float(ours["q_scat"])


@pytest.mark.slow
def test_any_number_of_threads_gives_the_same_file(umov, wing, tmp_path):
    files = []
    for threads in (1, 2, 8):
        done = umov("signature", wing, "--poses", 3000, "--phase", "60,120", "--threads", threads,
                    "-o", f"{threads}.fits")
        assert done.code == 0, done.err
        files.append((tmp_path / f"{threads}.fits").read_bytes())
    assert files[0] == files[1] == files[2]


def test_a_stop_keeps_the_finished_rows_under_another_name(wing, tmp_path):
    process = subprocess.Popen([UMOV, "signature", wing, "--poses", "9000000", "--phase", "60",
                                "--visibility", "masks", "-o", "big.fits"], cwd=tmp_path,
                               stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline and not any(
            p.stat().st_size > 3_000_000 for p in tmp_path.glob("big.fits.part-*")):
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130, err
    assert "big.partial.fits" in err
    assert not (tmp_path / "big.fits").exists() and not list(tmp_path.glob("*.part-*"))
    table = Table.read(tmp_path / "big.partial.fits")
    assert 0 < len(table) < 27_000_000
    assert any("stopped by the user" in line for line in table.meta["comments"])


def test_a_laser_refuses_masks(umov, wing):
    done = umov("signature", wing, "--poses", 3, "--phase", "0", "--source", "laser",
                "--visibility", "masks")
    assert done.code == 2 and "laser" in done.err


def test_mesh_make_box_wing(umov, tmp_path):
    done = umov("mesh", "make", "box-wing", "--facets", 1000, "--crumple", 0.01, "-o", "foil.obj")
    assert done.code == 0, done.err
    done = umov("mesh", "check", "foil.obj", "--unit", "m", "--up", "+Z")
    assert done.code == 0, done.out + done.err


def test_masks_are_kept_and_read_again(umov, wing, tmp_path):
    ask = ("signature", wing, "--poses", 300, "--phase", "60", "--masks", "wing.masks")
    first = umov(*ask, "-o", "a.csv")
    assert first.code == 0 and "masks are kept in wing.masks" in first.err
    second = umov(*ask, "-o", "b.csv")
    assert second.code == 0 and "kept" not in second.err
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


@pytest.mark.parametrize("arguments, words", [
    (("--visibility", "masks", "--accuracy", 0.002), ["other.masks", "made for another", "Remove it"]),
    (("--visibility", "rays"), ["--masks goes with"]),
    (("--source", "laser", "--set", 'bands.set=["nm:550"]'), ["masks are for sunlight"]),
])
def test_masks_that_do_not_fit_are_refused(umov, wing, tmp_path, arguments, words):
    done = umov("signature", wing, "--poses", 10, "--phase", "60", "--masks", "other.masks",
                "-o", "a.csv")
    assert done.code == 0, done.err
    before = (tmp_path / "other.masks").read_bytes()
    done = umov("signature", wing, "--poses", 10, "--phase", "60", "--masks", "other.masks",
                "-o", "b.csv", *arguments)
    assert done.code in (2, 3) and all(word in done.err for word in words), done.err
    assert not (tmp_path / "b.csv").exists()
    assert (tmp_path / "other.masks").read_bytes() == before


def test_a_file_that_holds_no_masks_is_left_alone(umov, wing, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    done = umov("signature", wing, "--poses", 10, "--phase", "60", "--masks", "notes.txt")
    assert done.code == 3 and "notes.txt: is not a file of masks" in done.err
    assert (tmp_path / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("file, words", [(".", "this is a folder"), ("no/where", "no such folder")])
def test_a_place_that_cannot_hold_masks_is_told_at_once(umov, wing, tmp_path, file, words):
    done = umov("signature", wing, "--poses", 10, "--phase", "60", "--masks", file)
    assert done.code == 6 and words in done.err, done.err
    assert "preparing" not in done.err


def test_a_convex_body_keeps_no_masks(umov, scenario, tmp_path):
    done = umov("signature", scenario(), "--poses", 10, "--phase", "60", "--masks", "cube.masks",
                "-o", "a.csv")
    assert done.code == 0 and "convex" in done.err
    assert not (tmp_path / "cube.masks").exists()
