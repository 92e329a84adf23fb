#!/usr/bin/env python3
"""Light between surfaces by chains beside paths, drawn pose by pose to a finer error: do half-widths cover, is any bias left?

    .deps/venv/bin/python bench/between/chains.py [--umov PATH] [--poses N] [--seeds N] [BODY ...]
    .deps/venv/bin/python bench/between/chains.py --rate N [--at A ...] [--bands nm:425,nm:550,nm:650] [--poses N]
        [--surfaces N] [--judge FOLDER] [BODY ...]

For each body, in random attitudes at phase angles from 15 to 150 deg: the part of the poses whose two I, Q, U, V lie
within the half-widths of both, the mean square of the difference over what they say, and the mean difference in its
standard errors, of I as it is and in parts of the pose's own. Chains of one seed err together over poses, so
each seed is a row. Both programs are umov's; tests/data/bounces has the tables of another one. Minutes per body.

With --rate: CPU time of N such poses on one thread, with masks, mended by rays, for the direct light, as `umov signature`
takes them by itself, once what they need is made (chains, the reserve, masks of their directions), and the time of that, for
each accuracy asked of the whole I. The first --poses of them have the error of I and q = Q/I beside it, direct light included, of
those above 1 % of the median I, judged by the mean of four runs by paths and rays.

The judge takes by far the longest. With --judge its runs are kept in FOLDER, a file for each, and taken from there the next
time; one of another scene, mesh or accuracy, or of other poses, is refused.
"""

import argparse
import csv
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

METALS = {"gold": (0.4, 2.4, 0.30), "silicon": (4.0, 0.5, 0.20), "aluminium": (0.96, 6.69, 0.25),
          "smooth": (0.4, 2.4, 0.15),
          # Those of the box-wing of bench/peers at 550 nm, and alike or diffuse ones.
          "bus": (0.359, 2.69, 0.30), "iron": (2.80, 3.22, 0.10), "tank": (1.015, 6.627, 0.15), "dish": (0.13, 3.4, 0.25),
          "alpha_3": (0.359, 2.69, 0.30), "alpha_1": (0.359, 2.69, 0.10),
          "alpha_05": (0.359, 2.69, 0.05), "cells": (4.0, 0.5, 0.15),
          "white_3": (1.5, 0, 0.30, 0.6), "white_4": (1.5, 0, 0.40, 0.8)}


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
       "handrail": "aluminium", "light_shield": "aluminium", "baffle": "aluminium"}
# As in examples/hst_maui.toml.
LIBRARY = {"light_shield": "film_aluminized", "baffle": "paint_black", "forward_shell": "film_aluminized",
           "equipment": "film_silvered", "aft_shroud": "film_silvered", "door": "film_aluminized", "array_front": "cell_silicon",
           "array_back": "mli_kapton", "array_frame": "aluminium_anodized", "antenna": "paint_white",
           "handrail": "paint_white"}
BOX_WING = {"bus": "gold", "panels": "silicon", "dish": "aluminium", "tank": "smooth"}
PARTS = ("bus", "panels", "dish", "tank")


def peers(*metals):
    """The box-wing of bench/peers, of 10,000 facets."""
    return ["box-wing", "--facets", "10000"], dict(zip(PARTS, metals))


BODIES = {"box-wing": (["box-wing", "--facets", "1000"], BOX_WING), "hst": (["hst"], HST),
          "hst-library": (["hst"], LIBRARY), "corner": corner, "bowl": bowl,
          "arrays": arrays, "joints": joints, "peers": peers("bus", "iron", "dish", "tank"),
          "peers-.30": peers(*4 * ["alpha_3"]), "peers-.10": peers(*4 * ["alpha_1"]),
          "peers-.05": peers(*4 * ["alpha_05"]),
          "peers-paint": peers("bus", "cells", "white_4", "white_3")}


