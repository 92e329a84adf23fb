#!/usr/bin/env python3
"""A seeded blind set through the whole observing chain: poses, spins and identities of objects in random attitudes, recorded by
`umov observe` (a finer mesh than the fitted one, air, sky, noise of a polarization camera whose filters take turns), reduced by
`umov reduce`, and asked of `umov invert pose`, `invert spin` and `identify`. The truth stays in this program.
Prints a line a curve; writes the table, with what made it in its header.

usage: blind_set.py [--counts] [--each 20] [--only 9 or 8-19] [--seed 60] [--kinds pose,spin,identity] [--objects cubesat,agena] [--snr 20] [-o FILE] [--umov PATH] [--work DIR]
                    [options of umov invert and identify]
--objects: of which poses and spins are asked; identities are of those of the library: cubesat, agena, box-wing, hst, each with its own light.
--snr: of I, in the median of the lit sets: the telescope is made as large as that takes, its focal ratio kept. Without it: 28 cm.
--counts: `umov invert` has the counts themselves, not what `umov reduce` made of them.
--work: what was observed is kept there and taken again by the next run."""
import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import time

import blind

CHAIN = """
[observation]
bands = ["nm:425", "nm:550", "nm:650"]
exposure_s = {exposure}
cadence_s = {cadence}
"""
LIBRARY = ("cubesat", "agena", "box-wing", "hst")
TELESCOPE = blind.ROOT / "data/instruments/c11_imx250.toml"


class Chain:
    def __init__(self, o, work):
        self.o, self.work = o, work
        self.telescope(1.0)  # scenarios name it, those of the library before anything is observed
        for shape in {*o.objects.split(","), *(LIBRARY if "identity" in o.kinds else ())}:
            for words, kind in zip(blind.MESH[shape], ("fit", "true")):
                path = work / f"{shape}_{kind}.obj"
                if not path.exists():
                    blind.run(o.umov, "mesh", "make", *words, "-o", path, "-q")

    def scenario(self, name, kind, law, cadence, method, seed):
        text = blind.SCENARIO.format(seed=seed, name=name, root=blind.ROOT, mesh=self.work / f"{name}_{kind}.obj", law=law, step=12,
                                     materials="\n".join(f'{g} = "{m}"' for g, m in blind.MATERIALS[name].items()), method=method,
                                     out=self.work / "out", span=blind.SPAN)
        text = text.replace("title =", f'instrument = "{self.work}/telescope.toml"\ntitle =')
        return text + CHAIN.format(exposure=min(1, cadence / 4), cadence=cadence)

    def telescope(self, larger):
        lines = TELESCOPE.read_text().splitlines()
        for k, line in enumerate(lines):
            key = line.split(" =")[0]
            if key in ("aperture_m", "focal_length_m"):
                lines[k] = f"{key} = {float(line.split('=')[1]) * larger:.4f}"
        (self.work / "telescope.toml").write_text("\n".join(lines) + "\n")

    def snr(self):
        """Of I, in the median of the sets that are lit."""
        true = {(r["set_id"], r["band"]): float(r["I"]) for r in blind.rows_of(self.work / "counts/truth.csv")}
        ratios = [true[r["set_id"], r["band"]] / float(r["I_err"]) for r in blind.rows_of(self.work / "stokes.csv") if r["I_err"]]
        return statistics.median([r for r in ratios if r > 0.01] or [0.01])

    def observe(self, name, law, cadence, seed, keep):
        """data.csv of an object in an attitude: counts, or what they are reduced to."""
        (self.work / "fit.toml").write_text(self.scenario(name, "fit", blind.inertial([1, 0, 0, 0]), cadence, "masks", seed))
        if keep.exists():
            (self.work / "data.csv").write_bytes(keep.read_bytes())
            return
        (self.work / "true.toml").write_text(self.scenario(name, "true", law, cadence, "auto", seed))
        larger = 1.0
        for _ in range(6):
            self.telescope(larger)
            blind.run(self.o.umov, "observe", self.work / "true.toml", "-o", self.work / "counts", "--force", "-q")
            blind.run(self.o.umov, "reduce", self.work / "counts/counts.csv", "-o", self.work / "stokes.csv", "-q")
            if not self.o.snr or abs(math.log(self.snr() / self.o.snr)) < 0.1:
                break
            larger = min(larger * self.o.snr / self.snr(), 200)
        made = {False: self.work / "stokes.csv", True: self.work / "counts/counts.csv"}
        for is_counts, path in made.items():
            self.kept(keep.name.replace("_counts", ""), is_counts).write_bytes(path.read_bytes())
        (self.work / "data.csv").write_bytes(made[self.o.counts].read_bytes())

    def kept(self, name, is_counts):
        """Both are kept, so that both can be asked of one observation."""
        return self.work / (name.replace(".csv", "_counts.csv") if is_counts else name)

    def ask(self, *words):
        began = time.time()
        done = subprocess.run([str(self.o.umov), *map(str, words), *self.o.rest, "-o", str(self.work / "answer"), "--force", "--json"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 4):
            return {"verdict": "refused", "note": done.stderr.strip().splitlines()[-1][:100] if done.stderr else ""}, time.time() - began
        return json.loads(done.stdout), time.time() - began


def pose(chain, name, rng, seed, keep):
    truth = blind.random_attitude(rng)
    chain.observe(name, blind.inertial(truth), 4, seed, keep)
    answer, seconds = chain.ask("invert", "pose", chain.work / "data.csv", "--scenario", chain.work / "fit.toml")
    if answer["verdict"] == "refused":
        return "refused", float("nan"), False, False, 1.0, seconds
    same = blind.twins(truth, answer["symmetries"])
    error = min(blind.apart(t, answer["modes"][0]["q"]) for t in same) if answer["modes"] else float("nan")
    inside = blind.in_set(chain.work / "answer/set95.ecsv", same)
    return answer["verdict"], error, error < 5, inside, answer["share_of_so3"], seconds


def spin(chain, name, rng, seed, keep, period=40.0):
    truth, axis = blind.random_attitude(rng), blind.random_attitude(rng)[:3]
    rate = [360 / period * c / math.sqrt(sum(x * x for x in axis)) for c in axis]
    law = f'mode = "tumble", inertia = [1, 1, 1], rate_deg_s = {rate}, start = {{ {blind.inertial(truth)} }}'
    chain.observe(name, law, 2, seed, keep)
    answer, seconds = chain.ask("invert", "spin", chain.work / "data.csv", "--scenario", chain.work / "fit.toml", "--period",
                                period * (1 + rng.uniform(-0.01, 0.01)))
    if answer["verdict"] == "refused" or not answer["modes"]:
        return answer["verdict"], float("nan"), False, False, 1.0, seconds
    true = blind.spin_axis(truth, rate)
    off = []
    for row in blind.table_rows(chain.work / "answer/modes.ecsv"):
        if off and float(row["weight"]) < 0.01:
            continue
        w = [float(row[k]) for k in ("rate_x", "rate_y", "rate_z")]
        found = blind.spin_axis([float(row[k]) for k in ("qw", "qx", "qy", "qz")], w)
        turns = math.sqrt(sum(x * x for x in w)) * period / 360
        angle = math.degrees(math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(found, true))))))
        off.append(angle if abs(turns - 1) < 0.01 else 180.0)
    # No set of spins is written: a mode that matters (1 %) is what the answer allows.
    return answer["verdict"], off[0], off[0] < 2, min(off) < 2, answer["share_of_so3"], seconds


