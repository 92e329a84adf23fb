#!/usr/bin/env python3
"""Light between surfaces by chains beside paths, drawn pose by pose to a finer error: do half-widths cover, is any bias left?

    .deps/venv/bin/python bench/between/chains.py [--umov PATH] [--poses N] [--seeds N] [BODY ...]

For each body, in random attitudes at phase angles from 15 to 150 deg: the part of the poses whose two I, Q, U, V lie
within the half-widths of both, the mean square of the difference over what they say, and the mean difference in its
standard errors, of I as it is and in parts of the pose's own. Chains of one seed err together over poses, so
each seed is a row. Both programs are umov's; tests/data/bounces has the tables of another one. Minutes per body.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

METALS = {"gold": (0.4, 2.4, 0.30), "silicon": (4.0, 0.5, 0.20), "aluminium": (0.96, 6.69, 0.25),
          "smooth": (0.4, 2.4, 0.15)}


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def box(low, high):
    """Triangles of a box, normals outwards."""
    x, y, z = zip(low, high)
    p = [(x[i & 1], y[i >> 1 & 1], z[i >> 2]) for i in range(8)]
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return [t for f in faces for t in quad(*(p[i] for i in f))]


def corner():
    return {"gold": quad((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
            "aluminium": quad((0, 0, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1)),
            "silicon": quad((0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0))}


def bowl(rings=12, sectors=32):
    """Half a sphere, open above."""
    def at(i, j):
        polar, turn = np.pi / 2 * (1 + i / rings), 2 * np.pi * (j % sectors) / sectors
        return (np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar))
    return {"aluminium": [t for i in range(rings) for j in range(sectors)
                          for t in quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j))
                          if len(set(t)) == 3]}


def arrays():
    """A box between two thin arrays, front and back 2 cm apart, close to its sides."""
    wings = [box((-0.4, s * 0.6 - 0.01, -1.5), (0.4, s * 0.6 + 0.01, 1.5)) for s in (-1, 1)]
    return {"gold": box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), "silicon": wings[0] + wings[1]}


def joints():
    """A box whose lid lies inside a tank, and arms that end in both."""
    return {"gold": box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), "smooth": box((-0.3, -0.3, 0.2), (0.3, 0.3, 1.2)),
            "aluminium": box((0.2, -0.05, -0.05), (1.5, 0.05, 0.05)) + box((0.1, -0.05, 0.8), (1.5, 0.05, 0.9)),
            "silicon": box((1.4, -0.8, -0.5), (1.42, 0.8, 1.2))}


HST = {"array_front": "silicon", "array_back": "gold", "forward_shell": "smooth", "aft_shroud": "gold",
       "antenna": "aluminium", "array_frame": "aluminium", "door": "aluminium", "equipment": "aluminium",
       "handrail": "aluminium", "light_shield": "aluminium"}
BOX_WING = {"bus": "gold", "panels": "silicon", "dish": "aluminium", "tank": "smooth"}
BODIES = {"box-wing": (["box-wing", "--facets", "1000"], BOX_WING), "hst": (["hst"], HST), "corner": corner, "bowl": bowl,
          "arrays": arrays, "joints": joints}


def write_body(umov, folder, which):
    made = BODIES[which]
    path = os.path.join(folder, "body.obj")
    if isinstance(made, tuple):
        words, groups = made
        subprocess.run([umov, "mesh", "make", *words, "-o", path], check=True, stdout=subprocess.DEVNULL)
    else:
        parts, count = made(), 0
        groups = {name: name for name in parts}
        with open(path, "w") as file:
            for name, triangles in parts.items():
                file.write(f"g {name}\n")
                for triangle in triangles:
                    file.writelines("v {:.9g} {:.9g} {:.9g}\n".format(*p) for p in triangle)
                    file.write(f"f {count + 1} {count + 2} {count + 3}\n")
                    count += 3
    text = 'umov = 1\n[[object]]\nmesh = { file = "body.obj", unit = "m", up = "+Z" }\n[object.materials]\n'
    text += "".join(f'{group} = "m_{metal}"\n' for group, metal in groups.items())
    for metal in sorted(set(groups.values())):
        n, k, alpha = METALS[metal]
        text += (f'[material.m_{metal}]\nindex = {{ n = {n}, k = {k} }}\nshadowing = "separable"\n'
                 f'distribution = {{ model = "ggx", alpha = {alpha} }}\n')
    text += '[bands]\nset = ["nm:550"]\n[render]\nsun = "point"\nbounces = 5\naccuracy_floor = 0\n'
    with open(os.path.join(folder, "s.toml"), "w") as file:
        file.write(text)


def write_poses(folder, count):
    rng = np.random.default_rng(5)

    def unit():
        v = rng.normal(size=(count, 3))
        return v / np.linalg.norm(v, axis=1)[:, None]

    sun, other, phase = unit(), unit(), np.radians(rng.uniform(15, 150, count))[:, None]
    across = np.cross(sun, other)
    across /= np.linalg.norm(across, axis=1)[:, None]
    observer = np.cos(phase) * sun + np.sin(phase) * np.cross(across, sun)
    with open(os.path.join(folder, "g.csv"), "w") as file:
        file.write("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n")
        file.writelines(",".join(repr(float(x)) for x in (*a, *b)) + "\n" for a, b in zip(sun, observer))


def light(umov, folder, between, accuracy, seed):
    """Stokes and half-widths, [2, pose, 4], and seconds."""
    begin = time.perf_counter()
    subprocess.run([umov, "signature", "s.toml", "--geometry", "g.csv", "--visibility", "rays", "--accuracy",
                    str(accuracy), "--set", f"render.between={between}", "--seed", str(seed), "-o", "o.csv", "-q"],
                   cwd=folder, check=True)
    with open(os.path.join(folder, "o.csv")) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = ("intensity", "stokes_q", "stokes_u", "stokes_v")
    values = [[[float(row[name + end]) for name in names] for row in rows] for end in ("", "_err")]
    return np.array(values), time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--umov", default="build/release/apps/cli/umov")
    parser.add_argument("--poses", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--accuracy", type=float, nargs=2, default=[0.002, 0.001], help="of chains, and of the judge")
    parser.add_argument("body", nargs="*", help=", ".join(BODIES))
    options = parser.parse_args()
    umov = os.path.abspath(options.umov)
    for which in options.body or BODIES:
        if which not in BODIES:
            sys.exit(f"error: no body '{which}': take {', '.join(BODIES)}")
        with tempfile.TemporaryDirectory() as folder:
            write_body(umov, folder, which)
            write_poses(folder, options.poses)
            judge, spent = light(umov, folder, "paths", options.accuracy[1], 1000)
            lit = judge[0, :, 0] > 0
            print(f"{which}: {lit.sum()} poses lit, judge {spent:.0f} s", flush=True)
            for seed in range(1, options.seeds + 1):
                chains, spent = light(umov, folder, "chains", options.accuracy[0], seed)
                off, sure = (chains[0] - judge[0])[lit], np.hypot(chains[1], judge[1])[lit]
                whole = judge[0, lit, 0]
                parts = off[:, 0] / whole

                def in_errors(x):
                    return x.mean() / (x.std(ddof=1) / np.sqrt(len(x))) if x.std() > 0 else 0.0

                worth = sure > 0  # V of a body that has none
                covered = [np.mean((np.abs(off) <= sure)[worth[:, k], k]) for k in range(4)]
                square = [np.mean((off[worth[:, k], k] / sure[worth[:, k], k] * 1.96) ** 2) for k in range(4)]
                print(f"  seed {seed}, {spent:.0f} s: covered " + " ".join(f"{x:.3f}" for x in covered) + "; mean square "
                      + " ".join(f"{x:.2f}" for x in square) + f"; mean of I {in_errors(off[:, 0]):+.1f}, in parts "
                      f"{in_errors(parts):+.1f} standard errors ({off[:, 0].sum() / whole.sum():+.1e}); error of I median "
                      f"{np.median(np.abs(parts)):.1e}, 90 % {np.quantile(np.abs(parts), 0.9):.1e}", flush=True)


if __name__ == "__main__":
    main()
