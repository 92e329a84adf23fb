#!/usr/bin/env python3
"""Refraction of twenty wavelengths, zenith angles and airs by package galsim (Rowe et al. 2015, module dcr), for
tests/data/air/refraction_galsim.csv. Usage: refraction_galsim.py > tests/data/air/refraction_galsim.csv"""
from importlib.metadata import version

import galsim
from galsim.dcr import get_refraction

AIRS = ((69.328, 293.15, 1.067), (101.325, 283.15, 0.8), (61.0, 271.0, 0.2), (77.5, 288.0, 1.5))
VIEWS = ((400, 20), (450, 60), (550, 45), (650, 70), (850, 30))


def main():
    print(f"# galsim {version('galsim')}, galsim.dcr.get_refraction: seconds of arc, and of 550 nm in the same air")
    print("nm,zenith_deg,pressure_hpa,temperature_k,water_hpa,refraction_arcsec,at_550_arcsec")
    for pressure, temperature, water in AIRS:
        for nm, zenith in VIEWS:
            of = [get_refraction(wave, zenith * galsim.degrees, temperature=temperature, pressure=pressure,
                                 H2O_pressure=water) * 206264.80624709636 for wave in (nm, 550)]
            print(f"{nm},{zenith},{pressure * 10:g},{temperature},{water * 10:g},{of[0]:.10f},{of[1]:.10f}")


if __name__ == "__main__":
    main()
