#!/usr/bin/env python3
"""Visible fraction of the Sun over the WGS 84 ellipsoid by 2.56 million rays per penumbra row.

usage: dense_sunlit.py tests/data/ephemeris/*.csv > tests/data/ephemeris/dense_sunlit.txt

The fractions in the reference ephemerides come from 6,912 rays and are noisy by up to 0.003 where a
ring of their pattern lies along the limb; these are good to 1e-4 (their change from 0.64 million).
Needs numpy. Independent of the library: plain ray against ellipsoid.
"""
import csv
import pathlib
import sys

import numpy as np

A, F, R_SUN = 6378.137, 1 / 298.257223563, 695700.0
RINGS, SPOKES = 800, 3200

print("# file utc visible_fraction (tools/oracles/dense_sunlit.py)")
radii = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
angles = 2 * np.pi * (np.arange(SPOKES) + 0.5) / SPOKES
disk_x = np.outer(radii, np.cos(angles)).ravel()
disk_y = np.outer(radii, np.sin(angles)).ravel()
scale = np.array([1 / A, 1 / A, 1 / (A * (1 - F))])
for name in sys.argv[1:]:
    for row in csv.DictReader(open(name, newline="")):
        if not 0 < float(row["sun_frac_ellipsoid"]) < 1:
            continue
        here = np.array([float(row[f"itrs_{c}_km"]) for c in "xyz"])
        sun = np.array([float(row[f"sun_itrs_u{c}"]) for c in "xyz"]) * float(row["sun_dist_km"])
        line = sun - here
        distance = np.linalg.norm(line)
        line /= distance
        tangent = np.tan(np.arcsin(R_SUN / distance))
        e1 = np.cross(line, [0, 0, 1.0])
        e1 /= np.linalg.norm(e1)
        e2 = np.cross(line, e1)
        rays = (line + tangent * (disk_x[:, None] * e1 + disk_y[:, None] * e2)) * scale
        q = here * scale
        along = rays @ q
        hidden = (along**2 - (rays**2).sum(axis=1) * (q @ q - 1) >= 0) & (along < 0)
        print(pathlib.Path(name).name, row["utc"], f"{1 - hidden.mean():.6f}", flush=True)
