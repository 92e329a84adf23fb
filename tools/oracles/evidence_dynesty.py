#!/usr/bin/env python3
"""Evidence of three bodies for the same light by nested sampling (dynesty): tests/data/evidence.

    python3 -m venv venv && venv/bin/pip install dynesty==3.1.0 numpy astropy
    PYTHONPATH=build/release/python venv/bin/python tools/oracles/evidence_dynesty.py observe
    PYTHONPATH=build/release/python venv/bin/python tools/oracles/evidence_dynesty.py check
    PYTHONPATH=build/release/python venv/bin/python tools/oracles/evidence_dynesty.py evidence > tests/data/evidence/dynesty.csv
    PYTHONPATH=build/release/python venv/bin/python tools/oracles/evidence_dynesty.py importance > tests/data/evidence/importance.csv

`observe` writes the observations: light of umov in a random attitude, wrong by photons, a floor and zero points. `evidence` integrates the likelihood of
docs/theory/inverse.md, section 2, over all attitudes (three uniform numbers, Shoemake 1992) and prints ln of it, relative to a prior that takes all attitudes alike, and
without the constants of the data alone, which section 2 leaves out. `importance` integrates the same by weighted draws: normal ones about 600 samples of umov.invert_pose and,
a fifth of them, even over all attitudes, so that what those samples lack shows in the error. Likelihood, directions and the scattering plane are written anew here; the light of a pose and the range
are umov's (`umov.Engine`, `umov.run`), the Sun is astropy's. Standard error tells what the integral over ln of the scale by quadrature has more than by Laplace's rule. `check` compares likelihoods with -2 ln of samples of umov.invert_pose, attitude by attitude.
"""
import csv
import datetime
import pathlib
import sys
import tomllib
from importlib.metadata import version

import numpy as np
import umov

HERE = pathlib.Path(__file__).resolve().parents[2] / "tests/data/evidence"
SCENARIO = HERE / "box.toml"
# Of the observations: S/N of the median I, begin, epochs, seconds between them, seed of attitude and noise.
CASES = {"bright": (30, "05:10", 12, 20, 13), "faint": (12, "05:12", 4, 30, 3)}
# What the body may be, as changes of the scenario: as it is, one side of another material, wider by a fifth along x.
HYPOTHESES = {"box": {}, "gold": {"object.materials.mx": "box_gold"}, "wider": {"object.mesh.file": str(HERE / "wider.obj")}}
FLOOR, ZERO_POINT_SD = 0.01, 0.02
UNIT = 3.1  # the scale is not known: fluxes are so many times what the body gives
POINTS, SAMPLE, SEED = 500, "rwalk", 1
DRAWS, AT_ONCE, WIDTH_DEG, EVEN = 24_000, 4000, {"bright": 1.5, "faint": 4}, 0.2


def rotation(u):
    """Rotations (..., 3, 3) of three uniform numbers (Shoemake 1992), once each: half of one angle leaves one of q and -q."""
    a, b = np.sqrt(1 - u[..., 0]), np.sqrt(u[..., 0])
    s, t = np.pi * u[..., 1], 2 * np.pi * u[..., 2]
    return rotation_of(b * np.cos(t), a * np.sin(s), a * np.cos(s), b * np.sin(t))


