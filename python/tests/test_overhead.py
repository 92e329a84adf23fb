"""What Python costs: the same work as a loop of the library, in turns, the shortest of each."""
import itertools
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
import umov
from astropy import units as u
from astropy.time import Time
from conftest import BUILD, DATA

POSES = 100_000

pytestmark = pytest.mark.alone


class Loop:
    """A program beside this file, which waits for its turn."""

    def __init__(self, program, *arguments):
        self._child = subprocess.Popen([BUILD / "python" / program, *map(str, arguments)], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, text=True)

    def __call__(self):
        self._child.stdin.write("\n")
        self._child.stdin.flush()
        return tuple(map(float, self._child.stdout.readline().split()))

    def close(self):
        self._child.communicate()


def cost_of(work):
    """Seconds by the clock and of the processor; what comes of it goes afterwards, as in the loops."""
    begin = time.perf_counter(), time.process_time()
    out = work()
    spent = time.perf_counter() - begin[0], time.process_time() - begin[1]
    del out
    return spent


def assert_costs_as_much(ours, theirs, rounds=10, most=60):
    """In turns, the shortest of each. What else a machine has to do is in its clock but not in the time of its
    processor, which therefore is held to the 3 % that are asked, and the clock to what shows a wait. A neighbour who
    takes the caches costs processor time too: more rounds then, as the shortest of many tells what the work needs."""
    seconds = []
    while len(seconds) < rounds or (len(seconds) < most and not costs_as_much(seconds)):
        seconds.append((cost_of(ours), theirs()))
    assert costs_as_much(seconds)


def costs_as_much(seconds):
    clock, processor = (min(one[0][k] for one in seconds) / min(one[1][k] for one in seconds) for k in (0, 1))
    print(f"{min(one[0][0] for one in seconds):.4f} s, library {min(one[1][0] for one in seconds):.4f} s: by the clock "
          f"{100 * (clock - 1):+.2f} %, of the processor {100 * (processor - 1):+.2f} %")
    return processor < 1.03 and clock < 1.2


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    box = tmp_path_factory.mktemp("scene") / "scene.toml"
    subprocess.run([BUILD / "apps/cli/umov", "mesh", "make", "chamfered-cube", "-o", box.parent / "cube.obj"], check=True,
                   capture_output=True)
    made = umov.Satellite(mesh=box.parent / "cube.obj", unit="m", up="+Z", materials="paper_al")
    box.write_text(umov.Scenario(made).to_toml())
    return box


def test_many_poses_cost_what_the_library_does(scene):
    engine = umov.Engine(scene, threads=1)
    sun, observer = umov.random_poses(POSES, phase_deg=60, seed=1)
    loop = Loop("pose_loop", scene, POSES)
    assert_costs_as_much(lambda: engine.evaluate(sun, observer), loop)
    loop.close()


def tle_lines(number, anomaly_deg):
    """HST's elements with another catalogue number and mean anomaly, and the checksums of both lines."""
    lines = [line for line in (DATA / "tle/hst.tle").read_text().splitlines() if line[:2] in ("1 ", "2 ")][:2]
    for line in lines:
        line = f"{line[:2]}{number:05}{line[7:68]}"
        if line[0] == "2":
            line = f"{line[:43]}{anomaly_deg:8.4f}{line[51:]}"
        yield line + str(sum(int(c) if c.isdigit() else c == "-" for c in line) % 10)


@pytest.fixture(scope="module")
def catalogue(tmp_path_factory):
    path = tmp_path_factory.mktemp("catalogue") / "many.tle"
    rows = itertools.chain.from_iterable(tle_lines(10_000 + k, 0.35 * k) for k in range(1000))
    path.write_text("\n".join(rows) + "\n")
    return path


def test_a_catalogue_costs_what_the_library_does(catalogue):
    first, count = "2018-01-21T00:00:00Z", 720
    times = Time(first.rstrip("Z")) + np.arange(count) * u.min
    loop = Loop("catalogue_loop", catalogue, first, count)
    assert umov.propagate(catalogue, times[:2]).position_km.shape == (1000, 2, 3)
    assert_costs_as_much(lambda: umov.propagate(catalogue, times, threads=1), loop)
    loop.close()


def test_one_pose_is_a_short_call(scene):
    """On a quiet machine of today a pose is to take 25 us at most and numpy's product of two vectors takes 12: a call of
    the same kind, arrays of three numbers looked at and one made."""
    engine = umov.Engine(scene, threads=1)
    sun, observer = np.array([0, 0, 1.0]), np.array([0, 0.6, 0.8])

    def once(call):
        begin = time.perf_counter()
        call()
        return time.perf_counter() - begin

    pairs = [(once(lambda: engine.evaluate(sun, observer)), once(lambda: np.cross(sun, observer))) for _ in range(5000)]
    ours, theirs = (min(side) for side in zip(*pairs))
    print(f"one pose {1e6 * ours:.1f} us, np.cross {1e6 * theirs:.1f} us")
    assert ours < 2 * theirs


@pytest.mark.parametrize("what", ["poses", "catalogue"])
def test_results_are_nowhere_twice(what, scene, catalogue):
    """The largest memory of a process grows by its results, with a tenth for all else; a copy would double it."""
    call = {"poses": f"""
        engine = umov.Engine({str(scene)!r}, threads=1)
        sun, observer = umov.random_poses(600_000, phase_deg=60)
        engine.light(sun[:100_000], observer[:100_000])
        work = lambda: engine.evaluate(sun, observer)
        bytes_of = lambda out: out.nbytes
        """, "catalogue": f"""
        times = Time("2018-01-21T00:00:00") + np.arange(1440) * u.min
        umov.propagate({str(catalogue)!r}, times[:60])
        work = lambda: umov.propagate({str(catalogue)!r}, times)
        bytes_of = lambda out: out.position_km.nbytes + out.velocity_km_s.nbytes + out.error.nbytes
        """}[what]
    script = textwrap.dedent("""
        import re, numpy as np, umov
        from astropy import units as u
        from astropy.time import Time
        def memory(name):
            return 1024 * int(re.search(name + r":\\s+(\\d+)", open("/proc/self/status").read()).group(1))
        """) + textwrap.dedent(call) + textwrap.dedent("""
        open("/proc/self/clear_refs", "w").write("5")  # the peak is that of now
        before = memory("VmRSS")
        out = work()
        print((memory("VmHWM") - before) / bytes_of(out), bytes_of(out))
        """)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    grown, size = map(float, done.stdout.split())
    assert size > 50e6 and grown < 1.25, done.stdout
