"""Rough surfaces of microfacets (microfacet.md 3-6, lobes.md): masking, lobes, albedos."""

import math
from functools import lru_cache

import mpmath
import numpy as np

from interfaces import NM, TABLE_1, factors, mean_reflectance
from quadrature import converged, nodes

DEGREE = np.pi / 180


class BlinnPhong:
    """D of microfacet.md 3 and its masking, by quadrature."""

    def __init__(self, m):
        self.m, self.width = m, 1 / np.sqrt(m + 2)
        self.edge = min(np.pi / 2, 9 * self.width)  # beyond it D is below 1e-17 of its peak
        self.series = None

    def density(self, cosine):
        return (self.m + 2) / (2 * np.pi) * np.where(cosine > 0, cosine, 0) ** self.m

    def masking_at(self, angles, order):
        """P at angles from the normal (microfacet.md 4). Over azimuth max(a + b cos, 0) is closed."""
        angles = np.atleast_1d(np.asarray(angles, dtype=float))
        kink = np.clip(np.pi / 2 - angles, 0, self.edge)
        # Beyond the kink the integrand goes with the 3/2nd power of the distance: squares of t.
        t, w = nodes(np.array([0.0, 1.0]), order)
        rest = (self.edge - kink)[:, None]
        theta = np.hstack([kink[:, None] * t, kink[:, None] + rest * t * t])
        weight = np.hstack([kink[:, None] * w, rest * 2 * t * w])
        a = np.cos(theta) * np.cos(angles)[:, None]
        b = np.sin(theta) * np.sin(angles)[:, None]
        half = np.arccos(np.clip(-a / np.maximum(b, 1e-300), -1, 1))
        ring = 2 * (a * half + b * np.sin(half))
        total = np.sum(self.density(np.cos(theta)) * ring * np.sin(theta) * weight, axis=1)
        return np.cos(angles) / total

    def masking(self, cosine):
        """The same as a Chebyshev series of the angle; P/cos is smooth up to 90 deg."""
        if self.series is None:
            degree = int(80 + 4 * np.sqrt(self.m))
            angles, self.series = chebyshev(degree), True
            over = self.masking_at(angles, 120) / np.cos(angles)
            self.series = np.polynomial.chebyshev.chebfit(4 * angles / np.pi - 1, over, degree)
            check = np.pi / 2 * (np.arange(1, 40) / 40.5)
            error = np.abs(self.masking(np.cos(check)) - self.masking_at(check, 180))
            assert np.max(error) < 2e-9, self.m
        return evaluate(self.series, cosine) * cosine


class Beckmann:
    """D and P of lobes.md 2."""

    def __init__(self, alpha):
        self.alpha, self.width = alpha, alpha / np.sqrt(2)
        self.edge = np.arctan(6.5 * alpha)

    def density(self, cosine):
        square = (1 / np.maximum(cosine, 1e-9)) ** 2
        return np.exp(-(square - 1) / self.alpha ** 2) * square ** 2 / (np.pi * self.alpha ** 2)

    def masking(self, cosine):
        cosine = np.clip(cosine, 1e-12, 1)
        a = np.maximum(cosine, 1e-9) / (self.alpha * np.maximum(np.sqrt(1 - cosine ** 2), 1e-9))
        rest = (np.vectorize(math.erf)(a) - 1) / 2 + np.exp(-a * a) / (2 * a * np.sqrt(np.pi))
        return 1 / (1 + rest)


def chebyshev(degree):
    """Angles between 0 and 90 deg at which a series of that degree is fitted."""
    return np.pi / 4 * (1 + np.cos(np.pi * (np.arange(degree + 1) + .5) / (degree + 1)))


def evaluate(series, cosine):
    angle = np.arccos(np.clip(cosine, 0, 1))
    return np.polynomial.chebyshev.chebval(4 * angle / np.pi - 1, series)


@lru_cache(maxsize=None)
def blinn_phong(m):
    return BlinnPhong(m)


def joint(shadowing, p_l, p_v, cos_phi):
    """G of both directions (microfacet.md, table of shadowings)."""
    if shadowing == "separable":
        return p_l * p_v
    if shadowing == "smith":
        return p_l * p_v / (p_l + p_v - p_l * p_v)
    t = np.sqrt(np.maximum(0, (1 + cos_phi) / 2))
    return (1 - t) * p_l * p_v + t * np.minimum(p_l, p_v)


