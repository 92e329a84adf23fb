#!/usr/bin/env python3
"""Light between surfaces by Mitsuba 3.9.1's polarized path tracer: tests/data/bounces/mitsuba_*.csv.

    python3 -m venv venv && venv/bin/pip install mitsuba==3.9.1 numpy      (LLVM 19: see bench/peers/run)
    DRJIT_LIBLLVM_PATH=... venv/bin/python tools/oracles/mitsuba_bounces.py MESH.obj > .../mitsuba_box_wing.csv

MESH.obj: `umov mesh make box-wing --facets 1000` (mitsuba_box_wing.csv), `--facets 10000` (mitsuba_box_wing_10k.csv) or `umov mesh make hst` (mitsuba_hst.csv).
Each geometry is rendered by `path` in `stokes` (variant
llvm_ad_mono_polarized, 550 nm) with a directional emitter of unit irradiance and an orthographic sensor whose
window holds the object and whose vertical is the normal of the scattering plane s = (v x l)/|v x l|. The
integrator's reference is the sensor's horizontal, 90 degrees from s, so Q and U are turned in sign here; and V,
which Mitsuba counts positive for light that is right-circular to the observer who faces it. That the signs are
these is seen at one surface, where Q is B/A I > 0 for every metal. Pixels added up times their area are m2/sr per unit
irradiance. max_depth is the number of surfaces plus one. Errors: of the mean of ten independent renderings.

Materials: separable Smith GGX conductors, two-sided with the index and alpha of METALS; GROUPS gives each group of
the mesh its own. tests/cli/test_bounces.py has both too.
"""
import pathlib
import sys

import mitsuba
import numpy as np

mitsuba.set_variant("llvm_ad_mono_polarized")
import drjit  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench/peers"))
from compare import read_groups  # noqa: E402

METALS = {"gold": (0.4, 2.4, 0.30), "silicon": (4.0, 0.5, 0.20), "aluminium": (0.96, 6.69, 0.25), "smooth": (0.4, 2.4, 0.15)}
GROUPS = {"bus": "gold", "panels": "silicon", "dish": "aluminium", "tank": "smooth",
          "array_front": "silicon", "array_back": "gold", "forward_shell": "smooth", "aft_shroud": "gold"}
RENDERINGS, SIZE, SAMPLES = 10, 192, 96


groups = read_groups(sys.argv[1])
vertices = next(iter(groups.values()))[0]
centre = (vertices.min(0) + vertices.max(0)) / 2
radius = 1.01 * np.linalg.norm(vertices - centre, axis=1).max()
shapes = {}
for name, (_, triangles) in groups.items():
    n, k, alpha = METALS[GROUPS.get(name, "aluminium")]
    properties = mitsuba.Properties()
    properties["bsdf"] = mitsuba.load_dict({"type": "twosided", "bsdf": {
        "type": "roughconductor", "distribution": "ggx", "alpha": alpha, "eta": n, "k": k}})
    properties["face_normals"] = True
    mesh = mitsuba.Mesh(name, len(vertices), len(triangles), props=properties)
    parameters = mitsuba.traverse(mesh)
    parameters["vertex_positions"] = mitsuba.Float(vertices.astype(np.float32).ravel())
    parameters["faces"] = mitsuba.UInt32(triangles.astype(np.uint32).ravel())
    parameters.update()
    shapes["mesh_" + name] = mesh


def render(sun, observer, depth, seed):
    s = np.cross(observer, sun)
    s /= np.linalg.norm(s)
    T = mitsuba.ScalarTransform4f
    view = T().look_at(origin=list(centre + 3 * radius * observer), target=list(centre), up=list(s))
    scene = mitsuba.load_dict({
        "type": "scene", **shapes,
        "light": {"type": "directional", "direction": list(-sun), "irradiance": 1.0},
        "sensor": {"type": "orthographic", "to_world": view @ T().scale([radius, radius, 1]), "near_clip": 0.01 * radius,
                   "far_clip": 10 * radius, "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE,
                                                     "rfilter": {"type": "box"}, "pixel_format": "luminance",
                                                     "component_format": "float32"},
                   "sampler": {"type": "independent", "sample_count": SAMPLES}},
        "integrator": {"type": "stokes", "nested": {"type": "path", "max_depth": depth, "rr_depth": 1000}}})
    image = np.array(mitsuba.render(scene, seed=seed, spp=SAMPLES), float)
    area = (2 * radius / SIZE) ** 2
    total = image.reshape(-1, image.shape[-1]).sum(0) * area
    i, q, u, v = total[-4:] if len(total) < 12 else total[[-12, -9, -6, -3]]
    return np.array([i, -q, -u, -v])


rng = np.random.default_rng(2024)
print("bounces,sun_x,sun_y,sun_z,obs_x,obs_y,obs_z,i,q,u,v,i_err,q_err,u_err,v_err")
for k in range(40):
    phase = np.radians(20 + 120 * (k + 0.5) / 40)
    a = rng.normal(size=3)
    a /= np.linalg.norm(a)
    b = np.cross(a, rng.normal(size=3))
    b /= np.linalg.norm(b)
    sun, observer = a, np.cos(phase) * a + np.sin(phase) * b
    for bounces in (1, 2, 5):
        runs = np.array([render(sun, observer, bounces + 1, 100 * k + r) for r in range(RENDERINGS)])
        mean, error = runs.mean(0), runs.std(0, ddof=1) / np.sqrt(RENDERINGS)
        print(",".join([str(bounces)] + [f"{x:.9g}" for x in (*sun, *observer, *mean, *error)]), flush=True)
