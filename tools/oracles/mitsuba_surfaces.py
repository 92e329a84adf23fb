#!/usr/bin/env python3
"""Independent oracle for polarised surface reflection: Mitsuba 3.9.1, frozen into a CSV.

    python3 -m venv venv && venv/bin/pip install mitsuba==3.9.1 numpy
    venv/bin/python mitsuba_surfaces.py [mitsuba_surfaces.csv]

Evaluates Mitsuba's `roughconductor` and `pplastic` in the variant
scalar_spectral_polarized (single precision; needs no LLVM), rewrites each Mueller
matrix in the conventions of umov, checks it against a double-precision numpy
transcription of the published formulas, and writes one CSV row per geometry.
The Mueller BRDF in the CSV is in 1/sr, without the cosine factor.

Target conventions.  exp(-i w t), index n + i k.  l = surface->Sun, v = surface->observer,
n = z.  s = (v x l)/|v x l| for both beams, p = k x s, k_in = -l, k_out = v.
I = |Es|^2+|Ep|^2, Q = |Es|^2-|Ep|^2, U = 2 Re(Es Ep*), V = 2 Im(Es* Ep).

Conversion, step by step.
 1. Roles.  In TransportMode.Radiance (the default) Mitsuba's wi points to the sensor and
    wo to the light; light travels along -wo and leaves along +wi.  So wi = v, wo = l.
    In TransportMode.Importance the two swap (used here only as a check).
 2. Cosine.  eval() returns f * |cos(wo)|, hence a division by n.l in Radiance mode
    (by n.v in Importance mode).
 3. Frames.  The matrix maps Stokes vectors referred to b_in = stokes_basis(-l) into
    Stokes vectors referred to b_out = stokes_basis(v).  With R(b -> s) the rotation by
    x = the counter-clockwise angle about k from b to s (seen facing the light),
    Q' = Q cos 2x + U sin 2x, U' = -Q sin 2x + U cos 2x -- Mitsuba's rotator() has the
    same sign as the target -- M_s = R_out M R_in^T.  It is what
    mi.mueller.rotate_mueller_basis computes; here it is done in double precision, and the
    two are compared.  The sign of s itself is immaterial (x -> x + 180 deg).
 4. Handedness.  Q and U agree: Mitsuba's U > 0 lies at +45 deg counter-clockwise from the
    basis vector, i.e. towards k x b = p.  V does not: Mitsuba's V > 0 is right circular
    (clockwise for the observer facing the light: right_circular_polarizer has m03 > 0),
    while V = 2 Im(Es* Ep) with exp(-i w t) and p = k x s is > 0 for a field that turns
    from s to p, counter-clockwise.  So M = C M_s C, C = diag(1,1,1,-1).
    Fresnel agrees: Mitsuba conjugates the index to n - i k (exp(+i w t)), keeps the sign of
    r_p, and writes the lower block as [[Re, -Im], [Im, Re]] of (r_s* r_p)*.  So does
    linear_retarder: a lagging y axis turns U = 1 into a field from x to y, V = -1 there.

What Mitsuba evaluates (read from its source: roughconductor.cpp, pplastic.cpp,
microfacet.h, mueller.h; c_i = n.l, c_o = n.v, h = half vector).
 * Microfacets: f = F(l.h) D(h) G / (4 c_i c_o), G = G1(l) G1(v): separable Smith, not
   height-correlated.  With a = 1/(alpha tan theta):
     GGX       D = 1 / (pi alpha^2 ((hx^2+hy^2)/alpha^2 + hz^2)^2)
               G1 = 2 / (1 + sqrt(1 + 1/a^2))
     Beckmann  D = exp(-tan^2 theta_h / alpha^2) / (pi alpha^2 cos^4 theta_h)
               G1 = (3.535 a + 2.181 a^2) / (1 + 2.276 a + 2.577 a^2), 1 for a >= 1.6:
               the rational fit of the exact 2 / (1 + erf a + exp(-a^2)/(a sqrt pi)).
   D is replaced by 0 where D cos(theta_h) <= 1e-20.
 * pplastic = ks * microfacets(real index m = int_ior/ext_ior) + diffuse, where
     diffuse = (a/pi) Rot_o [T(v)] Dep [T(l)] Rot_i,  Dep = diag(1,0,0,0),
   T = Mueller matrix of smooth transmission on n x k (the macroscopic plane), with
   T_s = 1-R_s, T_p = 1-R_p at the outer angle for both crossings (on the way out Mitsuba
   uses the inner angle and 1/m: the same numbers): the outer product of column 0 of T(v)
   and row 0 of T(l), each rotated to s.  With A = (T_s+T_p)/2, B = (T_s-T_p)/2 <= 0,
   m00 = (a/pi) A(c_o) A(c_i).  There is NO 1/m^2, NO internal diffuse Fresnel
   reflectance, NO 1/(1 - a F_int), and no `nonlinear` parameter.
"""
import sys
from math import erf
import numpy as np
import mitsuba as mi

