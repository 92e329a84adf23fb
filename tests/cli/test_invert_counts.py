"""umov invert on counts, as umov observe records them, in place of what umov reduce makes of them. Light is by rays, noise by
umov observe; the fit looks light up in masks."""
import json
import os
import re
import subprocess

import pytest
from astropy.table import Table

from conftest import ROOT, UMOV
from test_invert import KNOWN, TRUTHS, apart, in_set, scene  # noqa: F401


@pytest.fixture
def record(umov, scene, tmp_path):
    """record(exposure, ...): obs/counts.ecsv and stokes.ecsv of the cubesat, and fit.toml of one band."""

    def run(exposure_s, cadence_s=20, instrument="c11_imx250", seed=1):
        for name, method in (("truth", "rays"), ("fit", "masks")):
            path = tmp_path / scene(TRUTHS[0], method, name)
            path.write_text(path.read_text().replace('"paper_rgb"', '["bessell-V"]'))
        words = [f'instrument="{instrument}"', 'observation.bands=["bessell-V"]', f"observation.exposure_s={exposure_s}",
                 f"observation.cadence_s={cadence_s}", f"seed={seed}"]
        done = umov("observe", "truth.toml", "-o", "obs", "--force", "-q", *(w for key in words for w in ("--set", key)))
        assert done.code == 0, done.err
        assert umov("reduce", "obs/counts.ecsv", "-o", "stokes.ecsv", "-q").code == 0

    return run


@pytest.mark.long
def test_counts_say_what_their_stokes_parameters_say(umov, record, tmp_path):
    """S/N of 30 and more: attitudes agree within their errors, and the truth lies in the set of the counts."""
    record(2.0)
    best = []
    for name in ("obs/counts.ecsv", "stokes.ecsv"):
        done = umov("invert", "pose", name, "--scenario", "fit.toml", "-o", "answer", "--force", "--json", "--grid", "10000",
                    "--threads", "2")
        assert done.code == 0, done.err
        verdict = json.loads(done.out)
        assert verdict["p_value"] > 1e-3
        mode = verdict["modes"][0]
        assert apart(TRUTHS[0], mode["q"]) < max(3, 3 * mode["sd_deg"])
        best.append((verdict, mode))
        if name == "obs/counts.ecsv":
            assert in_set(tmp_path / "answer", TRUTHS[0])
    (counts, a), (stokes, b) = best
    assert counts["dof"] > stokes["dof"]  # four channels an exposure in place of I, q and u
    assert apart(a["q"], b["q"]) < 2 * max(a["sd_deg"], b["sd_deg"])
    assert a["scale"] == pytest.approx(b["scale"], rel=0.02)


@pytest.mark.long
def test_brightness_alone_is_that_of_the_reduced_sets(umov, record):
    """One channel an exposure says nothing of I by itself where q and u are left aside."""
    record(2.0, instrument="usafa16", cadence_s=5)
    found = []
    for name in ("obs/counts.ecsv", "stokes.ecsv"):
        done = umov("invert", "pose", name, "--scenario", "fit.toml", "--grid", "2000", "--intensity-only", "--json")
        assert done.code in (0, 4), done.err
        found.append(json.loads(done.out))
    for key in ("dof", "chi2", "modes"):
        assert found[0][key] == found[1][key], key


def test_a_material_from_counts(umov, record):
    record(2.0, cadence_s=12)
    done = umov("invert", "material", "obs/counts.ecsv", "--scenario", "fit.toml", "--group", "body_my", "--candidates",
                "paint_white,paint_black", "--json")
    assert done.code == 0, done.err
    found = json.loads(done.out)
    white = next(row for row in found["materials"] if "paint_white" in row["materials"])
    assert white["probability"] > 0.95


def test_what_is_wrong_with_counts_is_named(umov, record, tmp_path):
    record(2.0, cadence_s=60)
    ask = ("--scenario", "fit.toml", "--group", "body_my", "--candidates", "paint_white,paint_black")
    done = umov("invert", "material", "obs/counts.ecsv", "stokes.ecsv", *ask)
    assert done.code == 3 and "counts beside light curves" in done.err
    text = (tmp_path / "obs/counts.ecsv").read_text()
    rows = text.splitlines()
    (tmp_path / "two.ecsv").write_text("\n".join(rows[:-1] + [rows[-1].replace("cubesat", "another")]) + "\n")
    done = umov("invert", "material", "two.ecsv", *ask)
    assert done.code == 3 and "an inversion is of one object" in done.err
    (tmp_path / "bare.ecsv").write_text("\n".join(line for line in rows if "pol_frame" not in line) + "\n")
    done = umov("invert", "material", "bare.ecsv", *ask)
    assert done.code == 3 and "pol_frame" in done.err


