"""From counts back to Stokes parameters (docs/theory/observing.md 5 to 7), by least squares and quadrature in numpy."""

from math import erf, lgamma

import numpy as np

DEGREE = np.pi / 180
ANGLES = np.array([0, 45, 90, 135]) * DEGREE
D300 = 299 / 301
GAINS = np.array([.98, 1, 1.02, 1.01])
ROWS = GAINS[:, None] / 2 * np.column_stack([np.ones(4), D300 * np.cos(2 * ANGLES), D300 * np.sin(2 * ANGLES)])
COUNTS, SKY = np.array([3120., 2705, 2210, 2650]), 120.
FIXED = 40 * 2.3 ** 2 + SKY * 40 / 400 + 40 * 2.6 ** 2 / 12


def weighted(c):
    inverse = np.linalg.inv(c)
    covariance = np.linalg.inv(ROWS.T @ inverse @ ROWS)
    return covariance @ ROWS.T @ inverse @ (COUNTS - SKY), covariance


def fit(loops=60):
    """The fixed point: variances of the model that they lead to."""
    variance = COUNTS + FIXED
    for _ in range(loops):
        s, covariance = weighted(np.diag(variance))
        variance = ROWS @ s + SKY + FIXED
    return s, covariance, variance


def fractions(s, covariance):
    j = np.array([[-s[1] / s[0] ** 2, 1 / s[0], 0], [-s[2] / s[0] ** 2, 0, 1 / s[0]]])
    return s[1:] / s[0], j @ covariance @ j.T


def common_columns(s):
    gains = [np.eye(4)[k] * (ROWS @ s) for k in range(4)]
    own = [ROWS[:, 0] * s[0] * np.cos(2 * ANGLES), ROWS[:, 0] * s[0] * np.sin(2 * ANGLES)]
    return {"instrumental": own, "gains": gains, "scintillation": [ROWS @ s]}


PRIORS = {"instrumental": .002, "gains": .005, "scintillation": .0139}


def nuisance_rows():
    s, _, variance = fit()
    columns = common_columns(s)
    for case in ("instrumental", "gains", "scintillation", "all"):
        names = list(PRIORS) if case == "all" else [case]
        j = np.array([c * PRIORS[n] for n in names for c in columns[n]]).T
        c = np.diag(variance) + j @ j.T
        new, covariance = weighted(c)
        value, spread = fractions(new, covariance)
        r = COUNTS - SKY - ROWS @ new
        yield f"{case}_q", value[0]
        yield f"{case}_sd_q", np.sqrt(spread[0, 0])
        yield f"{case}_sd_u", np.sqrt(spread[1, 1])
        yield f"{case}_sd_i", np.sqrt(covariance[0, 0]) / new[0]
        yield f"{case}_likelihood", r @ np.linalg.solve(c, r) + np.linalg.slogdet(c)[1]


def rice(x, nu):
    """x exp(-(x^2 + nu^2)/2) I0(x nu)."""
    return x * np.exp(-(x * x + nu * nu) / 2) * np.i0(x * nu)


def limits_of(seen, level=.95):
    """Feldman & Cousins' limits of one value: where what is ranked above it has just the level. Sums over a grid, with
    the part of each step that is ranked above: good to 1e-4."""
    step = .004
    x = np.arange(0, 15, step) + 1e-9
    wide = np.arange(0, 15, .01)[:, None]
    log_rice = lambda at, nu: np.log(at * np.i0(at * nu)) - (at * at + nu * nu) / 2  # noqa: E731
    best = np.concatenate([log_rice(part, wide).max(axis=0) for part in np.array_split(x, 20)])
    at_seen = log_rice(seen, np.arange(0, seen + 1, .001)).max()

    def above(nu):
        excess = log_rice(x, nu) - best - (log_rice(seen, nu) - at_seen)
        low, high = np.minimum(excess[1:], excess[:-1]), np.maximum(excess[1:], excess[:-1])
        share = np.where(low >= 0, 1, np.where(high <= 0, 0, high / np.where(high > low, high - low, 1)))
        f = rice(x, nu)
        return np.sum((f[1:] + f[:-1]) / 2 * share) * step - level

    def crossing(inside, outside):
        for _ in range(30):
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if above(middle) < 0 else (inside, middle)
        return (inside + outside) / 2

    # The likeliest is well within the region; below 2.4477 nothing at all is too.
    likeliest = np.arange(0, seen + 1, .001)[np.argmax(log_rice(seen, np.arange(0, seen + 1, .001)))]
    return (0 if above(0) < 0 else crossing(likeliest, 0)), crossing(likeliest, likeliest + 4)


