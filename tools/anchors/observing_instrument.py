"""Telescopes, detectors and polarimeters (docs/theory/observing.md 3 and 4), from fields, sums and integrals."""

import tomllib
from math import erf

import numpy as np

from passbands import AB_ZERO, DATA, PLANCK, points, trapezoid

DEGREE = np.pi / 180
STOKES = np.array([1, .2, -.1, .05])


# Polarimeters: Jones matrices, turned into Mueller matrices by their action on the six pure states.
def turn(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s], [-s, c]], dtype=complex)


def jones(tx, ty, retardance, angle):
    """exp(-i omega t): a delay is a positive phase; y lags where the retardance is positive."""
    own = np.diag([np.sqrt(tx), np.sqrt(ty) * np.exp(1j * retardance)])
    return turn(-angle) @ own @ turn(angle)


def stokes_of(coherency):
    """V > 0 turns counter-clockwise as seen against the light with exp(-i omega t): V = 2 Im(Ex* Ey)."""
    j = coherency
    return np.array([(j[0, 0] + j[1, 1]).real, (j[0, 0] - j[1, 1]).real, 2 * j[0, 1].real, -2 * j[0, 1].imag])


PAULI = [np.eye(2), np.diag([1, -1]), np.array([[0, 1], [1, 0]]), np.array([[0, -1j], [1j, 0]])]


def mueller(element):
    columns = [stokes_of(element @ (p / 2) @ element.conj().T) for p in PAULI]
    return np.array(columns).T


def polarizer(extinction, degrees):
    return mueller(jones(1, 1 / extinction, 0, degrees * DEGREE))


def plate(retardance, degrees):
    return mueller(jones(1, 1, retardance * DEGREE, degrees * DEGREE))


def beams(theta, retardance=180, extinction=np.inf, gain=(1, 1), sky=1):
    return [gain[k] * sky * (polarizer(extinction, 90 * k) @ plate(retardance, theta))[0] @ STOKES for k in (0, 1)]


def plate_cases():
    def ratio(a, b):
        r = np.sqrt(a[0] / a[1] * b[1] / b[0])
        return (r - 1) / (r + 1)

    def difference(a, b):
        return sum((x[0] - x[1]) / (x[0] + x[1]) * s for x, s in ((a, .5), (b, -.5)))

    for name, options, skies in (("gains", {"gain": (.95, 1.05)}, (1, .8, .9, 1.1)),
                                 ("retardance", {"retardance": 185}, (1, 1, 1, 1)),
                                 ("extinction", {"extinction": 300}, (1, 1, 1, 1))):
        n = [beams(t, sky=s, **options) for t, s in zip((0, 45, 22.5, 67.5), skies)]
        yield f"{name}_ratio", ratio(n[0], n[1]), ratio(n[2], n[3])
        yield f"{name}_difference", difference(n[0], n[1]), difference(n[2], n[3])
    n = [beams(t + .5) for t in (0, 45, 22.5, 67.5)]
    yield "plate_zero_ratio", ratio(n[0], n[1]), ratio(n[2], n[3])


def scheme(retardance, angles):
    rows = np.array([(polarizer(np.inf, 0) @ plate(retardance, a))[0] for a in angles])
    s = np.linalg.svd(rows, compute_uv=False)
    return s[0] / s[-1], np.trace(np.linalg.inv(rows.T @ rows))


def bessel(order, x):
    """J of whole order, by its integral (DLMF 10.9.2): trapezoids of a period converge faster than any power."""
    t = np.pi * (np.arange(200) + .5) / 200
    return np.mean(np.cos(order * t - x * np.sin(t)))


def modulator(amplitude, bins=8):
    """Rows of each part of the period, by the series of Jacobi and Anger, every harmonic averaged over the part:
    cos(d sin t) = J0 + 2 J2 cos 2t + ..., sin(d sin t) = 2 J1 sin t + 2 J3 sin 3t + ..."""
    for b in range(bins):
        middle, half = 2 * np.pi * (b + .5) / bins, np.pi / bins
        term = lambda m, f: 2 * bessel(m, amplitude) * f(m * middle) * np.sin(m * half) / (m * half)  # noqa: E731
        q = bessel(0, amplitude) + sum(term(m, np.cos) for m in range(2, 40, 2))
        yield b, q / 2 / bins, sum(term(m, np.sin) for m in range(1, 40, 2)) / 2 / bins


