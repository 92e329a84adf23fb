#!/usr/bin/env python3
"""Does the 95 % set hold 95 % of the truths? Short arcs, 8 to 15 epochs somewhere in a pass, of random attitudes, whose data are wrong by just what the
search is told: photons, the floor (its part of I and half of it in q and u, and half of it, 1 % at most, of the median I), zero points of 2 %. Light of the truth by rays on the mesh
that is fitted, so that nothing else is wrong. Prints one line per curve, then the share of sets that hold the truth, of all and of those with and without dark epochs, with its binomial interval (Clopper & Pearson 1934, 95 %).

usage: coverage.py OBJECT CURVES [--snr 100] [--seed 1] [--floor 0.02] [--first CURVE] [--only CURVE] [--dark EPOCHS] [--umov PATH] [--work DIR] [options of umov invert]
OBJECT: as blind.py has them. --dark 2: arcs with two dark epochs or more alone. Materials are taken for right unless the options say otherwise."""
import argparse
import itertools
import math
import random
import statistics
import typing

import blind

KNOWN = ["--slope-sd", 0, "--reflectance-sd", 0, "--haze-sd", 0]
ZERO_POINT_SD, OF_MEDIAN = 0.02, 0.01  # what umov invert takes them for; of the median half of the floor at most
DAY, FIRST_S, LAST_S = "2018-01-21", 5 * 3600 + 8 * 60, 5 * 3600 + 15 * 60  # of the pass of blind.py


def clock(seconds):
    return f"{DAY}T{int(seconds) // 3600:02d}:{int(seconds) // 60 % 60:02d}:{seconds % 60:06.3f}Z"


def arc(rng):
    """Begin, end and step [s] of 8 to 15 epochs."""
    epochs, step = rng.randint(8, 15), rng.uniform(4, 12)
    begin = rng.uniform(FIRST_S, LAST_S - epochs * step)
    return begin, begin + (epochs - 0.5) * step, step


def part_of_median(floor):
    return min(OF_MEDIAN, floor / 2)


class Away(typing.NamedTuple):
    """A row of data less the truth with the gains that it was made with."""
    intensity: float
    seen: float
    sd: float  # of intensity, by photons
    polarization: list  # of q and u, where they are measured
    polarization_sd: float  # by photons


class Noise(typing.NamedTuple):
    of_gains: float  # chi-square
    median: float  # intensity
    told: float  # floor that was put in
    rows: dict  # of time and band

    def chi2(self, floor, fitted):
        """Of the truth (equation 3 of docs/theory/inverse.md), over the rows that a fit took (not those of the penumbra), with the floor that it came to."""
        out = self.of_gains
        of_median = part_of_median(self.told) * floor / self.told if self.told > 0 else part_of_median(floor)
        for row in fitted:
            a = self.rows[row["time_utc"], row["band"]]
            out += a.intensity**2 / (a.sd**2 + (floor * a.seen) ** 2 + (of_median * self.median) ** 2)
            if row["q_scat"] != "nan":
                out += sum(x * x for x in a.polarization) / (a.polarization_sd**2 + (floor / 2) ** 2)
        return out


def observed(rows, snr, floor, rng, path, zero_point_sd=ZERO_POINT_SD, typical=None):
    """A table as an observer has it whose model is wrong by `floor`: S/N is that of the mean I of a band, or of I where it is `typical`; dark epochs stand with their noise.
    Returns how far that is from the truth."""
    lit = [r for r in rows if float(r["intensity"]) > 0]
    unit = {r["band"]: 3.1 * float(r["I"]) / float(r["intensity"]) for r in lit}  # of what is dark: of another epoch
    of_median = part_of_median(floor)
    mean = {band: typical or statistics.mean(float(r["intensity"]) for r in rows if r["band"] == band) for band in sorted(unit)}
    median = statistics.median(float(r["intensity"]) for r in rows if r["band"] in unit)
    gain = {band: 1 + zero_point_sd * rng.gauss(0, 1) for band in mean}
    away = Noise(sum(((g - 1) / zero_point_sd) ** 2 for g in gain.values()), median, floor, {})
    out = ["# pol_frame: equatorial", "time_utc,band,flux,flux_err,q,u,q_err,u_err"]
    for r in (r for r in rows if r["band"] in unit):
        true, m, scale = float(r["intensity"]), mean[r["band"]], unit[r["band"]]
        if true > 0:
            scale = 3.1 * float(r["I"]) / true
        sd = blind.photon_sd(true, m, snr)
        seen = gain[r["band"]] * (true * (1 + floor * rng.gauss(0, 1)) + of_median * median * rng.gauss(0, 1)) + sd * rng.gauss(0, 1)
        off, e = [], 0.0
        cells = [r["time_utc"], r["band"], f"{scale * seen:.6e}", f"{scale * sd:.6e}", "", "", "", ""]
        if true > 3 * sd and r["q"]:
            e = math.sqrt(2) * sd / true
            both = math.hypot(e, floor / 2)
            off = [both * rng.gauss(0, 1) for _ in "qu"]
            cells[4:] = [f"{float(r[k]) + x:.6f}" for k, x in zip("qu", off)] + [f"{e:.6f}"] * 2
        away.rows[r["time_utc"], r["band"]] = Away(seen - gain[r["band"]] * true, seen, sd, off, e)
        out.append(",".join(cells))
    path.write_text("\n".join(out) + "\n")
    return away


