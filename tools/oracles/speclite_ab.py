#!/usr/bin/env python3
"""AB magnitudes of the solar spectrum (data/solar) in the curves of data/filters, by
package speclite (Kirkby et al.), for tests/data/bands/speclite_ab.csv. It sums at the points that it is given: curve
and spectrum, broken lines both, are given to it at all points of either. The LSST curves here are thinned: speclite has
them whole. Usage: speclite_ab.py > tests/data/bands/speclite_ab.csv"""
import csv
import pathlib
from importlib.metadata import version

import astropy.units as u
import numpy as np
import speclite.filters

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"


def sunlight():
    rows = [line.split() for line in (DATA / "solar/e490-00a_2014_hires.csv").read_text().splitlines()
            if line[:1].isdigit()]
    um, value = np.array(rows, float).T
    return um * u.um, value * u.W / u.m**2 / u.um


def ab_magnitude(stem, wavelength, flux):
    own = speclite.filters.load_filter(stem)
    points = np.round((own.wavelength * speclite.filters.default_wavelength_unit).to_value(u.nm), 6) * u.nm
    at = np.union1d(points.value, np.round(wavelength.to_value(u.nm), 6)) * u.nm
    inside = at[(at >= points[0]) & (at <= points[-1])]
    band = speclite.filters.FilterResponse(wavelength=inside, response=np.interp(inside, points, own.response),
                                           meta={"group_name": "dense", "band_name": stem.replace("-", "_")})
    return band.get_ab_magnitude(np.interp(at, wavelength, flux), at)


def main():
    wavelength, flux = sunlight()
    print(f"# speclite {version('speclite')}, AB magnitude of ASTM E490 at 1 au")
    print("name,ab")
    with open(DATA / "filters/bands.csv", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            print(f"{row['name']},{ab_magnitude(row['stem'], wavelength, flux):.6f}")


if __name__ == "__main__":
    main()