def rakic():
    """Aluminium of data/nk at the wavelengths of the tests, linear between its points."""
    import pathlib
    rows = []
    for line in (pathlib.Path(__file__).resolve().parents[2] / "data/nk/Al_Rakic.yml").read_text().splitlines():
        cells = line.split()
        try:
            rows.append([float(c) for c in cells]) if len(cells) == 3 else None
        except ValueError:
            continue
    t = np.array(rows).T
    return lambda nm: np.interp(nm / 1000, t[0], t[1]) + 1j * np.interp(nm / 1000, t[0], t[2])


def mirror(eta, incidence):
    """Fresnel's amplitudes with s and p right-handed in both beams."""
    c = np.cos(incidence)
    q = np.sqrt(eta ** 2 - np.sin(incidence) ** 2)
    return mueller(np.diag([(c - q) / (c + q), (eta ** 2 * c - q) / (eta ** 2 * c + q)]))


def mosaic(x, y, fwhm):
    """Light of a star in each sub-lattice: a Gaussian image, summed pixel by pixel."""
    from math import erf
    s = fwhm / np.sqrt(8 * np.log(2)) * np.sqrt(2)
    edges = np.arange(61) - 30.5
    fx = np.diff([erf((e - x) / s) for e in edges])
    fy = np.diff([erf((e - y) / s) for e in edges])
    n = {(b, a): fy[a::2].sum() * fx[b::2].sum() for a in (0, 1) for b in (0, 1)}  # pixel -30 is even
    n90, n45, n135, n0 = n[0, 0], n[1, 0], n[0, 1], n[1, 1]
    return (n0 - n90) / (n0 + n90), (n45 - n135) / (n45 + n135)


def boxed(fwhm, half):
    """False q of a star on a mosaic in a box that follows it, over its phases: root mean square, and the largest."""
    from math import erf
    s = fwhm / np.sqrt(8 * np.log(2)) * np.sqrt(2)

    def along(x):
        """Light of even and of odd pixels within the box."""
        pixels = [k for k in range(48) if abs(k - x) <= half]
        return [sum((erf((k + .5 - x) / s) - erf((k - .5 - x) / s)) / 2 for k in pixels if k % 2 == odd) for odd in (0, 1)]

    places = [along(24 + k / 8) for k in range(17)]
    q = np.array([(y[1] * x[1] - y[0] * x[0]) / (y[1] * x[1] + y[0] * x[0]) for x in places for y in places])
    return np.sqrt(np.mean(q ** 2)), np.max(np.abs(q))


# Telescope and detector.
def moffat_share(radius, beta=4.765):
    """Radial integral of the profile, in full widths."""
    scale = 4 * (2 ** (1 / beta) - 1)
    profile = lambda r: r * (1 + scale * r * r) ** -beta  # noqa: E731
    x, w = np.polynomial.legendre.leggauss(200)
    inside = np.sum(w * profile((x + 1) / 2 * radius)) * radius / 2
    t = (x + 1) / 2  # r = t/(1 - t) beyond
    whole = np.sum(w / 2 * profile(t / (1 - t)) / (1 - t) ** 2)
    return inside / whole


def seeing(outer=np.inf):
    free = 2 ** .6 * (650 / 500) ** -.2
    r0 = .976 * 650e-9 / (free * DEGREE / 3600)
    return free * np.sqrt(1 - 2.183 * (r0 / outer) ** .356)


def excess(gain, stages=536):
    return 2 * (gain - 1) * gain ** (-(stages + 1) / stages) + 1 / gain


def ccd(star, pixels, sky, dark, read, step, ring=np.inf, f2=1, gain=1):
    each = f2 * (sky + dark) + (read / gain) ** 2 + (step / gain) ** 2 / 12
    return f2 * star + pixels * each * (1 + pixels / ring)


def bent_polarization(q=.05, kappa=.02):
    """What two beams at a full well tell of q by numbers that bend."""
    n = np.array([1 + q, 1 - q])
    n = n * (1 - kappa * n)
    return (n[0] - n[1]) / (n[0] + n[1])


def trail_box(length=11, around=2):
    """Light of a trail of a Gaussian (sigma 1 px) in a box of two pixels around it."""
    share = lambda a, b: .5 * (erf(b / 2 ** .5) - erf(a / 2 ** .5))  # noqa: E731
    steps = 4000
    along = np.mean([share(-around - s, length + around - s) for s in (np.arange(steps) + .5) * length / steps])
    return along * share(-around, around)


