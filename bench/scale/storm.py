#!/usr/bin/env python3
"""kill -9 of workers and of the driver at random moments, each time gone on from: the bytes, what it cost, what was left.

    .deps/venv/bin/python bench/scale/storm.py [--kills 100] [--shard-s 0.1] [--life-s 0.6] [--workers 1] [--dask KILLS] [--ctrl-c 10]

A job by rays. Its shards take --shard-s seconds; something lives --life-s seconds on average before it is killed. With --dask:
so many kills of the worker processes of a LocalCluster of two as well, six seconds apart. With --ctrl-c: so many runs ended by an
interrupt, and gone on from with the command that each prints.
"""
import argparse
import os
import pathlib
import random
import re
import signal
import subprocess
import tempfile
import threading
import time

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


def dask_storm(folder, kills):
    """Workers of a LocalCluster, killed six seconds apart."""
    import umov as package
    killed, stop = [], threading.Event()

    def kill():
        while not stop.wait(6) and len(killed) < kills:
            victims = [p for p in psutil.Process().children(recursive=True)
                       if any(word in " ".join(p.cmdline()) for word in ("scale worker", "spawn_main"))]
            if victims and shards(folder):
                killed.append(random.choice(victims))
                killed[-1].kill()

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    try:
        package.scale.run(None, folder, cluster="local:2")
    finally:
        stop.set()
        thread.join()
    return len(killed)


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
    parser.add_argument("--ctrl-c", type=int, default=0)
    given = parser.parse_args()
    rng = random.Random(25)
    with tempfile.TemporaryDirectory(prefix="umov-storm-") as place:
        scene = cubesat(place)
        rate = lock(f"{place}/trial", by_rays(scene, 100_000))["predicted"]["cpu_s"]
        per_shard = max(1, round(given.shard_s / rate))

        def job(name, seconds):
            count = max(20, round(seconds / given.shard_s))
            command = by_rays(scene, per_shard * count)
            lock(f"{place}/{name}", command, "--per-shard", per_shard)
            return f"{place}/{name}", command, count

        if given.kills:
            folder, command, count = job("kills", 0.8 * given.kills * given.life_s * given.workers)
            with Stopwatch() as took:
                killed, none, lost = storm(folder, given.kills, given.life_s, given.workers, rng)
            print(f"{count} shards of {given.shard_s} s, {killed['driver']} drivers and {killed['worker']} workers killed in "
                  f"{took.wall:.0f} s, {none} of them before a shard was done; {lost} files were left in tmp meanwhile; "
                  f"{len(shards(folder))} shards done then; {load()}")
            finish(folder, command, shards(folder))
        if given.dask:
            folder, command, count = job("dask", 8 * given.dask)
            begin = time.monotonic()
            kills = dask_storm(folder, given.dask)
            print(f"Dask: {count} shards, {kills} kills in {time.monotonic() - begin:.0f} s; {len(shards(folder))} done")
            finish(folder, command, shards(folder))
        if given.ctrl_c:
            folder, command, count = job("interrupts", 1.5 * given.ctrl_c * given.life_s)
            codes = interrupts(folder, given.ctrl_c, given.life_s, rng)
            print(f"Ctrl-C: {count} shards, exit codes {codes}; {len(shards(folder))} done then")
            finish(folder, command, shards(folder))


if __name__ == "__main__":
    main()
