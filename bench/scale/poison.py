#!/usr/bin/env python3
"""Poison among a thousand shards: what is told of it, whether all others are done, and how long they wait for it.

    .deps/venv/bin/python bench/scale/poison.py [--objects 60] [--days 7] [--timeout-s 30] [--no-dask]

Light curves of a catalogue, a pass a shard. One shard meets an input that is not what it was when the job began (its object has no
pass: the lock is changed by hand), the process of a second crashes, that of a third hangs, that of a fourth takes all memory that it
may have (these three by tests/faults/shim.c). First the job without poison, then with it, by two processes and by two Dask workers.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from scenes import CATALOGUE, ROOT, UMOV, load, lock, umov

DASK = """import sys, umov
umov.scale.run(None, sys.argv[1], cluster="local:2", timeout_s=float(sys.argv[2]), memory_mb=int(sys.argv[3]))
"""


def scenario(place, objects, days):
    """Boxes on orbits of the catalogue, seen from Maui; the last but one is always above (one pass), the last never (none)."""
    place = pathlib.Path(place)
    umov("mesh", "make", "chamfered-cube", "-o", place / "cube.obj")
    lines = CATALOGUE.read_text().splitlines()
    sets = {int(two[2:7]): (name, float(two[52:63])) for name, two in zip(lines[::3], lines[2::3])}
    low = [number for number, (_, turns) in sets.items() if turns > 11][:objects]
    far = [next(number for number, (name, _) in sets.items() if name.startswith(wanted)) for wanted in ("GOES 15", "METEOSAT-9")]
    text = f"""umov = 1
[observer]
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T00:00:00Z
stop = 2018-01-{21 + days}T00:00:00Z
step_s = 30
only = {{ alt_min_deg = 10 }}
[bands]
set = "paper_rgb"
"""
    for number in [*low, *far]:
        text += f"""[[object]]
name = "{number}"
orbit = {{ file = "{CATALOGUE}", norad = {number} }}
mesh = {{ file = "cube.obj", unit = "m", up = "+Z", normals = "flat" }}
attitude = {{ mode = "nadir" }}
[object.materials]
default = "paper_al"
"""
    (place / "many.toml").write_text(text)
    return place / "many.toml"


def wrong(folder):
    """Says that the last object has the pass of the last but one: its shard is wrong for good."""
    file = folder / "job.json"
    told = json.loads(file.read_text())
    assert told["layout"][-2:] == [1, 0], told["layout"][-2:]
    told["layout"][-2:] = [0, 1]
    right = file.read_text()
    file.write_text(json.dumps(told))
    return right


def done(folder):
    return {int(path.name[:8]) for path in (folder / "shards").glob("*.rows")}


def timed(command, env):
    begin_s = time.monotonic()
    ended = subprocess.run([*map(str, command)], env={**os.environ, **env}, text=True, capture_output=True)
    return time.monotonic() - begin_s, ended


def begun(first, folder):
    shutil.copytree(first, folder)
    return folder


def poisoned(name, command, folder, env, kinds):
    """Seconds that it took; all is there but what is poisoned, which is told."""
    right = wrong(folder)
    took, ended = timed(command(folder), env)
    count = json.loads(right)["shards"]
    failed = {one["index"]: one for one in (json.loads(path.read_text()) for path in (folder / "failed").iterdir())}
    assert set(failed) == {*kinds, count - 1}, (sorted(failed), ended.stderr)
    assert done(folder) == set(range(count)) - set(failed) and not list((folder / "tmp").iterdir())
    assert ended.returncode == 3 or (name != "two processes" and "InputError" in ended.stderr), ended.stderr
    print(f"{name}: {len(done(folder))} of {count} done, {len(failed)} records")
    for index, one in sorted(failed.items()):
        print(f"  shard {index} ({kinds.get(index, 'wrong input')}): code {one['code']}, tried {one['attempts']} times: {one['message'][:100]}")
    (folder / "job.json").write_text(right)
    umov("scale", "run", "-q", folder)
    assert done(folder) == set(range(count)) and not list((folder / "failed").iterdir())
    return took


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objects", type=int, default=60)
    parser.add_argument("--days", type=int, default=7)
    parser.add_argument("--timeout-s", type=float, default=30)
    parser.add_argument("--memory-mb", type=int, default=1000)
    parser.add_argument("--no-dask", action="store_true")
    given = parser.parse_args()
    ways = {"two processes": lambda folder: [UMOV, "scale", "run", "-q", "--workers", 2, "--threads", 1, "--timeout-s", given.timeout_s,
                                             "--memory-mb", given.memory_mb, folder]}
    if not given.no_dask:
        ways["two Dask workers"] = lambda folder: [sys.executable, "-c", DASK, folder, given.timeout_s, given.memory_mb]
    with tempfile.TemporaryDirectory(prefix="umov-poison-") as place:
        shim, first = f"{place}/shim.so", pathlib.Path(place, "first")
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", shim, ROOT / "tests/faults/shim.c", "-ldl"], check=True)
        count = lock(first, ["run", scenario(place, given.objects, given.days)], "--per-shard", 1)["shards"]
        kinds = {int(0.3 * count): "crash", int(0.5 * count): "hang", int(0.7 * count): "memory"}
        env = {"PYTHONPATH": os.environ.get("UMOV_PYTHON", str(ROOT / "build/release/python"))}
        poison = {**env, "LD_PRELOAD": shim, "UMOV_POISON": ",".join(f"{index}:{kind}" for index, kind in kinds.items())}
        for name, command in ways.items():
            clean = begun(first, pathlib.Path(place, f"clean of {name}"))
            without, ended = timed(command(clean), env)
            assert ended.returncode == 0 and len(done(clean)) == count, ended.stderr
            took = poisoned(name, command, begun(first, pathlib.Path(place, f"poison of {name}")), poison, kinds)
            print(f"  {took:.1f} s, without poison {without:.1f} s: {(took - without) / given.timeout_s:.2f} timeouts of "
                  f"{given.timeout_s:.0f} s later; {load()}", flush=True)


if __name__ == "__main__":
    main()
