#!/usr/bin/env python3
"""What each Stokes component adds: the same curves of a cubesat with a panel with I alone, with I and Q, with I, Q and U of the scattering
plane, by question, phase angle and noise. Truth by rays, noise of photons (equal photons for all three: an ideal simultaneous polarimeter),
materials known but where they are what is asked. Prints a table in Markdown; a cell has the answers of all trials in three numbers at most. A row of I and Q tells u = 0 +- 100, since a table has both or none:
it counts as a measurement, so that chi-square of those answers has a degree of freedom a row too many and their chance is too large.

usage: ablation.py [--trials 6] [--seed 9] [--snr 10,100] [--questions pose,material,identity] [--phases 40,90] [--umov PATH] [--work DIR]
                   [options of umov invert and identify]
Numbers of pose: share of best attitudes within 5 deg / truths in the 95 % set / median share of all attitudes that the set takes [%]; of
material (is a face of paint, which it is, of aluminium or of cells, or of some of each? attitude known): share of curves that give paint over
95 % / mean of its probability / of the error of the three parts (root mean square), those that cannot be told apart sharing alike; of identity (three cubesats of one shape, each with its own light): how often the true
one leads / mean of its probability."""
import argparse
import json
import math
import random
import shutil
import statistics
import time

import blind

OBJECT, FACE = "cubesat", "body_my"
FACE_OF = ("paint_white", "aluminium_anodized", "cell_gaas")
# The others of the library, as what stands in the place of what.
OTHER = {"cubesat": {}, "cubesat_foil": {"mli_kapton": "film_aluminized"}, "cubesat_metal": {"paint_white": "aluminium_anodized"}}
# Parts of one pass of the orbit of blind.py by their middle phase angle [deg]: start, stop, step [s]; 11 epochs each, 30 deg.
PASSES = {"40": ("04:41:48", "04:43:06", 7.8), "90": ("04:40:32", "04:41:16", 4.4)}
DATA = ("I", "I,Q", "I,Q,U")