def identity(chain, name, rng, seed, keep):
    scenarios = [chain.work / f"{one}.toml" for one in LIBRARY]
    if not (chain.work / "lib").exists():
        for one, path in zip(LIBRARY, scenarios):
            path.write_text(chain.scenario(one, "fit", blind.inertial([1, 0, 0, 0]), 4, "masks", 1))
        blind.run(chain.o.umov, "library", "build", *scenarios, "-o", chain.work / "lib", "-q")
    chain.observe(name, blind.inertial(blind.random_attitude(rng)), 4, seed, keep)
    answer, seconds = chain.ask("identify", chain.work / "data.csv", "--scenario", chain.work / "fit.toml", "--library", chain.work / "lib",
                                "--objects", *scenarios)
    if answer["verdict"] == "refused":
        return "refused", float("nan"), False, False, 1.0, seconds
    shares = sorted([(c["probability"], c["name"]) for c in answer["searched"]] + [(answer["none_of_these"], "none of these")], reverse=True)
    named, total = [], 0.0
    for share, who in shares:
        if total < 0.95:
            named.append(who)
        total += share
    return answer["verdict"], dict((who, share) for share, who in shares).get(name, 0.0), shares[0][1] == name, name in named, len(named), seconds


def wanted(only, trial):
    """`only`: "9", or "8-19", or nothing for all."""
    first, _, last = (only or f"{trial}").partition("-")
    return int(first) <= trial <= int(last or first)


ASKED = {"pose": pose, "spin": spin, "identity": identity}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--each", type=int, default=20)
    parser.add_argument("--seed", type=int, default=60)
    parser.add_argument("--kinds", default="pose,spin,identity")
    parser.add_argument("--objects", default="cubesat,agena")
    parser.add_argument("--snr", type=float, default=0)
    parser.add_argument("--counts", action="store_true")
    parser.add_argument("--only", help="this trial alone, or those from one to another: 8-19")
    blind.add_places(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov invert
    work = blind.work_folder(o)
    chain, names, lines = Chain(o, work), o.objects.split(","), []
    for kind in o.kinds.split(","):
        done = right = covered = inside = 0
        for trial in range(o.each):
            if not wanted(o.only, trial):
                continue
            rng = random.Random(f"{o.seed} {kind} {trial}")
            name = LIBRARY[trial % len(LIBRARY)] if kind == "identity" else names[trial % len(names)]
            keep = chain.kept(f"{kind}_{name}_{o.seed}_{trial}_{o.snr:g}.csv", o.counts)
            verdict, value, is_right, is_covered, share, seconds = ASKED[kind](chain, name, rng, o.seed + trial, keep)
            done += 1
            right += is_right
            covered += is_covered
            inside += is_right or is_covered
            lines.append(f"{kind},{trial},{name},{verdict},{value:.4g},{int(is_right)},{int(is_covered)},{share:.2g},{seconds:.1f}")
            print(lines[-1], flush=True)
        print(f"{kind}, SNR {o.snr:g}: of {done} {right} right, {covered} in the set, {inside} right or in the set", flush=True)
    if o.output:
        version = subprocess.run([str(o.umov), "--version"], capture_output=True, text=True).stdout.strip()
        head = [f"# made by: blind_set.py --each {o.each} --seed {o.seed} --kinds {o.kinds} --objects {o.objects} --snr {o.snr:g}{' --counts' if o.counts else ''}"
                f"{'' if o.only is None else f' --only {o.only}'}{''.join(f' {word}' for word in o.rest)}; {version}",
                "# value: error of the best attitude [deg], of the best axis [deg], probability of the true object",
                "# share: of all attitudes, that the set takes; objects that 95 % of the probability need",
                "kind,trial,object,verdict,value,right,in_set,share,seconds"]
        o.output.write_text("\n".join(head + lines) + "\n")


if __name__ == "__main__":
    main()
