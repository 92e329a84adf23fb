"""Air, sky and stars that twinkle (docs/theory/observing.md 2), from the published formulas."""

import pathlib
from math import gamma

import numpy as np

import passbands

DEGREE = np.pi / 180
MAGNITUDE = 2.5 / np.log(10)
ROOT = pathlib.Path(__file__).resolve().parents[2]
SEA_LEVEL = 1013.25  # hPa


def gases():
    lines = (ROOT / "data/air/bird_riordan_1984.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")][1:]
    return np.array(rows, dtype=float).T


GASES = gases()


def pressure(height):
    return SEA_LEVEL * (1 - 2.25577e-5 * height) ** 5.25588


def molecules(nm, hpa):
    square = (nm / 1000) ** 2
    top = 1.0455996 - 341.29061 / square - .90230850 * square
    return .0021520 * top / (1 + .0027059889 / square - 85.968563 * square) * hpa / SEA_LEVEL


def extinction(nm, hpa, aerosol=.02, exponent=1.3, ozone=260):
    depth = molecules(nm, hpa) + aerosol * (nm / 550) ** -exponent
    return MAGNITUDE * (depth + np.interp(nm, GASES[0], GASES[2]) * ozone / 1000)


def water(nm, cm, airmass):
    x = np.interp(nm, GASES[0], GASES[1]) * cm * airmass
    return np.exp(-.2385 * x / (1 + 20.07 * x) ** .45)


def mixed(nm, hpa, airmass):
    x = np.interp(nm, GASES[0], GASES[3]) * airmass * hpa / SEA_LEVEL
    return np.exp(-1.41 * x / (1 + 118.3 * x) ** .45)


def refractivity(nm, hpa, kelvin, water_hpa):
    """Filippenko 1982, Eqs. 1-3, in mm of mercury and degrees Celsius."""
    mm, vapour, t = hpa * .750061683, water_hpa * .750061683, kelvin - 273.15
    s = (1000 / nm) ** 2
    n = 64.328 + 29498.1 / (146 - s) + 255.4 / (41 - s)
    n *= mm * (1 + (1.049 - .0157 * t) * 1e-6 * mm) / (720.883 * (1 + .003661 * t))
    return (n - (.0624 - .000680 * s) / (1 + .003661 * t) * vapour) * 1e-6


def refraction(nm, zenith_deg, *air):
    n = 1 + refractivity(nm, *air)
    return (n * n - 1) / (2 * n * n) * np.tan(zenith_deg * DEGREE) / DEGREE * 3600


def airmass(altitude_deg):
    return 1 / (np.sin(altitude_deg * DEGREE) + .50572 * (altitude_deg + 6.07995) ** -1.6364)


def horizontal(azimuth, altitude):
    a, h = azimuth * DEGREE, altitude * DEGREE
    return np.array([np.cos(h) * np.sin(a), np.cos(h) * np.cos(a), np.sin(h)])


def sky(source, place, dilution, rho=.0279):
    """Degree and angle from the zenith of once scattered light, by Stokes axes of the celestial sphere."""
    to_source, to_place = horizontal(*source), horizontal(*place)
    c = to_source @ to_place
    degree = dilution * (1 - rho) * (1 - c * c) / (1 + rho + (1 - rho) * c * c)
    normal = np.cross(to_source, to_place)
    north = np.array([0, 0, 1.]) - to_place[2] * to_place
    east = np.cross(north, to_place)  # seen against the light it lies to the left: smaller azimuth
    return degree, np.arctan2(normal @ east, normal @ north) / DEGREE % 180


def moonlight(phase, separation, zenith_moon, zenith, k):
    """Krisciunas & Schaefer 1991, Eqs. 3, 15, 20, 21."""
    layer = lambda z: 1 / np.sqrt(1 - .96 * np.sin(z * DEGREE) ** 2)  # noqa: E731
    moon = 10 ** (-.4 * (3.84 + .026 * phase + 4e-9 * phase ** 4))
    scattered = 10 ** 5.36 * (1.06 + np.cos(separation * DEGREE) ** 2) + 10 ** (6.15 - separation / 40)
    return scattered * moon * 10 ** (-.4 * k * layer(zenith_moon)) * (1 - 10 ** (-.4 * k * layer(zenith)))


def scintillation(diameter, seconds, mass, height, c_y):
    return np.sqrt(1e-5 * c_y ** 2 * diameter ** (-4 / 3) / seconds * mass ** 3 * np.exp(-height / 4000))


