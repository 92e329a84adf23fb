"""Light between the parts of an object."""
import csv
import math
import os
import pathlib
import signal
import subprocess
import time

import pytest
from conftest import ROOT, UMOV, read_csv


def test_a_convex_mesh_is_the_same_and_a_box_wing_brighter(umov, scenario, tmp_path):
    deep = ("[output]", "[render]\nbounces = 3\naccuracy = 0.02\n[output]")
    plain = ("[output]", "[render]\naccuracy = 0.02\n[output]")
    band = ('set = "paper_rgb"', 'set = ["nm:550"]')
    for name in (scenario(plain, band, name="a.toml"), scenario(deep, band, ('dir = "out"', 'dir = "deep"'), name="b.toml")):
        done = umov("run", name, "--quiet")
        assert done.code == 0, done.err
    a, b = read_csv(tmp_path / "out/lightcurve.csv"), read_csv(tmp_path / "deep/lightcurve.csv")
    for one, two in zip(a, b):  # the cube is convex
        assert one["I"] == two["I"] and float(two["indirect_i"]) == 0 and "indirect_i" not in one
    assert umov("mesh", "make", "box-wing", "--facets", 1000, "-o", "cube.obj").code == 0
    for name in ("a.toml", "b.toml"):
        done = umov("run", name, "--quiet")
        assert done.code == 0, done.err
    a, b = read_csv(tmp_path / "out/lightcurve.csv"), read_csv(tmp_path / "deep/lightcurve.csv")
    assert len(a) == len(b) > 0
    for one, two in zip(a, b):
        if float(two["intensity"]) == 0:
            continue
        whole, error = float(two["intensity"]), float(two["intensity_err"]) + float(one["intensity_err"])
        share = float(two["indirect_i"])
        assert 0 <= share <= 1
        assert abs(whole * (1 - share) - float(one["intensity"])) <= 3 * error + 1e-9 * whole
        # More than the plane of the first reflection knows.
        assert abs(float(two["v"])) <= share + 1e-9
    assert any(float(row["indirect_i"]) > 1e-3 for row in b)


def test_rays_and_masks_give_the_same_whole(umov, scenario, tmp_path):
    assert umov("mesh", "make", "box-wing", "--facets", 1000, "-o", "cube.obj").code == 0
    name = scenario(("[output]", "[render]\nbounces = 2\naccuracy = 0.05\n[output]"))
    done = umov("signature", name, "--poses", 4, "--phase", 60, "-o", "s.csv")
    assert done.code == 0, done.err
    done = umov("signature", name, "--poses", 4, "--phase", 60, "--visibility", "masks", "-o", "m.csv")
    assert done.code == 0, done.err
    rays, masks = read_csv(tmp_path / "s.csv"), read_csv(tmp_path / "m.csv")
    assert len(rays) == len(masks) == 12
    for one, two in zip(rays, masks):
        for name in ("intensity", "stokes_q", "stokes_u", "stokes_v"):
            # The paths are the same ones, the direct parts within their errors.
            error = float(one[f"{name}_err"]) + float(two[f"{name}_err"])
            assert abs(float(one[name]) - float(two[name])) <= error + 1e-12


def test_the_header_says_who_draws_light_between_surfaces(umov, scenario, tmp_path):
    """Chains are asked for: a convex body has no such light, and light that is polarized as it comes takes paths."""
    name = scenario(("[output]", '[render]\nbounces = 2\naccuracy = 0.2\nbetween = "chains"\n[output]'), ('set = "paper_rgb"', 'set = ["nm:550"]'))

    def told(*options):
        done = umov("signature", name, "--poses", 2, "--phase", 60, "-o", "s.ecsv", *options)
        assert done.code == 0, done.err
        return next(line for line in (tmp_path / "s.ecsv").read_text().splitlines() if "between surfaces" in line)

    assert "none: a convex body" in told()
    assert umov("mesh", "make", "box-wing", "--facets", 600, "-o", "cube.obj").code == 0
    assert "chains, and paths for what they cannot tell and where few of them are met" in told()
    laser = told("--source", "laser", "--state", 1, 0, 0, 1)
    assert "paths" in laser and "chains, and" not in laser
    # Where all that reflects are mirrors paths draw every pose; one rough part is enough for chains.
    (tmp_path / "cube.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\ng floor\nf 1 2 3\nf 1 3 4\ng wall\nf 1 4 6\nf 1 6 5\n")
    text = (tmp_path / name).read_text().replace('default = "paper_al"', 'default = "shiny"\nwall = "WALL"')
    text += ('[material.shiny]\nindex = { n = 0.4, k = 2.4 }\ndistribution = { model = "mirror" }\n'
             '[material.black]\nindex = { n = 1.0, k = 0.0 }\ndistribution = { model = "ggx", alpha = 0.3 }\n')
    for wall, is_drawn in (("shiny", False), ("black", False), ("paper_al", True)):
        (tmp_path / name).write_text(text.replace("WALL", wall))
        assert ("chains" in told()) == is_drawn, wall