def trail_share(profile, radius, length):
    """Light of an image that runs evenly along a length, within a radius of its path, in full widths: sums over the run, across it
    and along it, by Gauss' rule."""
    x, w = np.polynomial.legendre.leggauss(120)
    total = 0
    for y, wy in zip(x * radius, w * radius):
        half = np.sqrt(radius ** 2 - y ** 2)
        for s, ws in zip((x + 1) / 2 * length, w / 2):  # the mean over the run
            # Light beside the point, on both sides apart: it is sharp there.
            for reach in (s + half, length + half - s):
                u, wu = (x + 1) / 2 * reach, w / 2 * reach
                total += wy * ws * np.sum(wu * profile(np.hypot(u, y)))
    return total


def gauss_profile(r):
    return 4 * np.log(2) / np.pi * np.exp(-4 * np.log(2) * r ** 2)


def moffat_profile(r, beta=4.765):
    scale = 4 * (2 ** (1 / beta) - 1)
    return scale * (beta - 1) / np.pi * (1 + scale * r ** 2) ** -beta


def trail_peak(profile, length):
    """Light in a small square on the middle of a trail, over its area in square widths."""
    x, w = np.polynomial.legendre.leggauss(300)
    return np.sum(w / 2 * profile(np.abs(x) * length / 2))


def zero_points():
    """AB magnitude of one electron a second in V, without air and polarizers, of each instrument's file."""
    nm, response, _ = points("Bessell.V")
    photons = AB_ZERO / PLANCK * trapezoid(response / nm, nm)
    for path in sorted((DATA / "instruments").glob("*.toml")):
        t = tomllib.loads(path.read_text())["telescope"]
        area = np.pi / 4 * t["aperture_m"] ** 2 * (1 - t.get("obstruction", 0) ** 2)
        yield path.stem, 2.5 * np.log10(area * t["throughput"] * photons)


def panel_error(exposure, panel):
    """Worst error of three Gauss points per panel for a Gaussian flash of unit width, over its largest mean."""
    from math import erf
    s = 1 / np.sqrt(8 * np.log(2))
    n = int(np.ceil(exposure / panel - 1e-9))
    x, w = np.polynomial.legendre.leggauss(3)
    middles = (np.arange(n) + .5) * exposure / n - exposure / 2
    nodes = (middles[:, None] + x * exposure / n / 2).ravel()
    weights = np.tile(w / 2 / n, n)
    at = np.linspace(-exposure / 2 - 2, exposure / 2 + 2, 4001)
    exact = np.array([erf((exposure / 2 - a) / s / np.sqrt(2)) + erf((exposure / 2 + a) / s / np.sqrt(2)) for a in at])
    exact *= s * np.sqrt(2 * np.pi) / 2 / exposure
    found = np.exp(-(nodes[:, None] - at) ** 2 / 2 / s ** 2).T @ weights
    return np.abs(found - exact).max() / exact.max()