class Bench:
    def __init__(self, o, work):
        self.o, self.work = o, work
        shutil.rmtree(work / "lib", ignore_errors=True)  # of another run, perhaps of another umov
        self.right = ["--slope-sd", 0, "--reflectance-sd", 0, "--haze-sd", 0]
        for words, kind in zip(blind.MESH[OBJECT], ("fit", "true")):
            blind.run(o.umov, "mesh", "make", *words, "-o", work / f"{kind}.obj", "-q")

    def scenario(self, name, span, attitude, kind, method):
        materials = {g: OTHER[name].get(m, m) for g, m in blind.MATERIALS[OBJECT].items()}
        text = blind.SCENARIO.format(seed=self.o.seed, name=name, root=blind.ROOT, mesh=self.work / f"{kind}.obj", law=blind.inertial(attitude),
                                     step=span[2], materials="\n".join(f'{g} = "{m}"' for g, m in materials.items()), method=method,
                                     out=self.work / "truth", span=[f"2018-01-24T{time}Z" for time in span[:2]])
        path = self.work / (f"{name}.toml" if kind == "fit" else "true.toml")
        path.write_text(text + 'pol_frame = "scattering"\n')
        return path

    def observe(self, span, attitude, snr, rng):
        """A table for each of DATA, of the same photons."""
        true = self.scenario(OBJECT, span, attitude, "true", "rays")
        blind.run(self.o.umov, "run", true, "-o", self.work / "truth", "--force", "-q")
        rows = blind.rows_of(self.work / "truth/lightcurve.csv")
        blind.observed(rows, snr, rng, self.work / "all.csv")
        head, names, *lines = (self.work / "all.csv").read_text().splitlines()
        for data in DATA:
            out = [head.replace("equatorial", "scattering"), names]
            for line in lines:
                cells = line.split(",")
                if data == "I":
                    cells[4:] = [""] * 4
                elif data == "I,Q" and cells[4]:
                    cells[5], cells[7] = "0", "100"  # of U: nothing is known of it
                out.append(",".join(cells))
            self.table(data).write_text("\n".join(out) + "\n")
        phases = [float(r["phase_angle"]) for r in rows]
        return min(phases), max(phases), len({r["time_utc"] for r in rows})

    def table(self, data):
        return self.work / f"{data.replace(',', '').lower()}.csv"

    def asked(self, *words):
        return json.loads(blind.run(self.o.umov, *words, *self.o.rest, "-o", self.work / "answer", "--force", "--json", ok=(0, 4)))

    def pose(self, data, span, truth):
        answer = self.asked("invert", "pose", self.table(data), "--scenario", self.scenario(OBJECT, span, [1, 0, 0, 0], "fit", "masks"), *self.right)
        same = blind.twins(truth, answer["symmetries"])
        best = min((blind.apart(t, answer["modes"][0]["q"]) for t in same), default=180) if answer["modes"] else 180
        return best < 5, blind.in_set(self.work / "answer/set95.ecsv", same), 100 * answer["share_of_so3"]

    def material(self, data, span, truth):
        self.asked("invert", "material", self.table(data), "--scenario", self.scenario(OBJECT, span, truth, "fit", "masks"), "--group", FACE,
                   "--candidates", ",".join(FACE_OF))
        chance, off = 0.0, []
        for row in blind.table_rows(self.work / "answer/materials.ecsv"):
            alike = row["material"].strip('"').split("|")  # what cannot be told apart shares
            part = float(row["fraction"]) if row["fraction"].strip('"') else len(alike) / len(FACE_OF)
            off += [part / len(alike) - (one == FACE_OF[0]) for one in alike]
            if FACE_OF[0] in alike:
                chance = float(row["probability"]) / len(alike)
        return chance > 0.95, chance, math.sqrt(statistics.mean(x * x for x in off))

    def identity(self, data, span, truth):
        scenarios = [self.scenario(name, span, [1, 0, 0, 0], "fit", "masks") for name in OTHER]
        if not (self.work / "lib").exists():
            blind.run(self.o.umov, "library", "build", *scenarios, "-o", self.work / "lib", "-q")
        answer = self.asked("identify", self.table(data), "--scenario", scenarios[0], "--library", self.work / "lib", "--objects", *scenarios)
        chance = {row["name"]: row["probability"] for row in answer["searched"]}.get(OBJECT, 0)
        return answer["best"] == OBJECT and chance > answer["none_of_these"], chance


def in_words(results, of_share):
    """`of_share`: of the set, whose scatter over decades has a median."""
    columns = list(zip(*results))
    shares, numbers = [c for c in columns if isinstance(c[0], bool)], [c for c in columns if not isinstance(c[0], bool)]
    return " / ".join([f"{statistics.mean(c):.2f}" for c in shares] + [f"{statistics.median(c) if of_share else statistics.mean(c):.2g}" for c in numbers])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--trials", type=int, default=6)
    parser.add_argument("--seed", type=int, default=9)
    parser.add_argument("--snr", default="10,100")
    parser.add_argument("--questions", default="pose,material,identity")
    parser.add_argument("--phases", default=",".join(PASSES))
    blind.add_places(parser)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov invert and identify
    work = blind.work_folder(o)
    bench, seen = Bench(o, work), {}
    print(f"| question | phase | S/N | {' | '.join(DATA)} | s |\n|---|---|---|---|---|---|---|", flush=True)
    for question in o.questions.split(","):
        for phase in o.phases.split(","):
            for snr in o.snr.split(","):
                results, began = {data: [] for data in DATA}, time.time()
                for trial in range(o.trials):
                    rng = random.Random(f"{o.seed} {phase} {trial}")  # one attitude for all questions
                    truth = blind.random_attitude(rng)
                    seen[phase] = bench.observe(PASSES[phase], truth, float(snr), rng)
                    for data in DATA:
                        results[data].append(getattr(bench, question)(data, PASSES[phase], truth))
                print(f"| {question} | {phase} | {snr} | {' | '.join(in_words(results[d], question == 'pose') for d in DATA)} | {time.time() - began:.0f} |", flush=True)
    for phase, (least, most, epochs) in seen.items():
        print(f"phase {phase}: {least:.0f} to {most:.0f} deg, {epochs} epochs, {o.trials} curves", flush=True)


if __name__ == "__main__":
    main()
