#!/usr/bin/env python3
"""Which object of a library: seeded random cubesats (units, panels, 3 to 5 materials over their faces), curves by rays in random fixed
attitudes with noise of photons, at an unknown range; then objects that the library does not have.
Prints a line a curve and the summary.

usage: identify.py [--objects 10] [--trials 2] [--unseen 10] [--index 100 [--copies 10]] [--snr 100] [--seed 1]
                   [--own] [--wrong 1] [--umov PATH] [--work DIR] [options of umov identify]
--trials: curves of each object. --own: scenarios are named, so that the best are judged by their own light.
--wrong 1: materials of the true objects are others than the library's: slopes of lobes 20 % off (normal, ln), reflectances of paints 10 %, haze 30 %; other numbers are parts or multiples of that.
--index 100: no curve is named; a library of so many objects of four metals is built, built again in other bands from the abundances that
its files hold, and asked with one thread and with two, and so is one of --copies times as many files."""
import argparse
import collections
import json
import math
import random
import resource
import shutil
import statistics
import subprocess
import time

import blind

MATERIALS = ["aluminium_anodized", "cell_gaas", "mli_kapton", "paint_white", "paint_black", "film_aluminized", "aluminium", "cell_silicon",
             "titanium"]
# Lobes alone: abundances of body light and of haze are of one material, and serve no other colours.
METALS = {f"metal_{k}": f'[material.metal_{k}]\nindex = "{index}"\ndistribution = {{ model = "ggx", alpha = {alpha} }}\n'
          for k, (index, alpha) in enumerate((("Au_Johnson", 0.3), ("Fe_Johnson", 0.1), ("Al_Rakic", 0.15), ("Ag_Johnson", 0.25)))}


class Maker:
    def __init__(self, o, work):
        self.o, self.work = o, work

    def scenario(self, name, method, attitude, materials, mesh):
        text = blind.SCENARIO.format(seed=self.o.seed, name=name, root=blind.ROOT, mesh=mesh, law=blind.inertial(attitude), step=12,
                                     materials="\n".join(f'{g} = "{m}"' for g, m in materials.items()), method=method,
                                     out=self.work / "out", span=blind.SPAN)
        return text + "".join(METALS[m] for m in sorted(set(materials.values()) & set(METALS)))

    def object(self, number):
        """Mesh and materials of a random object."""
        rng = random.Random(f"{self.o.seed} object {number}")
        units, panels = rng.choice([1, 2, 3, 6, 12]), rng.randrange(0, 5)
        mesh = self.work / f"cubesat_{units}_{panels}.obj"
        if not mesh.exists():
            blind.run(self.o.umov, "mesh", "make", "cubesat", "--units", units, "--panels", panels, "-o", mesh, "-q")
        groups = sorted({line.split()[1] for line in mesh.read_text().splitlines() if line.startswith("usemtl ")})
        few = rng.sample(sorted(METALS) if self.o.index else MATERIALS, rng.randrange(3, 5 if self.o.index else 6))
        return mesh, {group: rng.choice(few) for group in groups}

    def write(self, number):
        """The scenario of an object of the library."""
        mesh, materials = self.object(number)
        path = self.work / f"sat_{number:03d}.toml"
        path.write_text(self.scenario(path.stem, "masks", [1, 0, 0, 0], materials, mesh))
        return path

    def curve(self, number, trial):
        """obs.csv of an object in a random attitude in which it is lit more often than not."""
        rng = random.Random(f"{self.o.seed} curve {number} {trial}")
        mesh, materials = self.object(number)
        rows = []
        while not rows or not any(statistics.median(float(r["intensity"]) for r in rows if r["band"] == band) > 0 for band in {r["band"] for r in rows}):
            text = self.scenario("true", "rays", blind.random_attitude(rng), materials, mesh)
            if self.o.wrong:
                other = random.Random(f"{self.o.seed} wrong {number} {trial}")
                text = blind.with_other_materials(text, set(materials.values()), self.o.wrong, other)
            (self.work / "true.toml").write_text(text)
            blind.run(self.o.umov, "run", self.work / "true.toml", "-o", self.work / "truth", "--force", "-q")
            rows = blind.rows_of(self.work / "truth/lightcurve.csv")
        blind.observed(rows, self.o.snr, rng, self.work / "obs.csv")


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
    parser.add_argument("--index", type=int, default=0)
    parser.add_argument("--snr", type=float, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--own", action="store_true")
    parser.add_argument("--wrong", type=float, default=0)
    parser.add_argument("--copies", type=int, default=10)
    blind.add_places(parser)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov identify
    if o.index and o.wrong:
        parser.error("--index names nothing: it takes no --wrong")
    if o.copies < 2:
        parser.error("--copies: two at least, or there is no object more to be timed")
    work = blind.work_folder(o)
    maker = Maker(o, work)
    if o.index:
        return index(o, work, maker)
    scenarios = [maker.write(k) for k in range(o.objects)]
    (work / "place.toml").write_text(scenarios[0].read_text())
    began = time.time()
    blind.run(o.umov, "library", "build", *scenarios, "-o", work / "lib", "-q")
    print(f"library of {o.objects} objects: {time.time() - began:.1f} s", flush=True)
    own = ["--objects", *scenarios] if o.own else []
    names(o, work, maker, own)


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


def measured(*command):
    """What a command printed, its seconds of processors, and the most memory of any so far [GB]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise SystemExit(done.stderr[-2000:])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, after.ru_maxrss / 1e6


def index(o, work, maker):
    scenarios = [maker.write(k) for k in range(o.index)]
    for bands in ('["nm:440", "nm:540", "nm:640"]', None):
        if bands:
            for path in scenarios:
                path.write_text(path.read_text().replace('set = "paper_rgb"', f"set = {bands}"))
        else:
            scenarios = [maker.write(k) for k in range(o.index)]
        table, seconds, memory = measured(o.umov, "library", "build", *scenarios, "-o", work / "lib", "--json")
        print(f"{o.index} objects of {table[0]['poses']} poses, {dict(collections.Counter(row['state'] for row in table))}: {seconds:.1f} s of processors, "
              f"at most {memory:.2f} GB", flush=True)
    (work / "place.toml").write_text(scenarios[0].read_text())
    maker.curve(0, 0)
    large = work / "large"
    shutil.rmtree(large, ignore_errors=True)
    large.mkdir()
    for file in sorted((work / "lib").glob("*.umovsig")):
        for k in range(o.copies):
            shutil.copy(file, large / f"{file.stem}_{k:03d}.umovsig")
    took = {}
    for library in (work / "lib", large):
        answers = []
        for threads in (1, 2):
            began = time.monotonic()
            found, seconds, memory = measured(o.umov, "identify", work / "obs.csv", "--library", library, "--scenario", work / "place.toml",
                                              "--json", "--threads", threads, *o.rest)
            took.setdefault(library, seconds)
            answers.append(found)
            print(f"{found['objects']} objects, {threads} threads: {time.monotonic() - began:.2f} s, {seconds:.2f} of processors, at most {memory:.2f} GB; best {found['best']}",
                  flush=True)
        print("the same answer with one thread and with two" if answers[0] == answers[1] else "ANOTHER ANSWER with two threads than with one",
              flush=True)
    each = (took[large] - took[work / "lib"]) / (o.index * (o.copies - 1))
    looked = 14_000 * 16  # attitudes and epochs: docs/theory/inverse.md, section 12
    print(f"an object more takes {1e3 * each:.2f} ms: {looked / each / 1e6:.0f} million pairs of attitude and epoch a second and core", flush=True)


if __name__ == "__main__":
    main()