def rows():
    """name, formula, value."""
    four = "observing.md 4"
    for e in (300, 100):
        yield f"diattenuation_{e}", four, ((e - 1) / (e + 1), "9g")
    yield "polarizer_300_30", four, (polarizer(300, 30)[0] @ STOKES, "9g")
    for name, q, u in plate_cases():
        yield f"{name}_q", four, (q, "9g")
        yield f"{name}_u", four, (u, "9g")
    for name, retardance, angles in (("balanced", 131.8, (-51.69, -15.12, 15.12, 51.69)),
                                     ("rounded", 132, (-51.7, -15.1, 15.1, 51.7)),
                                     ("quarter", 90, tuple(22.5 * k for k in range(8)))):
        condition, weighted = scheme(retardance, angles)
        yield f"{name}_condition", four, (condition, "9g")
        yield f"{name}_variance", four, (weighted, "9g")
    dark = 137.786355 * DEGREE  # the first zero of J0, as umov has it
    for order in (1, 2):
        yield f"modulator_j{order}", four, (bessel(order, dark), "9g")
    for name, amplitude in (("dark", dark), ("quarter", np.pi / 2)):
        for b, q, v in modulator(amplitude):
            yield f"modulator_{name}_{b}_q", four, (q, "9g")
            yield f"modulator_{name}_{b}_v", four, (v, "9g")
    for state, angle in (("a", 7), ("b", 52)):  # half of the time each
        for k, name in enumerate("ox"):
            row = (polarizer(300, 90 * k) @ plate(170, angle))[0] / 2
            for j in range(4):
                yield f"flip_{name}{state}_{j}", four, (row[j], "9g")
    al = rakic()
    for nm in (425, 550, 650):
        m = mirror(al(nm), 45 * DEGREE)
        yield f"aluminium_q_{nm}", four, (m[1, 0] / m[0, 0], "9g")
        yield f"aluminium_u_to_v_{nm}", four, (m[3, 2] / m[0, 0], "9g")
        yield f"aluminium_retardance_{nm}", four, (np.arctan2(m[3, 2], m[2, 2]) / DEGREE, "9g")
    chi = mueller(turn(25 * DEGREE))
    light = mirror(al(550), 45 * DEGREE) @ chi
    for name, angle in (("o", 0), ("x", 90)):
        row = (polarizer(300, angle) @ plate(183, 23) @ light)[0]
        for k in range(4):
            yield f"chain_{name}_{k}", four, (row[k], "9g")
        yield f"chain_{name}_light", four, (row @ STOKES, "9g")
    for fwhm in (1.5, 2, 2.5, 3):
        yield f"mosaic_q_{fwhm:g}", four, (mosaic(0, 0, fwhm)[0], "9g")
    for k, name in ((0, "q"), (1, "u")):
        yield f"mosaic_off_{name}", four, (mosaic(.3, .1, 2)[k], "9g")
    for fwhm, half in ((3, 4), (3, 6), (4, 6), (4, 8)):
        for name, value in zip(("rms", "worst"), boxed(fwhm, half)):
            yield f"box_{fwhm}_{half}_{name}", four, (value, "9g")
    three = "observing.md 3"
    yield "area_c11", three, (np.pi / 4 * .2794 ** 2 * (1 - .34 ** 2), "9g")
    for radius in (.5, 1, 1.5):
        yield f"moffat_{radius:g}", three, (moffat_share(radius), "9g")
    yield "seeing", three, (seeing(), "9g")
    yield "seeing_outer", three, (seeing(25), "9g")
    for gain in (10, 100, 1000):
        yield f"excess_{gain}", three, (excess(gain), "9g")
    yield "ccd", three, (ccd(1e4, 50, 20, .5, 2.3, 2.6, 500), "9g")
    yield "emccd", three, (ccd(1e4, 50, 20, .5, 60, 10, 500, excess(300), 300), "9g")
    doubled = ccd(1e4, 50, 20, .5, 60, 10, 500, 2, 300)  # of an endless register of an endless gain
    yield "emccd_doubled", three, (doubled, "9g")
    yield "emccd_doubled_snr", three, (1e4 / np.sqrt(doubled), "9g")
    yield "faint_emccd_doubled", three, (40 / np.sqrt(ccd(40, 9, .1, .01, 60, 10, f2=2, gain=300)), "9g")
    for name, read, step, register in (("cmos", 1.4, .45, 1), ("emccd", 60, 10, 300), ("ccd", 7, 1, 1)):
        noise = np.sqrt(ccd(40, 9, .1, .01, read, step, f2=excess(register), gain=register))
        yield f"faint_{name}", three, (40 / noise, "9g")
    yield "bent", three, (9000 * (1 - .02 * 9000 / 10500), "9g")
    yield "bent_q", three, (bent_polarization(), "9g")
    yield "trail_box", three, (trail_box(), "7g")
    # .5 deg/s over 16 arcsec a pixel in .1 s.
    yield "trail_lens_px", three, (.5 * 3600 * .1 / 16, "9g")
    yield "trail_lens_box", three, (trail_box(.5 * 3600 * .1 / 16), "7g")
    for name, profile in (("gauss", gauss_profile), ("moffat", moffat_profile)):
        for radius, length in ((.5, 1), (1, 3), (2, 10)):
            yield f"trail_{name}_{radius:g}_{length}", three, (trail_share(profile, radius, length), "7g")
        for length in (1, 10):
            yield f"trail_{name}_peak_{length}", three, (trail_peak(profile, length), "9g")
    for name, zero in zero_points():
        yield f"zero_point_{name}", three, (zero, "9g")
    yield "dead_time", three, (1e6 / 1.05, "9g")
    yield "prolonged", three, (1e6 * np.exp(-.05), "9g")
    for exposure in (.5, 1, 2, 5):
        yield f"panel_{exposure:g}", three, (panel_error(exposure, 1), "4g")
        yield f"half_panel_{exposure:g}", three, (panel_error(exposure, .5), "4g")
