#!/usr/bin/env python3
"""What one pass tells of ageing: how often `umov invert health` sees gold whose n and k have gone 2 % of the way to those of aluminium, and paint that has lost 3 % of its R_sub in the blue (a third of that in the
green, as it yellows), and how often it sees what has not happened; how often U of the scattering plane tells of polarization of the instrument. The pass and box of case_r.py, data by rays; attitudes in which the part
that ages gives 5 % of the light or more.

usage: health.py ATTITUDES PASSES [--snr 20] [--seed 1] [--epochs 200] [--instrument 0.002] [--attitude-off 0.1] [--gain-sd 0] [--umov PATH] [--work DIR] [options of umov invert health]
PASSES: without any change, in all; a tenth as many with each change. --instrument: the size of a polarization that stays in the instrument's axes, at a random angle in each pass. --attitude-off: how wrong the
scenario's attitude is, about each axis [deg]; the fit is told that. --gain-sd: zero points of bands are off by that, and the fit is told."""
import argparse
import math
import random
import statistics

import blind
import chamfered_box
import coverage
import known_attitude

DRIFTS = {"gold": ("px", 0.02), "paint": ("my", 0.03)}  # the group and how much of it has changed
STEP = 0.2  # of the changed materials that the fit is asked of: the change is linear that far
SEEN = 0.05  # of the light
GREEN = 0.35  # of the loss in the blue


def gold(part):
    both = [[a + part * (b - a) for a, b in zip(old, new)] for old, new in zip(known_attitude.index_of("Au_Johnson"), known_attitude.index_of("Al_Rakic"))]
    index = f"{{ wavelength_nm = {list(known_attitude.BANDS_NM)}, n = {[n for n, _ in both]}, k = {[k for _, k in both]} }}"
    return chamfered_box.MATERIALS["gold"].replace('"Au_Johnson"', index)


def paint(part):
    reflectance = [0.8 * (1 - part * lost) for lost in (1, GREEN, 0)]
    return chamfered_box.MATERIALS["paint"].replace("reflectance = 0.8", f"reflectance = {{ wavelength_nm = {list(known_attitude.BANDS_NM)}, reflectance = {reflectance} }}")


def materials():
    """In TOML: fresh, changed as the truth is, changed as the fit is asked, and one that gives no light."""
    out = "[material.dark]\nindex = { n = 1, k = 0 }\n" + chamfered_box.LOBE.format(m=20)
    for name, of in (("gold", gold), ("paint", paint)):
        for kind, part in (("fresh", 0), ("aged", DRIFTS[name][1]), ("asked", STEP)):
            out += f"[material.{name}_{kind}]\n{of(part)}"
    return out


def total(rows):
    return sum(r["intensity"] for r in rows)


class Count:
    """`true`: the change that there is."""

    def __init__(self, true):
        self.true, self.passes, self.seen, self.two_sided, self.changes, self.least, self.pulls, self.places = true, 0, 0, 0, [], [], [], set()

    def add(self, row, place):
        self.passes += 1
        self.seen += row["sigma"] > 3
        self.two_sided += abs(row["sigma"]) > 3
        self.changes.append(STEP * row["change"])
        self.least.append(STEP * row["detectable"])
        self.pulls.append((row["change"] - self.true / STEP) / row["change_err"])
        self.places |= {place} if row["sigma"] > 3 else set()

    def words(self):
        return (f"{self.seen} of {self.passes} over 3 sigma, in {len(self.places)} attitudes ({self.two_sided} to either side); change {100 * statistics.mean(self.changes):.2f} % in the mean, "
                f"pulls {statistics.mean(self.pulls):.2f} +- {statistics.pstdev(self.pulls):.2f}, smallest detectable {100 * statistics.median(self.least):.2f} % in the median")


class Counts:
    """Of a part that ages: passes in which it has, in which nothing has, and in which another part has."""

    def __init__(self, part):
        self.changed, self.unchanged, self.beside = Count(part), Count(0), Count(0)

    def of(self, changed, name):
        return self.unchanged if changed is None else self.changed if changed == name else self.beside


