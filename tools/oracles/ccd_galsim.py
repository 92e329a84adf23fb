#!/usr/bin/env python3
"""Noise of a detector's pixels by package galsim (Rowe et al. 2015, CCDNoise): mean and variance of a million numbers of
the converter, for tests/data/detector/ccd_galsim.csv. Usage: ccd_galsim.py > tests/data/detector/ccd_galsim.csv"""
from importlib.metadata import version

import galsim
import numpy as np

CASES = ((1, 2.3, 1.0), (10, 2.3, 2.6), (1000, 2.3, 2.6), (1000, 7, 12), (1e5, 10, 2), (300, 0, 1))
SIDE = 1000


def main():
    print(f"# galsim {version('galsim')}: CCDNoise on {SIDE * SIDE} pixels, rounded to whole numbers")
    print("electrons,read_e,gain_e_adu,mean_adu,variance_adu2,analytic_variance_adu2")
    for level, read, gain in CASES:
        # Light in ADU, a quarter of a number off, so that rounding meets every phase only through the noise.
        image = galsim.Image(np.full((SIDE, SIDE), level / gain), dtype=float)
        noise = galsim.CCDNoise(galsim.BaseDeviate(5), gain=gain, read_noise=read)
        image.addNoise(noise)
        numbers = np.floor(image.array + .5)
        analytic = level / gain ** 2 + (read / gain) ** 2
        print(f"{level:g},{read:g},{gain:g},{numbers.mean():.6f},{numbers.var():.6f},{analytic:.6f}")


if __name__ == "__main__":
    main()