def weight(m, shadowing, theta_l, theta_v, phi):
    """f_s / F (microfacet.md 5); radians."""
    l = np.array([np.sin(theta_l), 0, np.cos(theta_l)])
    v = np.array([np.sin(theta_v) * np.cos(phi), np.sin(theta_v) * np.sin(phi), np.cos(theta_v)])
    h = (l + v) / np.linalg.norm(l + v)
    lobe = blinn_phong(m)
    p_l, p_v = lobe.masking_at([theta_l, theta_v], 180)
    return lobe.density(h[2]) * joint(shadowing, p_l, p_v, np.cos(phi)) / (4 * l[2] * v[2])


def once(lobe, shadowing, theta, reflect, order):
    """int f_s cos dw over the observer: over half vectors, where 4 (h.l) dw_h = dw_v.

    n.v > 0 up to the angle that atan gives below; n.v = n.l, where the smaller of two maskings
    changes, at that of d."""
    phi, w_phi = nodes(np.array([0, np.pi / 2, np.pi]), order)
    d = np.arctan2(np.sin(theta) * np.cos(phi), np.cos(theta))
    last = np.minimum((d + np.pi / 2) / 2, lobe.edge)
    middle = np.clip(d, 0, last)
    width = np.minimum(3 * lobe.width, last)
    points = np.sort(np.stack([np.zeros_like(d), np.minimum(width, middle), middle,
                               np.maximum(middle, width), last], axis=-1), axis=-1)
    t, w_t = nodes(points, order)
    s, c, cos_phi = np.sin(t), np.cos(t), np.cos(phi)[:, None]
    h_l = np.cos(theta) * c + np.sin(theta) * s * cos_phi
    n_v = np.maximum(2 * h_l * c - np.cos(theta), 1e-300)
    # Azimuth between the projections of l (along x) and v = 2 (h.l) h - l.
    x, y = 2 * h_l * s * cos_phi - np.sin(theta), 2 * h_l * s * np.sin(phi)[:, None]
    between = x / np.maximum(np.hypot(x, y), 1e-300)
    g = joint(shadowing, lobe.masking(np.cos(theta)), lobe.masking(n_v), between)
    flux = lobe.density(c) * g * h_l / np.cos(theta) * s * w_t * w_phi[:, None] * 2
    return np.array([np.sum(flux * f(h_l)) for f in reflect])


def furnace(lobe, shadowing, theta, digits=4):
    return converged(lambda n: once(lobe, shadowing, theta, [np.ones_like], n), digits)[0]


class Albedo:
    """R(k) for several reflectances, as Chebyshev series of the angle, and the means 2 int R mu dmu."""

    def __init__(self, lobe, shadowing, reflect, degree):
        angles = chebyshev(degree)
        values = np.array([once(lobe, shadowing, a, reflect, 54) for a in angles])
        self.series = np.polynomial.chebyshev.chebfit(4 * angles / np.pi - 1, values, degree)
        mu, w = nodes(np.array([0, .02, .1, .3, 1]), 40)
        self.mean = np.array([np.sum(2 * mu * w * self(mu, k)) for k in range(len(reflect))])

    def __call__(self, cosine, k=0):
        return evaluate(self.series[:, k], cosine)


def interface_reflectances(name):
    return [lambda c, eta=eta: factors(c, eta)[0] for eta in TABLE_1[name]]


@lru_cache(maxsize=None)
def silicon(m):
    """R of a-Si, three bands, ashikhmin."""
    return Albedo(blinn_phong(m), "ashikhmin", interface_reflectances("paper_asi"),
                  degree=40 if m > 50 else 24)


@lru_cache(maxsize=None)
def white(m):
    return Albedo(blinn_phong(m), "ashikhmin", [np.ones_like], degree=24)


def between_facets(m, eta):
    """f_ms as a function of two cosines (lobes.md 9)."""
    e, f = white(m), float(mean_reflectance(eta))
    mean = e.mean[0]
    factor = f * f * mean / (1 - f * (1 - mean))
    return lambda l, v: factor * (1 - e(l)) * (1 - e(v)) / (np.pi * (1 - mean))


# ---- tables

def masking_rows():
    for m in (1, 10, 200):
        for theta in (30, 60, 75, 85, 89):
            value = converged(lambda n: blinn_phong(m).masking_at([theta * DEGREE], n), 6)[0]
            yield m, theta, (value, 6)


def other_masking_rows():
    """Beckmann and GGX (lobes.md 2, 3); the last two as wide as Blinn-Phong of m = 10 and 200."""
    for alpha, angles in ((.4, (45, 75, 85)), (.408248, (75,)), (.0995037, (85,))):
        for theta in angles:
            a = 1 / (mpmath.mpf(alpha) * mpmath.tan(mpmath.radians(theta)))
            rest = (mpmath.erf(a) - 1) / 2 + mpmath.exp(-a * a) / (2 * a * mpmath.sqrt(mpmath.pi))
            yield "beckmann", f"{alpha:g}", theta, (1 / (1 + rest), 6)
    for theta in (45, 75, 85):
        slope = mpmath.mpf(".4") * mpmath.tan(mpmath.radians(theta))
        yield "ggx", ".4", theta, (2 / (1 + mpmath.sqrt(1 + slope ** 2)), 6)