def test_a_warm_body_shines_by_itself(umov, scenario, tmp_path):
    """A cube is convex: what it emits is that of its faces, and other groups can be warmer."""
    (tmp_path / "plates.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\ng floor\nf 1 2 3\nf 1 3 4\ng wall\nf 1 4 6\nf 1 6 5\n")
    (tmp_path / "g.csv").write_text("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n1,0,1,0,0,1\n")
    (tmp_path / "s.toml").write_text(
        'umov = 1\n[[object]]\nname = "plates"\nmesh = { file = "plates.obj", unit = "m", up = "+Z" }\n'
        '[object.materials]\ndefault = "m"\n[material.m]\nindex = { n = 1.0, k = 0.0 }\n'
        'distribution = { model = "blinn_phong", m = 10 }\nbody = { reflectance = 0.4 }\n[bands]\nset = ["nm:10000"]\n[render]\nbounces = 3\n')
    found = []
    for kelvin in (["300"], ["300", "wall=400"]):
        done = umov("signature", "s.toml", "--geometry", "g.csv", "--source", "thermal", "-o", "o.csv",
                    *(word for k in kelvin for word in ("--temperature", k)))
        assert done.code == 0, done.err
        found.append(float(read_csv(tmp_path / "o.csv")[0]["intensity"]))
    # B(10 um, 300 K) = 9.924033 W m-2 sr-1 um-1 (physics of Planck's law, CODATA), e = .6, 1 m2; the wall adds what the
    # floor reflects of it: the form factor of two squares is .200044, rho = .4.
    planck = 9.924033e-3
    once = 0.6 * planck * (1 + 0.4 * 0.200044 + 0.4**2 * 0.04)
    assert abs(found[0] / once - 1) < 0.01
    assert found[1] > found[0] * 1.05
    for words, text in ((["--source", "thermal"], "go together"), (["--temperature", 300], "go together"),
                        (["--source", "thermal", "--temperature", "hot"], "K of all"),
                        (["--source", "thermal", "--temperature", "=300"], "K of all"),
                        (["--source", "thermal", "--temperature", "300", "--temperature", "310"], "said before"),
                        (["--source", "thermal", "--temperature", "wall=300"], "floor"),
                        (["--source", "thermal", "--temperature", "roof=300"], "floor, wall")):
        done = umov("signature", "s.toml", "--geometry", "g.csv", "-o", "x.csv", *words)
        assert done.code == 2 and text in done.err, done.err


@pytest.mark.slow
def test_passes_count_light_between_surfaces(umov, scenario, tmp_path):
    assert umov("mesh", "make", "box-wing", "--facets", 1000, "-o", "cube.obj").code == 0
    brightest = []
    for bounces in (1, 3):
        name = scenario(("[output]", f"[render]\nbounces = {bounces}\n[output]"), name=f"{bounces}.toml")
        done = umov("passes", "--orbit", ROOT / "data/tle/hst.tle", "-s", "20.7083,-156.2578,3058", "--start",
                    "2018-01-21T05:00:00Z", "--stop", "2018-01-21T05:20:00Z", "--scene", name, "-o", f"{bounces}.csv")
        assert done.code == 0, done.err
        brightest.append(float(read_csv(tmp_path / f"{bounces}.csv")[0]["mag_min"]))
    assert brightest[1] < brightest[0] - 0.005, "three surfaces give more light than one"


def test_a_laser_meets_several_surfaces_too(umov, scenario, tmp_path):
    """A corner of two plates sends a laser back by two reflections: far more than one surface does off the glint."""
    (tmp_path / "corner.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nusemtl a\nf 1 2 3\nf 1 3 4\nf 1 4 6\nf 1 6 5\n")
    (tmp_path / "g.csv").write_text("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n1,0,1,1,0,1\n")
    light = []
    for bounces in (1, 2):
        (tmp_path / "s.toml").write_text(
            'umov = 1\n[[object]]\nname = "corner"\nmesh = { file = "corner.obj", unit = "m", up = "+Z" }\n'
            '[object.materials]\ndefault = "paper_al"\n[bands]\nset = ["nm:550"]\n'
            f'[render]\nbounces = {bounces}\nsun = "point"\n')
        done = umov("signature", "s.toml", "--geometry", "g.csv", "--source", "laser", "--state", 1, 1, 0, 0,
                    "--visibility", "rays", "-o", "o.csv")
        assert done.code == 0, done.err
        light.append(read_csv(tmp_path / "o.csv")[0])
    assert float(light[1]["intensity"]) > 1000 * float(light[0]["intensity"])
    # Reflections by interfaces alone do not depolarize; lobes of 4 deg hardly do.
    i, q, u, v = (float(light[1][name]) for name in ("intensity", "stokes_q", "stokes_u", "stokes_v"))
    assert 0.95 < math.sqrt(q * q + u * u + v * v) / i < 1 + 1e-6


