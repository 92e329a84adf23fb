#!/usr/bin/env python3
"""How much of each material: a box all of whose facets are of one mixture of some of six materials, its attitude known, by `umov invert material`; and whether what is alike is told as one. The pass and box of
case_r.py in one third of its phases, data by rays. Conditions of pairs are numpy's, of I and q as the observer has them.

usage: mixtures.py TRIALS [--snr 100] [--seed 1] [--of 3] [--third 1] [--epochs 40] [--candidates gold,aluminium,cell,paint,silicon,foil] [--twins] [--umov PATH] [--work DIR] [options of umov invert material]
--of: materials in the truth, of random parts (flat on the simplex). --twins: beside each candidate one that is it but for .1 % of its roughness and, of paint, of its reflectance: alike.
Errors are of parts of the light at 550 nm over the pass, then of parts of the area, of which a material without a glint in the pass tells little: total variation, half the sum of the errors of the parts; F1 of
materials of 5 % and more; root mean square over materials; of areas that are there the root mean square of errors over what the answer says they are. What is told as one counts as one."""
import argparse
import itertools
import math
import random
import re
import statistics

import numpy

import blind
import chamfered_box
import known_attitude

PRESENT = 0.05
ALIKE = 200  # the condition from which two must be told as one


def twin(text):
    """The material, hardly changed."""
    out = re.sub(r"m = (\d+)", lambda found: f"m = {1.002 * int(found[1]):g}", text)
    return out.replace("reflectance = 0.8", "reflectance = 0.7992")


def condition(one, other, snr, typical):
    """Of I, Q and U of two curves, weighed by noise of photons and of unit length."""
    columns = []
    for rows in (one, other):
        column = []
        for r, other_row in zip(rows, other):
            sd = blind.photon_sd(other_row["intensity"], typical, snr)
            column += [r["intensity"] / sd, *(r[k] * r["intensity"] / (math.sqrt(2) * sd) for k in "qu")]
        columns.append(numpy.array(column) / numpy.linalg.norm(column))
    return numpy.linalg.cond(numpy.array(columns).T)


def by_light(told, parts, light):
    """Parts of the area, told and true, as parts of the light at 550 nm. What is told as one stands as the mean of its members."""
    given = {name: sum(r["intensity"] for r in rows if r["band"] == "nm:550") for name, rows in light.items()}
    found = [part * statistics.mean(given[n] for n in one) for one, part in told]
    there = [sum(parts.get(n, 0) * given[n] for n in one) for one, _ in told]
    return [x / max(sum(found), 1e-300) for x in found], [x / max(sum(there), 1e-300) for x in there]


def judged(found, there):
    """Total variation, F1 and mean square."""
    off = [a - b for a, b in zip(found, there)]
    both = sum(a > PRESENT and b > PRESENT for a, b in zip(found, there))
    return sum(map(abs, off)) / 2, 2 * both / max(sum(a > PRESENT for a in found) + sum(b > PRESENT for b in there), 1), statistics.mean(x * x for x in off)


def mixed(light, parts):
    """Rows of a mixture: I, Q and U add up."""
    out = []
    for rows in zip(*(light[name] for name in parts)):
        weighed = list(zip(parts.values(), rows))
        total = sum(p * r["intensity"] for p, r in weighed)
        row = {**rows[0], "intensity": total, "I": sum(p * r["I"] for p, r in weighed)}
        for k in "qu":
            row[k] = sum(p * r["intensity"] * r[k] for p, r in weighed) / total if total > 0 else 0
        out.append(row)
    return out


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("trials", type=int)
    parser.add_argument("--snr", type=float, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--of", type=int, default=3)
    parser.add_argument("--third", type=int, choices=(0, 1, 2), default=1)
    parser.add_argument("--epochs", type=int, default=40)
    parser.add_argument("--candidates", default=",".join(chamfered_box.MATERIALS))
    parser.add_argument("--twins", action="store_true")
    blind.add_places(parser)
    o, given = parser.parse_known_args()  # what is not ours goes to umov invert
    o.rest = ["--floor", 0, "--zero-point-sd", 1e-6, *given]
    work = blind.work_folder(o)
    names = o.candidates.split(",")
    more = "".join(f"[material.twin_{name}]\n{twin(text)}" for name, text in chamfered_box.MATERIALS.items())
    groups = [g for g in chamfered_box.names(False) if g != "edge"]
    box = known_attitude.Box(o, work, {"edge": "box_gold"}, more, 3 * o.epochs, same=[(g, "edge") for g in groups])
    known = [f"box_{name}" for name in names] + [f"twin_{name}" for name in names if o.twins]
    rng = random.Random(o.seed)
    errors, pulls, joined, alike, apart = [], [], 0, 0, 0
    for trial in range(o.trials):
        attitude = blind.random_attitude(rng)
        light = {name: box.light(attitude, edge=name)[o.third * o.epochs * 3:(o.third + 1) * o.epochs * 3] for name in known}
        typical = statistics.median(r["intensity"] for rows in light.values() for r in rows)
        cuts = sorted(rng.random() for _ in range(o.of - 1))
        parts = dict(zip(rng.sample([f"box_{n}" for n in names], o.of), (b - a for a, b in zip([0, *cuts], [*cuts, 1]))))
        rows = mixed(light, parts)
        if not any(r["intensity"] > 0 for r in rows):
            continue
        known_attitude.write_observed(rows, typical, o.snr, rng, work / "obs.csv")
        answer = box.asked("material", work / "obs.csv", "--scenario", box.scenario("fit", attitude, "rays"), "--group", "edge", "--candidates", ",".join(known))
        told = [(m["materials"], m["fraction"] or 0) for m in answer["materials"]]
        area = [part for _, part in told], [sum(parts.get(n, 0) for n in one) for one, _ in told]
        of_light, of_area = judged(*by_light(told, parts, light)), judged(*area)
        pulls += [(a - b) / m["fraction_err"] for a, b, m in zip(*area, answer["materials"]) if m["fraction_err"] and b > 0]
        errors.append((of_light, of_area, len(told)))
        for a, b in itertools.combinations(known, 2):
            if condition(light[a], light[b], o.snr, typical) > ALIKE:
                alike += 1
                joined += any(a in one and b in one for one, _ in told)
            else:
                apart += any(a in one and b in one for one, _ in told)
        print(f"{trial}: {answer['verdict']}, " + ", ".join(f"{'|'.join(one)} {part:.3f} ({true:.3f})" for (one, part), true in zip(told, area[1])) + f"; condition {answer['condition']:.3g}", flush=True)
    words = [f"of {name} total variation {statistics.mean(e[k][0] for e in errors):.4f} in the mean, F1 {statistics.mean(e[k][1] for e in errors):.3f}, root mean square error {math.sqrt(statistics.mean(e[k][2] for e in errors)):.4f}"
             for k, name in enumerate(("light", "area"))]
    print(f"{len(errors)} mixtures of {o.of} of {len(known)}, S/N {o.snr:g}, third {o.third}, {o.epochs} epochs, seed {o.seed}: {'; '.join(words)} (pulls {math.sqrt(statistics.mean(x * x for x in pulls)):.2f}); {statistics.mean(e[2] for e in errors):.1f} told apart; "
          f"pairs of a condition over {ALIKE}: {joined} of {alike} told as one; {apart} of the others are, too")


if __name__ == "__main__":
    main()
