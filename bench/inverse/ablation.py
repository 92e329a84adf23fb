#!/usr/bin/env python3
"""What each Stokes component adds: the same curves with I alone, with I and Q, with I, Q and U of the scattering plane, by question, phase
angle and noise. Truth by rays on a finer mesh, noise of photons (equal photons for all three: an ideal simultaneous polarimeter).
Prints a table in Markdown; a cell has the three answers side by side.

usage: ablation.py [--trials 6] [--seed 9] [--snr 20,100] [--questions pose,clouds,material,health,identity] [--phases 50-110] [--umov PATH] [--work DIR]
Numbers of pose and clouds: share of best attitudes within 5 deg / truths in the 95 % set / median share of all attitudes that the set takes;
of material (which face is of paint, aluminium or cells): share of curves in which a tenth of paint more or less would show at 3 sigma / median of
the smallest that does, where the face gives light; of health: the same of gold kapton that turns to aluminium; of identity (among three of one shape): how often the true one leads / its median probability."""
import argparse
import json
import math
import pathlib
import random
import statistics
import tempfile

import blind

# Parts of one pass of the orbit of blind.py by the phase angles [deg] that they run through: start, stop, step [s]; 21 epochs each.
PASSES = {"10-50": ("04:41:57", "04:44:45", 8.4), "50-110": ("04:40:24", "04:41:57", 4.65), "110-160": ("04:37:18", "04:40:24", 9.3)}
OBJECT = "cubesat"
LIBRARY = ("cubesat", "cubesat_dark", "cubesat_metal")
OTHER = {"cubesat_dark": {"mli_kapton": "paint_black"}, "cubesat_metal": {"paint_white": "aluminium_anodized"}}
DATA = ("I", "I,Q", "I,Q,U")


class Bench:
    def __init__(self, o, work):
        self.o, self.work = o, work
        for words, kind in zip(blind.MESH[OBJECT], ("fit", "true")):
            blind.run(o.umov, "mesh", "make", *words, "-o", work / f"{kind}.obj", "-q")

    def scenario(self, name, span, attitude, kind, method):
        materials = dict(blind.MATERIALS[OBJECT])
        for group, material in materials.items():
            materials[group] = OTHER.get(name, {}).get(material, material)
        text = blind.SCENARIO.format(seed=self.o.seed, name=name, root=blind.ROOT, mesh=self.work / f"{kind}.obj", law=blind.inertial(attitude),
                                     step=span[2], materials="\n".join(f'{g} = "{m}"' for g, m in materials.items()), method=method,
                                     out=self.work / "truth")
        text = text.replace("2018-01-21T05:08:00Z", f"2018-01-24T{span[0]}Z").replace("2018-01-21T05:16:00Z", f"2018-01-24T{span[1]}Z")
        path = self.work / f"{name}_{kind}.toml"
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
                    cells[7] = "100"  # of U: nothing is known of it
                out.append(",".join(cells))
            self.table(data).write_text("\n".join(out) + "\n")

    def table(self, data):
        return self.work / f"{data.replace(',', '').lower()}.csv"

    def asked(self, *words):
        return json.loads(blind.run(self.o.umov, *words, "-o", self.work / "answer", "--force", "--json", ok=(0, 4)))

    def pose(self, data, span, truth, *words):
        answer = self.asked("invert", "pose", self.table(data), "--scenario", self.scenario(OBJECT, span, [1, 0, 0, 0], "fit", "masks"), *words)
        balls = [[float(row[k]) for k in ("qw", "qx", "qy", "qz", "radius_deg")] for row in blind.table_rows(self.work / "answer/set95.ecsv")]
        same = blind.twins(truth, answer["symmetries"])
        best = min((blind.apart(t, answer["modes"][0]["q"]) for t in same), default=180) if answer["modes"] else 180
        return best < 5, any(blind.apart(t, b[:4]) <= b[4] for t in same for b in balls), answer["share_of_so3"]

    def clouds(self, data, span, truth):
        return self.pose(data, span, truth, "--clouds")

    def material(self, data, span, truth):
        self.asked("invert", "material", self.table(data), "--scenario", self.scenario(OBJECT, span, truth, "fit", "masks"), "--group", "body_my",
                   "--candidates", "paint_white,aluminium_anodized,cell_gaas")
        rows = blind.table_rows(self.work / "answer/materials.ecsv")
        return shown([row["detectable"] for row in rows if "paint_white" in row["material"]][0])

    def health(self, data, span, truth):
        self.asked("invert", "health", self.table(data), "--scenario", self.scenario(OBJECT, span, truth, "fit", "masks"), "--drift",
                   "body_pz=aluminium_anodized")
        return shown(blind.table_rows(self.work / "answer/health.ecsv")[0]["detectable"])

    def identity(self, data, span, truth):
        if not (self.work / "lib").exists():
            blind.run(self.o.umov, "library", "build", *(self.scenario(name, span, [1, 0, 0, 0], "fit", "masks").rename(self.work / f"{name}.toml")
                                                         for name in LIBRARY), "-o", self.work / "lib", "-q")
        answer = self.asked("identify", self.table(data), "--scenario", self.scenario(OBJECT, span, truth, "fit", "masks"), "--library",
                            self.work / "lib")
        chance = {row["name"]: row["probability"] for row in answer["searched"]}.get(OBJECT, 0)
        return answer["best"] == OBJECT, chance


def shown(text):
    """Whether a change of a tenth would show, and the smallest that does; without light of the group none does."""
    smallest = float(text) if text not in ('""', "", "nan") and float(text) > 0 else math.inf
    return smallest < 0.1, smallest


def in_words(results):
    column = list(zip(*results))
    share = [f"{sum(c) / len(c):.2f}" for c in column if isinstance(c[0], bool)]
    median = [f"{statistics.median([x for x in c if math.isfinite(x)] or [math.inf]):.2g}" for c in column if not isinstance(c[0], bool)]
    return " / ".join(share + median)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--trials", type=int, default=6)
    parser.add_argument("--seed", type=int, default=9)
    parser.add_argument("--snr", default="20,100")
    parser.add_argument("--questions", default="pose,clouds,material,health,identity")
    parser.add_argument("--phases", default=",".join(PASSES))
    parser.add_argument("--umov", default=blind.ROOT / "build/release/apps/cli/umov")
    parser.add_argument("--work", type=pathlib.Path)
    o = parser.parse_args()
    work = o.work or pathlib.Path(tempfile.mkdtemp())
    work.mkdir(parents=True, exist_ok=True)
    bench = Bench(o, work)
    print(f"| question | phase | S/N | {' | '.join(DATA)} |\n|---|---|---|---|---|---|", flush=True)
    for question in o.questions.split(","):
        for phase in o.phases.split(","):
            for snr in o.snr.split(","):
                results = {data: [] for data in DATA}
                for trial in range(o.trials):
                    rng = random.Random(f"{o.seed} {phase} {trial}")  # one attitude for all questions
                    truth = blind.random_attitude(rng)
                    bench.observe(PASSES[phase], truth, float(snr), rng)
                    for data in DATA:
                        results[data].append(getattr(bench, question)(data, PASSES[phase], truth))
                print(f"| {question} | {phase} | {snr} | {' | '.join(in_words(results[d]) for d in DATA)} |", flush=True)


if __name__ == "__main__":
    main()
