#!/usr/bin/env python3
"""Mueller matrices of rough facets, and amplitudes of film stacks, by pySCATMECH 0.1.10 (SCATMECH, NIST).

usage: pip install pySCATMECH==0.1.10 numpy
       scatmech_surfaces.py tests/data/surfaces     (writes scatmech_facets.csv, scatmech_films.csv)

Facets. Facet_BRDF_Model with Gaussian_Slope_Distribution_Function, p(slope) = exp(-slope^2/s^2)/(pi s^2):
Beckmann with alpha = s; no shadow function (G = 1).

Frames. SCATMECH's specular direction has azimuth phi_s = 0, ours phi = 180 deg (phi: azimuth of the
observer minus that of the source): phi_s = phi - 180 deg, both counter-clockwise about the normal when the
source is at azimuth 0 and SCATMECH's k_in points to azimuth 0. Coordinates "plane" refer both beams to the
plane of scattering: its normal is our s axis up to sign, so Stokes vectors need no further turn.
Stokes signs. Which signs of Q, U and V differ from ours is found by comparing with the closed matrix of one
reflection for each of the eight choices. None differs; turning U and V together fits as well, since the
matrix of one reflection does not change then. All other choices miss. The header of the result has the
numbers.
"""
import pathlib
import sys

import numpy as np
from pySCATMECH.brdf import BRDF_Model
from pySCATMECH.fresnel import Film, FilmStack, OpticalFunction

OUT = pathlib.Path(sys.argv[1])
RNG = np.random.default_rng(20180121)
NM = 0.55


def fresnel_matrix(eta, c):
    """Closed Mueller matrix of one reflection in our conventions (docs/conventions.md)."""
    q = np.sqrt(eta * eta - 1 + c * c + 0j)
    r_s, r_p = (c - q) / (c + q), (eta * eta * c - q) / (eta * eta * c + q)
    a, b = (abs(r_s)**2 + abs(r_p)**2) / 2, (abs(r_s)**2 - abs(r_p)**2) / 2
    z = np.conj(r_s) * r_p
    return np.array([[a, b, 0, 0], [b, a, 0, 0], [0, 0, z.real, -z.imag], [0, 0, z.imag, z.real]])


def beckmann_w(alpha, ti, to, phi):
    l_v = np.cos(ti) * np.cos(to) + np.sin(ti) * np.sin(to) * np.cos(phi)
    c = (np.cos(ti) + np.cos(to)) / np.sqrt(2 + 2 * l_v)
    d = np.exp(-(1 / c**2 - 1) / alpha**2) / (np.pi * alpha**2 * c**4)
    return d / (4 * np.cos(ti) * np.cos(to)), np.sqrt((1 + l_v) / 2)


def facets():
    rows, raw = [], []
    for eta in (0.359 + 2.69j, 1.518 + 0j):
        for alpha in (0.15, 0.4):
            model = BRDF_Model("Facet_BRDF_Model", {
                "lambda": str(NM), "substrate": f"({eta.real},{eta.imag})", "type": "0",
                "sdf": {None: "Gaussian_Slope_Distribution_Function", "s": str(alpha)},
                "stack": "No_StackModel"})
            for _ in range(200):
                # A mirror image in a facet of up to two alpha, turned aside: no empty tails.
                tilt, turn = np.arctan(alpha * 2 * RNG.random()), 2 * np.pi * RNG.random()
                ti = np.radians(75) * RNG.random()
                h = np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
                l = np.array([np.sin(ti), 0, np.cos(ti)])
                v = 2 * h.dot(l) * h - l
                if v[2] < np.cos(np.radians(80)) or np.linalg.norm(np.cross(l, v)) < 0.02:
                    continue
                to, phi = np.arccos(v[2]), np.arctan2(v[1], v[0])
                m = np.array(model.MuellerBRDF(ti, to, phi - np.pi, 0, "plane"), dtype=float)
                w, c = beckmann_w(alpha, ti, to, phi)
                rows.append((eta, alpha, ti, to, phi, w * fresnel_matrix(eta, c)))
                raw.append(m)
    fits = []
    for signs in np.ndindex(2, 2, 2):
        f = np.diag([1] + [1 - 2 * k for k in signs])
        worst = max(np.abs(f @ m @ f - r[5]).max() / r[5][0, 0] for m, r in zip(raw, rows))
        fits.append((worst, signs, f))
    fits.sort(key=lambda x: x[0])
    worst, signs, f = fits[0]
    with open(OUT / "scatmech_facets.csv", "w", newline="\n") as file:
        fit = [signs for worst, signs, _ in fits if worst < 1e-9]
        print(f"# pySCATMECH 0.1.10; turned signs of Q, U, V that fit: {fit}, to {worst:.1e} of m00; the "
              f"next choice misses by {fits[len(fit)][0]:.1e}", file=file)
        names = ",".join(f"m{r}{c}" for r in range(4) for c in range(4))
        print("eta_n,eta_k,alpha,theta_i_deg,theta_o_deg,phi_deg," + names, file=file)
        for m, (eta, alpha, ti, to, phi, _) in zip(raw, rows):
            ours = f @ m @ f
            numbers = [eta.real, eta.imag, alpha, *np.degrees([ti, to, phi])] + list(ours.ravel())
            print(",".join(f"{x:.15g}" for x in numbers), file=file)


STACKS = {
    "sio2_on_al": (1.015 + 6.627j, [(1.46 + 0j, 0.150)]),
    "mgf2_on_glass": (1.518 + 0j, [(1.38 + 0j, 0.55 / 4 / 1.38)]),
    "three_on_glass": (1.518 + 0j, [(2.1 + 0j, 0.060), (1.46 + 0j, 0.095), (2.1 + 0j, 0.060)]),
    "ito_on_si": (4.08 + 0.028j, [(1.9 + 0.01j, 0.080)]),
}


def films():
    with open(OUT / "scatmech_films.csv", "w", newline="\n") as file:
        print("# pySCATMECH 0.1.10, FilmStack.Rs and Rp at 550 nm; first film on top", file=file)
        print("stack,theta_deg,r_s,r_p", file=file)
        for name, (substrate, layers) in STACKS.items():
            # FilmStack grows from the substrate up.
            stack = FilmStack([Film(OpticalFunction(n), thickness=t) for n, t in reversed(layers)])
            for theta in np.linspace(0, 88, 45):
                a = [np.radians(theta), NM, OpticalFunction(1), OpticalFunction(substrate)]
                print(f"{name},{theta:.15g},{stack.Rs(*a):.15g},{stack.Rp(*a):.15g}", file=file)


facets()
films()
