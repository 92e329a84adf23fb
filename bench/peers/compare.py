#!/usr/bin/env python3
"""umov and Mitsuba's polarized variant on one mesh and machine: poses per second at equal error.

    bench/peers/run [--umov PATH] [--poses N] [--facets N] [-o FILE.csv]

Both light the same box-wing (separable GGX, four metals, flat normals) directly by the Sun. Errors are
against umov's ray reference (3e-4), over the same random geometries; that Mitsuba computes the same shows
in its errors falling with the number of rays. That number is then chosen twice: so that the 95th
percentile of its error of I is that of umov's masks, and the median. umov's time has the file written (FITS); its preparation and
Mitsuba's (kernel compilation, acceleration structure) stand beside.
"""

import argparse
import csv
import json
import os
import platform
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

MATERIALS = {"bus": ("Au_Johnson", 0.30), "panels": ("Fe_Johnson", 0.10),
             "tank": ("Al_Rakic", 0.15), "dish": ("Ag_Johnson", 0.25)}
WAVELENGTHS = {1: [550], 3: [450, 550, 650]}
PHASES = "30,60,90,120"


def umov(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"umov {arguments[0]} failed: {done.stderr.strip()}")
    return done


def read_groups(path):
    """{usemtl name: (vertices, triangles)} of an OBJ file of triangles, as umov writes them."""
    vertices, faces, group = [], {}, None
    for line in open(path):
        word = line.split()
        if not word:
            continue
        if word[0] == "v":
            vertices.append([float(x) for x in word[1:4]])
        elif word[0] == "usemtl":
            group = faces.setdefault(word[1], [])
        elif word[0] == "f":
            group.append([int(corner.split("/")[0]) - 1 for corner in word[1:4]])
    vertices = np.array(vertices)
    return {name: (vertices, np.array(list_)) for name, list_ in faces.items()}


def write_scenario(folder, bands, of=MATERIALS):
    lines = ["umov = 1", "[[object]]", 'name = "box-wing"',
             'mesh = { file = "box-wing.obj", unit = "m", up = "+Z" }', "[object.materials]"]
    lines += [f'{group} = "peer_{group}"' for group in MATERIALS]
    for group, (index, alpha, *body) in of.items():
        known = f"{{ n = {index}, k = 0 }}" if body else f'"{index}"'
        lines += [f"[material.peer_{group}]", f"index = {known}",
                  f'distribution = {{ model = "ggx", alpha = {alpha} }}', 'shadowing = "separable"']
        lines += [f"body = {{ reflectance = {reflectance}, polarized = true }}" for reflectance in body]
    names = ", ".join(f'"nm:{w}"' for w in WAVELENGTHS[bands])
    lines += ["[bands]", f"set = [{names}]"]
    path = os.path.join(folder, f"box-wing-{bands}.toml")
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")
    return path


def index_values(program, name, wavelengths):
    done = umov(program, "material", "index", name, "--wavelength", ",".join(map(str, wavelengths)),
                "--json")
    rows = json.loads(done.stdout)
    return [row["n"] for row in rows], [row["k"] for row in rows]


def random_geometries(count, seed):
    """Uniform attitudes, phase angles even between 15 and 150 deg."""
    rng = np.random.default_rng(seed)
    unit = lambda v: v / np.linalg.norm(v, axis=1, keepdims=True)
    sun = unit(rng.normal(size=(count, 3)))
    aside = rng.normal(size=(count, 3))
    aside = unit(aside - (aside * sun).sum(1, keepdims=True) * sun)
    phase = np.deg2rad(15 + 135 * (np.arange(count) + 0.5) / count)[:, None]
    return sun, np.cos(phase) * sun + np.sin(phase) * aside


def write_geometry(path, sun, observer):
    with open(path, "w") as file:
        file.write("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n")
        for row in np.hstack([sun, observer]):
            file.write(",".join(f"{x:.17g}" for x in row) + "\n")


def umov_stokes(program, scenario, geometry, folder, *more):
    """[pose, band, IQ]"""
    out = os.path.join(folder, "stokes.json")
    umov(program, "signature", scenario, "--geometry", geometry, "-o", out, "-q", *more)
    rows = json.load(open(out))
    bands = len({row["band"] for row in rows})
    return np.array([[row["intensity"], row["stokes_q"]] for row in rows], float).reshape(-1, bands, 2)


def errors(found, reference):
    """Median and 95th percentile of |dI|/I, 95th percentile of |d(Q/I)|, of poses above 1 % of the
    median light, in the middle band."""
    band = reference.shape[1] // 2
    i, i_ref = found[:, band, 0], reference[:, band, 0]
    lit = i_ref > 0.01 * np.median(i_ref[i_ref > 0])
    di = np.abs(i[lit] / i_ref[lit] - 1)
    dq = np.abs(found[lit, band, 1] / np.where(i[lit] > 0, i[lit], np.inf)
                - reference[lit, band, 1] / i_ref[lit])
    return float(np.median(di)), float(np.quantile(di, 0.95)), float(np.quantile(dq, 0.95))


def time_umov(program, scenario, poses, folder):
    """Seconds per pose with the file written, set-up seconds, bytes of masks, set apart by the log."""
    out = os.path.join(folder, "poses.fits")
    phases = len(PHASES.split(","))
    best = None
    for _ in range(3):
        begin = time.perf_counter()
        done = umov(program, "signature", scenario, "--poses", poses // phases, "--phase", PHASES,
                    "--visibility", "masks", "-o", out)
        spent = time.perf_counter() - begin
        log = re.search(r"([\d.]+) MB of masks, ([\d.]+) s", done.stderr)
        megabytes, setup = float(log.group(1)), float(log.group(2))
        rate = poses / (spent - setup)
        if best is None or rate > best[0]:
            best = (rate, setup, megabytes)
    return best


