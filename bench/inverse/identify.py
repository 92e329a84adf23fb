#!/usr/bin/env python3
"""Which object of a library: seeded random cubesats (units, panels, 3 to 5 materials over their faces), curves by rays in random fixed
attitudes with noise of photons, at an unknown range; then objects that the library does not have.
Prints a line a curve and the summary; with --copies the time and memory of a look through a large library.

usage: identify.py [--objects 10] [--trials 2] [--unseen 10] [--snr 100] [--seed 1] [--own] [--copies 100] [--umov PATH] [--work DIR]
--trials: curves of each object. --own: scenarios are named, so that the best are judged by their own light.
--copies: every file of the library so many times, under names of their own."""
import argparse
import json
import math
import pathlib
import random
import resource
import shutil
import statistics
import subprocess
import tempfile
import time

import blind

MATERIALS = ["aluminium_anodized", "cell_gaas", "mli_kapton", "paint_white", "paint_black", "film_aluminized", "aluminium", "cell_silicon",
             "titanium"]


class Maker:
    def __init__(self, o, work):
        self.o, self.work = o, work

    def scenario(self, name, method, attitude, materials, mesh):
        return blind.SCENARIO.format(seed=self.o.seed, name=name, root=blind.ROOT, mesh=mesh, law=blind.inertial(attitude), step=12,
                                     materials="\n".join(f'{g} = "{m}"' for g, m in materials.items()), method=method,
                                     out=self.work / "out")

    def object(self, number):
        """Mesh and materials of a random object."""
        rng = random.Random(f"{self.o.seed} object {number}")
        units, panels = rng.choice([1, 2, 3, 6, 12]), rng.randrange(0, 5)
        mesh = self.work / f"cubesat_{units}_{panels}.obj"
        if not mesh.exists():
            blind.run(self.o.umov, "mesh", "make", "cubesat", "--units", units, "--panels", panels, "-o", mesh, "-q")
        groups = sorted({line.split()[1] for line in mesh.read_text().splitlines() if line.startswith("usemtl ")})
        few = rng.sample(MATERIALS, rng.randrange(3, 6))
        return mesh, {group: rng.choice(few) for group in groups}

    def write(self, number):
        """The scenario of an object of the library."""
        mesh, materials = self.object(number)
        path = self.work / f"sat_{number:03d}.toml"
        path.write_text(self.scenario(path.stem, "masks", [1, 0, 0, 0], materials, mesh))
        return path

    def curve(self, number, trial):
        """obs.csv of an object in a random attitude."""
        rng = random.Random(f"{self.o.seed} curve {number} {trial}")
        mesh, materials = self.object(number)
        (self.work / "true.toml").write_text(self.scenario("true", "rays", blind.random_attitude(rng), materials, mesh))
        blind.run(self.o.umov, "run", self.work / "true.toml", "-o", self.work / "truth", "--force", "-q")
        blind.observed(blind.rows_of(self.work / "truth/lightcurve.csv"), self.o.snr, rng, self.work / "obs.csv")


def asked(o, work, library, *words):
    began = time.time()
    found = json.loads(blind.run(o.umov, "identify", work / "obs.csv", "--library", library, "--scenario", work / "place.toml", "--json",
                                 *words, *o.rest, ok=(0, 4)))
    return found, time.time() - began


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--objects", type=int, default=10)
    parser.add_argument("--trials", type=int, default=2)
    parser.add_argument("--unseen", type=int, default=10)
    parser.add_argument("--snr", type=float, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--own", action="store_true")
    parser.add_argument("--copies", type=int, default=0)
    parser.add_argument("--umov", default=blind.ROOT / "build/release/apps/cli/umov")
    parser.add_argument("--work", type=pathlib.Path)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov identify
    work = o.work or pathlib.Path(tempfile.mkdtemp())
    work.mkdir(parents=True, exist_ok=True)
    maker = Maker(o, work)
    scenarios = [maker.write(k) for k in range(o.objects)]
    (work / "place.toml").write_text(scenarios[0].read_text())
    began = time.time()
    blind.run(o.umov, "library", "build", *scenarios, "-o", work / "lib", "-q")
    print(f"library of {o.objects} objects: {time.time() - began:.1f} s", flush=True)
    own = ["--objects", *scenarios] if o.own else []
    names(o, work, maker, own)
    if o.copies:
        speed(o, work, maker)


def names(o, work, maker, own):
    none = {True: [], False: []}
    right = sure = wrong = 0
    seconds = []
    for number in [k for k in range(o.objects) for _ in range(o.trials)] + list(range(1000, 1000 + o.unseen)):
        trial = len(none[True]) + len(none[False])
        maker.curve(number, trial)
        found, took = asked(o, work, work / "lib", *own)
        known = number < o.objects
        name = f"sat_{number:03d}"
        right += known and found["best"] == name
        sure += known and found["best"] == name and found["verdict"] == "determined"
        wrong += found["verdict"] == "determined" and found["best"] != name
        none[known].append(found["none_of_these"])
        seconds.append(took)
        print(f"{name}: {found['verdict']} {found['best']} {found['probability']:.3f} none {found['none_of_these']:.3f} by {found['by']}, "
              f"chi2/dof {found['chi2'] / max(found['dof'], 1):.2f}, {took:.1f} s", flush=True)
    seen = sorted(none[True])
    line = seen[max(0, math.ceil(0.95 * len(seen)) - 1)] if seen else 0.5  # 5 % false alarms
    n, m = max(len(none[True]), 1), max(len(none[False]), 1)
    print(f"{o.objects} objects, SNR {o.snr:g}, {'own light' if own else 'tables'}, seed {o.seed}: right {right} of {len(none[True])} "
          f"({right / n:.2f}), determined and right {sure}, determined and wrong {wrong}; none > 0.5: known {sum(p > 0.5 for p in none[True]) / n:.2f}, "
          f"unseen {sum(p > 0.5 for p in none[False]) / m:.2f}; unseen above the line of 5 % false alarms ({line:.2g}): "
          f"{sum(p > line for p in none[False]) / m:.2f}; {statistics.median(seconds):.1f} s", flush=True)


def speed(o, work, maker):
    large = work / "large"
    shutil.rmtree(large, ignore_errors=True)
    large.mkdir()
    for file in sorted((work / "lib").glob("*.umovsig")):
        for k in range(o.copies):
            shutil.copy(file, large / f"{file.stem}_{k:03d}.umovsig")
    maker.curve(0, 0)
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        began = time.time()
        done = subprocess.run([str(o.umov), "identify", str(work / "obs.csv"), "--library", str(large), "--scenario", str(work / "place.toml"), "--json"],
                              capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        found = json.loads(done.stdout)
        print(f"{found['objects']} objects: {time.time() - began:.2f} s, {after.ru_utime - before.ru_utime:.2f} s of processors, "
              f"at most {after.ru_maxrss / 1e6:.2f} GB; best {found['best']}", flush=True)


if __name__ == "__main__":
    main()
