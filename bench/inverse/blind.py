#!/usr/bin/env python3
"""Blind recovery of attitudes and spins: truth by rays on a finer tessellation, noise of photons, `umov invert pose` or `spin` on
the coarser mesh. Prints one line per curve and the summary.

usage: blind.py OBJECT TRIALS [--snr 20] [--seed 1] [--spin PERIOD_S [--about x|y|z] [--period-open]] [--wrong 1] [--only TRIAL] [--umov PATH] [options of umov invert]
       bench/peers/run inverse metals TRIALS --truth mitsuba [--surfaces 3] ...
OBJECT: agena, hst, box-wing, cubesat, metals (a box-wing of four rough metals), box or grey-box (chamfered_box.py). --truth mitsuba: the data's light is another program's
(mitsuba_truth.py); before the answers stands how far it is from umov's rays. --surfaces 3: light between surfaces in the data, not in the fit. --spin: the body turns about a random axis; the search is told its period to 1 %.
--wrong 1: the true object is another one than the one that is fitted: slopes of each material's lobe are 20 % off (normal, ln), reflectances of
paints 10 %, haze 30 %, lengths along each axis of the mesh 2.5 % (areas 3.5 %; of boxes slopes 10 %, the area of each facet 5 %, each component of its normal .5 deg); other numbers are parts or multiples of that."""
import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import tempfile
import time
import tomllib

import chamfered_box

ROOT = pathlib.Path(__file__).resolve().parents[2]
MATERIALS = {
    "hst": dict(light_shield="film_aluminized", baffle="paint_black", forward_shell="film_aluminized", equipment="film_silvered",
                aft_shroud="film_silvered", door="film_aluminized", array_front="cell_silicon", array_back="mli_kapton",
                array_frame="aluminium_anodized", antenna="paint_white", handrail="paint_white"),
    "agena": dict(nozzle_titanium="titanium", rack_aluminium="aluminium", tank_aluminium="aluminium",
                  paint_white="paint_white", paint_black="paint_black", cap_gold_kapton="mli_kapton"),
    "box-wing": dict(bus="mli_kapton", panels="cell_silicon", tank="titanium", dish="paint_white"),
    "cubesat": dict(body_px="aluminium_anodized", body_mx="cell_gaas", body_py="cell_gaas", body_my="paint_white",
                    body_pz="mli_kapton", body_mz="aluminium_anodized", panel_px_front="cell_gaas",
                    panel_px_back="paint_black", panel_px_edge="aluminium_anodized"),
    "metals": dict(bus="peer_bus", panels="peer_panels", tank="peer_tank", dish="peer_dish"),
    "box": chamfered_box.names(False),
    "grey-box": chamfered_box.names(True),
}
BOXES = ("box", "grey-box")  # no shapes of umov mesh make
MESH = {  # fitted, true
    "hst": (["hst", "--sides", 36], ["hst", "--sides", 60]),
    "agena": (["agena", "--sides", 36], ["agena", "--sides", 60]),
    "box-wing": (["box-wing", "--facets", 600], ["box-wing", "--facets", 1500]),
    "cubesat": (["cubesat", "--panels", 1], ["cubesat", "--panels", 1]),
    "metals": (["box-wing", "--facets", 2000], ["box-wing", "--facets", 10000]),
    **{name: (None, None) for name in BOXES},
}
SPAN = ("2018-01-21T05:08:00Z", "2018-01-21T05:16:00Z")  # of a pass
SCENARIO = """umov = 1
title = "blind"
seed = {seed}
[observer]
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = {span[0]}
stop = {span[1]}
step_s = {step}
only = {{ alt_min_deg = 10, sunlit = true }}
[[object]]
name = "{name}"
orbit = {{ file = "{root}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "{mesh}", unit = "m", up = "+Z", normals = "smooth" }}
attitude = {{ {law} }}
[object.materials]
{materials}
[bands]
set = "paper_rgb"
[render]
method = "{method}"
[output]
dir = "{out}"
formats = ["csv"]
"""


