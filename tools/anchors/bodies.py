"""Whole bodies of one material (docs/theory/closed_forms.md), unit irradiance, [m2/sr]."""

from functools import lru_cache

import mpmath
import numpy as np

from interfaces import NM, TABLE_1, factors, incidence, q_of
from microfacet import DEGREE, between_facets, blinn_phong, exponent_at, joint, silicon
from quadrature import converged, nodes


def lune(phase, order, width=1.0):
    """Cosines to Sun and observer and the area over the lit and seen part of a unit sphere.

    Longitude runs from the bisector in the scattering plane; the lobe's width sets the pieces."""
    half = np.pi / 2 - phase / 2
    inner = min(3 * width, .9 * half)
    outer = min(9 * width, .95 * half)
    lon, w_lon = nodes(np.array([-half, -outer, -inner, 0, inner, outer, half]), order)
    lat, w_lat = nodes(np.array([0, min(3 * width, 1.0), min(9 * width, 1.2), np.pi / 2]), order)
    n_l = np.cos(lat)[:, None] * np.cos(lon - phase / 2)
    n_v = np.cos(lat)[:, None] * np.cos(lon + phase / 2)
    area = 2 * np.cos(lat)[:, None] * w_lat[:, None] * w_lon
    return n_l, n_v, area


def specular_sphere(m, phase, order):
    """4 J/(R^2 F) of one reflection, ashikhmin (closed_forms.md 5)."""
    lobe = blinn_phong(m)
    n_l, n_v, area = lune(phase, order, lobe.width)
    l_v = np.cos(phase)
    h = (n_l + n_v) / np.sqrt(2 + 2 * l_v)
    between = np.clip((l_v - n_l * n_v) / np.maximum(np.sqrt((1 - n_l ** 2) * (1 - n_v ** 2)), 1e-300), -1, 1)
    g = joint("ashikhmin", lobe.masking(n_l), lobe.masking(n_v), between)
    return np.sum(lobe.density(h) * g * area)


@lru_cache(maxsize=None)
def rough_sphere(m, phase_deg, digits):
    return float(converged(lambda n: specular_sphere(m, phase_deg * DEGREE, n), digits))


def diffuse_sphere(f, phase_deg, digits=7):
    """int f(n.l, n.v) (n.l)(n.v) dA."""
    def rule(order):
        n_l, n_v, area = lune(phase_deg * DEGREE, order)
        return np.sum(f(n_l, n_v) * n_l * n_v * area)
    return float(converged(rule, digits))


def silicon_body(m, band):
    r = silicon(m)
    return lambda l, v: .1 * (1 - r(l, band)) * (1 - r(v, band)) / (np.pi * (1 - r.mean[band]))


def silicon_sphere_q(m, band, phase_deg):
    a, b = (float(x) for x in factors(incidence(phase_deg), TABLE_1["paper_asi"][band]))
    once = rough_sphere(m, phase_deg, 6) / 4
    return b * once / (a * once + diffuse_sphere(silicon_body(m, band), phase_deg, 6))


# ---- tables

PHASES = range(0, 180, 5)


def q_table_rows():
    for name in ("paper_au", "paper_al", "paper_bk7", "paper_mylar", "paper_asi"):
        for nm, eta in zip(NM, TABLE_1[name]):
            yield name, nm, *((q_of(eta, phase) if phase else mpmath.mpf(0), 4) for phase in PHASES)
    for band, nm in enumerate(NM):
        yield "sphere", nm, *((silicon_sphere_q(200, band, phase), 4) for phase in PHASES)


def rough_sphere_rows():
    for m in (4, 10, 50, 200, 1000):
        for phase in (0, 60, 90, 120, 140, 150, 160, 170):
            yield m, phase, (rough_sphere(m, phase, 5), 4)


def sphere_stokes_rows():
    for name, m, bands in (("paper_au", 200, (0, 1, 2)), ("paper_al", 50, (0, 1, 2)),
                           ("paper_mylar", 10, (1,))):
        for k in bands:
            a, b = factors(incidence(90), TABLE_1[name][k])
            j = rough_sphere(m, 90, 8) / 4
            yield name, m, NM[k], (float(a) * j, 7), (float(b) * j, 7)


def lambert_sphere_rows():
    """rho R^2 times this (closed_forms.md 2; Russell 1916)."""
    for phase in range(0, 180, 30):
        a = mpmath.radians(phase)
        yield phase, (2 / (3 * mpmath.pi) * (mpmath.sin(a) + (mpmath.pi - a) * mpmath.cos(a)), 6)


