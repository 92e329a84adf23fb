#!/usr/bin/env python3
"""What a folder of many shards costs: a job of a million planned, a complete one gone over, by the command and from Python.

    .deps/venv/bin/python bench/scale/folder.py [--shards 100000]

The files of the complete folder are empty, as none of these calls reads them.
"""
import argparse
import os
import pathlib
import resource
import subprocess
import tempfile

from scenes import UMOV, Stopwatch, by_rays, cubesat, load, lock, umov


def peak_mb(*words):
    """Seconds of CPU and megabytes of a command."""
    process = subprocess.Popen([UMOV, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    assert status == 0, words
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shards", type=int, default=100_000)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="umov-folder-") as place:
        scene = cubesat(place)
        few, many = (peak_mb("scale", "plan", "--per-shard", 1, f"{place}/plan", *by_rays(scene, n)) for n in (1000, 10**6))
        print(f"plan of 1,000,000 shards: {many[0]:.2f} s of CPU, {many[1]:.0f} MB; of 1,000: {few[0]:.2f} s, {few[1]:.0f} MB (trial included)")
        folder = pathlib.Path(place, "job")
        key = lock(folder, by_rays(scene, given.shards), "--per-shard", 1)["key"]
        with Stopwatch() as locked:
            umov("scale", "plan", folder)
        print(f"plan of a locked job: {locked.wall:.2f} s")
        for index in range(given.shards):
            at = folder / "shards" / (f"{index // 1000:05d}" if given.shards > 10_000 else "")
            at.mkdir(exist_ok=True)
            (at / f"{index:08d}-{key}-{index:032x}.rows").touch()
        for what in ("status", "run"):
            with Stopwatch() as took:
                umov("scale", what, folder)
            print(f"scale {what} of {given.shards} shards that are there: {took.wall:.2f} s, {took.cpu:.2f} s of CPU, "
                  f"{1e6 * took.wall / given.shards:.1f} us a shard; {load()}")
        import umov as package
        begin = resource.getrusage(resource.RUSAGE_SELF).ru_utime
        result = package.scale.Result(folder)
        assert result.missing == []
        print(f"Python, Result.missing: {resource.getrusage(resource.RUSAGE_SELF).ru_utime - begin:.2f} s of CPU")


if __name__ == "__main__":
    main()