def add_places(parser):
    """Options of all programs here: the umov that is asked, and where its files go."""
    parser.add_argument("--umov", default=ROOT / "build/release/apps/cli/umov")
    parser.add_argument("--work", type=pathlib.Path)


def work_folder(o):
    """--work, or a new one."""
    work = o.work or pathlib.Path(tempfile.mkdtemp())
    work.mkdir(parents=True, exist_ok=True)
    return work


class NoResult(SystemExit):
    """umov's answer to what nothing can be seen of, as a span without a sunlit pass."""


def run(umov, *words, ok=(0,)):
    done = subprocess.run([umov, *map(str, words)], capture_output=True, text=True)
    if done.returncode not in ok:
        raise (NoResult if done.returncode == 5 else SystemExit)(f"{words}: {done.returncode}\n{done.stderr[-2000:]}")
    return done.stdout


def make_mesh(umov, words, path):
    if words:
        run(umov, "mesh", "make", *words, "-o", path, "-q")
    else:
        chamfered_box.write_mesh(path)


def rows_of(path):
    import csv
    lines = [line for line in pathlib.Path(path).read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def photon_sd(true, typical, snr):
    """Noise of photons and of the sky: S/N is that of an I of `typical`."""
    return math.sqrt((0.8 * true * typical + 0.2 * typical**2) / snr**2)


def observed(rows, snr, rng, path):
    """A table as an observer has it: SNR is that of I at its median; Q and U have sqrt(2) of its error."""
    median = {}
    for band in {r["band"] for r in rows}:
        median[band] = statistics.median(float(r["intensity"]) for r in rows if r["band"] == band)
    out = ["# pol_frame: equatorial", "time_utc,band,flux,flux_err,q,u,q_err,u_err"]
    for r in rows:
        true, m = float(r["intensity"]), median[r["band"]]
        if not m > 0:
            continue
        sd = photon_sd(true, m, snr)
        scale = 3.1 * float(r["I"]) / true if true > 0 else None
        if scale is None:
            continue
        seen = true + sd * rng.gauss(0, 1)
        flux = f"{scale * seen:.6e},{scale * sd:.6e}"
        if seen > 3 * sd and r["q"]:
            e = math.sqrt(2) * sd / seen
            out.append(f"{r['time_utc']},{r['band']},{flux},{float(r['q']) + e * rng.gauss(0, 1):.6f},"
                       f"{float(r['u']) + e * rng.gauss(0, 1):.6f},{e:.6f},{e:.6f}")
        else:
            out.append(f"{r['time_utc']},{r['band']},{flux},,,,")
    path.write_text("\n".join(out) + "\n")


def random_attitude(rng):
    q = [rng.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(x * x for x in q))
    return [x / n for x in q]


def product(a, b):
    return [a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]]


def apart(a, b):
    """Angle between two attitudes [deg]."""
    return math.degrees(2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b))))))


def twins(truth, names):
    """The truth and what the body's own turns make of it."""
    out = [truth]
    for text in names:
        axis = "XYZ".index(text[-1])
        if text.startswith("any"):
            turns = [math.radians(a) for a in range(2, 360, 2)]
        else:
            word = text.split(" turn")[0]
            turns = [math.pi] if word == "half" else [2 * math.pi * int(word.split()[0]) / (4 if "quarter" in word else 3)]
        for angle in turns:
            step = [math.cos(angle / 2), 0, 0, 0]
            step[1 + axis] = math.sin(angle / 2)
            out.append(product(truth, step))
    return out


def axis_of(q):
    """Body +Z among the stars: v_body = conj(q) v q, so its components are a row of that matrix."""
    w, x, y, z = q
    return [2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z]


