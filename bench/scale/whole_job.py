#!/usr/bin/env python3
"""A job as a user has it, three ways: plain, on a LocalCluster whose workers are killed, as tasks of an array. The same bytes?

    .deps/venv/bin/python bench/scale/whole_job.py [--objects 20] [--nights 1] [--poses 20000] [--kill-s 8] [--shards 12]

Passes of a catalogue over two sites with magnitudes of a cubesat; and a library of two objects by so many poses in three bands, with
a figure made from it lazily. Of the cluster: how many kills, and how far "shards done so far" was from true as a clock of the job
(worst between a third and the end).
"""
import argparse
import pathlib
import subprocess
import tempfile
import threading
import time

import psutil
from scenes import SITES, UMOV, catalogue, cubesat, load, lock, merged, plain, umov


class Killer:
    """Kills a worker process below this one every so many seconds, and looks how far the job is."""

    def __init__(self, folder, every_s):
        self.folder, self.every_s, self.killed, self.seen, self.over = folder, every_s, 0, [], threading.Event()
        self.thread = threading.Thread(target=self.work, daemon=True)

    def __enter__(self):
        self.begin = time.monotonic()
        self.thread.start()
        return self

    def work(self):
        next_kill = None
        while not self.over.wait(0.1):
            done = len(list(pathlib.Path(self.folder, "shards").iterdir()))
            now = time.monotonic()
            if done and next_kill is None:
                next_kill = now + 0.3  # something is at work: the first goes at once
                self.begin = now
            elif done:
                self.seen.append((now - self.begin, done - 1))
            if next_kill and now > next_kill:
                below = [p for p in psutil.Process().children(recursive=True)
                         if any(word in " ".join(p.cmdline()) for word in ("scale worker", "spawn_main"))]
                if below:
                    below[self.killed % len(below)].kill()
                    self.killed += 1
                next_kill = now + self.every_s

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()

    def clock(self, shards):
        """The worst of what the part that is done says of the whole, over what it was."""
        whole = self.seen[-1][0] / max(1, self.seen[-1][1]) * (shards - 1) if self.seen else 0
        said = [at / done * (shards - 1) / whole for at, done in self.seen if done >= shards / 3]
        return max(said, key=lambda ratio: abs(ratio - 1), default=1)


def three_ways(place, name, command, shards, kill_s):
    import umov as package
    begin = time.monotonic()
    expected = plain(command, f"{place}/{name}.csv")
    took = time.monotonic() - begin
    total = lock(f"{place}/{name}_trial", command)["total"]
    per_shard = max(1, -(-total // shards))
    for way in ("cluster", "array"):
        folder = f"{place}/{name}_{way}"
        count = lock(folder, command, "--per-shard", per_shard)["shards"]
        if way == "cluster":
            with Killer(folder, kill_s) as killer:
                result = package.scale.run(None, folder, cluster="local:2")
            told = f"{killer.killed} kills, the clock of the shards off by {killer.clock(count):.2f}"
        else:
            tasks = [subprocess.Popen([UMOV, "scale", "run", "-q", "--threads", "1", "--part", f"{k}/3", folder]) for k in range(3)]
            assert not any(task.wait() for task in tasks)
            told = "3 tasks"
        same = merged(folder, f"{name}_{way}.csv") == expected
        print(f"{name:16} {way:8} {count} shards: bytes {'equal' if same else 'DIFFER'} ({len(expected) / 1e6:.1f} MB, plain {took:.1f} s); "
              f"{told}; {load()}", flush=True)
        assert same
    return result


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
    parser.add_argument("--poses", type=int, default=20_000)
    parser.add_argument("--kill-s", type=float, default=8)
    parser.add_argument("--shards", type=int, default=12)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="umov-whole-") as place:
        scene = cubesat(place)
        span = ("--start", "2018-01-21T00:00:00Z", "--stop", f"2018-01-{21 + given.nights}T00:00:00Z")
        for site, where in SITES.items():
            three_ways(place, f"passes_{site}", ["passes", "--orbit", catalogue(place, given.objects), "-s", where, *span, "--scene", scene],
                       given.shards, given.kill_s)
        for name in ("sat", "other"):
            other = cubesat(place, name)
            if name == "other":
                umov("mesh", "make", "chamfered-cube", "-o", f"{place}/other.obj")
            result = three_ways(place, f"library_{name}", ["signature", other, "--poses", given.poses, "--phase", 60, "--visibility", "masks"],
                                given.shards, given.kill_s)
        rows = figure(result, f"{place}/figure.png")
        print(f"a histogram of {rows} of {len(result.rows())} rows drawn from the shards, {pathlib.Path(place, 'figure.png').stat().st_size} bytes")


if __name__ == "__main__":
    main()
