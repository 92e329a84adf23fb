"""Scripts end as they should, whatever their daemon threads are at."""
import subprocess
import sys

import pytest

START = """
import threading, time
import umov
started = threading.Event()
{prepare}
def work():
    while True:
        started.set()
        {work}
threading.Thread(target=work, daemon=True).start()
started.wait()
time.sleep(0.3)
"""
ENGINE = "engine = umov.Engine(umov.example('hst_maui.toml'))\nsun, observer = umov.random_poses(200_000, 60)"
WORK = {"brdf": ("", "umov.brdf('gold', 550, 30, 30)"),
        "run": ("", "umov.run(umov.example('hst_maui.toml'), set={'time.step_s': 5}, progress=lambda *_: None)"),
        "engine": (ENGINE, "engine.evaluate(sun, observer, progress=lambda *_: None)")}


@pytest.mark.parametrize("what", WORK)
def test_a_daemon_that_computes_does_not_spoil_the_end(what):
    """Python before 3.14 unwinds a thread that asks for the GIL at the end, which frames of C++ do not bear: SIGABRT."""
    prepare, work = WORK[what]
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", START.format(prepare=prepare, work=work)], capture_output=True,
                              text=True, timeout=120)
        assert done.returncode == 0 and done.stderr == "", done.stderr
