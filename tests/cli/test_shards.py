"""Parts of a job: their rows are those of the whole, byte for byte."""
import pytest

from conftest import ROOT

SITE = ("-s", "maui", "--start", "2018-01-21T00:00:00Z", "--stop", "2018-01-21T12:00:00Z")


def rows(path):
    """Data lines of a CSV: what stands below its header."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return lines[1:]


def parts(umov, tmp_path, command, shards):
    out = []
    for k in range(shards):
        name = f"part_{k}.csv"
        done = umov(*command, "--shard", f"{k}/{shards}", "-o", name)
        assert done.code == 0, done.err
        out.append(rows(tmp_path / name))
    return out


@pytest.mark.parametrize("poses,shards,more",
                         [(300, (2, 7), ["--visibility", "auto"]), (6000, (3,), ["--visibility", "masks"]),
                          (30, (2, 7), ["--visibility", "rays"]),
                          (20, (3,), ["--accuracy", "0.3", "--set", "render.bounces=2"])])
def test_shards_of_a_signature_are_its_rows(umov, scenario, tmp_path, poses, shards, more):
    """With light between surfaces a block of 512 poses shares its paths, and the parts cut through it."""
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    command = ["signature", name, "--poses", poses, "--phase", "60", *more]
    assert umov(*command, "-o", "whole.csv").code == 0
    for of in shards:
        assert sum(parts(umov, tmp_path, command, of), []) == rows(tmp_path / "whole.csv")


def test_ranges_of_a_signature(umov, scenario, tmp_path):
    command = ["signature", scenario(), "--poses", 50, "--phase", "60,90"]
    assert umov(*command, "-o", "whole.csv").code == 0
    assert umov(*command, "--range", "37:20", "-o", "part.csv").code == 0
    assert rows(tmp_path / "part.csv") == rows(tmp_path / "whole.csv")[37 * 3:57 * 3]


@pytest.mark.parametrize("shards", [2, pytest.param(5, marks=pytest.mark.slow)])
def test_shards_of_passes_are_its_rows(umov, tmp_path, shards):
    """Objects are shared out; the whole has their passes by the time of rise."""
    orbits = (ROOT / "tests/data/tle/mixed_979_2018-01-20.tle").read_text().splitlines()[:45]
    (tmp_path / "fifteen.tle").write_text("\n".join(orbits) + "\n")
    command = ["passes", "--orbit", "fifteen.tle", *SITE, "--model", "sphere", "--material", "gold"]
    assert umov(*command, "-o", "whole.csv").code == 0
    found = []
    for k in range(shards):
        done = umov(*command, "--shard", f"{k}/{shards}", "-o", f"{k}.csv")
        assert done.code in (0, 5), done.err  # 5: none of these objects has a pass
        if done.code == 0:
            found += rows(tmp_path / f"{k}.csv")
    assert sorted(found) == sorted(rows(tmp_path / "whole.csv"))


@pytest.mark.parametrize("shards,more", [(2, []), *(pytest.param(3, more, marks=pytest.mark.slow) for more in ([], ["--set", "render.bounces=2"]))])
def test_shards_of_a_run_are_its_rows(umov, scenario, tmp_path, shards, more):
    """Passes are shared out, in both tables."""
    name = scenario(("stop = 2018-01-21T05:12:00Z", "stop = 2018-01-23T08:00:00Z"),
                    ("sun_alt_max_deg = -6, sunlit = true", "sunlit = true"))
    whole = umov("run", name, "-o", "whole", *more)
    assert whole.code == 0, whole.err
    curve, passes = [], []
    for k in range(shards):
        assert umov("run", name, *more, "--shard", f"{k}/{shards}", "-o", f"part_{k}").code == 0
        curve += rows(tmp_path / f"part_{k}/lightcurve.csv")
        passes += [line for line in (tmp_path / f"part_{k}/passes.ecsv").read_text().splitlines()
                   if not line.startswith("#")][1:]
    assert curve == rows(tmp_path / "whole/lightcurve.csv")
    assert passes == [line for line in (tmp_path / "whole/passes.ecsv").read_text().splitlines()
                      if not line.startswith("#")][1:]
    assert len(passes) >= shards


@pytest.mark.parametrize("part", [("--shard", "3/3"), ("--shard", "1-2"), ("--range", "5"), ("--range", "90:20")])
def test_a_part_that_is_none(umov, scenario, part):
    done = umov("signature", scenario(), "--poses", 100, "--phase", "60", *part)
    assert done.code == 2 and part[0] in done.err, done.err
