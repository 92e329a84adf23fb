#!/usr/bin/env python3
"""umov and Mitsuba's polarized variant with light between surfaces: poses per second at equal error.

    bench/peers/run bounces [--umov PATH] [--poses N] [--facets N] [--surfaces N] [--accuracy A] [--kind K] [--many N] [--alpha A | --paints]

Both light the same box-wing (separable GGX, four metals or, with --paints, a binder of n = 1.5 over bodies of four reflectances;
flat normals) by the Sun, up to N surfaces: in random
geometries, in many of them (as of a library), and in a series, as of a body that turns by half a degree from one sample to the
next. umov shares paths between the poses of a series, and chains between many; Mitsuba treats all alike, so its rate and errors
are those of every eighth pose of a series, and of many the first.
Errors are each program's own, from two runs with different seeds: |a - b|/(sqrt 2 I), so neither is the other's
judge; that both compute the same is said by the median difference. Mitsuba's number of paths is chosen for the
median error of umov, and for its 90th and 95th percentile. Times hold everything but the start: umov's whole command less that
of a run of one pose (which prepares the scene; of many, of a run of the first, which draws the chains), Mitsuba's kernel after it was
compiled.
"""

import argparse
import os
import sys
import tempfile
import time

import numpy as np

from compare import (MATERIALS, WAVELENGTHS, index_values, machine, random_geometries, rays_for, read_groups, umov,
                     umov_stokes, write_geometry, write_scenario)

PAINTS = {"bus": (1.5, 0.30, 0.8), "panels": (1.5, 0.10, 0.05), "tank": (1.5, 0.15, 0.5), "dish": (1.5, 0.25, 0.8)}
QUANTILES = {"median": 0.5, "90 %": 0.9, "95 %": 0.95}


def two_run_errors(a, b):
    """QUANTILES of the error of I of one run, of poses above 1 % of the median light."""
    mean = (a[:, 0, 0] + b[:, 0, 0]) / 2
    lit = mean > 0.01 * np.median(mean[mean > 0])
    error = np.abs(a[lit, 0, 0] - b[lit, 0, 0]) / mean[lit] / np.sqrt(2)
    return [float(np.quantile(error, part)) for part in QUANTILES.values()]


def series_geometries(count, step_deg=0.5):
    """Sun and observer in the frame of a body that turns about an axis, while the phase angle goes from 20 to 100 deg
    and back."""
    turn = np.radians(step_deg) * np.arange(count)
    phase = np.radians(60 + 40 * np.sin(0.3 * turn))
    axis = np.array([0.3, 0.5, 0.8]) / np.sqrt(0.98)
    sun = np.array([1.0, 0.2, -0.3]) / np.sqrt(1.13)
    across = np.cross(sun, [0, 0, 1.0])
    across /= np.linalg.norm(across)
    observer = np.cos(phase)[:, None] * sun + np.sin(phase)[:, None] * across

    def turned(v):
        c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
        return v * c + np.cross(axis, v) * s + axis * (np.sum(v * axis, -1, keepdims=True) * (1 - c))

    return turned(np.broadcast_to(sun, observer.shape)), turned(observer)


def run_umov(options, folder, kind, sun, observer):
    """Stokes of two runs with different seeds, poses per second, and the time to start."""
    # What is lit to know errors, what the rate is of, and what tells the time before the first pose.
    geometry, timed, first = (os.path.join(folder, f"{name}.csv") for name in ("geometry", "timed", "first"))
    write_geometry(geometry, sun, observer)
    write_geometry(first, sun[:1], observer[:1])
    more, count, before = ["--accuracy", options.accuracy[kind == "series"]], len(sun), 1
    if kind == "many":
        more += ["--visibility", "auto", "--set", "render.between=chains"]
        write_geometry(timed, *random_geometries(options.many, 3))
        count, before, first = options.many, len(sun), geometry
    else:
        more += ["--visibility", "masks"]
        timed = geometry
    scenario = write_scenario(folder, 1, options.lobes)
    with open(scenario, "a") as file:
        file.write(f'[render]\nbounces = {options.surfaces}\nsun = "point"\n')

    def run(poses, seed=None):
        begin = time.perf_counter()
        found = umov_stokes(options.umov, scenario, poses, folder, *more, *(["--seed", seed] if seed else []))
        return found, time.perf_counter() - begin

    runs, spent = zip(*(run(geometry, seed) for seed in (1, 2)))
    if kind == "many":
        spent = [run(timed)[1]]
    start = min(run(first)[1] for _ in range(1 if kind == "many" else 3))
    return runs, (count - before) / (min(spent) - start), start