def lit_attitude(box, rng):
    """An attitude, its light, and the parts that give enough of it."""
    while True:
        truth = blind.random_attitude(rng)
        light = box.light(truth)
        seen = [name for name, (group, _) in DRIFTS.items() if total(box.light(truth, **{group: "dark"})) <= (1 - SEEN) * total(light)]
        if total(light) > 0 and seen:
            return truth, light, seen


def asked_of(box, truth, light, typical, seen, rng):
    """The answer about a pass as an observer has it, whose attitude, zero points and instrument are a little off."""
    o, path = box.o, box.work / "obs.csv"
    angle = rng.uniform(0, 2 * math.pi)
    off = blind.turned(truth, [o.attitude_off * rng.gauss(0, 1) for _ in range(3)], 1)
    gain = {f"nm:{nm}": 1 + o.gain_sd * rng.gauss(0, 1) for nm in known_attitude.BANDS_NM}
    known_attitude.write_observed(light, typical, o.snr, rng, path, gain, (o.instrument * math.cos(angle), o.instrument * math.sin(angle)))
    drifts = [word for name in seen for word in ("--drift", f"{DRIFTS[name][0]}={name}_asked")]
    return box.asked("health", path, "--scenario", box.scenario("fit", off, "rays"), *drifts)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("attitudes", type=int)
    parser.add_argument("passes", type=int)
    parser.add_argument("--snr", type=float, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--epochs", type=int, default=200)
    parser.add_argument("--instrument", type=float, default=0.002)
    parser.add_argument("--attitude-off", type=float, default=0.1)
    parser.add_argument("--gain-sd", type=float, default=0)
    blind.add_places(parser)
    o, given = parser.parse_known_args()  # what is not ours goes to umov invert
    o.rest = ["--floor", 0, "--zero-point-sd", max(o.gain_sd, 1e-6), "--attitude-sd", o.attitude_off, *given]
    work = blind.work_folder(o)
    fresh = {**chamfered_box.names(False), "px": "gold_fresh", "my": "paint_fresh"}
    del fresh["pz"]  # all gold is one group
    box = known_attitude.Box(o, work, fresh, materials(), o.epochs, same=[("pz", "px")])
    rng = random.Random(o.seed)
    typical = statistics.median(r["intensity"] for _ in range(20) for r in box.light(blind.random_attitude(rng)) if r["band"] == "nm:550")
    counts = {name: Counts(part) for name, (_, part) in DRIFTS.items()}
    flagged = asked = 0
    for place in range(o.attitudes):
        truth, light, seen = lit_attitude(box, rng)
        aged = {name: box.light(truth, **{DRIFTS[name][0]: f"{name}_aged"}) for name in seen}
        each = o.passes // o.attitudes
        for changed in [None] * each + [name for name in seen for _ in range(max(each // 10, 1))]:
            answer = asked_of(box, truth, aged.get(changed, light), typical, seen, rng)
            for row in answer["health"]:
                name = next(n for n in seen if row["parameter"].startswith(DRIFTS[n][0] + "="))
                counts[name].of(changed, name).add(row, place)
            flagged += answer["u_null_test"]["flagged"] if changed is None else 0
            asked += changed is None
        print(f"attitude {place}: {', '.join(seen)}; " + "; ".join(f"{n} alarms {c.unchanged.seen}, seen {c.changed.seen} of {c.changed.passes}" for n, c in counts.items()) + f"; flagged {flagged} of {asked}", flush=True)
    for name, c in counts.items():
        for what, one in ((f"changed by {100 * DRIFTS[name][1]:g} %", c.changed), ("unchanged", c.unchanged), ("unchanged while the other has changed", c.beside)):
            if one.passes:
                print(f"{name} {what}: {one.words()}")
    low, high = coverage.interval(asked, flagged)
    print(f"polarization of the instrument of {100 * o.instrument:g} %, S/N {o.snr:g}, {len(light) // 3} epochs: flagged {flagged} of {asked} passes ({low:.4f} to {high:.4f})")


if __name__ == "__main__":
    main()