def tail(n, k, p):
    """Chance of k or more of n, each of chance p."""
    if not 0 < p < 1:
        return float(p >= 1 or k <= 0)
    return sum(math.exp(math.lgamma(n + 1) - math.lgamma(j + 1) - math.lgamma(n - j + 1) + j * math.log(p) + (n - j) * math.log1p(-p)) for j in range(k, n + 1))


def interval(n, k, outside=0.05):
    """Shares of which k of n is neither too few nor too many."""
    def where(is_low):
        low, high = 0.0, 1.0
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if is_low(middle) else (low, middle)
        return low
    return (where(lambda p: tail(n, k, p) < outside / 2) if k else 0.0, where(lambda p: 1 - tail(n, k + 1, p) > outside / 2) if k < n else 1.0)


def parser_of(count, snr, floor):
    """What all programs are told that ask for many curves of one kind; `count`: the name of how many."""
    parser = argparse.ArgumentParser()
    parser.add_argument("object", choices=blind.MESH)
    parser.add_argument(count, type=int)
    parser.add_argument("--snr", type=float, default=snr)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--floor", type=float, default=floor, help="error of the model, put in and told")
    parser.add_argument("--first", type=int, default=0, help="of the seed, the one to begin with")
    blind.add_places(parser)
    return parser


def fit_options(floor, more):
    """Of umov invert, for materials that are right and a model that is wrong by `floor`."""
    return [*KNOWN, "--floor", floor, *more]


def told(parser):
    """The options, with what blind.py's functions ask for, and the folder to work in; what is not known here goes on to umov invert."""
    o, o.given = parser.parse_known_args()
    o.rest, o.surfaces, o.wrong, o.truth = fit_options(o.floor, o.given), 1, getattr(o, "wrong", 0), None
    work = blind.work_folder(o)
    return o, work


def main():
    parser = parser_of("curves", snr=100, floor=0.02)
    parser.add_argument("--only", type=int, help="of the curves, this one alone")
    parser.add_argument("--dark", type=int, default=0)
    o, work = told(parser)
    mesh = work / f"{o.object}.obj"
    blind.make_mesh(o.umov, blind.MESH[o.object][0], mesh)
    answers = []
    for curve in itertools.count(o.first) if o.only is None else [o.only]:
        if len(answers) == o.curves:
            break
        rng = random.Random(f"{o.seed} {o.object} {curve}")
        truth, (begin, end, step) = blind.random_attitude(rng), arc(rng)
        try:
            rows = blind.make_curve(o, work, [mesh, mesh], curve, blind.inertial(truth), step, rng, (clock(begin), clock(end)))
        except blind.NoResult:
            continue  # after the pass
        if not any(float(row["intensity"]) > 0 for row in rows):
            continue  # no light at all: nothing was seen
        if o.only is None and dark_of(rows) < o.dark:
            continue
        observed(rows, o.snr, o.floor, rng, work / "obs.csv")
        answers.append(judged(o, work, f"{o.object} {curve}", truth, rows))
    for kind, some in kinds(answers):
        low, high = interval(len(some), sum(a.is_held for a in some))
        print(f"{o.object}, S/N {o.snr:g}, seed {o.seed}, {kind}: held {sum(a.is_held for a in some)} of {len(some)} ({low:.3f} to {high:.3f}); "
              f"median set {100 * statistics.median(a.share for a in some):.2g} % of all attitudes, {statistics.median(a.seconds for a in some):.1f} s")


class Answer(typing.NamedTuple):
    is_held: bool
    share: float  # of all attitudes that the set takes
    dark: int  # epochs without light
    seconds: float


def dark_of(rows):
    """Epochs without light."""
    return len({row["time_utc"] for row in rows} - {row["time_utc"] for row in rows if float(row["intensity"]) > 0})


def judged(o, work, name, truth, rows):
    verdict, seconds = blind.asked(o, work, "pose")
    same = blind.twins(truth, verdict["symmetries"])
    best = min((blind.apart(t, verdict["modes"][0]["q"]) for t in same), default=180) if verdict["modes"] else 180
    epochs = len({row["time_utc"] for row in rows})
    out = Answer(blind.in_set(work / "answer/set95.ecsv", same), verdict["share_of_so3"], dark_of(rows), seconds)
    print(f"{name}: {'in' if out.is_held else 'OUT'}, best {best:.2f} deg off, {len(verdict['modes'])} modes, set {100 * out.share:.2g} %, "
          f"chi2 {verdict['chi2']:.1f} of {verdict['dof']}, floor {verdict['floor']:.3f}, {verdict['verdict']}, {epochs} epochs, {out.dark} dark, {seconds:.1f} s", flush=True)
    return out


def kinds(answers):
    """All, and those with and without dark epochs, as far as there are some."""
    for kind, some in (("all", answers), ("none dark", [a for a in answers if not a.dark]), ("some dark", [a for a in answers if a.dark])):
        if some:
            yield kind, some


if __name__ == "__main__":
    main()