def rotation_of(w, x, y, z):
    nine = (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
    return np.array(nine).T.reshape(*np.shape(w), 3, 3)


def run(case, **more):
    _, begin, epochs, step, _ = CASES[case]
    first = datetime.datetime.fromisoformat(f"2018-01-21T{begin}:00")
    span = {"time.start": f"{first.isoformat()}Z", "time.stop": f"{(first + datetime.timedelta(seconds=(epochs - 0.5) * step)).isoformat()}Z", "time.step_s": step}
    return umov.run(SCENARIO, set={**span, **more}, threads=1, cache=False).table


def observe(case):
    snr, *_, seed = CASES[case]
    rng = np.random.Generator(np.random.PCG64(seed))
    q = rng.normal(size=4)
    light = run(case, **{"object.attitude": {"mode": "inertial", "quaternion": (q / np.linalg.norm(q)).tolist()}})
    true = np.asarray(light["intensity"], float)
    typical = np.median(true)
    gain = {name: 1 + ZERO_POINT_SD * rng.normal() for name in ("nm:425", "nm:650")}
    lines = [f"# tools/oracles/evidence_dynesty.py observe, seed {seed}, S/N {snr} (CC0)", "# pol_frame: equatorial", "time_utc,band,flux,flux_err,q,u,q_err,u_err"]
    for k in range(len(true)):
        row = {name: light[name][k] for name in ("time_utc", "band", "I", "intensity", "q", "u")}
        sd = np.sqrt(0.8 * true[k] * typical + 0.2 * typical**2) / snr  # photons and sky
        seen = gain[row["band"]] * (true[k] * (1 + FLOOR * rng.normal()) + FLOOR / 2 * typical * rng.normal()) + sd * rng.normal()
        per = UNIT * row["I"] / row["intensity"]
        cells = [str(row["time_utc"]), row["band"], f"{per * seen:.5e}", f"{per * sd:.5e}", "", "", "", ""]
        if true[k] > 3 * sd:
            error = np.sqrt(2) * sd / true[k]
            cells[4:] = [f"{row[name] + np.hypot(error, FLOOR / 2) * rng.normal():.5f}" for name in "qu"] + [f"{error:.5f}"] * 2
        lines.append(",".join(cells))
    (HERE / f"{case}.csv").write_text("\n".join(lines) + "\n")


class Curve:
    """Observations in the units of the model, as equations (1) and (2) have them: arrays (epoch, band)."""

    def __init__(self, case):
        rows = list(csv.DictReader(line for line in (HERE / f"{case}.csv").read_text().splitlines() if line[0] != "#"))
        light = run(case)
        assert [row["time_utc"] for row in rows] == [str(one) for one in light["time_utc"]]
        bands = len(set(row["band"] for row in rows))
        number = {name: np.array([float(row[name] or "nan") for row in rows]).reshape(-1, bands) for name in ("flux", "flux_err", "q", "u", "q_err", "u_err")}
        of = {name: np.asarray(light[name], float).reshape(-1, bands) for name in ("ra", "dec", "range", "I", "intensity", "phase_angle", "pa_scat")}
        ra, dec = np.radians(of["ra"][:, 0]), np.radians(of["dec"][:, 0])
        seen = np.column_stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
        self.observer = -seen
        self.sun = sun_directions([str(one) for one in light["time_utc"][::bands]], seen * of["range"][:, :1])
        # Irradiance per intensity falls with the square of the range alone within minutes, in full sunlight.
        per = np.nanmedian(np.where(of["intensity"] > 0, of["I"] * of["range"] ** 2 / np.maximum(of["intensity"], 1e-300), np.nan), axis=0) / of["range"] ** 2
        self.i, self.i_sd = number["flux"] / per, number["flux_err"] / per
        normal = np.cross(self.sun, self.observer)
        east = np.cross([0, 0, 1.0], seen)
        north = np.cross(seen, east)
        angle = np.arctan2(np.sum(normal * east, -1), np.sum(normal * north, -1))[:, None]
        phase = np.degrees(np.arccos(np.sum(self.sun * self.observer, -1)))
        assert np.abs(phase - of["phase_angle"][:, 0]).max() < 3e-4 and np.abs(np.sin(angle - np.radians(of["pa_scat"]))).max() < 1e-5  # a second of arc
        c, s = np.cos(2 * angle), np.sin(2 * angle)
        self.q, self.u = number["q"] * c + number["u"] * s, number["u"] * c - number["q"] * s
        has_q = np.isfinite(self.q)
        assert np.all((number["q_err"] == number["u_err"])[has_q])  # so that they are alike in each frame
        middle = np.sort(self.i.ravel())[self.i.size // 2]
        # (4); F_m is 1 %, or half of F where that is less.
        self.s = self.i_sd**2 + (FLOOR * np.maximum(self.i, 0)) ** 2 + (min(0.01, FLOOR / 2) * middle) ** 2
        self.weight_q = np.where(has_q, 1 / (number["q_err"] ** 2 + (FLOOR / 2) ** 2), 0)
        self.q, self.u = np.nan_to_num(self.q), np.nan_to_num(self.u)

    def light(self, engine, turns):
        """Stokes (..., epoch, band, 4) in attitudes (..., 3, 3)."""
        return engine.evaluate(self.sun @ np.swapaxes(turns, -1, -2), self.observer @ np.swapaxes(turns, -1, -2))

    def log_likelihood(self, light, by_quadrature=False):
        """Of section 2, without constants of the data. Gains are normal about the scale s with the variance k = (z s_1)^2, so I of a band is normal about s m with S + k m m^T
        (its inverse and determinant after Sherman & Morrison 1950), and -2 ln is a parabola of s. The integral over ln s: by Laplace's rule, and a prior no wider than an e-fold; or by quadrature."""
        m = light[..., 0]
        safe = np.where(m > 0, m, 1)
        chi2_q = np.sum(self.weight_q * ((self.q - np.where(m > 0, light[..., 1] / safe, 0)) ** 2 + (self.u - np.where(m > 0, light[..., 2] / safe, 0)) ** 2), (-1, -2))
        a, c, d = (np.sum(one / self.s, -2) for one in (m * m, self.i * m, self.i**2 * np.ones_like(m)))
        lit = np.sum(a, -1) > 0
        s_1 = np.maximum(np.sum(c, -1) / np.where(lit, np.sum(a, -1), 1), 1e-9)
        k = (ZERO_POINT_SD * s_1[..., None]) ** 2
        less = 1 / (1 + k * a)
        top, bottom = np.sum(c * less, -1), np.sum(a * less, -1)
        base = chi2_q + np.sum(d - k * c * c * less - np.log(less), -1)
        s = np.maximum(top / np.where(lit, bottom, 1), 1e-9)
        if not by_quadrature:
            return -(base + bottom * s * s - 2 * top * s + np.log1p(bottom * s * s)) / 2
        wide = np.linspace(-12, 12, 481)
        x = wide / np.sqrt(1 + bottom * s * s)[..., None]  # of ln s
        scale = s[..., None] * np.exp(x)
        chi2 = bottom[..., None] * scale**2 - 2 * top[..., None] * scale
        least = chi2.min(-1)
        area = np.sum(np.exp(-(chi2 - least[..., None]) / 2), -1) * (x[..., 1] - x[..., 0])
        return -(base + least) / 2 + np.log(area / np.sqrt(2 * np.pi))


def sun_directions(times, from_site_km):
    """From the body to the apparent Sun, axes of the GCRS."""
    from astropy import units
    from astropy.coordinates import EarthLocation, get_sun
    from astropy.time import Time
    from astropy.utils import iers
    iers.conf.auto_download = False
    site = tomllib.loads(SCENARIO.read_text())["observer"]
    when = Time([one.rstrip("Z") for one in times], scale="utc")
    place = EarthLocation.from_geodetic(site["lon_deg"] * units.deg, site["lat_deg"] * units.deg, site["alt_m"] * units.m)
    body = place.get_gcrs_posvel(when)[0].xyz.to_value("km").T + from_site_km
    found = get_sun(when).cartesian.xyz.to_value("km").T - body
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


def engine_of(hypothesis):
    return umov.Engine(SCENARIO, set=HYPOTHESES[hypothesis] or None, threads=1, cache=False)


def samples_of(case, hypothesis):
    """umov's answer, its draws' quaternions (w, x, y, z), body from stars, and their weights."""
    fit = umov.Fit(grid=2000, floor=FLOOR, zero_point_sd=ZERO_POINT_SD, slope_sd=0, reflectance_sd=0, haze_sd=0, largest_floor=0)
    found = umov.invert_pose(HERE / f"{case}.csv", SCENARIO, set=HYPOTHESES[hypothesis] or None, fit=fit, threads=1, cache=False)
    table = found.tables["samples"]
    weight = np.array(table["weight"], float)
    return found, np.column_stack([np.asarray(table[name], float) for name in ("qw", "qx", "qy", "qz")]), weight / weight.sum()


def turns_of(quaternions):
    """The other way round, as `rotation` has them."""
    return np.swapaxes(rotation_of(*quaternions.T), -1, -2)


def product(a, b):
    (w, x, y, z), (W, X, Y, Z) = a.T, b.T
    return np.column_stack([w * W - x * X - y * Y - z * Z, w * X + x * W + y * Z - z * Y, w * Y - x * Z + y * W + z * X, w * Z + x * Y - y * X + z * W])


def importance(case, hypothesis):
    """ln evidence and its error."""
    rng = np.random.default_rng(SEED)
    _, samples, weight = samples_of(case, hypothesis)
    centres = samples[rng.choice(len(samples), 600, p=weight)]
    width = np.radians(WIDTH_DEG[case])
    vector = rng.normal(size=(DRAWS, 3)) * width
    angle = np.linalg.norm(vector, axis=1)[:, None]
    near = product(centres[rng.integers(len(centres), size=DRAWS)], np.hstack([np.cos(angle / 2), np.sin(angle / 2) * vector / angle]))
    even = rng.normal(size=(DRAWS, 4))
    draws = np.where(rng.uniform(size=(DRAWS, 1)) < EVEN, even / np.linalg.norm(even, axis=1)[:, None], near)
    value = []
    curve, engine = Curve(case), engine_of(hypothesis)
    for k in range(0, DRAWS, AT_ONCE):
        some = draws[k:k + AT_ONCE]
        off = 2 * np.arccos(np.clip(np.abs(some @ centres.T), 0, 1))
        # Over that of even attitudes: a volume of rotation vectors has (sin(a/2) / (a/2))^2 / (8 pi^2) of them.
        density = np.exp(-off**2 / 2 / width**2) / (2 * np.pi * width**2)**1.5 * 8 * np.pi**2 / np.sinc(off / 2 / np.pi)**2
        value.append(curve.log_likelihood(curve.light(engine, turns_of(some))) - np.log((1 - EVEN) * density.mean(1) + EVEN))
    value = np.concatenate(value)
    part = np.exp(value - value.max())
    return value.max() + np.log(part.mean()), part.std() / part.mean() / np.sqrt(DRAWS)


def nested(curve, engine):
    """ln evidence and its error as dynesty tells it; what quadrature over the scale adds; likelihoods that were asked."""
    import dynesty
    sampler = dynesty.NestedSampler(lambda u: float(curve.log_likelihood(curve.light(engine, rotation(u)))), lambda u: u, 3, nlive=POINTS, periodic=[2], sample=SAMPLE, bootstrap=0,
                                    rstate=np.random.default_rng(SEED))
    sampler.run_nested(dlogz=0.01, print_progress=False)
    found = sampler.results
    weight = np.exp(found.logwt - found.logz[-1])
    light = curve.light(engine, rotation(np.array(found.samples)[weight > 1e-8]))
    more = np.exp(curve.log_likelihood(light, by_quadrature=True) - curve.log_likelihood(light))
    return found.logz[-1], found.logzerr[-1], np.log(np.average(more, weights=weight[weight > 1e-8])), int(np.sum(found.ncall))


def evidence(cases, hypotheses):
    print(f"# tools/oracles/evidence_dynesty.py evidence, dynesty {version('dynesty')}, numpy {np.__version__}, {POINTS} live points, seed {SEED} (CC0)")
    print("case,hypothesis,ln_evidence,ln_evidence_err")
    for case in cases:
        curve = Curve(case)
        for hypothesis in hypotheses:
            engine = engine_of(hypothesis)
            value, error, more, calls = nested(curve, engine)
            print(f"{case},{hypothesis},{value:.4f},{error:.4f}", flush=True)
            print(f"{case} {hypothesis}: {calls} likelihoods, quadrature over the scale {more:+.4f}", file=sys.stderr)


def by_importance():
    print(f"# tools/oracles/evidence_dynesty.py importance, numpy {np.__version__}, {DRAWS} draws, seed {SEED} (CC0)")
    print("case,hypothesis,ln_evidence,ln_evidence_err")
    for case in CASES:
        for hypothesis in HYPOTHESES:
            value, error = importance(case, hypothesis)
            print(f"{case},{hypothesis},{value:.4f},{error:.4f}", flush=True)


def check():
    for case in CASES:
        curve = Curve(case)
        for hypothesis in HYPOTHESES:
            found, samples, weight = samples_of(case, hypothesis)
            ours = -2 * curve.log_likelihood(curve.light(engine_of(hypothesis), turns_of(samples)))
            off = ours - np.asarray(found.tables["samples"]["minus_2_log"], float)
            print(f"{case} {hypothesis}: -2 ln likelihood of {len(off)} samples off by {np.sqrt(np.average(off**2, weights=weight)):.2g} (weighted rms), {np.abs(off).max():.2g} at most; "
                  f"ln evidence of umov {found.values['log_evidence']:.3f}, effective {found.values['effective_samples']:.0f} of {len(off)}, runs apart {found.values['evidences_apart']:.3f}, "
                  f"{len(found.values['modes'])} modes")


if __name__ == "__main__":
    asked = sys.argv[1] if len(sys.argv) > 1 else ""
    if asked == "observe":
        for name in CASES:
            observe(name)
    elif asked == "check":
        check()
    elif asked == "importance":
        by_importance()
    elif asked == "evidence":
        evidence(sys.argv[2].split(",") if len(sys.argv) > 2 else CASES, sys.argv[3].split(",") if len(sys.argv) > 3 else HYPOTHESES)
    else:
        sys.exit(__doc__)