def compare(options, folder, scene, setup, kind):
    count = options.poses[kind == "series"]
    sun, observer = series_geometries(count) if kind == "series" else random_geometries(count, 1)
    runs, rate, start = run_umov(options, folder, kind, sun, observer)
    wanted = two_run_errors(*runs)
    some = slice(0, None, 8 if kind == "series" else 1)
    sun, observer = sun[some], observer[some]

    def many(samples, seed):
        """In blocks of poses that fit into memory."""
        block = max(1, (1 << 22) // samples)
        return np.concatenate([scene.evaluate_paths(sun[k:k + block], observer[k:k + block], samples,
                                                    options.surfaces, seed + k)
                               for k in range(0, len(sun), block)])

    curve = []
    for k in range(10, 21):
        curve.append((1 << k, two_run_errors(many(1 << k, 1000), many(1 << k, 5000))))
        print(f"  {1 << k:7} paths: {' '.join(f'{one:.1e}' for one in curve[-1][1])}", file=sys.stderr)
        if all(found < one for found, one in zip(curve[-1][1], wanted)):
            break
    print(f"{kind}:")
    told = ", ".join(f"{name} {one:.1e}" for name, one in zip(QUANTILES, wanted))
    print(f"umov     {rate:9.1f} poses/s, error of I {told}; start {start:.2f} s")
    for which, name in enumerate(QUANTILES):
        samples = rays_for(curve, which, wanted[which])
        is_equal = curve[-1][1][which] <= wanted[which]
        many(samples, 1)
        times = []
        for repeat in range(3):
            begin = time.perf_counter()
            found = many(samples, 10_000 * (repeat + 1))
            times.append(time.perf_counter() - begin)
        theirs = len(sun) / min(times)
        difference = np.median(found[:, 0, 0] / runs[0][some, 0, 0] - 1)
        print(f"mitsuba  {theirs:9.1f} poses/s at {'equal' if is_equal else 'no better'} {name} ({samples} paths), "
              f"set-up {setup:.1f} s: ratio {'' if is_equal else 'above '}{rate / theirs:.1f}; "
              f"median difference of I {difference:+.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--umov", default="build/release/apps/cli/umov")
    parser.add_argument("--facets", type=int, default=10_000)
    parser.add_argument("--poses", type=int, nargs=2, default=[60, 512], help="random ones, and those of the series")
    parser.add_argument("--many", type=int, default=4000)
    parser.add_argument("--surfaces", type=int, default=5)
    parser.add_argument("--accuracy", type=float, nargs=2, default=[0.005, 0.02], help="of both, as umov is asked")
    parser.add_argument("--kind", choices=["random", "many", "series", "all"], default="all")
    surfaces = parser.add_mutually_exclusive_group()
    surfaces.add_argument("--alpha", type=float, help="of all lobes, instead of their own")
    surfaces.add_argument("--paints", action="store_true", help="instead of metals")
    options = parser.parse_args()
    options.lobes = PAINTS if options.paints else {group: (index, options.alpha or alpha) for group, (index, alpha) in MATERIALS.items()}
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "box-wing.obj")
        umov(options.umov, "mesh", "make", "box-wing", "--facets", options.facets, "-o", mesh)
        materials = {}
        for group, (index, alpha, *body) in options.lobes.items():
            if body:
                materials[group] = {"alpha": alpha, "n": index, "body": body[0]}
                continue
            n, k = index_values(options.umov, index, WAVELENGTHS[1])
            materials[group] = {"alpha": alpha, "n": n, "k": k}

        from mitsuba_light import MitsubaScene
        begin = time.perf_counter()
        scene = MitsubaScene(read_groups(mesh), materials, WAVELENGTHS[1])
        scene.evaluate_paths(*random_geometries(8, 2), 64, options.surfaces)
        setup = time.perf_counter() - begin
        print(f"# {machine()}, {os.cpu_count()} cores, load {load:.2f} at the start; {options.facets} triangles, "
              f"separable GGX, up to {options.surfaces} surfaces, phase angles 15-150 deg")
        for kind in ("random", "many", "series"):
            if options.kind in (kind, "all"):
                compare(options, folder, scene, setup, kind)


if __name__ == "__main__":
    main()