def angle_coverage(truth, unknown_below=0):
    """Share of observations whose own 68.27 % half width reaches the true angle; all angles are in it where less than
    `unknown_below` was found."""
    p = np.linspace(1e-3, truth + 8, 900)
    half = np.array([90 if v < unknown_below else angle_half(v) if v < 4 else 1 / (2 * v * DEGREE) for v in p]) * DEGREE
    t = np.linspace(-1, 1, 401)[None, :] * half[:, None]
    # Density of q, u about (truth, 0) in polar coordinates: p dp 2 dt.
    density = np.exp(-(p[:, None] ** 2 + truth ** 2 - 2 * p[:, None] * truth * np.cos(2 * t)) / 2) / 2 / np.pi
    inner = (density[:, 1:] + density[:, :-1]).sum(axis=1) / 2 * (2 * half / 400) * 2 * p
    return np.sum((inner[1:] + inner[:-1]) / 2 * np.diff(p))


def angle_half(x):
    t = np.linspace(0, np.pi / 2, 40001)
    eta = x / np.sqrt(2) * np.cos(2 * t)
    g = (1 / np.sqrt(np.pi) + eta * np.exp(eta ** 2) * (1 + np.array([erf(e) for e in eta])))
    g *= np.exp(-x * x / 2) / np.sqrt(np.pi)
    sums = np.concatenate([[0], np.cumsum((g[1:] + g[:-1]) / 2 * np.diff(t))]) * 2
    return np.interp(.6827, sums, t) / DEGREE


def counts_likelihood(n, mu, read):
    k = np.arange(int(mu + 40 * np.sqrt(mu) + 60))
    terms = k * np.log(mu) - mu - np.array([lgamma(i + 1) for i in k]) - (n - k) ** 2 / 2 / read ** 2
    exact = np.log(np.sum(np.exp(terms - terms.max()))) + terms.max() - np.log(read * np.sqrt(2 * np.pi))
    m, v = n + read ** 2, mu + read ** 2
    return exact, m * np.log(v) - v - lgamma(m + 1), -(n - mu) ** 2 / 2 / v - np.log(2 * np.pi * v) / 2


def multiplied(x, mu, gain):
    """Sum over the number of electrons that went in: each gives an exponential output of mean `gain`."""
    n = np.arange(1, 60)
    log_terms = [k * np.log(mu) - mu - lgamma(k + 1) + (k - 1) * np.log(x) - x / gain - k * np.log(gain) - lgamma(k)
                 for k in n]
    return np.log(np.sum(np.exp(log_terms)))


def standards():
    factor, offset = .985 * np.exp(2j * .8 * DEGREE), .0042 - .0018j
    axes = np.array([0, 30, 60, 90, 10, 40, 70, 100]) * DEGREE
    truth = np.concatenate([np.zeros(4), np.full(4, .04893 * np.exp(2j * 59.10 * DEGREE))])
    g = np.column_stack([truth * np.exp(-2j * axes), np.ones(8)])
    inverse = np.linalg.inv(g.conj().T @ g)
    return abs(factor), 5e-4 * np.sqrt(inverse[0, 0].real), 5e-4 * np.sqrt(inverse[1, 1].real)


