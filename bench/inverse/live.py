#!/usr/bin/env python3
"""What it takes to follow an object while it is observed: `umov invert track` from the answer about the first half of a pass through the
second, the time of each epoch more by masks; and whether that, killed and begun anew or cut in two, and a job of curves of
cubesats that is killed and goes on, give the same bytes.

usage: live.py [--object hst] [--trials 3] [--curves 3] [--snr 100] [--seed 1] [--threads 2] [--umov PATH] [--work DIR] [options of umov invert pose]
The time of an epoch is that of the filters, light and all, as umov invert track -v tells it."""
import argparse
import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import time

import blind

TABLES = ("curves", "modes", "samples", "set95")


def epochs_of(path):
    """Head of a CSV of observations, and the rows of each time."""
    lines, epochs = path.read_text().splitlines(), {}
    for line in lines[2:]:
        epochs.setdefault(line.split(",")[0], []).append(line)
    return lines[:2], list(epochs.values())


def write_epochs(path, head, epochs):
    path.write_text("\n".join([*head, *(line for rows in epochs for line in rows)]) + "\n")


def follow(o, work, observations, start, out):
    """What -v tells of the time of an epoch; verdict.json."""
    words = ("invert", "track", work / observations, "--scenario", work / "fit.toml", "--start", work / start, "-o", work / out, "--threads",
             o.threads, "-v", *o.follow)
    done = subprocess.run([o.umov, *map(str, words)], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise SystemExit(done.stderr[-2000:])
    told = next(line for line in done.stderr.splitlines() + done.stdout.splitlines() if "poses lit; " in line)
    return told.split("; ")[1], json.loads((work / out / "verdict.json").read_text())


def same(one, other, names=("modes.ecsv", "state.json")):
    return all((one / name).read_bytes() == (other / name).read_bytes() for name in names)


def live(o, work, truth):
    """One object from the answer about its first half on."""
    head, epochs = epochs_of(work / "obs.csv")
    half = len(epochs) // 2
    middle = (half + len(epochs)) // 2
    for name, some in (("first", epochs[:half]), ("rest", epochs[half:]), ("rest_a", epochs[half:middle]), ("rest_b", epochs[middle:])):
        write_epochs(work / f"{name}.csv", head, some)
    blind.run(o.umov, "invert", "pose", work / "first.csv", "--scenario", work / "fit.toml", "-o", work / "start", "-q", "--threads", o.threads,
              *o.rest, ok=(0, 4))
    start = json.loads((work / "start/verdict.json").read_text())
    if start["verdict"] == "no_fit":
        print(f"{o.object}: the first half explains nothing", flush=True)
        return
    began = time.perf_counter()
    told, verdict = follow(o, work, "rest.csv", "start", "held")
    seconds = time.perf_counter() - began
    best = verdict["modes"][0]
    off = min(blind.apart(best["q"], twin) for twin in blind.twins(truth, verdict["symmetries"]))
    print(f"{o.object}: start {start['verdict']} of {len(start['modes'])} modes; {verdict['verdict']}, {len(verdict['modes'])} modes, "
          f"{off:.2f} deg off ({best['sd_deg']:.2f} told), {verdict['epochs']} epochs; {told}", flush=True)
    in_two = "lost in the first"
    if follow(o, work, "rest_a.csv", "start", "cut_a")[1]["lost_utc"] is None:
        follow(o, work, "rest_b.csv", "cut_a", "cut_b")
        in_two = "the same bytes" if same(work / "cut_b", work / "held") else "OTHER BYTES"
    command = [o.umov, "invert", "track", work / "rest.csv", "--scenario", work / "fit.toml", "--start", work / "start", "-o",
               work / "killed", "--threads", o.threads, "-q", *o.follow]
    process = subprocess.Popen(list(map(str, command)))
    time.sleep(0.5 * seconds)
    is_killed = process.poll() is None
    process.kill()
    process.wait()
    follow(o, work, "rest.csv", "start", "killed")
    print(f"{o.object}: in two goes {in_two}; "
          f"{'killed' if is_killed else 'NOT KILLED IN TIME'} and begun anew "
          f"{'the same bytes' if same(work / 'killed', work / 'held') else 'OTHER BYTES'}", flush=True)


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


def curve(o, work, rng, step=12):
    """obs.csv and fit.toml of an object in a random attitude; that attitude."""
    meshes = [work / f"{o.object}_{k}.obj" for k in ("fit", "true")]
    for mesh, words in zip(meshes, blind.MESH[o.object]):
        blind.make_mesh(o.umov, words, mesh)
    while True:
        truth = blind.random_attitude(rng)
        blind.make_curve(o, work, meshes, 0, blind.inertial(truth), step, rng)
        if epochs_of(work / "obs.csv")[1]:  # else dark sides alone are seen
            return truth


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--object", choices=blind.MESH, default="hst")
    parser.add_argument("--trials", type=int, default=3, help="objects that are followed")
    parser.add_argument("--curves", type=int, default=3, help="of cubesats, of the job that is killed; 0: none")
    parser.add_argument("--snr", type=float, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    blind.add_places(parser)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov invert pose
    o.wrong, o.surfaces, o.truth = 0, 1, None
    work = blind.work_folder(o)
    rng = random.Random(o.seed)
    o.follow = o.rest[:o.rest.index("--grid")] + o.rest[o.rest.index("--grid") + 2:] if "--grid" in o.rest else o.rest
    for _ in range(o.trials):
        live(o, work, curve(o, work, rng, 6))
    o.object = "cubesat"
    curves = [work / f"curve_{k}.csv" for k in range(o.curves)]
    for path in curves:
        curve(o, work, rng)
        path.write_bytes((work / "obs.csv").read_bytes())
    if curves:
        killed(o, work, curves)


if __name__ == "__main__":
    main()