MATERIAL = ("--scenario", "fit.toml", "--group", "body_my", "--candidates", "paint_white,paint_black")


def test_another_place_than_the_observers_is_refused(umov, record, tmp_path):
    """Both places are named, of counts and of what they were reduced to; a pillar beside is the same place."""
    record(2.0, cadence_s=60)
    text = (tmp_path / "fit.toml").read_text()
    lon = re.search(r"^lon_deg = (.*)$", text, re.MULTILINE).group(1)
    for shift, code in ((0.001, 0), (-0.1, 3)):
        (tmp_path / "fit.toml").write_text(text.replace(f"lon_deg = {lon}", f"lon_deg = {float(lon) + shift:.4f}"))
        for name in ("obs/counts.ecsv", "stokes.ecsv"):
            done = umov("invert", "material", name, *MATERIAL)
            assert done.code in (code, 4 if code == 0 else code), done.err
            if code:  # a tenth of a degree of longitude: 111.32 km cos(lat) / 10
                assert name in done.err and "fit.toml" in done.err and "10 km away" in done.err
                assert lon in done.err and f"{float(lon) + shift:.4f}" in done.err
    counts = (tmp_path / "obs/counts.ecsv").read_text()
    (tmp_path / "bad.ecsv").write_text(re.sub(r'(site_lat_deg\W+)[\d.]+', r'\1north', counts))
    done = umov("invert", "material", "bad.ecsv", *MATERIAL)
    assert done.code == 3 and 'site_lat_deg of the header is "north"' in done.err


def test_what_is_left_out_is_told_with_how_many_of_how_many(umov, record, tmp_path):
    record(2.0, cadence_s=60)
    head, *rows = [line for line in (tmp_path / "obs/counts.ecsv").read_text().splitlines(True)
                   if not line.startswith("#")]
    comments = [line for line in (tmp_path / "obs/counts.ecsv").read_text().splitlines(True) if line.startswith("#")]
    column = head.split().index("saturated")
    first_set = [k for k, row in enumerate(rows) if row.split()[head.split().index("set_id")] == rows[0].split()[head.split().index("set_id")]]
    assert 1 < len(first_set) < len(rows)
    cells = rows[0].split(" ")
    cells[column] = "True"
    (tmp_path / "full.ecsv").write_text("".join([*comments, head, " ".join(cells), *rows[1:]]))
    done = umov("invert", "material", "full.ecsv", *MATERIAL)
    assert f"1 of {len(rows)} counts left out: saturated" in done.err, done.err
    done = umov("invert", "material", "full.ecsv", *MATERIAL, "--intensity-only")
    sets = len({row.split()[head.split().index("set_id")] for row in rows})
    assert f"1 of {sets} sets left out: some of their counts are saturated" in done.err, done.err
    # An hour later the object is somewhere else: what is below the horizon there is counted channel by channel.
    time = head.split().index("time_utc")
    late = [row.replace(row.split(" ")[time], row.split(" ")[time].replace("T05:", "T06:")) for row in rows[-8:]]
    (tmp_path / "late.ecsv").write_text("".join([*comments, head, *rows[:-8], *late]))
    done = umov("invert", "material", "late.ecsv", *MATERIAL)
    assert f"8 of {len(rows)} counts left out: the object was" in done.err, done.err


