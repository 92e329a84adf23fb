"""Tests of the package as it was built, beside the command of the same build."""
import os
import pathlib
import signal
import subprocess
import sys

import pytest

# Whoever starts the tests in the background may have SIGINT ignored, and then Python leaves it so;
# what is asked of Ctrl-C here is asked of a terminal.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"
sys.path.insert(0, str(BUILD / "python"))
os.environ["PYTHONPATH"] = str(BUILD / "python")  # of child processes
os.environ.setdefault("MPLBACKEND", "Agg")

EXAMPLES, DATA = ROOT / "examples", ROOT / "data"
UMOV = BUILD / "apps/cli/umov"
#: Elements of HST, the two lines alone.
LINES = [line for line in (DATA / "tle/hst.tle").read_text().splitlines() if line[:2] in ("1 ", "2 ")][:2]


@pytest.fixture(scope="session", autouse=True)
def cache_of_its_own(tmp_path_factory):
    """Masks of the tests stay out of the user's cache."""
    os.environ["XDG_CACHE_HOME"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture
def command(tmp_path):
    """command("brdf", ...) in an empty folder; returns what it printed."""

    def call(*arguments, code=0):
        done = subprocess.run([UMOV, *map(str, arguments)], cwd=tmp_path, text=True, capture_output=True,
                              timeout=300)
        assert done.returncode == code, done.stderr
        return done.stdout if code == 0 else done.stderr

    return call


@pytest.fixture
def hst():
    import umov
    return umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", orbit=DATA / "tle/hst.tle", norad=20580,
                          attitude={"mode": "nadir"}, materials={"default": "film_silvered"}, name="HST")


@pytest.fixture(scope="session")
def plate():
    """A sheet of paper's aluminium: two triangles, convex, quick."""
    import umov
    vertices = [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]
    return umov.Satellite(mesh=(vertices, [[0, 1, 2], [0, 2, 3]]), materials="paper_al", name="plate")


@pytest.fixture(scope="session")
def glass():
    """The same of a glass whose roughness needs no table: compiled in half a millisecond."""
    import umov
    vertices = [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]
    rough = umov.Material.from_dict("glass", {"index": {"n": 1.5, "k": 0.0}, "distribution": {"model": "ggx", "alpha": 0.3}})
    return umov.Satellite(mesh=(vertices, [[0, 1, 2], [0, 2, 3]]), materials=rough, name="glass")
