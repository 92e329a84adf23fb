#!/usr/bin/env python3
"""Light of a sphere, of a cylinder's and of a cone's side by quadrature over their true normals and the Sun's disk.

    .deps/venv/bin/python tools/oracles/curved_glints.py > tests/data/surfaces/curved_glints.csv

Shares no code with umov: numpy alone. One reflection with F = 1, irradiance 1, height-correlated Smith masking:

    J = <int D(n.h) G(l, v) / 4 dA>,  the mean over the directions l of a uniform disk of .2665 deg,

with D, P of docs/theory/microfacet.md, Eqs. 3 and 4, and lobes.md, Eqs. 2 and 3. Masking of Blinn-Phong is that of a
Beckmann of the same variance of slopes: 1 at the angles asked here. J in m2/sr.

cylinder: radius 1, length 2 about z; cone: radius 1 at z = -1, .4 at z = 1, both without caps; sphere: radius 1.
Directions are those at azimuth 0 of the half vector; about z a cylinder and a cone look the same from all sides.
`peak` is J where the half vector is a normal of the shape.
"""
import sys

import numpy as np

SUN_RADIUS = np.radians(0.2665)
LOBES = [("ggx", a) for a in (0.3, 0.1, 0.03, 0.01, 0.003)] + [("beckmann", a) for a in (0.3, 0.1, 0.03, 0.01, 0.003)] + [
    ("blinn_phong", m) for m in (100, 1e3, 1e4, 1e5)]


def erfc(x):
    """For x >= 0 to 1.2e-7 (Press et al. 1992, section 6.2)."""
    t = 1 / (1 + 0.5 * x)
    c = (-1.26551223, 1.00002368, .37409196, .09678418, -.18628806, .27886807, -1.13520398, 1.48851587, -.82215223, .17087277)
    return t * np.exp(-x * x + np.polyval(c[::-1], t))


def width(model, p):
    return 1 / np.sqrt(p + 2) if model == "blinn_phong" else p / np.sqrt(2)


def density(model, p, cosine, sine2):
    cosine = np.maximum(cosine, 1e-9)
    if model == "ggx":
        return p * p / np.pi / (sine2 + p * p * cosine * cosine)**2
    if model == "beckmann":
        return np.exp(-sine2 / (cosine * p)**2) / (np.pi * p * p * cosine**4)
    return (p + 2) / (2 * np.pi) * np.exp(0.5 * p * np.log1p(-np.minimum(sine2, 1 - 1e-12)))


def masking(model, p, cosine):
    cosine = np.clip(cosine, 1e-12, 1)
    tangent = np.sqrt(1 - cosine * cosine) / cosine
    if model == "ggx":
        return 2 / (1 + np.sqrt(1 + (p * tangent)**2))
    x = 1 / np.maximum(np.sqrt(2) * width(model, p) * tangent, 0.16)  # 1 beyond x = 6, to 1e-17
    return 1 / (1 + np.maximum(np.exp(-x * x) / (2 * x * np.sqrt(np.pi)) - erfc(x) / 2, 0))


def gauss(low, high, count):
    x, w = np.polynomial.legendre.leggauss(count)
    return low + (high - low) * (x + 1) / 2, w * (high - low) / 2


def graded(centre, scale, low, high, count):
    """Nodes that crowd about a centre."""
    t, w = gauss(np.arcsinh((low - centre) / scale), np.arcsinh((high - centre) / scale), count)
    return centre + scale * np.sinh(t), w * scale * np.cosh(t)


def disk(to_sun, rings=12, spokes=24):
    """Directions of the disk, their weights."""
    share, w = gauss(0, 1, rings)  # of the solid angle
    cosine = 1 - share * (1 - np.cos(SUN_RADIUS))
    sine = np.sqrt(1 - cosine * cosine)
    e = np.cross(to_sun, [0, 0, 1] if abs(to_sun[2]) < 0.9 else [1, 0, 0])
    e = e / np.linalg.norm(e)
    f = np.cross(to_sun, e)
    out, weights = [], []
    for k in range(spokes):
        a = 2 * np.pi * (k + 0.5) / spokes
        out.append(cosine[:, None] * to_sun + sine[:, None] * (np.cos(a) * e + np.sin(a) * f))
        weights.append(w / spokes)
    return np.concatenate(out), np.concatenate(weights)


