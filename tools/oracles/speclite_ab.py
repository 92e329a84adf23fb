#!/usr/bin/env python3
"""AB magnitudes of the solar spectrum (data/solar) in the curves of data/filters, by
package speclite (Kirkby et al.), for tests/data/bands/speclite_ab.csv. It sums at the points that it is given: curve
and spectrum, broken lines both, are given to it at all points of either. The LSST curves here are thinned: speclite has
them whole. Usage: speclite_ab.py > tests/data/bands/speclite_ab.csv; with --vega the same of Vega's spectrum
(tests/data/bands/vega_calspec.csv), for speclite_vega.csv."""
import csv
import pathlib
import sys
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


def vega():
    text = (DATA.parent / "tests/data/bands/vega_calspec.csv").read_text()
    nm, value = np.array([line.split(",") for line in text.splitlines() if line[:1].isdigit()], float).T
    return nm * u.nm, value * u.W / u.m**2 / u.nm


def ab_magnitude(stem, wavelength, flux):
    own = speclite.filters.load_filter(stem)
    points = np.round((own.wavelength * speclite.filters.default_wavelength_unit).to_value(u.nm), 6) * u.nm
    at = np.union1d(points.value, np.round(wavelength.to_value(u.nm), 6)) * u.nm
    inside = at[(at >= points[0]) & (at <= points[-1])]
    band = speclite.filters.FilterResponse(wavelength=inside, response=np.interp(inside, points, own.response),
                                           meta={"group_name": "dense", "band_name": stem.replace("-", "_")})
    return band.get_ab_magnitude(np.interp(at, wavelength, flux), at)


def main():
    is_vega = sys.argv[1:] == ["--vega"]
    wavelength, flux = vega() if is_vega else sunlight()
    of = "Vega (CALSPEC alpha_lyr_mod_001)" if is_vega else "ASTM E490 at 1 au"
    print(f"# speclite {version('speclite')}, AB magnitude of {of}")
    print("name,ab")
    with open(DATA / "filters/bands.csv", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if not is_vega or row["name"] in ("Bessell.V", "sdss.g", "sdss.r", "gaia.G"):
                print(f"{row['name']},{ab_magnitude(row['stem'], wavelength, flux):.6f}")


if __name__ == "__main__":
    main()