def rays_for(curve, kind, wanted):
    """Rays per pose at which an error (0: median of I, 1: 95 % of I) is `wanted`, between powers of
    two; the last that was tried if none is as good."""
    for (a, before), (b, after) in zip(curve, curve[1:]):
        if after[kind] <= wanted < before[kind]:
            share = np.log(before[kind] / wanted) / np.log(before[kind] / after[kind])
            return int(round(a * (b / a) ** share))
    return curve[0][0] if curve[0][1][kind] <= wanted else curve[-1][0]


def time_mitsuba(scene, samples):
    """Poses per second, kernel cached, best of five."""
    count = max(16, min(20_000, (1 << 24) // samples))
    sun, observer = random_geometries(count, 5)
    scene.evaluate(sun, observer, samples)
    best = 0.0
    for repeat in range(5):
        begin = time.perf_counter()
        scene.evaluate(sun, observer, samples, seed=repeat)
        best = max(best, count / (time.perf_counter() - begin))
    return best


def peer(bands, job):
    """Run in a process of its own: a variant of Mitsuba is chosen once."""
    from mitsuba_light import MitsubaScene

    begin = time.perf_counter()
    scene = MitsubaScene(job["groups"], job["materials"], WAVELENGTHS[bands])
    sun, observer, reference = job["sun"], job["observer"], job["reference"]
    scene.evaluate(sun[:16], observer[:16], 64)
    setup = time.perf_counter() - begin
    curve = [(n, errors(scene.evaluate(sun, observer, n)[:, :, :2], reference))
             for n in (1 << k for k in range(6, 19))]
    for n, (median, p95, q95) in curve:
        print(f"  {n:7} rays: {median:.1e} {p95:.1e} {q95:.1e}", file=sys.stderr)
    out = []
    for name, kind in (("95 %", 1), ("median", 0)):
        samples = rays_for(curve, kind, job["wanted"][kind])
        at = errors(scene.evaluate(sun, observer, samples)[:, :, :2], reference)
        out.append({"equal": name, "setup": setup, "samples": samples, "errors": at,
                    "rate": time_mitsuba(scene, samples),
                    "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3})
    return out


def machine():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--umov", default="build/release/apps/cli/umov")
    parser.add_argument("--facets", type=int, default=10_000)
    parser.add_argument("--poses", type=int, default=1_000_000, help="for umov's rate")
    parser.add_argument("--geometries", type=int, default=200, help="for the errors")
    parser.add_argument("-o", "--output", help="CSV")
    options = parser.parse_args()
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    rows = []
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "box-wing.obj")
        umov(options.umov, "mesh", "make", "box-wing", "--facets", options.facets, "-o", mesh)
        groups = read_groups(mesh)
        sun, observer = random_geometries(options.geometries, 1)
        geometry = os.path.join(folder, "geometry.csv")
        write_geometry(geometry, sun, observer)
        for bands in (1, 3):
            scenario = write_scenario(folder, bands)
            materials = {}
            for group, (index, alpha) in MATERIALS.items():
                n, k = index_values(options.umov, index, WAVELENGTHS[bands])
                materials[group] = {"alpha": alpha, "n": n, "k": k}
            reference = umov_stokes(options.umov, scenario, geometry, folder, "--visibility", "rays",
                                    "--accuracy", 3e-4)
            masks = umov_stokes(options.umov, scenario, geometry, folder, "--visibility", "masks")
            own = errors(masks, reference)
            rate, setup, megabytes = time_umov(options.umov, scenario, options.poses, folder)
            job = {"groups": groups, "materials": materials, "sun": sun, "observer": observer,
                   "reference": reference, "wanted": own}
            with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
                others = pool.submit(peer, bands, job).result()
            rows.append({"program": "umov", "bands": bands, "equal": "", "poses_per_s": rate,
                         "ratio": 1, "i_err_median": own[0], "i_err_p95": own[1],
                         "q_err_p95": own[2], "rays": "", "setup_s": setup, "memory_mb": megabytes})
            for other in others:
                rows.append({"program": "mitsuba", "bands": bands, "equal": other["equal"],
                             "poses_per_s": other["rate"], "ratio": rate / other["rate"],
                             "i_err_median": other["errors"][0], "i_err_p95": other["errors"][1],
                             "q_err_p95": other["errors"][2], "rays": other["samples"],
                             "setup_s": other["setup"], "memory_mb": other["megabytes"]})
    print(f"# {machine()}, {os.cpu_count()} cores, load {load:.2f} at the start; {options.facets} triangles, "
          f"separable GGX, {options.geometries} geometries for errors, phase 15-150 deg")
    print(f"{'program':9}{'bands':>6}{'equal':>8}{'poses/s':>11}{'ratio':>8}{'I median':>10}{'I 95 %':>9}{'Q/I 95 %':>10}"
          f"{'rays':>8}{'setup s':>9}{'MB':>7}")
    for r in rows:
        print(f"{r['program']:9}{r['bands']:6}{r['equal']:>8}{r['poses_per_s']:11.0f}{r['ratio']:8.0f}"
              f"{r['i_err_median']:10.1e}{r['i_err_p95']:9.1e}{r['q_err_p95']:10.1e}{r['rays']:>8}"
              f"{r['setup_s']:9.1f}{r['memory_mb']:7.0f}")
    if options.output:
        with open(options.output, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
