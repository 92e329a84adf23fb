"""Objects of several materials in the three bands of Table 1 (docs/theory/paper.md 1-4)."""

import mpmath
import numpy as np

from interfaces import TABLE_1, factors, incidence


def light(name, phase):
    """F and F Q of one reflection in the three bands."""
    pairs = [factors(incidence(phase), eta) for eta in TABLE_1[name]]
    return np.array([[float(a), float(b)] for a, b in pairs]).T


def mixed(one, other, share):
    i, s = (share[:, None] * one[k] + (1 - share[:, None]) * other[k] for k in (0, 1))
    return s / i


def departure(name, other, phase):
    """Length of the chord in Q-RGB and the largest distance of the mixtures from it (paper.md 3)."""
    a, b = light(name, phase), light(other, phase)
    start, end = b[1] / b[0], a[1] / a[0]
    chord = end - start
    length = np.linalg.norm(chord)

    def distance(share):
        off = mixed(a, b, np.atleast_1d(np.asarray(share, dtype=float))) - start
        along = off @ chord / length
        return np.sqrt(np.maximum(0, np.sum(off * off, axis=1) - along * along))

    low, high = 0.0, 1.0
    for _ in range(12):  # a comb around the largest value, each a hundredth of the one before
        comb = np.linspace(low, high, 201)
        best = int(np.argmax(distance(comb)))
        low, high = comb[max(best - 1, 0)], comb[min(best + 1, 200)]
    return length, float(distance(low)[0])


PAIRS = (("paper_au", "paper_al", (60, 100, 140, 160)), ("paper_au", "paper_bk7", (60, 140)),
         ("paper_au", "paper_asi", (60, 140)), ("paper_al", "paper_mylar", (60, 140)),
         ("paper_bk7", "paper_mylar", (60, 140)), ("paper_al", "paper_bk7", (60, 140)))


def departure_rows():
    for one, other, phases in PAIRS:
        for phase in phases:
            length, largest = departure(one, other, phase)
            ratio = largest / length
            yield one, other, phase, (ratio, 3 if ratio > .1 else 4)


def half_rows():
    """Equal weights of gold and aluminium at phase 140."""
    q = mixed(light("paper_au", 140), light("paper_al", 140), np.array([.5]))[0]
    for nm, value in zip((425, 550, 650), q):
        yield nm, (value, 6)


def random_mixtures(phase, count=50_000):
    """Q of mixtures of the paper's six materials, weights spread evenly over all that add up to one.

    Spectralon has no interface; its light from below is taken to be as bright as a mirror's."""
    draw = np.random.Generator(np.random.PCG64(2))
    lights = [light(name, phase) for name in TABLE_1] + [np.array([[1, 1, 1], [0, 0, 0]])]
    weights = draw.exponential(size=(count, len(lights)))
    i, s = (sum(weights[:, [k]] * one[part] for k, one in enumerate(lights)) for part in (0, 1))
    return s / i


def plane(points):
    """Normal (blue, green, red) of the plane that fits best, and its thickness over its size."""
    _, size, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return axes[2] * np.sign(axes[2][1]), size[2] / size[0]


def plane_rows():
    """The last row: all phase angles from 40 to 140 deg together."""
    for phase in (40, 140):
        normal, thickness = plane(random_mixtures(phase))
        yield phase, *((x, 3) for x in normal), (thickness, 4)
    normal, thickness = plane(np.vstack([random_mixtures(phase) for phase in range(40, 141, 20)]))
    yield "all", *((x, 3) for x in normal), (thickness, 4)