VERSION = "3.9.1"
VARIANT = "scalar_spectral_polarized"
CONDUCTOR = (0.359, 2.69)  # n, k
PLASTIC_N = 1.5
DIFFUSE = 0.5
ROWS = 200
C_FLIP = np.diag([1.0, 1.0, 1.0, -1.0])
unit = lambda a: a / np.linalg.norm(a)
basis = lambda k: np.array(mi.mueller.stokes_basis(mi.Vector3f(*k)), dtype=float).ravel()
first_wavelength = lambda m: np.array(m, dtype=float).reshape(4, 4, -1)[:, :, 0]


def direction(theta, az):
    return np.array([np.sin(theta) * np.cos(az), np.sin(theta) * np.sin(az), np.cos(theta)])


def geometries(alpha, slope_max, seed):
    """ROWS pairs (l, v), angles up to 80 deg.  Even rows: both directions at random, facet
    slope at most slope_max (a Gaussian lobe alone would be 0 beyond).  Odd rows: v = mirror
    image of l in a facet of slope up to 2.5 alpha, to land in the lobe.  Directions are
    rounded to float before the angles of the CSV are taken: this rounding costs nothing."""
    rng = np.random.default_rng(seed)
    out = []
    zmin = np.cos(np.radians(80.0))
    while len(out) < ROWS:
        l = direction(np.radians(rng.uniform(0.5, 80)), rng.uniform(0, 2 * np.pi))
        if len(out) % 2 == 0:
            v = direction(np.radians(rng.uniform(0.5, 80)), rng.uniform(0, 2 * np.pi))
        else:
            h = direction(np.arctan(alpha * rng.uniform(0, 2.5)), rng.uniform(0, 2 * np.pi))
            v = 2 * (l @ h) * h - l
        l, v = (np.float32(d).astype(float) for d in (l, v))
        if np.hypot(*(l + v)[:2]) > slope_max * (l + v)[2]:
            continue
        if min(v[2], l[2]) > zmin and np.linalg.norm(np.cross(v, l)) > 0.02:
            out.append((l, v))
    return out


def angles(l, v):
    phi = np.arctan2(v[1], v[0]) - np.arctan2(l[1], l[0])
    return np.degrees([np.arctan2(np.hypot(d[0], d[1]), d[2]) for d in (l, v)] + [phi % (2 * np.pi)])


def rotation(k, b_from, b_to):
    """Stokes change of reference axis b_from -> b_to for light travelling along k."""
    x = np.arctan2(k @ np.cross(b_from, b_to), b_from @ b_to)
    c, s = np.cos(2 * x), np.sin(2 * x)
    return np.array([[1, 0, 0, 0], [0, c, s, 0], [0, -s, c, 0], [0, 0, 0, 1.0]])


def mitsuba_brdf(bsdf, l, v, mode):
    """Mueller BRDF in the target's frames, and the same through Mitsuba's own rotation."""
    si = mi.SurfaceInteraction3f()
    si.wavelengths = [550.0] * 4
    wi, wo = (v, l) if mode == mi.TransportMode.Radiance else (l, v)
    si.wi = mi.Vector3f(*wi)
    raw = bsdf.eval(mi.BSDFContext(mode), si, mi.Vector3f(*wo))
    s = unit(np.cross(v, l))
    m = rotation(v, basis(v), s) @ first_wavelength(raw) @ rotation(-l, basis(-l), s).T
    V = lambda a: mi.Vector3f(*a)
    own = mi.mueller.rotate_mueller_basis(raw, V(-l), V(basis(-l)), V(s), V(v), V(basis(v)), V(s))
    return (C_FLIP @ m @ C_FLIP / wo[2], C_FLIP @ first_wavelength(own) @ C_FLIP / wo[2])


def fresnel(index, c):
    q = np.sqrt(index**2 - 1 + c**2 + 0j)
    return (c - q) / (c + q), (index**2 * c - q) / (index**2 * c + q)


def g1(kind, alpha, d, exact=False):
    a = d[2] / (alpha * np.hypot(d[0], d[1]))
    if kind == "ggx":
        return 2 / (1 + np.sqrt(1 + 1 / a**2))
    if exact:
        return 2 / (1 + erf(a) + np.exp(-a * a) / (a * np.sqrt(np.pi)))
    return 1.0 if a >= 1.6 else (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a)