def uncertain_standards(p_sd=.00029, angle_sd=.17 * DEGREE):
    """The same where the star's own degree and angle are wrong by as much in all four measurements: the whole covariance."""
    factor, star = .985 * np.exp(2j * .8 * DEGREE), .04893 * np.exp(2j * 59.10 * DEGREE)
    axes = np.array([0, 30, 60, 90, 10, 40, 70, 100]) * DEGREE
    seen = np.array([0, 0, 0, 0, 1, 1, 1, 1])
    turned = seen * np.exp(-2j * axes)
    columns = [star * turned, 1j * star * turned, np.ones(8), 1j * np.ones(8)]
    common = [factor * star / abs(star) * turned * p_sd, factor * 2j * star * turned * angle_sd]
    real = lambda parts: np.array([np.concatenate([p.real, p.imag]) for p in parts]).T  # noqa: E731
    j, g = real(common), real(columns)
    covariance = np.linalg.inv(g.T @ np.linalg.inv(5e-4 ** 2 * np.eye(16) + j @ j.T) @ g)
    return tuple(np.sqrt(covariance.diagonal().reshape(2, 2).mean(axis=1)))


def photometry():
    star = np.array([8.120, 9.455, 8.902, 10.231, 9.017, 9.788])
    x = np.array([1.02, 1.21, 1.55, 1.08, 1.90, 1.37])
    c = np.array([.05, .62, 1.10, .35, .71, -.02])
    seen = star - 20.571 + .118 * x - .030 * c + np.array([.004, -.003, .002, -.005, .001, .001])
    m = np.column_stack([np.ones(6), -x, -c])
    found, left = np.linalg.lstsq(m, star - seen, rcond=None)[:2]
    covariance = np.linalg.inv(m.T @ m) * left[0] / 3
    return found, np.sqrt(np.diag(covariance)), np.sqrt(left[0] / 3), covariance


def second_order():
    """The six stars with k'' = .035 beside, and two more; the offset of a source of B - V .653 at an air mass of 2."""
    star = np.array([8.120, 9.455, 8.902, 10.231, 9.017, 9.788, 8.551, 9.203])
    x = np.array([1.02, 1.21, 1.55, 1.08, 1.90, 1.37, 2.10, 1.15])
    c = np.array([.05, .62, 1.10, .35, .71, -.02, 1.25, 1.31])
    left = np.array([.004, -.003, .002, -.005, .001, .001, -.002, .003])
    seen = star - 20.571 + .118 * x - .030 * c - .035 * c * x + left
    m = np.column_stack([np.ones(8), -x, -c, c * x])
    found, rest = np.linalg.lstsq(m, star - seen, rcond=None)[:2]
    covariance = np.linalg.inv(m.T @ m) * rest[0] / 4
    effect = np.array([1, -2, -.653, .653 * 2])
    return found, np.sqrt(np.diag(covariance)), effect @ found, np.sqrt(effect @ covariance @ effect)


def turn(x):
    c, s = np.cos(2 * x), np.sin(2 * x)
    return np.array([[1, 0, 0, 0], [0, c, s, 0], [0, -s, c, 0], [0, 0, 0, 1]])


def retarder(d, x):
    c, s = np.cos(d), np.sin(d)
    return turn(-x) @ np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, c, -s], [0, 0, s, c]]) @ turn(x)


def retarder_rows(d=131.8 * DEGREE, zero=0, chi=25 * DEGREE, leaks=(0, 0)):
    """Four states of a retarder before an analyser of extinction 300, behind retarders at 0 and 45 deg."""
    analyser = (1 + 1 / 300) / 2 * np.array([1, D300, 0, 0])
    before = retarder(leaks[0], 0) @ retarder(leaks[1], 45 * DEGREE) @ turn(chi)
    return np.array([analyser @ retarder(d, x * DEGREE + zero) @ before for x in (-51.69, -15.12, 15.12, 51.69)])


