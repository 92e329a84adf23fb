"""What all fault tests share: small jobs, ways to make the system fail, and what must hold whatever fails."""
import importlib.util
import os
import pathlib
import random
import resource
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FULL = os.environ.get("UMOV_FAULTS") == "full"
_spec = importlib.util.spec_from_file_location("cli_conftest", ROOT / "tests/cli/conftest.py")
_cli = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_cli)
UMOV, SCENARIO, read_csv = _cli.UMOV, _cli.SCENARIO, _cli.read_csv

# Every end that is not a bug: done, bad input, physics, nothing found, device, interrupted.
ENDS = {0, 3, 4, 5, 6, 130}


def times(few, many):
    """Repetitions in tests/faults/run, and in tests/faults/run --full."""
    return many if FULL else few


def sample(count, few):
    """Numbers 1 to `count`: all of them in the full run, else the first, the last and some between."""
    if FULL or count <= few:
        return list(range(1, count + 1))
    return sorted({1, 2, count - 1, count, *random.Random(1).sample(range(1, count + 1), few - 4)})


class Outcome:
    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err


def limited(**limits):
    """For preexec_fn: RLIMIT_* by name."""

    def apply():
        for name, value in limits.items():
            resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), (value, value))

    return apply


class Place:
    """An empty folder with a small scenario, and umov in it."""

    def __init__(self, folder, cache, shim):
        self.folder, self.cache, self.shim = folder, cache, shim
        folder.mkdir(parents=True, exist_ok=True)

    def environment(self, more):
        return {**os.environ, "XDG_CACHE_HOME": str(self.cache), **more}

    def start(self, *arguments, env=None, preexec_fn=None, **more):
        return subprocess.Popen([UMOV, *map(os.fspath, map(_text, arguments))], cwd=self.folder,
                                stdout=more.pop("stdout", subprocess.PIPE), stderr=subprocess.PIPE,
                                env=self.environment(env or {}), preexec_fn=preexec_fn, **more)

    def umov(self, *arguments, timeout=300, **more):
        process = self.start(*arguments, **more)
        try:
            out, err = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        return Outcome(process.returncode, (out or b"").decode(errors="replace"), err.decode(errors="replace"))

    def faulty(self, fault, *arguments, under=None, **more):
        """With the N-th call of the system failing: "write:3:28"; see shim.c."""
        env = {"LD_PRELOAD": str(self.shim), "UMOV_FAULT": fault, "UMOV_FAULT_UNDER": str(under or self.folder)}
        return self.umov(*arguments, env=env, **more)

    def count(self, call, *arguments, under=None):
        """How often a call of the system is made when nothing fails."""
        report = self.cache / "count.txt"
        env = {"LD_PRELOAD": str(self.shim), "UMOV_FAULT_UNDER": str(under or self.folder),
               "UMOV_FAULT_COUNT": str(report)}
        report.unlink(missing_ok=True)
        done = self.umov(*arguments, env=env)
        assert done.code == 0, done.err
        return int(dict(line.split() for line in report.read_text().splitlines())[call])

    def scenario(self, *replacements, name="scenario.toml"):
        assert self.umov("mesh", "make", "chamfered-cube", "-o", "cube.obj").code == 0
        text = SCENARIO.format(root=ROOT)
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new)
        (self.folder / name).write_text(text)
        return name

    def names(self):
        """What lies in the folder, but for the cube's MTL and the journals of jobs that failed."""
        return sorted(name for name in os.listdir(self.folder)
                      if name != "cube.mtl" and not name.endswith(".rows.partial"))

    def journals(self):
        return [name for name in os.listdir(self.folder) if name.endswith(".rows.partial")]

    def leftovers(self):
        """Temporaries, which only a kill may leave."""
        return [name for _, folders, files in os.walk(self.folder) for name in folders + files if ".part-" in name]


def _text(argument):
    return argument if isinstance(argument, (str, bytes)) else str(argument)


def assert_clean_end(done, ends=ENDS):
    """Ended by itself, with a message of its own."""
    assert done.code in ends, (done.code, done.err[-2000:])
    assert "bug of umov" not in done.err, done.err
    if done.code not in (0, 5):
        assert "error: " in done.err, done.err


@pytest.fixture(scope="session")
def shim(tmp_path_factory):
    out = tmp_path_factory.mktemp("shim") / "shim.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-Wall", "-Werror", "-o", out,
                    pathlib.Path(__file__).with_name("shim.c"), "-ldl"], check=True)
    return out


@pytest.fixture
def place(tmp_path, tmp_path_factory, shim):
    return Place(tmp_path / "work", tmp_path_factory.mktemp("cache"), shim)


PASSES = ("passes", "--orbit", ROOT / "data/tle/hst.tle", "-s", "20.7083,-156.2578,3058",
          "--start", "2018-01-21T00:00:00Z", "--stop", "2018-01-22T00:00:00Z")
POSES = ("signature", "scenario.toml", "--poses", "200", "--phase", "60")
# A job, what it writes, and whether that is a folder.
JOBS = {
    "run": (("run", "scenario.toml"), "out"),
    "signature.csv": ((*POSES, "-o", "t.csv"), "t.csv"),
    "signature.ecsv": ((*POSES, "-o", "t.ecsv"), "t.ecsv"),
    "signature.fits": ((*POSES, "-o", "t.fits"), "t.fits"),
    "signature.json": ((*POSES, "-o", "t.json"), "t.json"),
    "passes": ((*PASSES, "-o", "t.csv"), "t.csv"),
    "chart": ((*PASSES, "--chart", "t.html", "-q"), "t.html"),
    "paper": (("paper", "--only", "fig11", "-o", "p"), "p"),
}


def contents(path):
    """Bytes of a file, or of a folder by name, without what tells of time and process."""
    path = pathlib.Path(path)
    if not path.exists():
        return None
    if path.is_file():
        return path.read_bytes()
    return {one.name: one.read_bytes() for one in sorted(path.iterdir())
            if one.name not in ("manifest.json", "index.html", "speed.ecsv")}
