#!/usr/bin/env python3
"""Lomb-Scargle power of an uneven series with a trend, by astropy.

usage: periodogram_astropy.py > tests/data/periodogram/astropy.csv

Rows `series`: time [s] and magnitude; rows `power`: period [s] and power of the magnitudes less numpy's
parabola, floating mean, equal weights. Needs numpy and astropy. Independent of the library.
"""
import astropy
import numpy as np
from astropy.timeseries import LombScargle

rng = np.random.Generator(np.random.Philox(20))
time = np.sort(rng.uniform(0, 300, 140))
turn = 2 * np.pi * time / 11.7
magnitude = 6 + 0.004 * time + 2e-5 * (time - 100) ** 2 + 0.6 * np.sin(turn) + 0.3 * np.cos(2 * turn + 0.4)
magnitude = np.round(magnitude + 0.2 * rng.normal(size=time.size), 6)
time = np.round(time, 6)
rest = magnitude - np.polyval(np.polyfit(time, magnitude, 2), time)
span = time[-1] - time[0]
frequency = 2 / span + np.arange(600) / (5 * span)
power = LombScargle(time, rest, fit_mean=True, center_data=False).power(frequency, method="slow")
print(f"# tools/oracles/periodogram_astropy.py, astropy {astropy.__version__}, numpy {np.__version__} (CC0)")
for row in zip(time, magnitude):
    print("series,%.6f,%.6f" % row)
for f, p in list(zip(frequency, power))[:200:8]:
    print("power,%.12g,%.12g" % (1 / f, p))