def write_body(umov, folder, which, surfaces=5):
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
    text += "".join(f'{group} = "{"m_" if metal in METALS else ""}{metal}"\n' for group, metal in groups.items())
    for metal in sorted(set(groups.values()) & set(METALS)):
        n, k, alpha, *white = METALS[metal]
        text += (f'[material.m_{metal}]\nindex = {{ n = {n}, k = {k} }}\nshadowing = "separable"\n'
                 f'distribution = {{ model = "ggx", alpha = {alpha} }}\n'
                 + (f'body = {{ reflectance = {white[0]} }}\n' if white else ""))
    text += '[bands]\nset = ["nm:550"]\n[render]\nsun = "point"\naccuracy_floor = 0\n'
    text += f"bounces = {surfaces}\n"
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
    write_geometry(folder, "g.csv", np.hstack([sun, np.cos(phase) * sun + np.sin(phase) * np.cross(across, sun)]))


def write_geometry(folder, name, directions):
    with open(os.path.join(folder, name), "w") as file:
        file.write("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n")
        file.writelines(",".join(repr(float(x)) for x in row) + "\n" for row in directions)


def stokes(path):
    """Stokes and half-widths of the middle band, [2, pose, 4]."""
    with open(path) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    bands = list(dict.fromkeys(row["band"] for row in rows))
    rows = [row for row in rows if row["band"] == bands[len(bands) // 2]]
    names = ("intensity", "stokes_q", "stokes_u", "stokes_v")
    return np.array([[[float(row[name + end]) for name in names] for row in rows] for end in ("", "_err")])


def light(umov, folder, between, accuracy, seed):
    """Stokes and half-widths, [2, pose, 4], and seconds."""
    begin = time.perf_counter()
    subprocess.run([umov, "signature", "s.toml", "--geometry", "g.csv", "--visibility", "rays", "--accuracy",
                    str(accuracy), "--set", f"render.between={between}", "--seed", str(seed), "-o", "o.csv", "-q"],
                   cwd=folder, check=True)
    return stokes(os.path.join(folder, "o.csv")), time.perf_counter() - begin


def fingerprint(umov, folder, accuracy, seed):
    """Of what a judge's light follows from: version, scene, mesh, poses, and how it is drawn. Not of what a name in the library of
    materials stands for, nor of a change of paths within a version: remove the folder after either."""
    version = subprocess.run([umov, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    out = {"umov": version, "accuracy": accuracy, "seed": seed}
    for what, name in (("scene", "s.toml"), ("mesh", "body.obj"), ("poses", "g.csv")):
        with open(os.path.join(folder, name), "rb") as file:
            out[what] = hashlib.sha256(file.read()).hexdigest()
    return out


def read_run(path, wanted, poses):
    """Stokes and half-widths, [2, pose, 4]; an error if they are of something else."""
    try:
        with open(path) as file:
            known = json.load(file)
        stale = [what for what in wanted if known["of"][what] != wanted[what]]
        found = np.array(known["light"])
        is_whole = found.shape == (2, poses, 4) and np.isfinite(found).all()
    except (ValueError, KeyError, TypeError) as error:
        sys.exit(f"error: {path}: no run as --judge writes it ({error!r}): remove it, or name another folder")
    if stale or not is_whole:
        sys.exit(f"error: {path}: a run of {'another ' + ', another '.join(stale) if stale else 'fewer poses or no numbers'} than asked: "
                 "remove it, or name another folder")
    return found


def judge_run(umov, folder, options, which, seed):
    """The same; drawn, and kept where --judge says, unless it is there."""
    wanted = fingerprint(umov, folder, options.accuracy[1], seed)
    path = options.judge and os.path.join(
        options.judge, f"{which}-{options.surfaces}-{options.bands.replace(':', '')}-{options.poses}-{seed}.json")
    if path and os.path.exists(path):
        return read_run(path, wanted, options.poses)
    found = light(umov, folder, "paths", options.accuracy[1], seed)[0]
    if path:
        os.makedirs(options.judge, exist_ok=True)
        with open(path + ".part", "w") as file:
            json.dump({"of": wanted, "light": found.tolist()}, file)
        os.replace(path + ".part", path)
    return found


def random_poses(count):
    """Uniform attitudes, phase angles between 15 and 150 deg; the first of many are those of few."""
    rng = np.random.default_rng(6)
    rows = []
    for _ in range(count):
        sun, other = rng.normal(size=(2, 3))
        sun /= np.linalg.norm(sun)
        aside = other - (other @ sun) * sun
        phase = np.radians(rng.uniform(15, 150))
        rows.append([*sun, *(np.cos(phase) * sun + np.sin(phase) * aside / np.linalg.norm(aside))])
    return rows


JUDGE_SEEDS = range(1001, 1005)


def rates(umov, folder, options, which):
    bands = options.bands.split(",")
    with open(os.path.join(folder, "s.toml")) as file:
        text = file.read()
    with open(os.path.join(folder, "s.toml"), "w") as file:
        file.write(text.replace('"nm:550"', ", ".join(f'"{band}"' for band in bands)).replace("accuracy_floor = 0\n", ""))
    poses = random_poses(options.rate)
    few = options.poses = min(options.poses, options.rate)
    write_geometry(folder, "g.csv", poses[:few])
    runs = np.array([judge_run(umov, folder, options, which, seed)[0] for seed in JUDGE_SEEDS])
    judge = runs.mean(axis=0)
    kept = judge[:, 0] > 0.01 * np.median(judge[:, 0])
    poses = np.array(poses)
    own = runs[:, kept, 0].std(axis=0, ddof=1) / 2 / judge[kept, 0]
    print(f"{which}: {kept.sum()} poses; the judge's own error of I median {np.median(own):.1e}, 90 % "
          f"{np.quantile(own, 0.9):.1e}", flush=True)
    package = package_of(umov)
    for accuracy in options.at:
        spent = []
        begin = time.process_time()
        engine = package.Engine(os.path.join(folder, "s.toml"), set={"render.between": "chains"}, accuracy=accuracy, threads=1,
                                cache=False)
        found = engine.evaluate(poses[:few, :3], poses[:few, 3:])[kept, len(bands) // 2]
        for _ in range(2):
            engine.evaluate(poses[:, :3], poses[:, 3:])
            spent.append(time.process_time() - begin)
            begin = time.process_time()
        ready = spent[0] - spent[1] * (1 + few / options.rate)
        i = np.abs(found[:, 0] / judge[kept, 0] - 1)
        q = np.abs(found[:, 1] / found[:, 0] - judge[kept, 1] / judge[kept, 0])
        print(f"{which}, {len(bands)} band{'s' if len(bands) > 1 else ''}, accuracy {accuracy}: {ready:.1f} s for what "
              f"{options.rate} poses prepare, then {options.rate / spent[1]:.0f} poses/s (load {os.getloadavg()[0]:.1f}); error of I "
              f"median {np.median(i):.1e}, 90 % {np.quantile(i, 0.9):.1e}, 95 % {np.quantile(i, 0.95):.1e}; of q "
              f"{np.median(q):.1e}, {np.quantile(q, 0.9):.1e}", flush=True)


def package_of(umov):
    """The package that was built beside the command."""
    sys.path.insert(0, os.path.join(os.path.dirname(umov), "..", "..", "python"))
    import umov as package
    return package


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--umov", default="build/release/apps/cli/umov")
    parser.add_argument("--poses", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--accuracy", type=float, nargs=2, default=[0.002, 0.001], help="of chains, and of the judge")
    parser.add_argument("--rate", type=int, default=0, metavar="N", help="time of N poses")
    parser.add_argument("--at", type=float, nargs="+", default=[0.02, 0.005], help="accuracies asked, for --rate")
    parser.add_argument("--judge", metavar="FOLDER", help="where judges are kept, for --rate")
    parser.add_argument("--surfaces", type=int, default=5)
    parser.add_argument("--bands", default="nm:550", help="for --rate, separated by commas")
    parser.add_argument("body", nargs="*", help=", ".join(BODIES))
    options = parser.parse_args()
    umov = os.path.abspath(options.umov)
    for which in options.body or BODIES:
        if which not in BODIES:
            sys.exit(f"error: no body '{which}': take {', '.join(BODIES)}")
        with tempfile.TemporaryDirectory() as folder:
            write_body(umov, folder, which, options.surfaces)
            if options.rate:
                rates(umov, folder, options, which)
                continue
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