def light(lobe, normals, suns, observer):
    """D G/4, [sun, normal]."""
    half = suns + observer
    half = half / np.linalg.norm(half, axis=1)[:, None]
    n_l, n_v = suns @ normals.T, (normals @ observer)[None, :]
    apart = ((normals[None, :, :] - half[:, None, :])**2).sum(2)
    p_l, p_v = masking(*lobe, n_l), masking(*lobe, n_v)
    joint = p_l * p_v / (p_l + p_v - p_l * p_v)
    return np.where((n_l > 0) & (n_v > 0), density(*lobe, 1 - apart / 2, apart * (1 - apart / 4)) * joint / 4, 0)


def ring(lobe, sun, observer, polar, nodes=400):
    """Integral over the azimuth of normals at one angle from z."""
    suns, weights = disk(sun)
    half = sun + observer
    middle = np.arctan2(half[1], half[0])
    azimuth, w = graded(middle, max(width(*lobe), 0.002), middle - np.pi, middle + np.pi, nodes)
    normals = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth),
                        np.full_like(azimuth, np.cos(polar))], 1)
    return weights @ (light(lobe, normals, suns, observer) @ w)


def sphere(lobe, sun, observer, nodes=240):
    """A point Sun: J changes by less than 1e-5 over the disk's phase angles."""
    half = (sun + observer) / np.linalg.norm(sun + observer)
    e = np.cross(half, [0, 0, 1] if abs(half[2]) < 0.9 else [1, 0, 0])
    e = e / np.linalg.norm(e)
    f = np.cross(half, e)
    angle, w = graded(0, width(*lobe), 0, np.pi / 2, nodes)
    total = 0
    for k in range(nodes):
        a = 2 * np.pi * (k + 0.5) / nodes
        normals = np.cos(angle)[:, None] * half + np.sin(angle)[:, None] * (np.cos(a) * e + np.sin(a) * f)
        total += 2 * np.pi / nodes * (w * np.sin(angle)) @ light(lobe, normals, sun[None], observer)[0]
    return total


def directions(polar, phase, roll):
    """Sun and observer, half vector at azimuth 0; roll 0: their plane is across the axis."""
    half = np.array([np.sin(polar), 0, np.cos(polar)])
    e = np.cos(roll) * np.array([0, 1, 0]) + np.sin(roll) * np.cross(half, [0, 1, 0])
    return (np.cos(phase / 2) * half + np.sin(phase / 2) * e, np.cos(phase / 2) * half - np.sin(phase / 2) * e)


def main():
    slant = np.hypot(2, 0.6)
    shapes = {"cylinder": (np.pi / 2, 2.0), "cone": (np.arccos(0.6 / slant), slant * 0.7), "sphere": (np.pi / 3, 1.0)}
    print("# one reflection with F = 1, Smith masking, Sun of .2665 deg: tools/oracles/curved_glints.py, numpy", np.__version__)
    print("shape,model,parameter,sun_x,sun_y,sun_z,observer_x,observer_y,observer_z,j_m2_sr,peak_m2_sr")
    for name, (polar, area) in shapes.items():
        for lobe in LOBES:
            wide = np.hypot(width(*lobe), SUN_RADIUS / 4)
            for phase in np.radians([30, 110]):
                for roll in (np.radians([20, 80]) if name != "sphere" else [0.0]):
                    peak = None
                    for tilt in ((0, 1, 2.5) if name != "sphere" else [0]):
                        sun, observer = directions(polar + tilt * wide, phase, roll)
                        j = sphere(lobe, sun, observer) if name == "sphere" else area * ring(lobe, sun, observer, polar)
                        peak = j if peak is None else peak
                        numbers = [*sun, *observer, j, peak]
                        print(f"{name},{lobe[0]},{lobe[1]:g}," + ",".join(f"{x:.10g}" for x in numbers))
                    sys.stdout.flush()


if __name__ == "__main__":
    main()
