"""Parts of an observation: rows, headers and frames are those of the whole, byte for byte."""
import json

import pytest

from conftest import ROOT
from sphere_over_maui import make_sphere, write_scene

# Cloud and clock are drawn along the run, noise by exposure: none may know of the part. The sky is bright enough to be warned of.
OBSERVATION = 'bands = ["nm:550", "nm:650"]\nwidth_nm = 50\nexposure_s = 0.1\ncadence_s = 0.3\nclock_error_s = 0.01\n'
AIR = 'seeing = { arcsec = 3 }\nscintillation = { c_y = 0.5 }\nsky = { mag = 8.0, p = 0.3 }\ncloud = { sd_mag = 0.2, time_s = 2 }'
SECOND = """[[object]]
name = "a longer name"
orbit = {{ file = "{root}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "{mesh}", unit = "m", up = "+Z" }}
materials = {{ default = "gold" }}
"""


@pytest.fixture
def scene(umov, tmp_path):
    """scene(more...) writes observe.toml of a sphere, with an object of `mesh` beside it."""
    make_sphere(umov, 0.2)
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0

    def write(mesh=None, observation="", telescope="", stop="2018-01-21T05:11:20Z", formats='["ecsv", "csv", "fits"]'):
        path = write_scene(tmp_path, OBSERVATION + observation, atmosphere=AIR, telescope=telescope, seed=5, stop=stop)
        text = path.read_text().replace('["ecsv"]', formats)
        if mesh:
            text = text.replace("[atmosphere]", SECOND.format(root=ROOT, mesh=mesh) + "[atmosphere]")
        path.write_text(text)
        return path

    return write