METALS = {"gold": (0.4, 2.4, 0.30), "silicon": (4.0, 0.5, 0.20), "aluminium": (0.96, 6.69, 0.25), "smooth": (0.4, 2.4, 0.15)}
OBJECTS = {
    "box_wing": (["box-wing", "--facets", 1000],
                 {"bus": "gold", "panels": "silicon", "dish": "aluminium", "tank": "smooth"}),
    "box_wing_10k": (["box-wing", "--facets", 10000],
                     {"bus": "gold", "panels": "silicon", "dish": "aluminium", "tank": "smooth"}),
    "hst": (["hst"],
            {"array_front": "silicon", "array_back": "gold", "forward_shell": "smooth", "aft_shroud": "gold",
             "antenna": "aluminium", "array_frame": "aluminium", "door": "aluminium", "equipment": "aluminium",
             "handrail": "aluminium", "light_shield": "aluminium", "baffle": "aluminium"}),
}


@pytest.mark.parametrize("which", [pytest.param(which, marks=pytest.mark.slow if which == "box_wing" else pytest.mark.long) for which in OBJECTS])
def test_stokes_agree_with_mitsubas_path_tracer(umov, tmp_path, which):
    """tests/data/bounces: I, Q, U and V of 40 geometries at 1, 2 and 5 surfaces, chi-square at 1 %."""
    mesh, groups = OBJECTS[which]
    assert umov("mesh", "make", *mesh, "-o", "object.obj").code == 0
    text = 'umov = 1\n[[object]]\nmesh = { file = "object.obj", unit = "m", up = "+Z" }\n[object.materials]\n'
    text += "".join(f'{group} = "m_{metal}"\n' for group, metal in groups.items())
    for metal, (n, k, alpha) in METALS.items():
        text += (f'[material.m_{metal}]\nindex = {{ n = {n}, k = {k} }}\nshadowing = "separable"\n'
                 f'distribution = {{ model = "ggx", alpha = {alpha} }}\n')
    (tmp_path / "s.toml").write_text(text + '[bands]\nset = ["nm:550"]\n[render]\nsun = "point"\n')
    with open(ROOT / f"tests/data/bounces/mitsuba_{which}.csv") as file:
        reference = list(csv.DictReader(file))
    axes = ["sun_x", "sun_y", "sun_z", "obs_x", "obs_y", "obs_z"]
    for bounces in (1, 2, 5):
        rows = [row for row in reference if row["bounces"] == str(bounces)]
        assert len(rows) == 40
        (tmp_path / "g.csv").write_text(
            "\n".join([",".join(axes)] + [",".join(row[a] for a in axes) for row in rows]) + "\n")
        done = umov("signature", "s.toml", "--geometry", "g.csv", "--set", f"render.bounces={bounces}", "--visibility",
                    "rays", "--accuracy", 0.002, "-o", "o.csv")
        assert done.code == 0, done.err
        ours = read_csv(tmp_path / "o.csv")
        for theirs, name in (("i", "intensity"), ("q", "stokes_q"), ("u", "stokes_u"), ("v", "stokes_v")):
            square = 0
            for row, mine in zip(rows, ours):
                # Single precision of the path tracer: 1e-6 of I.
                sigma = math.hypot(float(mine[name + "_err"]) / 1.96, float(row[theirs + "_err"]),
                                   1e-6 * float(mine["intensity"]))
                square += ((float(mine[name]) - float(row[theirs])) / sigma) ** 2
            # 63.7 is the 99 % quantile for 40; errors known from 16 and 10 samples spread by Student's
            # variance, 15/13 and 9/7, on top.
            assert square < 63.7 * 1.25, (bounces, name, square)
            if bounces > 1:  # nor are the errors so large that anything would do
                assert square > 8, (bounces, name, square)
    assert sum(abs(float(row["v"])) > 1e-4 * float(row["i"]) for row in reference if row["bounces"] == "5") > 10


def processor_s(process):
    """Seconds of the processor that a process has had."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_a_stop_is_heard_while_the_reserve_of_chains_is_drawn(tmp_path):
    """Plates of narrow lobes alone: a million chains, some 4 s of a core, before the first row."""
    (tmp_path / "plates.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\ng floor\nf 1 2 3\nf 1 3 4\ng wall\nf 1 4 6\nf 1 6 5\n")
    (tmp_path / "s.toml").write_text(
        'umov = 1\n[[object]]\nname = "plates"\nmesh = { file = "plates.obj", unit = "m", up = "+Z" }\n'
        '[object.materials]\ndefault = "m"\n[material.m]\nindex = { n = 0.4, k = 2.4 }\nshadowing = "separable"\n'
        'distribution = { model = "ggx", alpha = 0.12 }\n[bands]\nset = ["nm:550"]\n'
        '[render]\nbounces = 3\nbetween = "chains"\n')
    process = subprocess.Popen([UMOV, "signature", "s.toml", "--poses", "32", "--phase", "60", "--threads", "1", "-o", "x.csv"],
                               cwd=tmp_path, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while processor_s(process) < 1.5:
        time.sleep(0.01)
    had = processor_s(process)
    process.send_signal(signal.SIGINT)
    took = had
    while process.poll() is None:
        took = processor_s(process)
        time.sleep(0.002)
    told = process.stderr.read()
    assert process.returncode == 130, told
    assert "stopped by the user" in told and took - had < 0.5
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plates.obj", "s.toml"]  # nothing half done is kept