def wind_crossing(diameter, wind=20):
    """Exposure at which the variance of long exposures reaches that of short ones behind a round pupil, of one layer of
    Kolmogorov's turbulence: the irradiance's spectrum goes with f^(1/3), the pupil filters by (2 J1(x)/x)^2, x = pi D f, and a
    long exposure takes its section across the wind. Integrals of J1(x)^2 x^-l by Weber and Schafheitlin (DLMF 10.22.57)."""
    squared = lambda l: gamma(l) * gamma((3 - l) / 2) / (2 ** l * gamma((1 + l) / 2) ** 2 * gamma((3 + l) / 2))  # noqa: E731
    short = 2 * np.pi * (np.pi * diameter) ** (-7 / 3) * squared(2 / 3)
    long = 2 / wind * (np.pi * diameter) ** (-4 / 3) * squared(5 / 3)
    return long / short


def band_extinction(name, hpa, water_cm, mass):
    """Magnitudes of sunlight in a band, summed over all points of curve and sunlight."""
    nm, response, sun = passbands.points(name)
    light = response * sun * nm
    through = 10 ** (-.4 * extinction(nm, hpa) * mass) * water(nm, water_cm, mass) * mixed(nm, hpa, mass)
    return -2.5 * np.log10(passbands.trapezoid(light * through, nm) / passbands.trapezoid(light, nm))


TWILIGHT = {"B": (11.84, 1.411, -.041), "V": (11.84, 1.518, -.057), "R": (11.40, 1.567, -.064)}


def rows():
    """name, formula, value."""
    for height in (1000, 3058, 4160):
        yield f"pressure_{height}", "observing.md 2", (pressure(height), "9g")
    for nm in (400, 550, 700, 900):
        yield f"rayleigh_{nm}", "observing.md 2", (molecules(nm, SEA_LEVEL), "9g")
    for nm in (425, 550, 600, 650, 850):
        yield f"extinction_{nm}", "observing.md 2", (extinction(nm, pressure(3058)), "9g")
    yield "water_720", "observing.md 2", (water(720, .3, 2), "9g")
    yield "mixed_760", "observing.md 2", (mixed(760, 700, 2), "9g")
    for band in ("Bessell.B", "Bessell.V", "Bessell.I", "gaia.G"):
        for altitude, mass in ((90, 1), (30, airmass(30)), (10, airmass(10))):
            yield f"band_{band}_{altitude}", "observing.md 2", (band_extinction(band, pressure(3058), .3, mass), "8g")
    for altitude in (60, 30, 10, 5):
        yield f"airmass_{altitude}", "observing.md 2", (airmass(altitude), "9g")
    air = (693.28, 293.15, 10.67)
    yield "refraction_60", "observing.md 2", (refraction(550, 60, *air), "9g")
    for blue, red in ((425, 550), (550, 650), (400, 700)):
        dispersion = refraction(blue, 60, *air) - refraction(red, 60, *air)
        yield f"dispersion_{blue}_{red}", "observing.md 2", (dispersion, "9g")
    for name, source, place in (("sky_a", (270, -6), (180, 45)),
                                ("sky_b", (253.969112, -14.897084), (140.523474, 55.844337))):
        degree, angle = sky(source, place, .8)
        yield f"{name}_p", "observing.md 2", (degree, "9g")
        yield f"{name}_axis_deg", "observing.md 2", (angle, "9g")
    for band, (a, b, c) in TWILIGHT.items():
        for zenith in (96, 100, 104):
            x = zenith - 95
            yield f"twilight_{band}_{zenith}", "observing.md 2", (a + b * x + c * x * x, "9g")
    yield "moonlight_nl", "observing.md 2", (moonlight(30, 60, 40, 30, .172), "9g")
    yield "dark_nl", "observing.md 2", (34.08 * np.exp(20.7233 - .92104 * 21.587), "9g")
    for name, case in (("c11", (.2794, 1, 1.5, 3058, 1.5)), ("metre", (1, .1, 1, 3058, 1.63)),
                       ("lens", (.071, .1, 1, 2030, 1.5))):
        yield f"scintillation_{name}", "observing.md 2", (scintillation(*case), "9g")
    yield "wind_crossing_c11", "observing.md 2", (wind_crossing(.2794), "9g")
    still = scintillation(.2794, wind_crossing(.2794), 1.5, 3058, 1.5)
    yield "scintillation_still", "observing.md 2", (still, "9g")
    yield "slewing_factor", "observing.md 2", (20 / np.hypot(20, .5 * DEGREE * 1.5e4), "9g")
