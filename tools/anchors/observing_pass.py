"""Axes and rates of a pass (docs/theory/observing.md 4), by vectors from an ephemeris of others (tests/data/ephemeris)."""

import csv
import pathlib

import numpy as np

DEGREE = np.pi / 180
ROOT = pathlib.Path(__file__).resolve().parents[2]
LATITUDE, LONGITUDE, HEIGHT = 20.7083 * DEGREE, -156.2578 * DEGREE, 3.058
TURN = np.array([0, 0, 7.292115e-5])  # of the Earth [rad/s]
GRAVITY = 398600.4418


def unit(v):
    return v / np.linalg.norm(v)


def site():
    """Place of the site on the ellipsoid of WGS 84 [km], and the direction to its zenith."""
    up = np.array([np.cos(LATITUDE) * np.cos(LONGITUDE), np.cos(LATITUDE) * np.sin(LONGITUDE), np.sin(LATITUDE)])
    axes = np.array([6378.137, 6378.137, 6378.137 * (1 - 1 / 298.257223563)])
    return axes ** 2 * up / np.linalg.norm(axes * up) + HEIGHT * up, up


def after(vector, seconds):
    """Where the turning Earth carries a vector: to second order, for half a second."""
    first = np.cross(TURN, vector)
    return vector + first * seconds + np.cross(TURN, first) * seconds ** 2 / 2


def directions(row, seconds=0.):
    """From the object to observer and Sun, and the zenith, in axes that stand still while the Earth turns."""
    place = np.array([float(row[f"itrs_{c}_km"]) for c in "xyz"])
    speed = np.array([float(row[f"itrs_v{c}_kms"]) for c in "xyz"]) + np.cross(TURN, place)
    place = place + speed * seconds - GRAVITY * place / np.linalg.norm(place) ** 3 * seconds ** 2 / 2
    here, up = (after(v, seconds) for v in site())
    sun = np.array([float(row[f"sun_itrs_u{c}"]) for c in "xyz"]) * float(row["sun_dist_km"])
    return unit(here - place), unit(sun - place), up


def position_angle(axis, beam, pole):
    """Of an axis across the beam, from the pole towards the left of who looks against the light."""
    north = unit(pole - pole @ beam * beam)
    return np.arctan2(axis @ np.cross(beam, north), axis @ north) / DEGREE


def rate(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b) / DEGREE  # within one second


def rows():
    """utc, psi_altaz, psi_pole, eta, rate, half_rate."""
    with open(ROOT / "tests/data/ephemeris/hst_maui_20180121_60s.csv") as file:
        table = {row["utc"][11:16]: row for row in csv.DictReader(file)}
    for minute in ("05:10", "05:11", "05:12", "05:13"):
        beam, sun, up = directions(table[minute])
        across = unit(np.cross(beam, sun))
        eta = position_angle(unit(up - up @ beam * beam), beam, np.array([0, 0, 1.]))
        early, late = directions(table[minute], -.5), directions(table[minute], .5)
        half = [unit(d[0] + d[1]) for d in (early, late)]
        yield f"2018-01-21T{minute}:00Z", (position_angle(across, beam, up) % 180, "8g"), (
            position_angle(across, beam, np.array([0, 0, 1.])) % 180, "8g"), (eta, "8g"), (rate(early[0], late[0]), "7g"), (
            rate(*half), "7g")
