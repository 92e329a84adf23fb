"""How the Earth turns: the table that is compiled in, and one of the user's."""
from pathlib import Path

import astropy.units as u
import astropy_iers_data
import numpy as np
import pytest
from astropy.coordinates import GCRS, ITRS, CartesianRepresentation
from astropy.time import Time
from astropy.utils import iers

from conftest import read_csv

FINALS = Path(astropy_iers_data.__file__).parent / "data/finals2000A.all"
POINT_KM = (20000.0, 30000.0, 10000.0)
OEM = """CCSDS_OEM_VERS = 2.0
CREATION_DATE = 2026-01-01T00:00:00
ORIGINATOR = TEST
META_START
OBJECT_NAME = POINT
OBJECT_ID = 2000-001A
CENTER_NAME = EARTH
REF_FRAME = GCRF
TIME_SYSTEM = UTC
START_TIME = {day}T00:00:00
STOP_TIME = {day}T01:00:00
INTERPOLATION = LINEAR
INTERPOLATION_DEGREE = 1
META_STOP
{day}T00:00:00 20000 30000 10000 0 0 0
{day}T01:00:00 20000 30000 10000 0 0 0
"""


def itrs(umov, tmp_path, day, *options):
    """Where a point that stands still in GCRS is at 00:20 in ITRS [km], and what was said."""
    (tmp_path / "point.oem").write_text(OEM.format(day=day))
    time = f"{day}T00:20:00Z"
    done = umov("orbit", "ephemeris", "--orbit", "point.oem", "-s", "maui", "--start", time,
                "--stop", time, "-o", "e.csv", *options)
    assert done.code == 0, done.err
    row = read_csv(tmp_path / "e.csv")[0]
    return np.array([float(row[f"itrs_{axis}"]) for axis in "xyz"]), done.err


@pytest.mark.parametrize("day", [
    "1995-03-01", "1998-12-31", "2001-06-15", "2005-12-31", "2009-07-04", "2012-06-30", "2016-12-31",
    "2020-02-29", "2024-11-05", "2027-06-01"])
def test_ten_dates_without_a_warning_and_as_astropy_has_them(umov, tmp_path, day):
    found, said = itrs(umov, tmp_path, day)
    assert "warning" not in said
    table = iers.IERS_A.open(str(FINALS))
    for name in ("UT1_UTC", "PM_x", "PM_y"):  # Bulletin A alone, as ours: B is up to 0.1 ms off it
        table[name] = table[f"{name}_A"]
    with iers.earth_orientation_table.set(table):
        time = Time(f"{day}T00:20:00", scale="utc")
        point = GCRS(CartesianRepresentation(POINT_KM * u.km), obstime=time)
        truth = point.transform_to(ITRS(obstime=time)).cartesian.xyz.to_value(u.km)
    angle = np.arctan2(np.linalg.norm(np.cross(found, truth)), np.dot(found, truth))
    # 1 mas. UT1 0.1 ms off would turn the point by 1.3 mas; the same table, the same IAU 2006/2000A.
    assert angle < 1e-3 / 206264.8


def test_a_table_of_the_users(umov, tmp_path, scenario):
    base, _ = itrs(umov, tmp_path, "2018-01-21")
    same, said = itrs(umov, tmp_path, "2018-01-21", "--eop", FINALS)
    assert np.array_equal(base, same) and not said
    (tmp_path / "eop.csv").write_text("mjd,x_arcsec,y_arcsec,ut1_utc_s\n" + "".join(
        f"{day},0,0,0.5\n" for day in range(58130, 58145)))
    moved, _ = itrs(umov, tmp_path, "2018-01-21", "--eop", "eop.csv")
    # UT1-UTC was .2105 s by IERS, here .5: the Earth has turned by 0.2895 s more.
    turned = np.arctan2(base[1], base[0]) - np.arctan2(moved[1], moved[0])
    assert turned == pytest.approx((0.5 - 0.2105) * 7.2921159e-5, abs=2e-4 * 7.3e-5 + 1e-6)
    (tmp_path / "bad.csv").write_text("mjd,x_arcsec,y_arcsec,ut1_utc_s\n58130,0,0,0.5\n58131,0,0,50\n")
    for change, options in (((("[bands]", '[earth]\neop = "bad.csv"\n[bands]'),), ()),
                            ((), ("--eop", tmp_path / "bad.csv"))):
        done = umov("run", scenario(*change), "--dry-run", *options)
        assert done.code == 3 and "bad.csv:3" in done.err and "finals2000A" in done.err, done.err
    done = umov("run", scenario(("[bands]", '[earth]\neop = "none.csv"\n[bands]')), "--dry-run")
    assert done.code == 3 and "none.csv" in done.err and "named in" in done.err


def test_past_the_table_the_warning_says_what_that_is_off_by(umov, tmp_path):
    _, said = itrs(umov, tmp_path, "2028-01-01")
    # 64 days after 2027-10-29 at up to 3 ms a day.
    assert "held" in said and "0.19 s or 90 m" in said and "--eop" in said
