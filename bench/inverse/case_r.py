"""The pass that goals of accuracy name: 480 s of a circular orbit 700 km high, 14.3 deg beside the site's zenith at its middle, the Sun 20.4 deg below the horizon, phase angles
from 68 to 148 deg, 40 epochs of which the first is in the Earth's shadow. Directions to the Sun are good to .01 deg, precession (.25 deg) is left out: of what the pass is like, not of any orbit."""
import math

from coverage import clock
from vectors import cross, dot, unit

EARTH_KM, HEIGHT_KM, GM = 6378.0, 700.0, 398600.4
BESIDE_RAD, SUN = 0.25, (-0.35, 0.85, 0.40)  # the Sun along zenith, flight and what is left
MIDDLE_S, HALF_S, EPOCHS = 5 * 3600 + 12 * 60, 240, 40  # of 2018-01-21
STEP_S = 2 * HALF_S / (EPOCHS - 1)
SPAN = (clock(MIDDLE_S - HALF_S), clock(MIDDLE_S + HALF_S + 1))
DAYS = 6594.5 + MIDDLE_S / 86400  # since J2000


def to_sun():
    """Astronomical Almanac, section C: low precision."""
    g = math.radians(357.528 + 0.9856003 * DAYS)
    along = math.radians(280.460 + 0.9856474 * DAYS + 1.915 * math.sin(g) + 0.020 * math.sin(2 * g))
    tilt = math.radians(23.439)
    return [math.cos(along), math.sin(along) * math.cos(tilt), math.sin(along) * math.sin(tilt)]


def axes():
    """Zenith, flight and what is left, among the stars: the shortest turn that brings the Sun of the pass to the Sun."""
    a, b = unit(SUN), to_sun()
    w, c = cross(a, b), dot(a, b)

    def turned(v):
        return [x * c + y + z * dot(w, v) / (1 + c) for x, y, z in zip(v, cross(w, v), w)]
    return [turned([float(k == j) for j in range(3)]) for k in range(3)]


def states():
    """Seconds of the day, km and km/s of the orbit."""
    x, y, z = axes()
    r = EARTH_KM + HEIGHT_KM
    w = math.sqrt(GM / r**3)
    ahead = unit([a * math.cos(BESIDE_RAD) + b * math.sin(BESIDE_RAD) for a, b in zip(x, z)])
    for t in range(-300, 301, 10):
        c, s = math.cos(w * t), math.sin(w * t)
        yield MIDDLE_S + t, [r * (c * a + s * b) for a, b in zip(ahead, y)], [r * w * (c * b - s * a) for a, b in zip(ahead, y)]


def site():
    """Latitude and longitude [deg] where the zenith is that of the pass."""
    zenith = axes()[0]
    star = 280.46061837 + 360.98564736629 * DAYS
    return math.degrees(math.asin(zenith[2])), (math.degrees(math.atan2(zenith[1], zenith[0])) - star + 180) % 360 - 180


def scenario(text, folder):
    """The scenario of blind.py with this pass; its orbit is written to the folder."""
    lines = [f"{clock(t)[:-1]} " + " ".join(f"{v:.9f}" for v in (*place, *speed)) for t, place, speed in states()]
    (folder / "case_r.oem").write_text("\n".join(
        ["CCSDS_OEM_VERS = 2.0", "CREATION_DATE = 2018-01-20T00:00:00", "ORIGINATOR = UMOV", "META_START", "OBJECT_NAME = BOX", "OBJECT_ID = 2018-001A", "CENTER_NAME = EARTH",
         "REF_FRAME = EME2000", "TIME_SYSTEM = UTC", f"START_TIME = {lines[0].split()[0]}", f"STOP_TIME = {lines[-1].split()[0]}", "META_STOP", *lines]) + "\n")
    latitude, longitude = site()
    for old, new in (("lat_deg = 20.7083", f"lat_deg = {latitude:.6f}"), ("lon_deg = -156.2578", f"lon_deg = {longitude:.6f}"), ("alt_m = 3058", "alt_m = 0"),
                     ("alt_min_deg = 10", "alt_min_deg = 0"), ('"{root}/data/tle/hst.tle", norad = 20580', f'"{folder}/case_r.oem"')):
        text = text.replace(old, new)
    return text