def sphere_colour_rows():
    """I(425)/I(650) of a gold sphere whose roughness depends on wavelength, m = 100 at 550 nm."""
    for phase in (30, 90, 120, 150):
        blue, red = (float(factors(incidence(phase), eta)[0])
                     * rough_sphere(exponent_at(100, nm), phase, 5)
                     for nm, eta in ((425, TABLE_1["paper_au"][0]), (650, TABLE_1["paper_au"][2])))
        yield phase, (blue / red, 3)


def gold_sphere_rows():
    """Q/I at phase 90 and 425 nm: one reflection, then with light between facets added to I."""
    eta = TABLE_1["paper_au"][0]
    a, b = (float(x) for x in factors(incidence(90), eta))
    yield "none", 10, (b / a, 4)
    for m in (10, 1):
        once = rough_sphere(m, 90, 8) / 4
        yield "unpolarized", m, (b * once / (a * once + diffuse_sphere(between_facets(m, eta), 90)), 6)


def silicon_cube_rows():
    """Median Q/I of a cube in random attitudes and Q/I of a sphere, with body light, 550 nm, m = 10."""
    draw = np.random.Generator(np.random.PCG64(1))
    count, m, eta = 200_000, 10, TABLE_1["paper_asi"][1]
    l = draw.normal(size=(count, 3))
    l /= np.linalg.norm(l, axis=1)[:, None]
    side = np.cross(l, draw.normal(size=(count, 3)))
    side /= np.linalg.norm(side, axis=1)[:, None]
    body, lobe = silicon_body(m, 1), blinn_phong(m)
    for phase in (60, 90, 140):
        v = l * np.cos(phase * DEGREE) + side * np.sin(phase * DEGREE)
        h = (l + v) / np.linalg.norm(l + v, axis=1)[:, None]
        a, b = (float(x) for x in factors(incidence(phase), eta))
        once, below = np.zeros(count), np.zeros(count)
        for axis in range(3):
            for sign in (1, -1):
                n_l, n_v, n_h = (sign * x[:, axis] for x in (l, v, h))
                both = (n_l > 0) & (n_v > 0)
                n_l, n_v, n_h = n_l[both], n_v[both], n_h[both]
                between = np.clip((np.cos(phase * DEGREE) - n_l * n_v)
                                  / np.sqrt((1 - n_l ** 2) * (1 - n_v ** 2)), -1, 1)
                g = joint("ashikhmin", lobe.masking(n_l), lobe.masking(n_v), between)
                once[both] += lobe.density(n_h) * g / 4
                below[both] += body(n_l, n_v) * n_l * n_v
        seen = a * once + below > 1e-12
        q = (b * once / np.maximum(a * once + below, 1e-300))[seen]
        yield phase, (np.median(q), 3), (silicon_sphere_q(m, 1, phase), 4)


def lambert_cylinder(length, radius, theta_l, theta_v, phi):
    """closed_forms.md 4; degrees from the axis."""
    t, o, f = (mpmath.radians(x) for x in (theta_l, theta_v, phi))
    return (radius * length / mpmath.pi * mpmath.sin(t) * mpmath.sin(o)
            * ((mpmath.pi - f) * mpmath.cos(f) + mpmath.sin(f)) / 2)


def mirror_cylinder(length, radius, theta_l, theta_v, phi, disk):
    """closed_forms.md 7; F = 1."""
    t, o, f, rho = (mpmath.radians(x) for x in (theta_l, theta_v, phi, disk))
    l_v = mpmath.cos(t) * mpmath.cos(o) + mpmath.sin(t) * mpmath.sin(o) * mpmath.cos(f)
    half = mpmath.sqrt((1 + l_v) / 2)
    h_a = (mpmath.cos(t) + mpmath.cos(o)) / mpmath.sqrt(2 + 2 * l_v)
    x0 = 2 * half * h_a / mpmath.sin(t)
    return (radius * length * half * mpmath.sqrt(rho ** 2 - x0 ** 2)
            / (mpmath.pi * rho ** 2 * mpmath.sin(t)))


def mirror_ellipsoid(axes, l, v):
    """closed_forms.md 1; F = 1."""
    h = [mpmath.mpf(x) + mpmath.mpf(y) for x, y in zip(l, v)]
    size = mpmath.sqrt(sum(x * x for x in h))
    support = sum((a * x / size) ** 2 for a, x in zip(axes, h))
    return (axes[0] * axes[1] * axes[2]) ** 2 / (4 * support ** 2)
