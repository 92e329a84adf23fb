#!/usr/bin/env python3
"""How often intervals of the degree of polarization hold the truth where q and u are not known alike.

    .deps/venv/bin/python bench/interval/coverage.py        a minute; numpy alone, none of umov's code

Feldman & Cousins (1998) order what can be found, p, by its density over the largest density that any true degree gives it. With
equal errors that density is Rice's. With others it depends on the true angle, which nobody knows; four ways are tried: the angle that
was found stands for it ("found"), the true one does ("true", for comparison), Rice's density of the larger error ("larger"), and of the
mean variance ("mean"). Printed: least and largest share of 200,000 draws over the true angles 0, 22.5 ... 90 deg (of 2 psi, from the
better known of both), for intervals of 68.27 and 95 %. p is in units of the root of the mean variance."""
import numpy as np

STEP, DRAWS = .025, 200_000
FOUND = np.arange(STEP / 2, 22, STEP)
TRUE = np.arange(0, 18, .06)
ROUND = np.linspace(0, 2 * np.pi, 120, endpoint=False)
ANGLES = np.radians(np.linspace(0, 90, 13))
LEVELS = (.6827, .95)


def errors(ratio):
    """Standard deviations along both axes, of mean variance 1."""
    return np.array([1, np.sqrt(ratio)]) / np.sqrt((1 + ratio) / 2)


def density(sd, angle, degrees):
    """Of FOUND, for each true degree at an angle."""
    x, y = FOUND[:, None] * np.cos(ROUND), FOUND[:, None] * np.sin(ROUND)
    out = [np.exp(-((x - p * np.cos(angle)) / sd[0]) ** 2 / 2 - ((y - p * np.sin(angle)) / sd[1]) ** 2 / 2).mean(1) for p in degrees]
    return np.array(out) * FOUND / (sd[0] * sd[1])


def ranked_above(one, best):
    """Probability of what the ordering takes before each of FOUND, itself included."""
    order = np.argsort(-one / best, kind="stable")
    out = np.empty(len(one))
    out[order] = np.cumsum(one[order]) * STEP
    return out


def main():
    rng = np.random.default_rng(5)
    alike = np.maximum(density((1, 1), 0, TRUE).max(0), 1e-300)
    for ratio in (1, 1.5, 2, 4, 9):
        sd = errors(ratio)
        best = [np.maximum(density(sd, angle, TRUE).max(0), 1e-300) for angle in ANGLES]
        for degree in (.5, 1., 2., 4.):
            by_angle = np.array([ranked_above(density(sd, angle, [degree])[0], b) for angle, b in zip(ANGLES, best)])
            shares = {}
            for angle in np.radians([0, 22.5, 45, 67.5, 90]):
                q, u = np.array([degree * np.cos(angle), degree * np.sin(angle)])[:, None] + sd[:, None] * rng.standard_normal((2, DRAWS))
                p = np.hypot(q, u)

                def ordered_at(turned):
                    place = np.clip(turned / ANGLES[1], 0, len(ANGLES) - 1.001)
                    k, share = place.astype(int), place - place.astype(int)
                    column = np.clip(p / STEP, 0, len(FOUND) - 1).astype(int)
                    return by_angle[k, column] * (1 - share) + by_angle[k + 1, column] * share

                def as_rice(one):
                    return np.interp(p / one, FOUND, ranked_above(density((1, 1), 0, [degree / one])[0], alike))

                for name, rank in (("found", ordered_at(np.arctan2(abs(u), abs(q)))), ("true", ordered_at(np.full(DRAWS, angle))),
                                   ("larger", as_rice(sd.max())), ("mean", as_rice(1))):
                    shares.setdefault(name, []).append([(rank <= level).mean() for level in LEVELS])
            print(f"variances 1:{ratio:g}, p = {degree:g} sd: " + "; ".join(
                f"{name} " + " ".join(f"{low:.3f}-{high:.3f}" for low, high in zip(np.min(found, 0), np.max(found, 0)))
                for name, found in shares.items()), flush=True)


if __name__ == "__main__":
    main()
