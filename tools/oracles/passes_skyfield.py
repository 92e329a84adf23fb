#!/usr/bin/env python3
"""Passes of Explorer 27 and HST over Maui by Skyfield at 0.1 s steps: tests/data/ephemeris/passes_skyfield.csv.

    python3 -m venv v && v/bin/pip install skyfield==1.55 skyfield-data==7.0.0
    v/bin/python tools/oracles/passes_skyfield.py > tests/data/ephemeris/passes_skyfield.csv

Rise and set at 10 deg and the shadow's edge (half of the Sun's disk behind the WGS 84 ellipsoid) are where the
0.1 s rows change sign, interpolated between them; phase at rise, culmination and set. SGP4 is that of the
package sgp4 (WGS 72), TEME to ITRS by GMST 1982 with polar motion, the Sun apparent (DE421).
"""
import pathlib
import warnings

import numpy as np
from sgp4.api import Satrec, WGS72
from skyfield.api import Loader, wgs84
from skyfield.data import iers
from skyfield.framelib import itrs

warnings.simplefilter("ignore")
import skyfield_data  # noqa: E402

load = Loader(skyfield_data.get_skyfield_data_path(), expire=False)
ts = load.timescale(builtin=False)
with load.open("finals2000A.all") as file:
    iers.install_polar_motion_table(ts, iers.parse_x_y_dut1_from_finals_all(file))
ephemeris = load("de421.bsp")
A, F = 6378.137, 1 / 298.257223563
SUN_KM = 695700.0
root = pathlib.Path(__file__).resolve().parents[2]
lines = (root / "tests/data/ephemeris/elements.tle").read_text().splitlines()


def elements(norad):
    first = next(i for i, line in enumerate(lines) if line.startswith("1 ") and int(line[2:7]) == norad)
    return Satrec.twoline2rv(lines[first], lines[first + 1], WGS72)


site = wgs84.latlon(20.7083, -156.2578, elevation_m=3058)


def gmst82(t):
    """Greenwich mean sidereal time 1982 [rad] of UT1."""
    T = (t.ut1 - 2451545.0) / 36525
    seconds = 67310.54841 + T * (876600 * 3600 + 8640184.812866 + T * (0.093104 - 6.2e-6 * T))
    return np.radians(seconds / 240 % 360)


def itrs_from_teme(t, r):
    g = gmst82(t)
    x, y, z = np.cos(g) * r[0] + np.sin(g) * r[1], -np.sin(g) * r[0] + np.cos(g) * r[1], r[2]
    _, xp, yp = t.polar_motion_angles()
    xp, yp = np.radians(np.asarray(xp) / 3600), np.radians(np.asarray(yp) / 3600)
    # Wobble, small angles: R2(-xp) R1(-yp) transposed to ITRS.
    return np.array([x + xp * z, y - yp * z, z - xp * x + yp * y])


def sunlit(r, sun):
    """Visible share of the Sun's disk over the ellipsoid: 40,000 points of the disk, even in area."""
    k = np.arange(40000)
    rho, phi = np.sqrt((k + 0.5) / len(k)), k * 2.399963229728653
    out = np.empty(r.shape[1])
    scale = np.array([1 / A, 1 / A, 1 / (A * (1 - F))])
    for i in range(r.shape[1]):
        to = sun[:, i] - r[:, i]
        distance = np.linalg.norm(to)
        u = to / distance
        e1 = np.cross(u, [0, 0, 1]); e1 /= np.linalg.norm(e1)
        e2 = np.cross(u, e1)
        tangent = np.tan(np.arcsin(SUN_KM / distance))
        d = u[:, None] + tangent * rho * (np.cos(phi) * e1[:, None] + np.sin(phi) * e2[:, None])
        o, d = r[:, i] * scale, d * scale[:, None]
        b, dd = o @ d, np.einsum("ij,ij->j", d, d)
        hidden = (b < 0) & (b * b - dd * (o @ o - 1) >= 0)
        out[i] = 1 - hidden.mean()
    return out


