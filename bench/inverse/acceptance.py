#!/usr/bin/env python3
"""Fixed attitudes of one pass, many trials: errors, modes, sets, misses and times. Data by rays on a finer mesh than the fitted one, in random attitudes; wrong by
just what the search is told (coverage.py): photons, floor, zero points. Materials are taken for right unless the options say otherwise.
Prints a line a curve, then the summary.

usage: acceptance.py OBJECT TRIALS [--snr 20] [--seed 1] [--floor 0.005] [--first TRIAL] [--third 0|1|2] [--clouds] [--case-r] [--wrong 1] [--facets FIT TRUE] [--step S] [--umov PATH] [--work DIR] [options of umov invert]
OBJECT: as blind.py has them. --third: 40 epochs in that third of the pass instead of one every 12 s of all of it. --clouds: the air of every epoch lets through
another part (normal in ln, a third), which is free in the fit. --case-r: the pass of case_r.py in 40 epochs, noise of photons alone, and S/N of the I (550 nm) that half of
all attitudes and epochs exceed, not of the mean I of each curve, of which a glint is the larger part. Seconds are those of the processor.
--wrong 1: the true object is another one, as blind.py has it; the fit is told the floor, which is not put in, and takes the materials for unknown (as umov invert does by itself).
missed: the truth itself fits better than the best mode by more than 2 in chi-square (with the gains that the data were made with, so it fits a little better still), of the rows and with the floor of the fit.
--facets: of a box-wing, as it is fitted and as the data have it, instead of 600 and 1,500. --step: seconds from one epoch to the next; 9 are 39 epochs of that pass."""
import math
import random
import resource
import statistics
import typing

import blind
import case_r
import coverage

LIT_S = (5 * 3600 + 8 * 60, 5 * 3600 + 14 * 60)  # when the body of the pass of blind.py is seen
CLOUDS_SD = 0.33
MANY = 100  # attitudes that stand for all
EXACT = 1e-6  # a zero point that is known


class Answer(typing.NamedTuple):
    best: float  # from the truth [deg]
    nearest: float
    told: float  # root of the mean square that the covariance of that mode says [deg]
    modes: int
    is_held: bool
    share: float
    is_missed: bool
    is_sure: bool
    seconds: float  # of the processor
    clock: float  # [s]


def behind_clouds(rows, rng):
    part = {row["time_utc"]: math.exp(CLOUDS_SD * rng.gauss(0, 1)) for row in rows}
    return [{**row, "I": float(row["I"]) * part[row["time_utc"]], "intensity": float(row["intensity"]) * part[row["time_utc"]]} for row in rows]


def typical_light(o, work, meshes):
    """The I that half of many attitudes and epochs exceed."""
    rng = random.Random(f"{o.seed} typical")
    lit = []
    for trial in range(MANY):
        rows = blind.make_curve(o, work, meshes, trial, blind.inertial(blind.random_attitude(rng)), case_r.STEP_S, rng, case_r.SPAN, o.scenario)
        lit += [float(row["intensity"]) for row in rows if row["band"] == "nm:550"]
    return statistics.median(lit)


def span_of(third, is_case_r):
    if third is None:
        return (case_r.SPAN, case_r.STEP_S) if is_case_r else (blind.SPAN, 12)
    first, last = (case_r.MIDDLE_S - case_r.HALF_S + case_r.STEP_S, case_r.MIDDLE_S + case_r.HALF_S) if is_case_r else LIT_S
    length = (last - first) / 3
    begin = first + third * length
    return (coverage.clock(begin), coverage.clock(begin + length - 1)), length / 40


def processor_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def told_deg(path, mode):
    row = blind.table_rows(path)[mode]
    return math.degrees(math.sqrt(sum(float(row[f"cov_{k}{k}"]) for k in "xyz")))


