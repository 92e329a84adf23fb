#!/usr/bin/env python3
"""Time and memory of `umov identify` against a library of COUNT cubesats of seeded materials (97,461 poses each), and what an
object more costs: the first look is linear in their number.

usage: identify_speed.py COUNT [--seed 1] [--umov PATH] [--work DIR]"""
import argparse
import pathlib
import random
import resource
import subprocess
import tempfile
import time

import blind

MATERIALS = ["aluminium_anodized", "cell_gaas", "cell_silicon", "mli_kapton", "paint_white", "paint_black", "titanium", "aluminium"]


def measured(words):
    began = time.time()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    out = subprocess.run(["/usr/bin/env", *map(str, words)], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if out.returncode not in (0, 4):
        raise SystemExit(out.stderr)
    return time.time() - began, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, after.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--umov", default=blind.ROOT / "build/release/apps/cli/umov")
    parser.add_argument("--work", type=pathlib.Path)
    o = parser.parse_args()
    work = o.work or pathlib.Path(tempfile.mkdtemp())
    (work / "lib").mkdir(parents=True, exist_ok=True)
    mesh = work / "cubesat.obj"
    if not mesh.exists():
        blind.run(o.umov, "mesh", "make", *blind.MESH["cubesat"][0], "-o", mesh, "-q")
    rng, scenarios = random.Random(o.seed), []
    for k in range(o.count):
        materials = "\n".join(f'{g} = "{rng.choice(MATERIALS)}"' for g in blind.MATERIALS["cubesat"])
        scenarios.append(work / f"object_{k:04d}.toml")
        scenarios[-1].write_text(blind.SCENARIO.format(seed=1, name="cubesat", root=blind.ROOT, mesh=mesh, law=blind.inertial([0.5, 0.5, -0.5, 0.5]),
                                                       step=12, materials=materials, method="masks", out=work / "run"))
    wall, cpu, memory = measured([o.umov, "library", "build", *scenarios, "-o", work / "lib", "-q"])
    print(f"build: {o.count} objects, {wall:.1f} s, {cpu:.1f} s of CPU, {memory:.0f} MB")
    true = scenarios[o.count // 3]
    blind.run(o.umov, "run", true, "-o", work / "run", "-q")
    blind.observed(blind.rows_of(work / "run/lightcurve.csv"), 50, rng, work / "obs.csv")
    part = work / "part"
    part.mkdir(exist_ok=True)
    for file in sorted((work / "lib").glob("*.umovsig"))[:max(8, o.count // 10)]:
        if not (part / file.name).exists():
            (part / file.name).hardlink_to(file)
    cost = []
    for folder, count in ((part, max(8, o.count // 10)), (work / "lib", o.count)):
        best = min((measured([o.umov, "identify", work / "obs.csv", "--library", folder, "--scenario", true, "-o", work / "answer", "--force",
                              "-q"]) for _ in range(3)), key=lambda m: m[1])
        cost.append((count, *best))
        print(f"identify: {count} objects, {best[0]:.2f} s, {best[1]:.2f} s of CPU, {best[2]:.0f} MB at most in any run so far")
    each = (cost[1][2] - cost[0][2]) / max(cost[1][0] - cost[0][0], 1)
    print(f"an object more: {1000 * each:.2f} ms of CPU; 1,000 objects by that: {cost[1][2] + each * (1000 - cost[1][0]):.1f} s of CPU")
    print((work / "answer/log.txt").read_text().splitlines()[0])


if __name__ == "__main__":
    main()
