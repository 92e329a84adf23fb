#!/usr/bin/env python3
"""Vega and the Sun through the curves of data/filters by package synphot (STScI), for tests/data/bands/synphot_vega.csv,
with Vega's spectrum as package galsim carries it (CALSPEC's alpha_lyr_mod_001), for tests/data/bands/vega_calspec.csv.
Usage: synphot_vega.py FOLDER, with synphot and galsim installed; writes both files into it."""
import csv
import pathlib
import sys
from importlib.metadata import version

import astropy.units as u
import galsim
import numpy as np
from astropy.table import Table
from synphot import Observation, SourceSpectrum, SpectralElement
from synphot.models import Empirical1D
from synphot.units import FLAM

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
KEPT = (290, 1130)  # nm: all bands
CGS_PER_NM = 1e-3   # erg s-1 cm-2 nm-1 in W m-2 nm-1


def vega():
    nm, value = np.loadtxt(pathlib.Path(galsim.meta_data.share_dir) / "SEDs/vega.txt").T
    is_kept = (nm >= KEPT[0]) & (nm <= KEPT[1])
    return nm[is_kept], value[is_kept] * CGS_PER_NM


def sunlight():
    rows = [line.split() for line in (DATA / "solar/e490-00a_2014_hires.csv").read_text().splitlines()
            if line[:1].isdigit()]
    um, value = np.array(rows, float).T
    return um * 1e3, value * 1e-3


def source(nm, irradiance):
    flam = irradiance / CGS_PER_NM / 10  # erg s-1 cm-2 A-1
    return SourceSpectrum(Empirical1D, points=nm * 10, lookup_table=flam * FLAM)


def curve(stem):
    table = Table.read(DATA / f"filters/{stem}.ecsv")
    wavelength, response = table.columns.values()
    nm = wavelength.quantity.to_value(u.nm) if wavelength.unit else np.asarray(wavelength)
    return SpectralElement(Empirical1D, points=nm * 10, lookup_table=np.asarray(response))


def main():
    folder = pathlib.Path(sys.argv[1])
    nm, irradiance = vega()
    with open(folder / "vega_calspec.csv", "w") as file:
        file.write(f"# Vega, CALSPEC alpha_lyr_mod_001 as package galsim {version('galsim')} has it, {KEPT[0]}-{KEPT[1]} nm\n")
        file.write("nm,w_m2_nm\n")
        file.writelines(f"{a:.4f},{b:.6e}\n" for a, b in zip(nm, irradiance))
    star, sun = source(nm, irradiance), source(*sunlight())
    with open(folder / "synphot_vega.csv", "w") as out, open(DATA / "filters/bands.csv", newline="") as file:
        out.write(f"# synphot {version('synphot')}: Vega's AB magnitude and mean irradiance; the Sun (E490) where Vega is 0\n")
        out.write("name,vega_ab,vega_w_m2_nm,sun_over_vega\n")
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["stem"].startswith("lsst"):  # thinned here, and y ends in a step: half a per cent; speclite has them
                continue
            band = curve(row["stem"])
            seen = Observation(star, band, force="taper")
            own = Observation(sun, band, force="taper")
            out.write(f"{row['name']},{seen.effstim(u.ABmag).value:.6f},"
                      f"{seen.effstim(FLAM).value * 10 * CGS_PER_NM:.6e},"
                      f"{own.effstim('vegamag', vegaspec=star).value:.6f}\n")


if __name__ == "__main__":
    main()