def reference(case, l, v, exact=False):
    kind, index, alpha, diffuse, ks = (case[k] for k in ("kind", "index", "alpha", "diffuse", "ks"))
    h = unit(l + v)
    t2 = (h[0]**2 + h[1]**2) / h[2]**2
    if kind == "beckmann":
        d = np.exp(-t2 / alpha**2) / (np.pi * alpha**2 * h[2]**4)
    else:
        d = 1 / (np.pi * alpha**2 * h[2]**4 * (1 + t2 / alpha**2)**2)
    d = d if d * h[2] > 1e-20 else 0.0  # Mitsuba's cut-off
    w = ks * d * g1(kind, alpha, l, exact) * g1(kind, alpha, v, exact) / (4 * l[2] * v[2])
    rs, rp = fresnel(index, unit(l) @ h)
    A, B, z = (abs(rs)**2 + abs(rp)**2) / 2, (abs(rs)**2 - abs(rp)**2) / 2, np.conj(rs) * rp
    m = w * np.array([[A, B, 0, 0], [B, A, 0, 0], [0, 0, z.real, -z.imag], [0, 0, z.imag, z.real]])
    if diffuse:
        n, s = np.array([0, 0, 1.0]), unit(np.cross(v, l))
        def transmission(c):
            ts, tp = (1 - abs(r)**2 for r in fresnel(index, c))
            return np.array([(ts + tp) / 2, (ts - tp) / 2, 0, 0])
        column = rotation(v, unit(np.cross(n, v)), s) @ transmission(v[2])
        row = rotation(-l, unit(np.cross(n, -l)), s) @ transmission(l[2])
        m = m + diffuse / np.pi * np.outer(column, row)
    return m


def cases():
    flat = lambda x: {"type": "spectrum", "value": x}
    for kind in ("beckmann", "ggx"):
        for alpha in (0.14, 0.4):
            yield dict(name=f"roughconductor_{kind}", kind=kind, index=complex(*CONDUCTOR), alpha=alpha,
                       diffuse=0.0, ks=1.0, slope_max=5 * alpha if kind == "beckmann" else np.inf,
                       scene={"type": "roughconductor", "distribution": kind, "alpha": alpha,
                              "eta": flat(CONDUCTOR[0]), "k": flat(CONDUCTOR[1]), "specular_reflectance": flat(1.0)})
    for name, ks in (("pplastic_beckmann", 1.0), ("pplastic_diffuse_only", 0.0)):
        yield dict(name=name, kind="beckmann", index=complex(PLASTIC_N), alpha=0.2, diffuse=DIFFUSE, ks=ks,
                   slope_max=np.inf,
                   scene={"type": "pplastic", "distribution": "beckmann", "alpha": 0.2, "int_ior": PLASTIC_N,
                          "ext_ior": 1.0, "diffuse_reflectance": flat(DIFFUSE), "specular_reflectance": flat(ks)})


def main(path):
    if mi.__version__ != VERSION:
        sys.exit(f"expected Mitsuba {VERSION}, found {mi.__version__}")
    mi.set_variant(VARIANT)
    lines = [f"# Mitsuba {mi.__version__}, variant {VARIANT} (single precision)",
             "# Mueller BRDF [1/sr], both Stokes vectors on s = (v x l)/|v x l|; exp(-i w t), n + i k",
             "# masking: separable Smith G1(l) G1(v); Beckmann G1 by the rational fit (see mitsuba_surfaces.py)",
             "case,eta_n,eta_k,alpha,diffuse,theta_i_deg,theta_o_deg,phi_deg,"
             + ",".join(f"m{i}{j}" for i in range(4) for j in range(4))]
    print("worst |difference| of any entry / m00 of the row")
    for number, case in enumerate(cases()):
        bsdf = mi.load_dict(case["scene"])
        worst = dict(all=0.0, lobe=0.0, frames=0.0, importance=0.0, masking_fit=0.0)
        for row, (l, v) in enumerate(geometries(case["alpha"], case["slope_max"], 1000 + number)):
            m, own = mitsuba_brdf(bsdf, l, v, mi.TransportMode.Radiance)
            other, _ = mitsuba_brdf(bsdf, l, v, mi.TransportMode.Importance)
            ref, exact = reference(case, l, v), reference(case, l, v, exact=True)
            head = (case["name"], case["index"].real, case["index"].imag, case["alpha"], case["diffuse"])
            lines.append(",".join([str(x) for x in head] + [f"{x:.12g}" for x in angles(l, v)]
                                  + [f"{x:.9g}" for x in (m + 0.0).ravel()]))
            def note(key, a, b):
                worst[key] = max(worst[key], np.abs(a - b).max() / b[0, 0])
            note("all", m, ref)
            if row % 2:
                note("lobe", m, ref)
            note("frames", own, m)
            note("importance", other, m)
            note("masking_fit", exact, ref)
        print(f"{case['name']:24s} alpha {case['alpha']:4}: numpy reference {worst['all']:.2e} "
              f"(in the lobe {worst['lobe']:.2e}), Mitsuba's own rotation {worst['frames']:.2e}, "
              f"importance mode {worst['importance']:.2e}, exact masking {worst['masking_fit']:.2e}")
    with open(path, "w") as f:
        f.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "mitsuba_surfaces.csv")
