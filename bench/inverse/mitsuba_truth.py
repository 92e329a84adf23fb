"""Light curves whose light is Mitsuba's: what blind.py --truth mitsuba inverts, so that no light of umov's own is in the data.

Epochs, attitudes and the scattering plane are those of umov's rows; I, q and u come from Mitsuba's polarized variant (mitsuba_light.py):
another program's BRDF, Fresnel equations, shadows and, with more surfaces than one, light between them, which the fit does not have."""
import math
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/peers"))
import compare  # noqa: E402


def materials_in_toml():
    """The four metals of the comparison with Mitsuba, as tables of a scenario."""
    out = []
    for group, (index, alpha) in compare.MATERIALS.items():
        out += [f"[material.peer_{group}]", f'index = "{index}"', f'distribution = {{ model = "ggx", alpha = {alpha} }}',
                'shadowing = "separable"']
    return "\n".join(out) + "\n"


def sun_among_stars(mjd):
    """Direction of the Sun, GCRS axes, to .02 deg (Astronomical Almanac, low-precision formulas, page C5): settles on which side it is."""
    days = mjd - 51544.5
    mean, anomaly = math.radians(280.460 + 0.9856474 * days), math.radians(357.528 + 0.9856003 * days)
    longitude = mean + math.radians(1.915) * math.sin(anomaly) + math.radians(0.020) * math.sin(2 * anomaly)
    tilt = math.radians(23.439 - 4e-7 * days)
    return np.array([math.cos(longitude), math.cos(tilt) * math.sin(longitude), math.sin(tilt) * math.sin(longitude)])


def directions(row):
    """Sun and observer in body axes: the line of sight, the scattering plane's normal and the phase angle of a row, turned by its attitude."""
    ra, dec = (math.radians(float(row[key])) for key in ("ra", "dec"))
    sight = np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])
    east = np.array([-math.sin(ra), math.cos(ra), 0])
    north = np.cross(sight, east)
    angle, phase = math.radians(float(row["pa_scat"])), math.radians(float(row["phase_angle"]))
    aside = np.cross(math.cos(angle) * north + math.sin(angle) * east, -sight)
    aside *= math.copysign(1, aside @ sun_among_stars(float(row["mjd_utc"])))
    sun = -math.cos(phase) * sight + math.sin(phase) * aside
    w, x, y, z = (float(row[key]) for key in ("qw", "qx", "qy", "qz"))
    to_stars = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    return to_stars.T @ sun, to_stars.T @ -sight


class Truth:
    """The object in Mitsuba, for the wavelengths of the rows' bands."""

    def __init__(self, program, mesh, wavelengths_nm, surfaces, rays=1 << 18):
        from mitsuba_light import MitsubaScene

        materials = {}
        for group, (index, alpha) in compare.MATERIALS.items():
            n, k = compare.index_values(program, index, wavelengths_nm)
            materials[group] = {"alpha": alpha, "n": n, "k": k}
        self.scene = MitsubaScene(compare.read_groups(mesh), materials, wavelengths_nm)
        self.wavelengths, self.surfaces, self.rays = list(wavelengths_nm), surfaces, rays

    def relit(self, rows):
        """The rows with Mitsuba's intensity, I, q and u in the place of umov's."""
        epochs = list({row["time_utc"]: row for row in rows}.values())
        sun, observer = (np.array(v) for v in zip(*map(directions, epochs)))
        stokes = np.concatenate([self.scene.evaluate_paths(sun[k:k + 16], observer[k:k + 16], self.rays, self.surfaces, seed=k)
                                 for k in range(0, len(epochs), 16)])
        of_time = {row["time_utc"]: k for k, row in enumerate(epochs)}
        out = []
        for row in rows:
            i, q, u = stokes[of_time[row["time_utc"]], self.wavelengths.index(float(row["lambda_eff"]))]
            changed = dict(row, intensity=str(i))
            if float(row["intensity"]) > 0:
                changed["I"] = str(float(row["I"]) * i / float(row["intensity"]))
            if i > 0:  # from the scattering plane to the sky
                twice = 2 * math.radians(float(row["pa_scat"]))
                changed["q"] = str((q * math.cos(twice) - u * math.sin(twice)) / i)
                changed["u"] = str((q * math.sin(twice) + u * math.cos(twice)) / i)
            out.append(changed)
        return out

    @staticmethod
    def difference(rows, relit):
        """Median of |dI|/I and of |dq| of two tables, of rows above a hundredth of the median light."""
        light = [float(row["intensity"]) for row in rows]
        pairs = [(a, b) for a, b, i in zip(rows, relit, light) if i > 0.01 * np.median(light) and a["q"]]
        return (float(np.median([abs(float(b["intensity"]) / float(a["intensity"]) - 1) for a, b in pairs])),
                float(np.median([abs(float(b["q"]) - float(a["q"])) for a, b in pairs])))
