#!/usr/bin/env python3
"""A seeded blind set through the whole observing chain: poses and spins of objects in random attitudes, recorded by
`umov observe` (a finer mesh than the fitted one, air, sky, noise of a polarization camera whose filters take turns), reduced by
`umov reduce`, and asked of `umov invert pose` and `invert spin`. The truth stays in this program.
Prints a line a curve; writes the table, with what made it in its header.

usage: blind_set.py [--each 20] [--seed 60] [--kinds pose,spin] [-o bench/inverse/blind_set.csv] [--umov PATH] [--work DIR]"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import tempfile
import time

import blind

CHAIN = """
[observation]
bands = ["nm:425", "nm:550", "nm:650"]
exposure_s = {exposure}
cadence_s = {cadence}
"""
def objects():
    """Name -> (shape, materials)."""
    return {name: (name, blind.MATERIALS[name]) for name in ("cubesat", "agena")}


class Chain:
    def __init__(self, o, work):
        self.o, self.work = o, work
        for shape in ("cubesat", "agena"):
            for words, kind in zip(blind.MESH[shape], ("fit", "true")):
                path = work / f"{shape}_{kind}.obj"
                if not path.exists():
                    blind.run(o.umov, "mesh", "make", *words, "-o", path, "-q")

    def scenario(self, name, kind, law, cadence, method, seed):
        shape, materials = objects()[name]
        text = blind.SCENARIO.format(seed=seed, name=name, root=blind.ROOT, mesh=self.work / f"{shape}_{kind}.obj", law=law, step=12,
                                     materials="\n".join(f'{g} = "{m}"' for g, m in materials.items()), method=method,
                                     out=self.work / "out")
        text = text.replace("title =", 'instrument = "c11_imx250"\ntitle =')
        return text + CHAIN.format(exposure=min(1, cadence / 4), cadence=cadence)

    def observe(self, name, law, cadence, seed):
        """stokes.csv of an object in an attitude."""
        (self.work / "true.toml").write_text(self.scenario(name, "true", law, cadence, "auto", seed))
        (self.work / "fit.toml").write_text(self.scenario(name, "fit", blind.inertial([1, 0, 0, 0]), cadence, "masks", seed))
        blind.run(self.o.umov, "observe", self.work / "true.toml", "-o", self.work / "counts", "--force", "-q")
        blind.run(self.o.umov, "reduce", self.work / "counts/counts.csv", "-o", self.work / "stokes.csv", "-q")

    def ask(self, *words):
        began = time.time()
        done = subprocess.run([str(self.o.umov), *map(str, words), "-o", str(self.work / "answer"), "--force", "--json"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 4):
            return {"verdict": "refused", "note": done.stderr.strip().splitlines()[-1][:100] if done.stderr else ""}, time.time() - began
        return json.loads(done.stdout), time.time() - began


def pose(chain, name, rng, seed):
    truth = blind.random_attitude(rng)
    chain.observe(name, blind.inertial(truth), 4, seed)
    answer, seconds = chain.ask("invert", "pose", chain.work / "stokes.csv", "--scenario", chain.work / "fit.toml")
    if answer["verdict"] == "refused":
        return "refused", float("nan"), False, False, seconds
    same = blind.twins(truth, answer["symmetries"])
    error = min(blind.apart(t, answer["modes"][0]["q"]) for t in same) if answer["modes"] else float("nan")
    balls = [[float(row[k]) for k in ("qw", "qx", "qy", "qz", "radius_deg")] for row in blind.table_rows(chain.work / "answer/set95.ecsv")]
    inside = any(blind.apart(t, b[:4]) <= b[4] for t in same for b in balls)
    return answer["verdict"], error, error < 5, inside, seconds


def spin(chain, name, rng, seed, period=40.0):
    truth, axis = blind.random_attitude(rng), blind.random_attitude(rng)[:3]
    rate = [360 / period * c / math.sqrt(sum(x * x for x in axis)) for c in axis]
    law = f'mode = "tumble", inertia = [1, 1, 1], rate_deg_s = {rate}, start = {{ {blind.inertial(truth)} }}'
    chain.observe(name, law, 2, seed)
    answer, seconds = chain.ask("invert", "spin", chain.work / "stokes.csv", "--scenario", chain.work / "fit.toml", "--period",
                                period * (1 + rng.uniform(-0.01, 0.01)))
    if answer["verdict"] == "refused" or not answer["modes"]:
        return answer["verdict"], float("nan"), False, False, seconds
    true = blind.spin_axis(truth, rate)
    off = []
    for row in blind.table_rows(chain.work / "answer/modes.ecsv"):
        w = [float(row[k]) for k in ("rate_x", "rate_y", "rate_z")]
        found = blind.spin_axis([float(row[k]) for k in ("qw", "qx", "qy", "qz")], w)
        turns = math.sqrt(sum(x * x for x in w)) * period / 360
        angle = math.degrees(math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(found, true))))))
        off.append(angle if abs(turns - 1) < 0.01 else 180.0)
    # No set of spins is written: a mode that matters (1 %) is what the answer allows.
    return answer["verdict"], off[0], off[0] < 2, min(off) < 2, seconds


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--each", type=int, default=20)
    parser.add_argument("--seed", type=int, default=60)
    parser.add_argument("--kinds", default="pose,spin")
    parser.add_argument("--umov", default=blind.ROOT / "build/release/apps/cli/umov")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    o = parser.parse_args()
    work = o.work or pathlib.Path(tempfile.mkdtemp())
    work.mkdir(parents=True, exist_ok=True)
    chain, names, lines = Chain(o, work), list(objects()), []
    for kind in o.kinds.split(","):
        right = inside = 0
        for trial in range(o.each):
            rng = random.Random(f"{o.seed} {kind} {trial}")
            name = names[trial % len(names)]
            verdict, value, is_right, is_inside, seconds = {"pose": pose, "spin": spin}[kind](
                chain, name, rng, o.seed + trial)
            right += is_right
            inside += is_right or is_inside
            lines.append(f"{kind},{trial},{name},{verdict},{value:.4g},{int(is_right)},{int(is_inside)},{seconds:.1f}")
            print(lines[-1], flush=True)
        print(f"{kind}: {right} of {o.each} right, {inside} right or in the set", flush=True)
    if o.output:
        version = subprocess.run([str(o.umov), "--version"], capture_output=True, text=True).stdout.strip()
        head = [f"# made by: blind_set.py --each {o.each} --seed {o.seed} --kinds {o.kinds}; {version}",
                "# value: error of the best attitude [deg], of the best axis [deg]",
                "kind,trial,object,verdict,value,right,in_set,seconds"]
        o.output.write_text("\n".join(head + lines) + "\n")


if __name__ == "__main__":
    main()