def axis_apart(a, b):
    return math.degrees(math.acos(max(-1.0, min(1.0, sum(x * y for x, y in zip(axis_of(a), axis_of(b)))))))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("object", choices=MESH)
    parser.add_argument("trials", type=int)
    parser.add_argument("--snr", type=float, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--spin", type=float)
    parser.add_argument("--about", choices="xyz", help="with --spin: the body axis that it turns about, told to the search")
    parser.add_argument("--period-open", action="store_true", help="with --spin: the period is not told")
    parser.add_argument("--wrong", type=float, default=0)
    parser.add_argument("--only", type=int, help="of the trials, this one alone (the others' curves are made, for the same noise)")
    parser.add_argument("--truth", choices=["rays", "mitsuba"], default="rays")
    parser.add_argument("--surfaces", type=int, default=1, help="that the light of the truth touches at most; of the fit: --set render.bounces=N")
    add_places(parser)
    o, o.rest = parser.parse_known_args()  # what is not ours goes to umov invert
    work = work_folder(o)
    meshes = [work / f"{o.object}_{k}.obj" for k in ("fit", "true")]
    for mesh, words in zip(meshes, MESH[o.object]):
        if not mesh.exists():
            make_mesh(o.umov, words, mesh)
    if o.truth == "mitsuba" and (o.object != "metals" or o.wrong):
        parser.error("--truth mitsuba knows the object metals, and no --wrong")
    o.truth = by_mitsuba(o.umov, meshes[1], o.surfaces) if o.truth == "mitsuba" else None
    if o.spin:
        return spins(o, work, meshes)
    poses(o, work, meshes)


def inertial(q):
    return f'mode = "inertial", quaternion = [{q[0]}, {q[1]}, {q[2]}, {q[3]}]'


def in_toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {in_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(in_toml, value)) + "]"
    return json.dumps(value)


def other_material(name, much, rng):
    """A material of the library or of the boxes, a little off, as a table of a scenario."""
    if name in chamfered_box.MATERIAL_OF:
        table, slope_sd = tomllib.loads(chamfered_box.MATERIAL_OF[name]), 0.1
    else:
        table, slope_sd = tomllib.loads((ROOT / f"data/materials/{name}.toml").read_text())["material"][name], 0.2
    slope = math.exp(slope_sd * much * rng.gauss(0, 1))
    for key, power in (("alpha", 1), ("m", -2), ("nu", -2), ("nv", -2)):
        if key in table.get("distribution", {}):
            table["distribution"][key] *= slope**power
    if "reflectance" in table.get("body", {}):
        table["body"]["reflectance"] = min(0.95, table["body"]["reflectance"] * math.exp(0.1 * much * rng.gauss(0, 1)))
    haze = table.get("haze", {})
    for key in ("share", "albedo"):
        if key in haze:
            haze[key] *= math.exp(0.3 * much * rng.gauss(0, 1))
    haze.pop("range", None)
    return f"[material.true_{name}]\n" + "\n".join(f"{k} = {in_toml(v)}" for k, v in table.items()) + "\n"


def with_other_materials(scenario, names, much, rng):
    """A scenario whose materials of these names are a little off, each the same wherever it is."""
    for name in names:
        scenario = scenario.replace(f'"{name}"', f'"true_{name}"')
    return scenario + "".join(other_material(name, much, rng) for name in sorted(names))


def other_object(o, trial, scenario, mesh, path):
    """The scenario with materials and a mesh that are a little off."""
    rng = random.Random(f"{o.seed} wrong {trial}")
    if o.object in BOXES:
        chamfered_box.write_other_mesh(mesh, path, 0.05 * o.wrong, math.radians(0.5) * o.wrong, rng)
    else:
        factor = [math.exp(0.025 * o.wrong * rng.gauss(0, 1)) for _ in range(3)]
        lines = mesh.read_text().splitlines()
        for k, line in enumerate(lines):
            if line.startswith("v "):
                lines[k] = "v " + " ".join(f"{float(x) * f:.9g}" for x, f in zip(line.split()[1:], factor))
        path.write_text("\n".join(lines) + "\n")
    return with_other_materials(scenario.replace(str(mesh), str(path)), set(MATERIALS[o.object].values()), o.wrong, rng)


def metals_in_toml():
    from mitsuba_truth import materials_in_toml

    return materials_in_toml()


def by_mitsuba(program, mesh, surfaces):
    from mitsuba_truth import Truth

    return Truth(program, mesh, [425, 550, 650], surfaces)


def make_curve(o, work, meshes, trial, law, step, rng, span=SPAN, scenario=SCENARIO):
    """Scenarios of truth and fit, and what an observer has of the truth; returns its rows."""
    materials = "\n".join(f'{k} = "{v}"' for k, v in MATERIALS[o.object].items())
    for mesh, method, out, attitude, name in ((meshes[1], "rays", "truth", law, "true.toml"),
                                              (meshes[0], "masks", "fit", inertial([1, 0, 0, 0]), "fit.toml")):
        text = scenario.format(seed=o.seed + trial, name=o.object, root=ROOT, mesh=mesh, law=attitude, step=step, materials=materials,
                               method=method, out=work / out, span=span)
        if o.surfaces > 1 and out == "truth" and not o.truth:
            text = text.replace(f'method = "{method}"', f'method = "{method}"\nbounces = {o.surfaces}')
        if o.object == "metals":
            text += metals_in_toml()
        if o.object in BOXES:
            text = text.replace('normals = "smooth"', 'normals = "flat"') + chamfered_box.materials_in_toml()
        if o.wrong and out == "truth":
            text = other_object(o, trial, text, mesh, work / "wrong.obj")
        (work / name).write_text(text)
    run(o.umov, "run", work / "true.toml", "-o", work / "truth", "--force", "-q")
    rows = rows_of(work / "truth/lightcurve.csv")
    if o.truth:
        relit = o.truth.relit(rows)
        print("Mitsuba less rays: median {:.1e} of I, {:.1e} in q".format(*o.truth.difference(rows, relit)), flush=True)
        rows = relit
    observed(rows, o.snr, rng, work / "obs.csv")
    return rows


def asked(o, work, question, *words):
    began = time.time()
    verdict = json.loads(run(o.umov, "invert", question, work / "obs.csv", "--scenario", work / "fit.toml", "-o", work / "answer",
                             "--force", "--json", *words, *o.rest, ok=(0, 4)))
    return verdict, time.time() - began


def table_rows(path):
    lines = [line.split() for line in path.read_text().splitlines() if line and not line.startswith("#")]
    return [dict(zip(lines[0], line)) for line in lines[1:]]


def in_set(path, attitudes):
    """One of some attitudes that are alike lies in the balls of a set95.ecsv."""
    balls = [[float(row[k]) for k in ("qw", "qx", "qy", "qz", "radius_deg")] for row in table_rows(path)]
    return any(apart(q, b[:4]) <= b[4] for q in attitudes for b in balls)


def spin_axis(q, rate):
    """A vector of the body among the stars: q v conj(q)."""
    w, x, y, z = q
    v = product(product(q, [0, *rate]), [w, -x, -y, -z])[1:]
    n = math.sqrt(sum(c * c for c in v))
    return [c / n for c in v]


def turned(q, rate_deg_s, seconds):
    """An attitude after a constant turn in body axes."""
    n = math.sqrt(sum(c * c for c in rate_deg_s))
    if n == 0:
        return q
    half = math.radians(n * seconds) / 2
    return product(q, [math.cos(half), *(math.sin(half) * c / n for c in rate_deg_s)])


def seconds_of(clock):
    hours, minutes, seconds = clock.rstrip("Z").split("T")[1].split(":")
    return 3600 * int(hours) + 60 * int(minutes) + float(seconds)


def spins(o, work, meshes):
    rng = random.Random(o.seed)
    results = []
    for trial in range(o.trials):
        q, axis = random_attitude(rng), random_attitude(rng)[:3]
        if o.about:
            axis = [float(a == o.about) for a in "xyz"]
        n = math.sqrt(sum(c * c for c in axis))
        rate = [360 / o.spin * c / n for c in axis]
        law = f'mode = "tumble", inertia = [1, 1, 1], rate_deg_s = {rate}, start = {{ {inertial(q)} }}'
        rows = make_curve(o, work, meshes, trial, law, o.spin / 10, rng)
        told = o.spin * (1 + rng.uniform(-0.01, 0.01))
        if o.only not in (None, trial):
            continue
        words = [] if o.period_open else ["--period", told]
        verdict, seconds = asked(o, work, "spin", *words, *(["--axis", o.about] if o.about else []))
        mode, periods = table_rows(work / "answer/modes.ecsv")[0], [float(row["period_s"]) for row in table_rows(work / "answer/periods.ecsv")]
        first = [float(mode[k]) for k in ("qw", "qx", "qy", "qz")]
        found = spin_axis(first, [float(mode[k]) for k in ("rate_x", "rate_y", "rate_z")])
        off = math.degrees(math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(found, spin_axis(q, rate)))))))
        relative = periods[0] / o.spin - 1
        true = turned(q, rate, seconds_of(rows[0]["time_utc"]) - seconds_of(SPAN[0]))
        attitude = min(apart(t, first) for t in twins(true, verdict["symmetries"]))
        is_listed = any(abs(p / o.spin - 1) < 0.01 for p in periods)
        results.append((off, abs(relative), off < 2 and abs(relative) < 0.01, seconds, attitude, verdict["verdict"] == "determined", is_listed))
        print(f"{o.object} spin {trial}: axis off {off:.3f} deg, period {relative:+.1e} of {len(periods)}{'' if is_listed else ', NOT LISTED'}, attitude off {attitude:.3f} deg, "
              f"{verdict['verdict']}, chi2/dof {verdict['chi2'] / max(verdict['dof'], 1):.2f}, {len(rows) // 3} epochs, {seconds:.1f} s", flush=True)
    n = len(results)
    print(f"{o.object} spin {o.spin:g} s, SNR {o.snr:g}, seed {o.seed}, {n} curves: found {sum(r[2] for r in results) / n:.2f}, period listed {sum(r[6] for r in results) / n:.2f}, "
          f"determined {sum(r[5] for r in results)}, of these not found {sum(r[5] and not r[2] for r in results)}; median axis {statistics.median(r[0] for r in results):.3f} deg, "
          f"attitude {statistics.median(r[4] for r in results):.3f} deg, period {statistics.median(r[1] for r in results):.1e}; {statistics.median(r[3] for r in results):.1f} s")


