"""Light at smooth interfaces: Fresnel, films, slabs, emission (microfacet.md 1-2, lobes.md)."""

import mpmath
from mpmath import mp

mp.dps = 25

NM = (425, 550, 650)
# Table 1 of the paper as it is printed.
TABLE_1 = {
    "paper_au": (1.62 + 1.94j, .359 + 2.69j, .170 + 3.14j),
    "paper_al": (.556 + 5.146j, 1.015 + 6.627j, 1.558 + 7.712j),
    "paper_bk7": (1.527, 1.518, 1.514),
    "paper_asi": (5.15, 4.77, 4.46),
    "paper_mylar": (1.10, 1.5, 1.6),
}


def amplitudes(c, eta):
    """r_s and r_p at the cosine c, numbers or arrays (microfacet.md 1)."""
    square = complex(eta) ** 2
    q = (square - 1 + c * c + 0j) ** 0.5
    return (c - q) / (c + q), (square * c - q) / (square * c + q)


def powers(c, eta):
    return tuple(abs(r) ** 2 for r in amplitudes(c, eta))


def factors(c, eta):
    """A and B (microfacet.md 2)."""
    s, p = powers(c, eta)
    return (s + p) / 2, (s - p) / 2


def cross_term(c, eta):
    """z = conj(r_s) r_p: M22 = Re z, M32 = -M23 = Im z."""
    s, p = amplitudes(c, eta)
    return s.conjugate() * p


def keys(name, nm, eta):
    """First cells of a row of Table 1."""
    return name, nm, f"{complex(eta).real:g}", f"{complex(eta).imag:g}"


def incidence(phase_deg):
    return mpmath.cos(mpmath.radians(phase_deg) / 2)


def q_of(eta, phase_deg):
    a, b = factors(incidence(phase_deg), eta)
    return b / a


def mean_reflectance(eta):
    """2 int F mu dmu; in sqrt(mu), since F rises steeply at grazing incidence (microfacet.md 6)."""
    return mpmath.quad(lambda x: 4 * x ** 3 * factors(x * x, eta)[0], [0, .1, .3, 1])


def mueller_rows():
    for name in ("paper_au", "paper_al"):
        for nm, eta in zip(NM, TABLE_1[name]):
            c = incidence(140)
            (a, b), z = factors(c, eta), cross_term(c, eta)
            yield *keys(name, nm, eta), 140, (a, 6), (b, 6), (z.real, 6), (-z.imag, 6)


def principal_rows():
    """Phase angle at which the retardance is 90 deg: M22 = 0."""
    for name in ("paper_au", "paper_al"):
        for nm, eta in zip(NM, TABLE_1[name]):
            retardance = lambda x: cross_term(incidence(x), eta).real
            at = mpmath.findroot(retardance, (130, 175), solver="anderson", tol=1e-20)
            yield *keys(name, nm, eta), (at, 3)


def table1_rows():
    for name, etas in TABLE_1.items():
        for nm, eta in zip(NM, etas):
            yield *keys(name, nm, eta), (factors(mpmath.mpf(1), eta)[0], 6), (mean_reflectance(eta), 6)


def q_140_rows():
    for name in ("paper_au", "paper_al"):
        for nm, eta in zip(NM, TABLE_1[name]):
            yield name, nm, (q_of(eta, 140), 6)


def q_peak_rows():
    for name, start in (("paper_au", (139, 143, 147)), ("paper_al", (159, 163, 166))):
        for nm, eta, first in zip(NM, TABLE_1[name], start):
            slope = lambda x: mpmath.diff(lambda y: q_of(eta, y), x)
            at = mpmath.findroot(slope, (first - 2, first + 2), solver="anderson", tol=1e-12)
            yield name, nm, (q_of(eta, at), 6), (at, 2)


def film_powers(theta_deg, layers, substrate, nm):
    """|r_s|^2, |r_p|^2 of a coherent stack, downward recursion (lobes.md 6; Born & Wolf 1.6)."""
    sine = mpmath.sin(mpmath.radians(theta_deg))
    etas = [mpmath.mpc(1)] + [mpmath.mpc(n) for n, _ in layers] + [mpmath.mpc(substrate)]
    q = [mpmath.sqrt(n * n - sine * sine) for n in etas]
    out = []
    for is_p in (False, True):
        r = mpmath.mpc(0)
        for j in range(len(etas) - 2, -1, -1):
            upper = etas[j + 1] ** 2 * q[j] if is_p else q[j]
            lower = etas[j] ** 2 * q[j + 1] if is_p else q[j + 1]
            step = (upper - lower) / (upper + lower)
            depth = layers[j][1] if j < len(layers) else 0
            # r so far is that of the stack below layer j + 1: once down and up through that layer
            turn = mpmath.exp(4j * mpmath.pi * q[j + 1] * depth / nm) if j < len(layers) else 0
            r = (step + r * turn) / (1 + step * r * turn)
        out.append(abs(r) ** 2)
    return out


def thick_film_powers(theta_deg, n, tau, substrate):
    """R of a layer that no longer interferes, internal transmittance tau a pass (lobes.md 7)."""
    c = mpmath.cos(mpmath.radians(theta_deg))
    inside = mpmath.sqrt(1 - (1 - c * c) / (mpmath.mpf(n) ** 2))
    below = complex(substrate) / n
    return [top + (1 - top) ** 2 * tau ** 2 * bottom / (1 - top * bottom * tau ** 2)
            for top, bottom in zip(powers(c, n), powers(inside, below))]


def film_rows():
    al = TABLE_1["paper_al"][1]
    for theta in (45, 70):
        yield "sio2_on_al", theta, *((r, 6) for r in film_powers(theta, [(1.46, 150)], al, 550))
    three = [(2.1, 60), (1.46, 95), (2.1, 60)]
    yield "three_films", 50, *((r, 6) for r in film_powers(50, three, 1.518, 550))
    for theta in (0, 60):
        yield "thick_on_al", theta, *((r, 6) for r in thick_film_powers(theta, 1.7, mpmath.mpf(".9"), al))
    once = powers(mpmath.cos(mpmath.radians(50)), 1.518)
    yield "slab_reflects", 50, *((2 * r / (1 + r), 6) for r in once)
    yield "slab_transmits", 50, *(((1 - r) / (1 + r), 6) for r in once)
    yield "quarter_wave_mgf2", 0, *((r, 7) for r in film_powers(0, [(1.38, 550 / 1.38 / 4)], 1.518, 550))


def emission_rows():
    """Kirchhoff (lobes.md 12): e = 1 - A, Q/I = -B/(1 - A)."""
    for eta, theta in ((25.3 + 90j, 60), (25.3 + 90j, 80), (1.518 + 0j, 60)):
        a, b = factors(mpmath.cos(mpmath.radians(theta)), eta)
        yield f"{eta.real:g}", f"{eta.imag:g}", theta, (1 - a, 6), (-b / (1 - a), 6)


def planck(um, kelvin):
    """W m-2 sr-1 um-1 with the SI's h, c, k."""
    h, c, k = mpmath.mpf("6.62607015e-34"), mpmath.mpf(299792458), mpmath.mpf("1.380649e-23")
    x = mpmath.mpf(um) * mpmath.mpf("1e-6")
    return 2 * h * c ** 2 / x ** 5 / mpmath.expm1(h * c / (x * k * kelvin)) * mpmath.mpf("1e-6")
