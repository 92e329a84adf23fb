#!/usr/bin/env python3
"""kill -9 of workers and of the driver at random moments, each time gone on from: the bytes, what it cost, what was left.

    .deps/venv/bin/python bench/scale/storm.py [--kills 100] [--shard-s 0.1] [--life-s 0.6] [--workers 1] [--ctrl-c 10]
    .deps/venv/bin/python bench/scale/storm.py --kills 0 --dask 100 [--dask-shard-s 0.5] [--dask-life-s 3]

A job by rays. Its shards take --shard-s seconds; something lives --life-s seconds on average before it is killed. With --dask:
so many kills of drivers, nannies, workers and their umov on a Dask cluster of two workers. With --ctrl-c: so many runs ended by an
interrupt, and gone on from with the command that each prints.
"""
import argparse
import collections
import contextlib
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

import dask_here
import psutil
from scenes import UMOV, Stopwatch, by_rays, cubesat, load, lock, merged, plain, umov


def shards(folder):
    return {path.name for path in pathlib.Path(folder, "shards").iterdir()}


def left_over(folder):
    """Processes that still work there."""
    return [p.pid for p in psutil.process_iter(["cmdline"]) if str(folder) in " ".join(p.info["cmdline"] or [])]


def finish(folder, command, before):
    """Goes on to the end; says whether the bytes are the plain ones, and whether what was there was left alone."""
    stood = {name: os.stat(pathlib.Path(folder, "shards", name)).st_mtime_ns for name in before}
    last = umov("scale", "run", folder)
    same = merged(folder) == plain(command, f"{folder}.plain.csv")
    untouched = all(os.stat(pathlib.Path(folder, "shards", name)).st_mtime_ns == at for name, at in stood.items())
    print(f"  the last run: {last.stderr.strip().splitlines()[-1].split('. umov')[0]}")
    print(f"  bytes {'equal' if same else 'DIFFER'}, finished shards {'left alone' if untouched else 'MADE AGAIN'}, "
          f"{len(os.listdir(f'{folder}/tmp'))} files in tmp, {len(left_over(folder))} processes left")
    assert same and untouched


def storm(folder, kills, life_s, workers, rng):
    """Kills the driver or a worker of it, at random, until so many are dead."""
    killed, lost_files, none, seen = {"driver": 0, "worker": 0}, 0, 0, set()
    driver = None
    while sum(killed.values()) < kills:
        if driver is None or driver.poll() is not None:
            driver = subprocess.Popen([UMOV, "scale", "run", "-q", "--workers", str(workers), "--threads", "1", folder],
                                      stderr=subprocess.DEVNULL)
        time.sleep(rng.uniform(0, 2 * life_s))
        below = [p for p in psutil.Process(driver.pid).children() if p.status() != psutil.STATUS_ZOMBIE]
        if not below:
            if driver.poll() == 0:
                break
            continue
        if rng.random() < 0.5:
            os.kill(driver.pid, signal.SIGKILL)
            driver.wait()
            psutil.wait_procs(below, timeout=20)  # they hear that their parent is gone
            killed["driver"] += 1
            lost_files += len(os.listdir(f"{folder}/tmp"))
        else:
            rng.choice(below).kill()
            killed["worker"] += 1
        there = shards(folder)
        assert seen <= there, "a finished shard is gone"
        none += len(there) == len(seen)
        seen = there
    if driver and driver.poll() is None:
        driver.send_signal(signal.SIGINT)
        driver.wait(60)
    return killed, none, lost_files


class DaskCluster:
    """A scheduler, two nannies with their workers, and a driver, each of which may be killed; what nobody starts again is started here,
    as a batch system does."""

    def __init__(self, place, folder):
        self.place, self.folder = place, folder
        self.scheduler, self.file = dask_here.scheduler(place)
        with open(self.file) as text:
            self.address = json.load(text)["address"]
        self.nannies, self.driver = [], None
        self.revive()

    def revive(self):
        self.nannies = [one for one in self.nannies if one.poll() is None]
        while len(self.nannies) < 2:
            self.nannies.append(dask_here.worker(self.place, self.file, nanny=True))
        ended = self.driver and self.driver.poll()
        assert ended in (None, 0, -signal.SIGKILL), f"the driver ended by itself with {ended}"
        if self.driver is None or ended:
            self.driver = subprocess.Popen([sys.executable, "-m", "umov.scale", "run", self.folder, "--cluster", self.address],
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "PYTHONPATH": dask_here.PYTHON})

    def victims(self):
        """Processes by what they are."""
        out = {"driver": [psutil.Process(self.driver.pid)] if self.driver.poll() is None else [], "nanny": [], "worker": [], "umov": []}
        for nanny in self.nannies:
            if nanny.poll() is not None:
                continue
            out["nanny"].append(psutil.Process(nanny.pid))
            for below in out["nanny"][-1].children(recursive=True):
                words = " ".join(below.cmdline())
                if "scale worker" in words:
                    out["umov"].append(below)
                elif "spawn_main" in words:
                    out["worker"].append(below)
        return out

    def close(self):
        for process in (self.driver, *self.nannies, self.scheduler):
            process.terminate()
            try:
                process.wait(15)
            except subprocess.TimeoutExpired:  # a nanny that waits for a worker which was killed
                process.kill()
                process.wait()