def weight_rows():
    for m, shadowing, l, v, phi, digits in (
            (0, "separable", 30, 60, 90, 8), (10, "ashikhmin", 60, 60, 180, 8),
            (10, "smith", 60, 60, 180, 8), (10, "ashikhmin", 30, 60, 90, 8),
            (10, "ashikhmin", 70, 70, 0, 8), (10, "smith", 70, 70, 0, 8),
            (200, "ashikhmin", 30, 30, 180, 8), (200, "ashikhmin", 60, 60, 180, 8)):
        yield m, shadowing, l, v, phi, (weight(m, shadowing, l * DEGREE, v * DEGREE, phi * DEGREE), digits)


def furnace_rows():
    for m, shadowing in ((0, "ashikhmin"), (0, "smith"), (1, "ashikhmin"), (4, "ashikhmin"),
                         (10, "ashikhmin"), (10, "smith"), (50, "ashikhmin"), (200, "ashikhmin"),
                         (1000, "ashikhmin"), (10000, "ashikhmin")):
        for theta in (0, 30, 60, 75, 85, 89.5):
            yield m, shadowing, theta, (furnace(blinn_phong(m), shadowing, theta * DEGREE), 4)


def body_rows():
    """Unpolarized body light (microfacet.md 6): a-Si, 550 nm, m = 200, R_sub = .1."""
    r = silicon(200)
    for l, v in ((0, 0), (30, 60), (60, 60)):
        f = .1 * (1 - r(np.cos(l * DEGREE), 1)) * (1 - r(np.cos(v * DEGREE), 1)) / (np.pi * (1 - r.mean[1]))
        yield l, v, (f, 6)


def polarized_body(eta, r_sub, theta_l, theta_v, phi):
    """I, Q, U of unpolarized light (lobes.md 8); degrees."""
    l_angle, v_angle, phi = (np.deg2rad(x) for x in (theta_l, theta_v, phi))
    l = np.array([np.sin(l_angle), 0, np.cos(l_angle)])
    v = np.array([np.sin(v_angle) * np.cos(phi), np.sin(v_angle) * np.sin(phi), np.cos(v_angle)])
    s = np.cross(v, l)
    s = s / np.linalg.norm(s)
    across = np.cross([0, 0, 1], v)
    psi = np.arctan2(across @ np.cross(v, s), across @ s)
    entering = 1 - factors(l[2], eta)[0]
    leaving, difference = 1 - factors(v[2], eta)[0], -factors(v[2], eta)[1]
    scale = r_sub / (np.pi * (1 - float(mean_reflectance(eta)))) * entering
    return scale * leaving, scale * difference * np.cos(2 * psi), scale * difference * np.sin(2 * psi)


def polarized_body_rows():
    for phi in (0, 90, 180):
        i, q, u = polarized_body(TABLE_1["paper_asi"][1], .1, 30, 60, phi)
        yield 30, 60, phi, (i, 7), (q, 7), (abs(u), 7)


def exponent_at(m, nm, hurst=.8, reference=550):
    """m(lambda) of a self-affine surface (lobes.md 10)."""
    return (m + 2) * (nm / reference) ** (2 * (1 - hurst) / hurst) - 2


def exponent_rows():
    for m in (10, 100, 1000):
        yield m, (exponent_at(m, 425), 3), (exponent_at(m, 650), 3)


def colour_rows():
    """I(425)/I(650) of rough gold in plane, source at 60 deg, observer on the mirror's side."""
    for m in (10, 100, 1000):
        for theta in (0, 20, 40, 50, 60, 70, 80):
            cosine = np.cos((60 + theta) * DEGREE / 2)
            light = [weight(exponent_at(m, nm), "ashikhmin", 60 * DEGREE, theta * DEGREE, np.pi)
                     * factors(cosine, eta)[0]
                     for nm, eta in ((425, TABLE_1["paper_au"][0]), (650, TABLE_1["paper_au"][2]))]
            ratio = light[0] / light[1]
            yield m, theta, (ratio, 5) if ratio < 1e4 else (ratio, "6g")


def polished_rows():
    """Share of a polished surface that is a mirror: sigma = 50 nm at 60 deg (lobes.md 11)."""
    for nm in NM:
        yield nm, (np.exp(-(2 * np.pi * 50 * 2 * np.cos(60 * DEGREE) / nm) ** 2), 6)
