"""A Dask scheduler and its workers as processes of their own, behind the loopback: what LocalCluster hides in one."""
import os
import pathlib
import subprocess
import sys
import time

PYTHON = os.environ.get("UMOV_PYTHON", str(pathlib.Path(__file__).resolve().parents[2] / "build/release/python"))
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
COMMON = ("--host", "127.0.0.1", "--no-dashboard")


def _dask(what, *words, **more):
    program = f"import sys; from distributed.cli.dask_{what} import main; main()"
    env = {**os.environ, "PYTHONPATH": PYTHON}  # what is submitted are functions of umov
    return subprocess.Popen([sys.executable, "-c", program, *COMMON, *words], env=env, **QUIET, **more)


def scheduler(place, **more):
    """Its process, and the file that says where it is."""
    file = f"{place}/scheduler.json"
    process = _dask("scheduler", "--port", "0", "--scheduler-file", file, **more)
    while not os.path.exists(file):
        time.sleep(0.1)
    return process, file


def worker(place, file, nanny=False, **more):
    """One of one thread; with a nanny, which starts it again when it dies."""
    return _dask("worker", "--nthreads", "1", "--nanny" if nanny else "--no-nanny", "--scheduler-file", file, "--local-directory", place,
                 **more)