def instrument_priors():
    """sd of q, u, v of 4e6 electrons with one error of the instrument, by differences of the whole chain."""
    s = 1e6 * np.array([1, .2, -.1, .05])
    step = 1e-5
    ways = {"crosstalk": ([{"leaks": (1, 0)}, {"leaks": (0, 1)}], .02), "plate": ([{"zero": 1}], .1 * DEGREE),
            "retardance": ([{"d": 1}], 2 * DEGREE), "clock": ([{"chi": 1}], .5 * DEGREE)}  # .5 s at 1 deg/s
    base = {"d": 131.8 * DEGREE, "zero": 0, "chi": 25 * DEGREE, "leaks": (0, 0)}
    moved = lambda way, by: {k: np.add(base[k], np.multiply(v, by)) for k, v in way.items()}  # noqa: E731
    w = retarder_rows()
    for name, (all_ways, sd) in ways.items():
        j = [sd * (retarder_rows(**moved(way, step)) - retarder_rows(**moved(way, -step))) @ s / (2 * step) for way in all_ways]
        c = np.diag(w @ s) + sum(np.outer(one, one) for one in j)
        covariance = np.linalg.inv(w.T @ np.linalg.inv(c) @ w)
        f = np.column_stack([-s[1:] / s[0] ** 2, np.eye(3) / s[0]])
        yield name, np.sqrt(np.diag(f @ covariance @ f.T))


def data_weighted(mean, read):
    """Mean of counts about `mean` read with a normal error, each weighted by the variance that it seems to have itself."""
    n = np.arange(0, 100)[:, None]
    z = np.linspace(-8, 8, 2001)[None, :]
    p = np.exp(-mean) * np.cumprod(np.concatenate([[1.], mean / np.arange(1, 100)]))[:, None] * np.exp(-z ** 2 / 2)
    seen = n + read * z
    weight = p / (np.maximum(seen, 0) + read ** 2)
    return (weight * seen).sum() / weight.sum()


def sequence_rms(order, exposure):
    angles = np.array(order) * DEGREE
    begin = np.arange(len(order)) * exposure
    out = []
    for phase in np.linspace(0, 2 * np.pi, 73):  # the mean of each exposure of 1 + .3 cos, period 10 s
        f = lambda t: t + .3 * 10 / 2 / np.pi * np.sin(2 * np.pi * t / 10 + phase)  # noqa: E731
        light = f(begin + exposure) - f(begin)
        w = np.column_stack([np.ones(len(order)), np.cos(2 * angles), np.sin(2 * angles)]) / 2
        s = np.linalg.lstsq(w, light, rcond=None)[0]
        out.append(np.hypot(s[1], s[2]) / s[0])
    return np.sqrt(np.mean(np.square(out))), max(out)