def rows(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")][1:]


def header(path):
    return [line for line in path.read_text().splitlines() if line.startswith("#")]


TABLES = ("counts.ecsv", "counts.csv", "counts.fits", "truth.ecsv", "truth.csv", "truth.fits")


@pytest.mark.parametrize("per_shard", [1000, 50, 17])
@pytest.mark.parametrize("mesh", [None, "cube.obj"])
def test_an_observation_in_parts_is_the_plain_one(umov, scene, tmp_path, mesh, per_shard):
    """Warnings in the header count the exposures of all shards; those of before the first exposure are in the lock."""
    name = scene(mesh)
    plain = umov("observe", name, "-o", "plain")
    assert plain.code == 0, plain.err
    assert umov("scale", "plan", "job", "observe", name).code == 0 and not (tmp_path / "job").exists()
    done = umov("scale", "run", "--per-shard", per_shard, "job", "observe", name)
    assert done.code == 0, done.err
    lock = json.loads((tmp_path / "job/job.json").read_text())
    objects = 2 if mesh else 1
    assert lock["unit"] == "exposures" and sum(lock["layout"][::2]) == lock["total"] == 67 * objects
    assert "with a sky more than ten times" in (tmp_path / "plain/counts.ecsv").read_text()
    for table in TABLES:
        merged = umov("scale", "merge", "job", "--table", table.split(".")[0], "-o", table)
        assert merged.code == 0, merged.err
        assert (tmp_path / table).read_bytes() == (tmp_path / "plain" / table).read_bytes(), table


@pytest.mark.parametrize("of", [2, 5])
def test_shards_of_an_observation_are_its_rows(umov, scene, tmp_path, of):
    name = scene("cube.obj")
    assert umov("observe", name, "-o", "whole").code == 0
    counts, truth = [], []
    for k in range(of):
        done = umov("observe", name, "--shard", f"{k}/{of}", "-o", f"part_{k}")
        assert done.code == 0, done.err
        counts += rows(tmp_path / f"part_{k}/counts.ecsv")
        truth += rows(tmp_path / f"part_{k}/truth.ecsv")
    assert counts == rows(tmp_path / "whole/counts.ecsv") and truth == rows(tmp_path / "whole/truth.ecsv")


def test_a_range_is_drawn_as_in_the_whole(umov, scene, tmp_path):
    """Noise, cloud and clock of an exposure know its number and the seed, not what was asked for with it."""
    name = scene()
    assert umov("observe", name, "-o", "whole").code == 0
    assert umov("observe", name, "--range", "31:4", "-o", "part").code == 0
    whole, part = rows(tmp_path / "whole/truth.ecsv"), rows(tmp_path / "part/truth.ecsv")
    assert part == whole[31:35] and len(whole) == 67
    per = len(rows(tmp_path / "whole/counts.ecsv")) // 67
    assert rows(tmp_path / "part/counts.ecsv") == rows(tmp_path / "whole/counts.ecsv")[31 * per:35 * per]
    assert any("4 exposures with a sky" in line for line in header(tmp_path / "part/counts.ecsv"))
    assert umov("observe", name, "--set", "seed=6", "--range", "31:4", "-o", "other").code == 0
    assert rows(tmp_path / "other/counts.ecsv") != rows(tmp_path / "part/counts.ecsv")


def test_light_between_surfaces_is_shared_by_the_same_exposures(umov, scene, tmp_path):
    """Paths are drawn for a block of exposures, and the parts cut through it."""
    command = ["observe", scene("cube.obj", stop="2018-01-21T05:11:06Z"), "--set", "render.bounces=2", "--set", "render.accuracy=0.3"]
    assert umov(*command, "-o", "whole").code == 0
    counts = []
    for k in range(3):
        assert umov(*command, "--shard", f"{k}/3", "-o", f"part_{k}").code == 0
        counts += rows(tmp_path / f"part_{k}/counts.ecsv")
    assert counts == rows(tmp_path / "whole/counts.ecsv")


def test_frames_of_parts_are_those_of_the_whole(umov, scene, tmp_path):
    name = scene(observation='level = "image"\nframe_px = [48, 48]\n', stop="2018-01-21T05:11:03Z", formats='["ecsv"]')
    assert umov("observe", name, "-o", "whole").code == 0
    names = sorted(path.name for path in (tmp_path / "whole/frames").iterdir())
    found = []
    for k in range(3):
        assert umov("observe", name, "--shard", f"{k}/3", "-o", f"part_{k}").code == 0
        for path in sorted((tmp_path / f"part_{k}/frames").iterdir()):
            found.append(path.name)
            assert path.read_bytes() == (tmp_path / "whole/frames" / path.name).read_bytes()
    assert found == names and len(names) == 10
    refused = umov("scale", "run", "job", "observe", name)
    assert refused.code == 3 and "--shard" in refused.err and "observe.toml" in refused.err
    assert not (tmp_path / "job").exists()


def test_saturation_is_told_of_the_whole(umov, scene, tmp_path):
    """All exposures of the whole are an error; of a part they are a warning, as the others may be well."""
    name = scene(telescope="throughput = 1.0", stop="2018-01-21T05:11:03Z")
    full = ["observe", name, "--set", "observation.exposure_s=0.29"]
    path = tmp_path / "observe.toml"
    path.write_text(path.read_text().replace("mag = 8.0", "mag = -3.0"))
    plain = umov(*full, "-o", "plain")
    assert plain.code == 4 and "every exposure of 10 is saturated" in plain.err, plain.err
    part = umov(*full, "--shard", "0/2", "-o", "part")
    assert part.code == 0 and "5 of 5 exposures are saturated" in part.err, part.err
    assert umov("scale", "run", "--per-shard", 4, "job", *full).code == 0
    merged = umov("scale", "merge", "job", "-o", "counts.ecsv")
    assert merged.code == 4 and "every exposure of 10 is saturated" in merged.err, merged.err
    assert not (tmp_path / "counts.ecsv").exists()


def test_what_is_kept_in_place_of_rows_warns_as_they_do(umov, scene, tmp_path):
    """Whichever table is asked for: what was noticed is of the rows that were made, not of one table."""
    done = umov("scale", "run", "--per-shard", 25, "--reduce", "most:counts:3", "--reduce", "histogram:counts:0:1e9:2", "job",
                "observe", scene())
    assert done.code == 0, done.err
    for table in ("most_counts", "histogram_counts"):
        assert umov("scale", "merge", "job", "--table", table, "-o", "kept.csv").code == 0
        assert any("warning_1" in line and "67 exposures with a sky" in line for line in header(tmp_path / "kept.csv")), table


@pytest.mark.parametrize("part, told", [(("--shard", "3/3"), "K from 0"), (("--range", "60:20"), "67 exposures"),
                                        (("--shard", "80/90"), "67 exposures")])
def test_a_part_that_is_none(umov, scene, part, told):
    done = umov("observe", scene(), *part, "-o", "part")
    assert done.code in (2, 5) and part[0] in done.err and told in done.err, done.err


def test_other_inputs_are_refused(umov, scene, tmp_path):
    name = scene()
    assert umov("scale", "lock", "--per-shard", 20, "job", "observe", name).code == 0
    (tmp_path / "observe.toml").write_text((tmp_path / "observe.toml").read_text().replace("seed = 5", "seed = 6"))
    done = umov("scale", "run", "job")
    assert done.code == 3 and "seed" in done.err, done.err
