"""Bands with a curve (docs/theory/bands.md): zero points, colours, metals through a band. Curves, sunlight and
optical constants are read from data/."""

import csv
import pathlib
import re

import numpy as np

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
LIGHT_NM_S, PLANCK = 299792458e9, 6.62607015e-34
AB_ZERO = 3631e-26          # W m-2 Hz-1
ST_ZERO = 10 ** (-.4 * 21.1) * 1e-2  # erg s-1 cm-2 A-1 in W m-2 nm-1
METALS = ("Au_Johnson", "Al_Rakic", "Cu_Johnson", "Ti_Johnson")
METAL_BANDS = ("Bessell.B", "Bessell.V", "sdss.g", "sdss.r", "gaia.G")
NM_OF = {"Angstrom": .1, "nm": 1., "um": 1000.}


def rows_of(path):
    """Rows of two numbers of an ECSV, and the unit of the first column."""
    text = path.read_text()
    unit = re.search(r"name: wavelength, unit: (\w+)", text).group(1)
    rows = [line.split() for line in text.splitlines() if line[:1].isdigit()]
    x, y = np.array(rows, float).T
    return x * NM_OF[unit], y, unit


def sunlight():
    nm, value, _ = rows_of(DATA / "solar/e490-00a_2014_hires.csv")
    return nm, value / 1000


def known_bands():
    with open(DATA / "filters/bands.csv", newline="") as file:
        lines = [line for line in file if not line.startswith("#")]
    return {row["name"]: row for row in csv.DictReader(lines)}


def curve(name):
    nm, response, _ = rows_of(DATA / f"filters/{known_bands()[name]['stem']}.ecsv")
    return nm, response


def trapezoid(y, x):
    return np.sum((y[1:] + y[:-1]) * np.diff(x)) / 2


def points(name, step=None):
    """Wavelengths of curve and sunlight (and a fine grid), response and sunlight there."""
    nm, response = curve(name)
    sun_nm, sun = sunlight()
    at = np.concatenate([nm, sun_nm[(sun_nm > nm[0]) & (sun_nm < nm[-1])]])
    if step:
        at = np.concatenate([at, np.arange(nm[0], nm[-1], step)])
    at = np.unique(at)
    return at, np.interp(at, nm, response), np.interp(at, sun_nm, sun)


def band_rows():
    for name, known in known_bands().items():
        x, r, e = points(name)
        light = trapezoid(r * x * e, x)
        mean = light / trapezoid(r * x, x)
        pivot = np.sqrt(trapezoid(r * x, x) / trapezoid(r / x, x))
        effective = trapezoid(r * x * x * e, x) / light
        spread = np.sqrt(trapezoid(r * x * e * (x - effective) ** 2, x) / light)
        ab_zero = AB_ZERO * LIGHT_NM_S / pivot ** 2
        vega_zero = float(known["vega_zero"])
        yield (name, known["stem"], (pivot, 5), (effective, 5), (spread, 5), (mean, 7),
               (-2.5 * np.log10(mean / ab_zero), 6), (-2.5 * np.log10(mean / ST_ZERO), 6),
               (AB_ZERO / PLANCK * trapezoid(r / x, x) / 1e9, 6),
               (-2.5 * np.log10(mean / vega_zero), 6) if vega_zero else "none")


def index(name):
    text = (DATA / f"nk/{name}.yml").read_text()
    rows = [line.split() for line in text.splitlines() if re.fullmatch(r"\s+[\d.eE+-]+ [\d.eE+-]+ [\d.eE+-]+\s*", line)]
    um, n, k = np.array(rows, float).T
    return um * 1000, n + 1j * k


def reflected(name, nm, phase_deg):
    """I and Q of a smooth metal that mirrors unpolarized light (microfacet.md 2)."""
    at, eta = index(name)
    eta = np.interp(nm, at, eta.real) + 1j * np.interp(nm, at, eta.imag)
    c = np.cos(np.radians(phase_deg / 2))
    root = np.sqrt(eta * eta - 1 + c * c)
    s = np.abs((c - root) / (c + root)) ** 2
    p = np.abs((eta * eta * c - root) / (eta * eta * c + root)) ** 2
    return (s + p) / 2, (s - p) / 2


def metal_rows():
    """Through the band on a grid of a quarter nanometre."""
    for metal in METALS:
        for band in METAL_BANDS:
            x, r, e = points(band, .25)
            weight = r * e * x
            for phase in (60, 100, 140):
                i, q = reflected(metal, x, phase)
                light = trapezoid(weight * i, x)
                yield (metal, band, phase, (light / trapezoid(weight, x), 7),
                       (trapezoid(weight * q, x) / light, 7))
