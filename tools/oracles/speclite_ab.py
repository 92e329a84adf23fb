#!/usr/bin/env python3
"""AB magnitudes of the solar spectrum (data/solar) in the curves of data/filters, by
package speclite (Kirkby et al.), for tests/data/bands/speclite_ab.csv. The LSST curves here are thinned: speclite has
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


def main():
    wavelength, flux = sunlight()
    print(f"# speclite {version('speclite')}, AB magnitude of ASTM E490 at 1 au")
    print("name,ab")
    with open(DATA / "filters/bands.csv", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            band = speclite.filters.load_filter(row["stem"])
            print(f"{row['name']},{band.get_ab_magnitude(flux, wavelength):.6f}")


if __name__ == "__main__":
    main()
