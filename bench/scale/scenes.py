"""What the programs of this folder share: small jobs, their folders, and how much processes took."""
import json
import os
import pathlib
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
UMOV = os.environ.get("UMOV", str(ROOT / "build/release/apps/cli/umov"))
sys.path.insert(0, os.environ.get("UMOV_PYTHON", str(ROOT / "build/release/python")))

SCENE = """umov = 1
[[object]]
name = "sat"
mesh = {{ file = "{mesh}", unit = "m", up = "+Z", normals = "flat" }}
[object.materials]
default = "paper_al"
[bands]
set = "paper_rgb"
"""
CATALOGUE = ROOT / "tests/data/tle/mixed_979_2018-01-20.tle"
NIGHT = ("--start", "2018-01-21T04:00:00Z", "--stop", "2018-01-21T16:00:00Z")
SITES = {"maui": "20.7083,-156.2578,3058", "teide": "28.3008,-16.5117,2390"}


def umov(*words, **more):
    return subprocess.run([UMOV, *map(str, words)], check=True, text=True, capture_output=True, **more)


def cubesat(folder, name="sat"):
    """A scenario of a 3U cubesat with wings, which hides itself; its name."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", folder / f"{name}.obj")
    (folder / f"{name}.toml").write_text(SCENE.format(mesh=f"{name}.obj"))
    return folder / f"{name}.toml"


def catalogue(folder, objects):
    """Two-line elements of the first objects of a catalogue; the file's name."""
    lines = CATALOGUE.read_text().splitlines()[:3 * objects]
    file = pathlib.Path(folder) / f"first_{objects}.tle"
    file.write_text("\n".join(lines) + "\n")
    return file


def by_rays(scene, poses):
    """Milliseconds a pose, half a kilobyte each: what is measured is not the disk."""
    return ["signature", scene, "--poses", poses, "--phase", 60, "--visibility", "rays", "--accuracy", 0.02]


def lock(folder, command, *more):
    """Begins a job and returns what it says of itself."""
    umov("scale", "lock", "-q", *more, folder, *command)
    return json.loads((pathlib.Path(folder) / "job.json").read_text())


def merged(folder, output="merged.csv", *more):
    """The bytes of the table."""
    output = pathlib.Path(folder).with_name(output)
    umov("scale", "merge", folder, "-q", "-o", output, *more)
    return output.read_bytes()


def plain(command, output):
    """The bytes of the plain command."""
    umov(*command, "-q", "-o", output)
    return pathlib.Path(output).read_bytes()


def children_s():
    """CPU seconds of all processes that ended below this one."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Stopwatch:
    """Seconds by the clock, and of the processors by processes that ended meanwhile."""

    def __enter__(self):
        self.begin, self.cpu_begin = time.monotonic(), children_s()
        return self

    def __exit__(self, *_):
        self.wall, self.cpu = time.monotonic() - self.begin, children_s() - self.cpu_begin


def load():
    return f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