def dask_storm(place, folder, kills, life_s, rng):
    """Kills a driver, a nanny, a worker or its umov, at random, until so many are dead; then lets the driver end."""
    cluster, killed, none, seen = DaskCluster(place, folder), collections.Counter(), 0, set()
    try:
        while sum(killed.values()) < kills and cluster.driver.poll() != 0:
            time.sleep(rng.uniform(0, 2 * life_s))
            with contextlib.suppress(psutil.NoSuchProcess):
                kinds = {kind: found for kind, found in cluster.victims().items() if found}
                kind = rng.choice(sorted(kinds))
                rng.choice(kinds[kind]).kill()
                killed[kind] += 1
            time.sleep(0.05)
            cluster.revive()
            there = shards(folder)
            assert seen <= there, "a finished shard is gone"
            none += len(there) == len(seen)
            seen = there
        while cluster.driver.poll() is None and len(shards(folder)) == len(seen):
            time.sleep(0.1)
    finally:
        cluster.close()
    return killed, none


def interrupts(folder, times, life_s, rng):
    """Ctrl-C, then the command that was printed."""
    command, codes = [UMOV, "scale", "run", folder], []
    for _ in range(times):
        driver = subprocess.Popen([*command, "-q"], stderr=subprocess.PIPE, text=True)
        time.sleep(rng.uniform(0.05, 2 * life_s))
        driver.send_signal(signal.SIGINT)
        _, err = driver.communicate(timeout=60)
        codes.append(driver.returncode)
        if driver.returncode == 130:
            command = [UMOV, *re.search(r"umov (scale run \S+) goes on", err)[1].split()]
    return codes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--shard-s", type=float, default=0.1)
    parser.add_argument("--life-s", type=float, default=0.6)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--dask", type=int, default=0)
    parser.add_argument("--dask-shard-s", type=float, default=0.5)
    parser.add_argument("--dask-life-s", type=float, default=3)
    parser.add_argument("--ctrl-c", type=int, default=0)
    given = parser.parse_args()
    rng = random.Random(25)
    with tempfile.TemporaryDirectory(prefix="umov-storm-") as place:
        scene = cubesat(place)
        rate = lock(f"{place}/trial", by_rays(scene, 100_000))["predicted"]["cpu_s"]

        def job(name, seconds, shard_s):
            per_shard, count = max(1, round(shard_s / rate)), max(20, round(seconds / shard_s))
            command = by_rays(scene, per_shard * count)
            lock(f"{place}/{name}", command, "--per-shard", per_shard)
            return f"{place}/{name}", command, count

        if given.kills:
            folder, command, count = job("kills", 0.8 * given.kills * given.life_s * given.workers, given.shard_s)
            with Stopwatch() as took:
                killed, none, lost = storm(folder, given.kills, given.life_s, given.workers, rng)
            print(f"{count} shards of {given.shard_s} s, {killed['driver']} drivers and {killed['worker']} workers killed in "
                  f"{took.wall:.0f} s, {none} of them before a shard was done; {lost} files were left in tmp meanwhile; "
                  f"{len(shards(folder))} shards done then; {load()}")
            finish(folder, command, shards(folder))
        if given.dask:
            folder, command, count = job("dask", given.dask * given.dask_life_s, given.dask_shard_s)
            with Stopwatch() as took:
                killed, none = dask_storm(place, folder, given.dask, given.dask_life_s, rng)
            assert shards(folder), "no shard was done: nothing was tested"
            time.sleep(6)  # what a dead parent leaves ends within five seconds
            print(f"Dask: {count} shards of {given.dask_shard_s} s, {sum(killed.values())} kills ({dict(killed)}) in {took.wall:.0f} s, {none} of "
                  f"them before another shard was done; {len(shards(folder))} shards done then, {len(left_over(folder))} processes left; {load()}",
                  flush=True)
            finish(folder, command, shards(folder))
        if given.ctrl_c:
            folder, command, count = job("interrupts", 1.5 * given.ctrl_c * given.life_s, given.shard_s)
            codes = interrupts(folder, given.ctrl_c, given.life_s, rng)
            print(f"Ctrl-C: {count} shards, exit codes {codes}; {len(shards(folder))} done then")
            finish(folder, command, shards(folder))


if __name__ == "__main__":
    main()