def asked(o, work, meshes, trial):
    rng = random.Random(f"{o.seed} acceptance {o.object} {trial}")
    truth = blind.random_attitude(rng)
    span, step = span_of(o.third, o.case_r)
    rows = blind.make_curve(o, work, meshes, trial, blind.inertial(truth), o.step or step, rng, span, o.scenario)
    if not any(float(row["intensity"]) > 0 for row in rows):
        return None  # no light at all: nothing was seen
    noise = coverage.observed(behind_clouds(rows, rng) if o.clouds else rows, o.snr, 0 if o.wrong else o.floor, rng, work / "obs.csv",
                              EXACT if o.case_r else coverage.ZERO_POINT_SD, o.typical)
    began = processor_s()
    verdict, clock = blind.asked(o, work, "pose", *(["--clouds"] if o.clouds else []))
    seconds = processor_s() - began
    same = blind.twins(truth, verdict["symmetries"])
    off = [min(blind.apart(t, m["q"]) for t in same) for m in verdict["modes"]]
    if verdict["epochs_searched"] < verdict["epochs"]:
        raise SystemExit("so many epochs that umov joins some: chi-square of their rows is not that of the fit")
    chi2 = noise.chi2(verdict["floor"], blind.table_rows(work / "answer/fit.ecsv"))
    told = told_deg(work / "answer/modes.ecsv", off.index(min(off)))
    out = Answer(off[0], min(off), told, len(off), blind.in_set(work / "answer/set95.ecsv", same), verdict["share_of_so3"],
                 not o.clouds and not o.wrong and verdict["chi2"] > chi2 + 2, verdict["verdict"] == "determined", seconds, clock)
    phases = [float(row["phase_angle"]) for row in rows]
    print(f"{o.object} {trial}: best {out.best:.3f}, nearest {out.nearest:.3f} deg (told {out.told:.3f}) of {out.modes} modes, {'in' if out.is_held else 'OUT'}, set {100 * out.share:.2g} %, "
          f"chi2 {verdict['chi2']:.1f} of {verdict['dof']}, truth's {chi2:.1f}{', MISSED' if out.is_missed else ''}, {verdict['verdict']}, floor {verdict['floor']:.3f}, {len(rows) // 3} epochs, "
          f"phase {min(phases):.0f}-{max(phases):.0f}, {seconds:.1f} s, {clock:.1f} by the clock", flush=True)
    return out


def main():
    parser = coverage.parser_of("trials", snr=20, floor=0.005)
    parser.add_argument("--third", type=int, choices=(0, 1, 2))
    parser.add_argument("--clouds", action="store_true")
    parser.add_argument("--case-r", action="store_true")
    parser.add_argument("--wrong", type=float, default=0)
    parser.add_argument("--facets", nargs=2, type=int)
    parser.add_argument("--step", type=float)
    o, work = coverage.told(parser)
    if o.facets and o.object != "box-wing":
        parser.error("--facets goes with a box-wing")
    o.typical, o.scenario = None, blind.SCENARIO
    known = ["--zero-point-sd", EXACT] if o.case_r else []
    if o.case_r:
        o.scenario = case_r.scenario(blind.SCENARIO, work)
    if o.wrong:
        o.rest = ["--floor", o.floor, *known, *o.given]
    elif o.case_r:
        o.floor, o.rest = 0, coverage.fit_options(0, [*known, "--largest-floor", 0, *o.given])
    meshes = [work / f"{o.object}_{k}.obj" for k in ("fit", "true")]
    shapes = [["box-wing", "--facets", facets] for facets in o.facets] if o.facets else blind.MESH[o.object]
    for mesh, words in zip(meshes, shapes):
        blind.make_mesh(o.umov, words, mesh)
    if o.case_r:
        o.typical = typical_light(o, work, meshes)
    answers = []
    trial = o.first
    while len(answers) < o.trials:
        answer = asked(o, work, meshes, trial)
        answers += [answer] if answer else []
        trial += 1
    tell(o, answers)


def tell(o, answers):
    n = len(answers)
    held = sum(a.is_held for a in answers)
    low, high = coverage.interval(n, held)
    sure = [a for a in answers if a.is_sure]
    print(f"{o.object}, S/N {o.snr:g}, seed {o.seed}, {n} curves: best < 5 deg {sum(a.best < 5 for a in answers) / n:.2f}, nearest mode < 5 deg {sum(a.nearest < 5 for a in answers) / n:.2f}; "
          f"median error of the best {statistics.median(a.best for a in answers):.3f} deg, of the nearest {statistics.median(a.nearest for a in answers):.3f} (told {statistics.median(a.told for a in answers):.3f}); modes {statistics.median(a.modes for a in answers):g}; "
          f"held {held} ({low:.3f} to {high:.3f}) in sets of {100 * statistics.median(a.share for a in answers):.2g} %; missed {'-' if o.clouds or o.wrong else sum(a.is_missed for a in answers)}; "
          f"determined {len(sure)}, of these more than 5 deg off {sum(a.best > 5 for a in sure)}; {statistics.median(a.seconds for a in answers):.1f} s, {statistics.median(a.clock for a in answers):.1f} by the clock")


if __name__ == "__main__":
    main()
