"""Light that meets an explicit rough surface once: rays over random height fields (lobes.md, Checks).

No microfacet theory: a field of Gaussian correlation, F = 1, rays that march through it. Beside them the
same share by Smith's masking of Beckmann's lobe."""

import numpy as np

from microfacet import Beckmann, furnace

CELLS, PER_CORRELATION = 512, 8  # periodic tile, cells per correlation length


def height_field(slope, draw):
    """Heights in cells; correlation exp(-r^2/tau^2) has a slope of sqrt(2) sigma/tau per axis."""
    k = 2 * np.pi * np.fft.fftfreq(CELLS)
    power = np.exp(-(k[:, None] ** 2 + k ** 2) * PER_CORRELATION ** 2 / 4)
    z = np.fft.ifft2(np.fft.fft2(draw.normal(size=(CELLS, CELLS))) * np.sqrt(power)).real
    dx = (np.roll(z, -1, 0) - np.roll(z, 1, 0)) / 2
    dy = (np.roll(z, -1, 1) - np.roll(z, 1, 1)) / 2
    return z * slope / np.sqrt((np.mean(dx ** 2) + np.mean(dy ** 2)) / 2)


def look_up(z, x, y):
    """Bilinear height and its two slopes."""
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    u, w = x - i, y - j
    i, j = i % CELLS, j % CELLS
    k, n = (i + 1) % CELLS, (j + 1) % CELLS
    a, b, c, d = z[i, j], z[k, j], z[i, n], z[k, n]
    height = a * (1 - u) * (1 - w) + b * u * (1 - w) + c * (1 - u) * w + d * u * w
    return height, (b - a) * (1 - w) + (d - c) * w, (c - a) * (1 - u) + (d - b) * u


def march(z, at, direction, step, first):
    """Whether rays meet the field before they leave its heights, and where (bisected)."""
    top, low = z.max(), z.min()
    active = np.arange(len(at))
    hit = np.zeros(len(at), dtype=bool)
    place = at.copy()
    reach = np.full(len(at), first)
    while len(active):
        p = at[active] + reach[active, None] * direction[active]
        below = look_up(z, p[:, 0], p[:, 1])[0] > p[:, 2]
        met = active[below]
        if len(met):
            lower, upper = reach[met] - step, reach[met].copy()
            for _ in range(20):
                middle = (lower + upper) / 2
                q = at[met] + middle[:, None] * direction[met]
                inside = look_up(z, q[:, 0], q[:, 1])[0] > q[:, 2]
                upper, lower = np.where(inside, middle, upper), np.where(inside, lower, middle)
            place[met] = at[met] + lower[:, None] * direction[met]
            hit[met] = True
        gone = (p[:, 2] > top) & (direction[active, 2] > 0) | (p[:, 2] < low)
        active = active[~below & ~gone & (reach[active] < 40 * CELLS)]
        reach[active] += step
    return hit, place


def scattered_once(slope, theta_deg, seed, rays=20_000):
    draw = np.random.Generator(np.random.PCG64(seed))
    z = height_field(slope, draw)
    theta = np.deg2rad(theta_deg)
    start = np.column_stack([draw.random((rays, 2)) * CELLS, np.full(rays, z.max() + 1e-6)])
    down = np.tile([-np.sin(theta), 0.0, -np.cos(theta)], (rays, 1))
    hit, at = march(z, start, down, .2, 0.0)
    assert hit.all()
    _, dx, dy = look_up(z, at[:, 0], at[:, 1])
    normal = np.column_stack([-dx, -dy, np.ones(rays)])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    away = down - 2 * np.sum(down * normal, axis=1)[:, None] * normal
    again, _ = march(z, at + 1e-3 * normal, away, .2, .05)
    return 1 - again.mean()


def explicit_rows():
    """Mean of four fields; their spread leaves .002 of uncertainty, cells another .003."""
    lobe = Beckmann(np.sqrt(2) * .3)
    for theta in (0, 60):
        traced = np.mean([scattered_once(.3, theta, seed) for seed in range(1, 5)])
        yield ".3", theta, (traced, 3), (furnace(lobe, "ashikhmin", np.deg2rad(theta)), 4)
