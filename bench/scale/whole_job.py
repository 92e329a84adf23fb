#!/usr/bin/env python3
"""A job as a user has it, three ways: plain, on a LocalCluster whose workers are killed, as tasks of an array. The same bytes?

    .deps/venv/bin/python bench/scale/whole_job.py [--objects 20] [--nights 1] [--shapes 2] [--poses 20000] [--kill-s 8] [--shards 12]
    .deps/venv/bin/python bench/scale/whole_job.py --objects 200 --nights 3 --shapes 5 --poses 2000000 --kill-s 60 --shards 20

Passes of a catalogue over two sites with magnitudes of a cubesat; and a library of so many shapes by so many poses in three bands, with
a figure made from the last one lazily. Of the cluster: how many kills, and how true the time was that it said was left
(bench/scale/progress.py has the words). Files of one job go before the next one begins.
"""
import argparse
import hashlib
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import psutil
from progress import describe, told
from scenes import SITES, UMOV, catalogue, cubesat, load, lock, umov

SHAPES = (("cubesat", "--units", 3, "--panels", 2), ("hst",), ("agena",), ("rocket-body",), ("box-wing",))


def is_worker(process):
    try:
        words = " ".join(process.cmdline())
    except psutil.Error:  # it has ended, of its own accord or by the last kill
        return False
    return "scale worker" in words or "spawn_main" in words


class Killer:
    """Kills a worker process below this one every so many seconds, once something is done."""

    def __init__(self, folder, every_s):
        self.folder, self.every_s, self.killed, self.over = folder, every_s, 0, threading.Event()
        self.thread = threading.Thread(target=self.work, daemon=True)

    def __enter__(self):
        self.thread.start()
        return self

    def work(self):
        next_kill = None
        while not self.over.wait(0.1):
            now = time.monotonic()
            if next_kill is None:
                if any(pathlib.Path(self.folder, "shards").iterdir()):
                    next_kill = now + 0.3  # something is at work: the first goes at once
            elif now > next_kill:
                below = [p for p in psutil.Process().children(recursive=True) if is_worker(p)]
                if below:
                    below[self.killed % len(below)].kill()
                    self.killed += 1
                next_kill = now + self.every_s

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()


def digest(file):
    with open(file, "rb") as content:
        out = hashlib.file_digest(content, "sha256").hexdigest()
    pathlib.Path(file).unlink()
    return out


def by_cluster(folder, kill_s):
    with Killer(folder, kill_s) as killer:
        lines, took = told([sys.executable, "-m", "umov.scale", "run", folder, "--cluster", "local:2", "--program", UMOV],
                           {"PYTHONPATH": sys.path[0]})
    return f"{killer.killed} kills; the time that it said was left: {describe(lines, took)}"


def by_array(folder):
    tasks = [subprocess.Popen([UMOV, "scale", "run", "-q", "--threads", "1", "--part", f"{k}/3", folder]) for k in range(3)]
    assert not any(task.wait() for task in tasks)
    return "3 tasks"


def three_ways(place, name, command, shards, kill_s, suffix, keeps=False):
    """The folder of the last way, where it is kept."""
    begin = time.monotonic()
    umov(*command, "-q", "-o", f"{place}/plain.{suffix}")
    took, size = time.monotonic() - begin, pathlib.Path(place, f"plain.{suffix}").stat().st_size
    expected = digest(f"{place}/plain.{suffix}")
    total = lock(f"{place}/{name}_trial", command)["total"]
    for way in ("cluster", "array"):
        folder = f"{place}/{name}_{way}"
        count = lock(folder, command, "--per-shard", max(1, -(-total // shards)))["shards"]
        said = by_cluster(folder, kill_s) if way == "cluster" else by_array(folder)
        umov("scale", "merge", "-q", folder, "-o", f"{place}/merged.{suffix}")
        same = digest(f"{place}/merged.{suffix}") == expected
        print(f"{name:16} {way:8} {count} shards: bytes {'equal' if same else 'DIFFER'} ({size / 1e6:.1f} MB, plain {took:.1f} s); {said}; "
              f"{load()}", flush=True)
        assert same
        if not keeps or way == "cluster":
            shutil.rmtree(folder)
    return folder


def figure(result, file):
    """Brightness of all poses, block after block."""
    import matplotlib
    import numpy as np
    matplotlib.use("Agg")
    import dask.array as da
    import matplotlib.pyplot as plt
    intensity = result.dask_array(["intensity"])[:, 0]
    counts, edges = da.histogram(intensity, bins=np.geomspace(1e-6, 1e3, 91))
    plt.stairs(counts.compute(), edges)
    plt.xscale("log")
    plt.savefig(file)
    return int(counts.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objects", type=int, default=20)
    parser.add_argument("--nights", type=int, default=1)
    parser.add_argument("--shapes", type=int, default=2, choices=range(1, len(SHAPES) + 1))
    parser.add_argument("--poses", type=int, default=20_000)
    parser.add_argument("--kill-s", type=float, default=8)
    parser.add_argument("--shards", type=int, default=12)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="umov-whole-") as place:
        scene = cubesat(place)
        span = ("--start", "2018-01-21T00:00:00Z", "--stop", f"2018-01-{21 + given.nights}T00:00:00Z")
        for site, where in SITES.items():
            three_ways(place, f"passes_{site}", ["passes", "--orbit", catalogue(place, given.objects), "-s", where, *span, "--scene", scene],
                       given.shards, given.kill_s, "csv")
        text = scene.read_text()
        shapes = SHAPES[:given.shapes]
        for name, *words in shapes:
            umov("mesh", "make", name, *words, "-o", f"{place}/{name}.obj")
            shape = pathlib.Path(place, f"{name}.toml")
            shape.write_text(text.replace("sat.obj", f"{name}.obj"))
            folder = three_ways(place, f"library_{name}", ["signature", shape, "--poses", given.poses, "--phase", 60, "--visibility", "masks"],
                                given.shards, given.kill_s, "fits", name == shapes[-1][0])
        import umov as package
        result = package.scale.Result(folder)
        begin = time.monotonic()
        rows = figure(result, f"{place}/figure.png")
        print(f"a histogram of {rows} of {len(result.rows())} rows drawn from the shards in {time.monotonic() - begin:.1f} s, "
              f"{pathlib.Path(place, 'figure.png').stat().st_size} bytes")


if __name__ == "__main__":
    main()