def poses(o, work, meshes):
    rng = random.Random(o.seed)
    results = []
    for trial in range(o.trials):
        truth = random_attitude(rng)
        rows = make_curve(o, work, meshes, trial, inertial(truth), 12, rng)
        if o.only not in (None, trial):
            continue
        verdict, seconds = asked(o, work, "pose")
        same = twins(truth, verdict["symmetries"])
        errors = [min(apart(t, m["q"]) for t in same) for m in verdict["modes"]]
        axis = min(axis_apart(t, verdict["modes"][0]["q"]) for t in same)
        inside = in_set(work / "answer/set95.ecsv", same)
        phases = [float(r["phase_angle"]) for r in rows]
        results.append((errors[0], min(errors), len(errors), inside, verdict["share_of_so3"], seconds, verdict["verdict"],
                        verdict["chi2"] / max(verdict["dof"], 1), axis))
        print(f"{o.object} {trial}: best {errors[0]:.3f} nearest {min(errors):.3f} +Z {axis:.3f} deg of {len(errors)}, in set {inside}, share "
              f"{verdict['share_of_so3']:.1e}, chi2/dof {results[-1][7]:.2f}, {verdict['verdict']}, {seconds:.1f} s, "
              f"{len(rows) // 3} epochs, phase {min(phases):.0f}-{max(phases):.0f}, {verdict['symmetries']}", flush=True)
    n = len(results)
    print(f"{o.object} SNR {o.snr:g}, {n} curves: best < 5 deg {sum(r[0] < 5 for r in results) / n:.2f}; nearest mode < 5 deg "
          f"{sum(r[1] < 5 for r in results) / n:.2f}; in the 95 % set {sum(r[3] for r in results) / n:.2f}; median error of best "
          f"{statistics.median(r[0] for r in results):.2f}, of nearest {statistics.median(r[1] for r in results):.3f}, of +Z {statistics.median(r[8] for r in results):.3f} deg; modes "
          f"{statistics.median(r[2] for r in results):.0f}; share of SO(3) {statistics.median(r[4] for r in results):.1e}; chi2/dof "
          f"{statistics.median(r[7] for r in results):.2f}; {statistics.median(r[5] for r in results):.1f} s")


if __name__ == "__main__":
    main()
