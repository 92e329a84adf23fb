#!/usr/bin/env python3
"""What an answer costs to be kept up to date while an object is observed: the light of all that the answer stands for at one more epoch, by
masks in three bands on one core; and whether a job of curves of cubesats that is killed and goes on gives the same bytes.

usage: live.py [--object hst] [--curves 3] [--snr 100] [--seed 1] [--umov PATH] [--work DIR] [options of umov invert pose]
Needs numpy and the package umov (PYTHONPATH=build/release/python .deps/venv/bin/python bench/inverse/live.py). umov has no filter that
follows an attitude: this is the light that one would need, of the draws of samples.ecsv and of the modes with eight points about each (the
sigma points of attitude and scale; Julier & Uhlmann 1997), not what it would do with it."""
import argparse
import contextlib
import os
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import time

import blind
import numpy as np
import umov
from mitsuba_truth import directions

POINTS = 9  # of a mode
TABLES = ("curves", "modes", "samples", "set95")


def to_stars(q):
    """Matrices that take body axes to the stars; q (n, 4), scalar first."""
    w, x, y, z = np.asarray(q, float).T
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)


def attitudes(path):
    return np.array([[float(row[key]) for key in ("qw", "qx", "qy", "qz")] for row in blind.table_rows(path)])


def milliseconds(engine, rows, q):
    """Of the light of all attitudes, for each epoch of the rows of a run."""
    body_from_stars, out = to_stars(q).transpose(0, 2, 1), []
    for row in {row["time_utc"]: row for row in rows}.values():
        back = to_stars([[float(row[key]) for key in ("qw", "qx", "qy", "qz")]])[0]
        sun, observer = (body_from_stars @ (back @ v) for v in directions(row))
        began = time.perf_counter()
        engine.evaluate(sun, observer)
        out.append(1e3 * (time.perf_counter() - began))
    return np.array(out)


def times(o, work, rows):
    engine = umov.Engine(work / "fit.toml", method="masks", threads=1)
    draws, modes = (attitudes(work / f"answer/{name}.ecsv") for name in ("samples", "modes"))
    for what, q in ((f"{len(draws)} draws", draws), (f"{len(modes)} modes, {POINTS} points each", np.repeat(modes, POINTS, axis=0))):
        took = milliseconds(engine, rows, q)
        print(f"{o.object}, {what}: an epoch more takes {np.median(took):.1f} ms in the median, {took.max():.1f} at most, of {len(took)} epochs",
              flush=True)


def merged(o, job, work):
    out = []
    for name in TABLES:
        blind.run(o.umov, "scale", "merge", job, "--table", name, "-o", work / "merged.ecsv")
        out.append((work / "merged.ecsv").read_bytes())
    return out


def killed(o, work, curves):
    """The job in one go, and killed after each of its first shards."""
    for old in ("whole", "cut"):
        shutil.rmtree(work / old, ignore_errors=True)
    words = ["invert", "pose", *curves, "--each", "--scenario", work / "fit.toml", *o.rest]
    command = list(map(str, [o.umov, "scale", "run", "-q", "--per-shard", 1, "--workers", 1, "--threads", 1]))
    subprocess.run([*command, str(work / "whole"), *map(str, words)], check=True)
    kills = 0
    for done in range(1, len(curves)):
        process = subprocess.Popen([*command, str(work / "cut"), *map(str, words)], start_new_session=True)
        while process.poll() is None and len(list((work / "cut/shards").glob("*.rows"))) < done:
            time.sleep(0.05)
        kills += process.poll() is None
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)  # its workers too
        process.wait()
    subprocess.run([*command, str(work / "cut"), *map(str, words)], check=True)
    is_same = merged(o, work / "whole", work) == merged(o, work / "cut", work)
    if kills < len(curves) - 1:
        raise SystemExit(f"{o.object}: the job was done before it was killed {len(curves) - 1} times ({kills}): ask more of it, as by --curves")
    print(f"{o.object}, {len(curves)} curves, killed {kills} times: {'the same bytes' if is_same else 'OTHER BYTES'}", flush=True)


def curve(o, work, rng):
    """obs.csv and fit.toml of an object in a random attitude; its rows without noise."""
    meshes = [work / f"{o.object}_{k}.obj" for k in ("fit", "true")]
    for mesh, words in zip(meshes, blind.MESH[o.object]):
        blind.run(o.umov, "mesh", "make", *words, "-o", mesh, "-q")
    return blind.make_curve(o, work, meshes, 0, blind.inertial(blind.random_attitude(rng)), 12, rng)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--object", choices=blind.MESH, default="hst")
    parser.add_argument("--curves", type=int, default=3)
    parser.add_argument("--snr", type=float, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--umov", default=blind.ROOT / "build/release/apps/cli/umov")
    parser.add_argument("--work", type=pathlib.Path)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov invert pose
    o.wrong, o.surfaces, o.truth = 0, 1, None
    work = o.work or pathlib.Path(tempfile.mkdtemp())
    work.mkdir(parents=True, exist_ok=True)
    rng = random.Random(o.seed)
    rows = curve(o, work, rng)
    verdict, seconds = blind.asked(o, work, "pose", "--threads", 1)
    print(f"{o.object}: {verdict['verdict']}, {len(verdict['modes'])} modes, {seconds:.1f} s", flush=True)
    times(o, work, rows)
    o.object = "cubesat"
    curves = [work / f"curve_{k}.csv" for k in range(o.curves)]
    for path in curves:
        curve(o, work, rng)
        path.write_bytes((work / "obs.csv").read_bytes())
    killed(o, work, curves)


if __name__ == "__main__":
    main()