def rows():
    """name, formula, value."""
    six = "observing.md 6"
    s, covariance, variance = fit()
    for k, name in enumerate("IQU"):
        yield f"fit_{name}", six, (s[k], "10g")
        yield f"fit_{name}{name}", six, (covariance[k, k], "9g")
    value, spread = fractions(s, covariance)
    for name, a, b in (("IQ", 0, 1), ("IU", 0, 2), ("QU", 1, 2)):
        yield f"fit_{name}", six, (covariance[a, b], "9g")
    p = np.hypot(*value)
    radial, across = value / p, np.array([-value[1], value[0]]) / p
    along2, across2 = radial @ spread @ radial, across @ spread @ across
    yield "fit_p", six, (p, "9g")
    yield "fit_debiased", six, (p - across2 * (1 - np.exp(-p * p / across2)) / 2 / p, "9g")
    yield "fit_sd_p", six, (np.sqrt(along2), "9g")
    yield "fit_angle_deg", six, (np.arctan2(value[1], value[0]) / 2 / DEGREE, "9g")
    yield "fit_angle_sd_deg", six, (np.sqrt(across2) / 2 / p / DEGREE, "9g")
    yield "fit_q", six, (value[0], "9g")
    yield "fit_u", six, (value[1], "9g")
    yield "fit_sd_q", six, (np.sqrt(spread[0, 0]), "9g")
    yield "fit_sd_u", six, (np.sqrt(spread[1, 1]), "9g")
    yield "fit_chi2", six, (np.sum((COUNTS - SKY - ROWS @ s) ** 2 / variance), "9g")
    for x in (.5, 1, 2, 3, 5):
        yield f"debiased_{x:g}", six, (x - (1 - np.exp(-x * x)) / 2 / x, "9g")
    for x in (1, 2, 3, 5):
        yield f"angle_{x}", six, (angle_half(x), "7g")
    for x in (.25, .5, 1, 1.5, 2, 2.5, 3, 4, 5):
        for end, limit in zip(("low", "high"), limits_of(x)):
            yield f"{end}_{x:g}", six, (limit, 4)
    for truth in (1, 2, 3, 4, 8):
        yield f"angle_coverage_{truth}", six, (angle_coverage(truth), 4)
    for truth in (.25, .5, 1, 1.5, 2, 4, 8):
        yield f"reach_coverage_{truth:g}", six, (angle_coverage(truth, 1.28), 4)
    for name, order, exposure in (("plain", (0, 45, 90, 135), 1), ("crossed", (0, 90, 45, 135), 1),
                                  ("mirrored", (0, 45, 90, 135, 135, 90, 45, 0), 1),
                                  ("quick", (0, 45, 90, 135), .05)):
        rms, largest = sequence_rms(order, exposure)
        yield f"tumble_{name}_rms", six, (rms, "7g")
        yield f"tumble_{name}_largest", six, (largest, "7g")
    five = "observing.md 5"
    for name, number in zip(("factor", "factor_sd", "offset_sd"), standards()):
        yield f"standards_{name}", five, (number, "9g")
    factor, factor_sd, _ = standards()
    yield "standards_phi0_sd_deg", five, (factor_sd / factor / 2 / DEGREE, "9g")
    for name, number in zip(("factor_sd", "offset_sd"), uncertain_standards()):
        yield f"uncertain_{name}", five, (number, "9g")
    found, sds, residual, c = photometry()
    for k, name in enumerate(("zero", "extinction", "colour")):
        yield f"photometry_{name}", five, (found[k], "9g")
        yield f"photometry_{name}_sd", five, (sds[k], "9g")
    yield "photometry_residual", five, (residual, "9g")
    yield "photometry_correlation", five, (c[0, 1] / sds[0] / sds[1], "9g")
    found, sds, offset, spread = second_order()
    for k, name in enumerate(("zero", "extinction", "colour", "second")):
        yield f"second_order_{name}", five, (found[k], "9g")
        yield f"second_order_{name}_sd", five, (sds[k], "9g")
    yield "second_order_offset", five, (offset, "9g")
    yield "second_order_offset_sd", five, (spread, "9g")
    seven = "observing.md 7"
    for name, numbers in instrument_priors():
        for letter, number in zip("quv", numbers):
            yield f"{name}_sd_{letter}", seven, (number, "7g")
    for name, number in nuisance_rows():
        yield name, seven, (number, "9g")
    for n, mu, read in ((3.2, 5, 1.6), (52.3, 45, 3), (1012, 980, 7)):
        for kind, number in zip(("exact", "shifted", "normal"), counts_likelihood(n, mu, read)):
            yield f"{kind}_{mu}", seven, (number, "8g")
    for mean in (2, 5, 20):
        yield f"data_weighted_{mean}", seven, (data_weighted(mean, 1.6), "6g")
    yield "multiplied", seven, (multiplied(1500, 3, 300), "8g")
