"""Earth, Sun and air around an object (earthshine.md, time_and_frames.md, photometry.md)."""

import mpmath

EARTH_KM = mpmath.mpf("6378.137")


def earthshine(radius_km, zenith_deg, albedo=mpmath.mpf(".3")):
    """Irradiance of a facet that faces the Earth, and from all sides, over the Sun's (earthshine.md 2, 3).

    Only where all of the cap is sunlit: then the azimuth leaves cos(zenith)."""
    r, cosine = mpmath.mpf(radius_km), mpmath.cos(mpmath.radians(zenith_deg))
    assert mpmath.radians(zenith_deg) + mpmath.acos(EARTH_KM / r) < mpmath.pi / 2
    last = mpmath.asin(EARTH_KM / r)

    def inner(u):  # eta = last (1 - u^2): smooth at the limb
        eta = last * (1 - u * u)
        root = mpmath.sqrt(max(0, EARTH_KM ** 2 - (r * mpmath.sin(eta)) ** 2))
        distance = r * mpmath.cos(eta) - root
        return (r - distance * mpmath.cos(eta)) / EARTH_KM * mpmath.sin(eta) * 2 * last * u, mpmath.cos(eta)

    facet = mpmath.quad(lambda u: inner(u)[0] * inner(u)[1], [0, 1])
    around = mpmath.quad(lambda u: inner(u)[0], [0, 1])
    return 2 * albedo * cosine * facet, 2 * albedo * cosine * around


def sunlit(radius_km, place, sun_deg=".2666"):
    """Visible part of a uniform disk beside a sphere (time_and_frames.md 8): place = (c - b)/a."""
    a = mpmath.radians(mpmath.mpf(sun_deg))
    b = mpmath.asin(EARTH_KM / mpmath.mpf(radius_km))
    c = b + place * a
    x = (c * c + a * a - b * b) / (2 * c)
    hidden = a * a * mpmath.acos(x / a) + b * b * mpmath.acos((c - x) / b) - c * mpmath.sqrt(a * a - x * x)
    return 1 - hidden / (mpmath.pi * a * a)


def airmass(zenith_deg):
    """Kasten & Young 1989, Eq. 3 (photometry.md 3)."""
    z = mpmath.mpf(zenith_deg)
    power = (mpmath.mpf("96.07995") - z) ** mpmath.mpf("-1.6364")
    return 1 / (mpmath.cos(mpmath.radians(z)) + mpmath.mpf("0.50572") * power)


def magnitude(intensity, range_m, sun=mpmath.mpf("-26.76")):
    """Beside the Sun's own, V = -26.76 (Willmer 2018; photometry.md 1)."""
    return sun - mpmath.mpf(5) / 2 * mpmath.log10(intensity / mpmath.mpf(range_m) ** 2)


def earthshine_rows():
    for radius, zenith, digits in (("6878.137", 0, 6), ("6878.137", 60, 6), ("42164", 0, 7),
                                   ("42164.137", 0, 7)):
        facet, around = earthshine(radius, zenith)
        yield radius, zenith, (facet, digits), (around, digits)


def eclipse_rows():
    for radius in ("6878.137", "42164"):
        for place in ("-.5", "0", ".5"):
            yield radius, place, (sunlit(radius, mpmath.mpf(place)), 6)


def airmass_rows():
    for zenith in (60, 80):
        yield zenith, (airmass(zenith), 6)