def test_threads_are_heeded_where_counts_are_reduced(umov, record, tmp_path):
    """Ten thousand sets take long enough that a second thread would be seen."""
    record(2.0, cadence_s=60)
    lines = (tmp_path / "obs/counts.ecsv").read_text().splitlines()
    head = next(line for line in lines if not line.startswith("#"))
    rows, at = lines[lines.index(head) + 1:], head.split().index("set_id")
    one = [row.split(" ") for row in rows if row.split(" ")[at] == rows[0].split(" ")[at]]
    many = [" ".join([*row[:at], str(k), *row[at + 1:]]) for k in range(10000) for row in one]
    (tmp_path / "many.ecsv").write_text("\n".join([*lines[:lines.index(head) + 1], *many]) + "\n")
    job = subprocess.Popen([UMOV, "invert", "material", "many.ecsv", *MATERIAL, "--threads", "1", "-q"], cwd=tmp_path,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    most = 0
    while job.poll() is None:
        try:
            most = max(most, len(os.listdir(f"/proc/{job.pid}/task")))
        except FileNotFoundError:
            break
    job.wait()
    assert most == 1


WHEEL = """umov = 1
title = "a rocket body that turns by nine degrees from one polarizer to the next"
seed = 5
[observer]
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T05:12:50Z
stop = 2018-01-21T05:15:00Z
only = { alt_min_deg = 20, sun_alt_max_deg = -6, sunlit = true }
[[object]]
name = "Agena"
orbit = { file = "ROOT/data/tle/agena733.tle", norad = 733 }
mesh = { file = "ROOT/data/mesh/agena.obj", unit = "m", up = "+Z", normals = "smooth" }
attitude = { mode = "spin", axis = "+X", period_s = 20EPOCH }
[object.materials]
default = "paint_white"
[bands]
set = ["Bessell.V", "Bessell.I"]
[telescope]
aperture_m = 0.4
obstruction = 0.35
focal_length_m = 3.3
throughput = 0.5
[detector]
model = "ccd"
pixel_um = 13
read_e = 10
dark_e_s = 1
well_e = 1e5
gain_e_adu = 2
[polarimeter]
type = "polarizer_wheel"
x_axis_deg = 0
[atmosphere]
scintillation = "none"
[observation]
bands = ["Bessell.V", "Bessell.I"]
exposure_s = 0.02
cadence_s = 0.5
[output]
dir = "obs"
formats = ["ecsv"]
pol_frame = "altaz"
""".replace("ROOT", str(ROOT))


def test_parts_and_changes_of_a_body_that_turns_between_analysers(umov, tmp_path):
    """Sets that are reduced as of a body at rest make polarization of its turning: fits of them were 30,000 in chi-square off."""
    (tmp_path / "wheel.toml").write_text(WHEEL.replace("EPOCH", ", epoch = 2018-01-21T05:09:00Z"))
    assert umov("observe", "wheel.toml", "-q").code == 0
    ask = ("obs/counts.ecsv", "--scenario", "wheel.toml", "--json")
    done = umov("invert", "material", *ask, "--group", "tank_aluminium", "--candidates", "paint_white,aluminium,paint_black", "-o", "made_of")
    assert done.code == 0, done.err
    found = json.loads(done.out)
    assert found["verdict"] == "determined"
    white = next(row for row in found["materials"] if "paint_white" in row["materials"])
    assert abs(white["fraction"] - 1) < 4 * white["fraction_err"] and white["fraction_err"] < 0.05
    assert not found["u_null_test"]["flagged"]
    # I alone is what no single analyser tells.
    parts = Table.read(tmp_path / "made_of/parts.ecsv")
    assert set(parts["measured"]) == {"I,q,u"} and len(set(parts["bands"])) == 3
    assert "tank_aluminium of Agena is paint_white" in (tmp_path / "made_of/log.txt").read_text()
    done = umov("invert", "health", *ask, "--drift", "tank_aluminium=paint_black")
    assert done.code == 0, done.err
    found = json.loads(done.out)
    assert found["verdict"] == "determined" and abs(found["health"][0]["sigma"]) < 4
    assert not found["u_null_test"]["flagged"]


def test_the_epoch_that_is_assumed_is_the_scenarios(umov, tmp_path):
    """Not the first row's, which would be another attitude."""
    (tmp_path / "wheel.toml").write_text(WHEEL.replace("EPOCH", ""))
    assert umov("observe", "wheel.toml", "-q").code == 0
    done = umov("invert", "health", "obs/counts.ecsv", "--scenario", "wheel.toml", "--set", "time.start=2018-01-21T05:12:00Z", "--drift",
                "tank_aluminium=paint_black")
    assert "Set epoch = 2018-01-21T05:12:00.000Z" in done.err, done.err