def at(satrec, seconds, start):
    """Times `seconds` after `start` (datetime tuple, UTC); position, altitude, phase, Sun."""
    t = ts.utc(*start[:5], start[5] + seconds)
    error, r, _ = satrec.sgp4_array(np.full(len(seconds), utc_jd(start)),
                                       (start_fraction(start) + seconds) / 86400)
    assert not error.any()
    position = itrs_from_teme(t, r.T)
    observer = np.asarray(site.itrs_xyz.km)[:, None]
    up = np.array([np.cos(site.latitude.radians) * np.cos(site.longitude.radians),
                   np.cos(site.latitude.radians) * np.sin(site.longitude.radians), np.sin(site.latitude.radians)])
    line = position - observer
    altitude = np.degrees(np.arcsin(up @ line / np.linalg.norm(line, axis=0)))
    earth = ephemeris["earth"]
    sun = earth.at(t).observe(ephemeris["sun"]).apparent().frame_xyz(itrs).km
    to_sun, to_site = sun - position, observer - position
    cosine = (to_sun * to_site).sum(0) / np.linalg.norm(to_sun, axis=0) / np.linalg.norm(to_site, axis=0)
    sine = np.linalg.norm(np.cross(to_sun.T, to_site.T), axis=1) / np.linalg.norm(to_sun, axis=0) / np.linalg.norm(to_site, axis=0)
    return position, altitude, np.degrees(np.arctan2(sine, cosine)), sun


def utc_jd(start):
    y, m, d = start[:3]
    return 367 * y - 7 * (y + (m + 9) // 12) // 4 + 275 * m // 9 + d + 1721013.5


def start_fraction(start):
    return 3600 * start[3] + 60 * start[4] + start[5]


def crossings(seconds, value):
    k = np.nonzero(np.diff(np.sign(value)) != 0)[0]
    return seconds[k] - value[k] * (seconds[k + 1] - seconds[k]) / (value[k + 1] - value[k])


def stamp(start, seconds):
    total = start_fraction(start) + seconds
    return "%04d-%02d-%02dT%02d:%02d:%06.3fZ" % (*start[:3], total // 3600, total % 3600 // 60, total % 60)


DAYS = {1328: [(2022, 2, d) for d in range(22, 29)] + [(2022, 3, 1)], 20580: [(2018, 1, d) for d in range(21, 25)]}
print("norad,rise_utc,culmination_utc,set_utc,culmination_alt,phase_rise,phase_culmination,phase_set,shadow_utc,"
      "shadow_is_entry")
for norad, day in [(norad, day) for norad, days in DAYS.items() for day in days]:
    satrec, start = elements(norad), (*day, 0, 0, 0)
    coarse = np.arange(0, 86400, 20.0)
    above = at(satrec, coarse, start)[1] > 9
    edges = np.nonzero(np.diff(above.astype(int)))[0]
    for begin in edges[~above[edges]]:
        ends = edges[(edges > begin) & above[edges]]
        if not len(ends):
            continue
        seconds = np.arange(coarse[begin] - 20, coarse[ends[0] + 1] + 20, 0.1)
        position, altitude, phase, sun = at(satrec, seconds, start)
        cut = crossings(seconds, altitude - 10)
        if len(cut) != 2:
            continue
        top = np.argmax(altitude)
        inside = np.nonzero((seconds > cut[0]) & (seconds < cut[1]))[0]
        rough = sunlit(position[:, inside[::50]], sun[:, inside[::50]])
        shadow, entry = "", ""
        change = np.nonzero(np.diff(np.sign(rough - 0.5)))[0]
        if len(change):
            k = inside[::50][change[0]]
            part = slice(k, k + 52)
            light = sunlit(position[:, part], sun[:, part]) - 0.5
            shadow, entry = stamp(start, crossings(seconds[part], light)[0]), int(light[0] > 0)
        # The top of a parabola through three rows.
        a = altitude[top - 1:top + 2]
        culmination = seconds[top] + 0.05 * (a[0] - a[2]) / (a[0] - 2 * a[1] + a[2])
        p = np.interp([cut[0], culmination, cut[1]], seconds, phase)
        print(f"{norad},{stamp(start, cut[0])},{stamp(start, culmination)},{stamp(start, cut[1])},{a.max():.6f},"
              f"{p[0]:.6f},{p[1]:.6f},{p[2]:.6f},{shadow},{entry}")
