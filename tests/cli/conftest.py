"""Runs the built command as its users do."""
import csv
import os
import pathlib
import resource
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
UMOV = ROOT / "build/release/apps/cli/umov"


@pytest.fixture(scope="session", autouse=True)
def cache_of_its_own(tmp_path_factory):
    """Masks of the tests stay out of the user's cache."""
    os.environ["XDG_CACHE_HOME"] = str(tmp_path_factory.mktemp("cache"))


def processor_s_of_children():
    """Seconds of the processor of all commands that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Outcome:
    def __init__(self, done):
        self.code, self.out, self.err = done.returncode, done.stdout, done.stderr


@pytest.fixture
def umov(tmp_path):
    """umov("mesh", "make", ...) in an empty folder."""

    def call(*arguments, timeout=300):
        return Outcome(subprocess.run([UMOV, *map(str, arguments)], cwd=tmp_path, text=True,
                                      capture_output=True, timeout=timeout))

    return call


def read_csv(path):
    """Rows of one of our CSV files as dictionaries; the unit line is checked on the way."""
    lines = pathlib.Path(path).read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    assert any(line.startswith("# unit:") for line in comments), "no '# unit:' line"
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def anchors(name):
    """Rows of a table that tools/anchors makes from the formulas of docs/theory."""
    lines = (ROOT / f"tests/data/anchors/{name}.csv").read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


SCENARIO = """umov = 1
seed = 1
[observer]
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T05:08:00Z
stop = 2018-01-21T05:12:00Z
step_s = 20
only = {{ alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true }}
[[object]]
name = "HST"
orbit = {{ file = "{root}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "cube.obj", unit = "m", up = "+Z", normals = "flat" }}
attitude = {{ mode = "nadir" }}
[object.materials]
default = "paper_al"
[bands]
set = "paper_rgb"
[output]
dir = "out"
formats = ["ecsv", "csv", "html"]
"""


@pytest.fixture
def scenario(tmp_path, umov):
    """Writes a small scenario (a cube on HST's orbit) with lines replaced; returns its name."""
    assert umov("mesh", "make", "chamfered-cube", "-o", "cube.obj").code == 0

    def write(*replacements, name="scenario.toml"):
        text = SCENARIO.format(root=ROOT)
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / name).write_text(text)
        return name

    return write
