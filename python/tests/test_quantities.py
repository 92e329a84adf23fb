"""Times, places, directions and lengths as other packages have them."""
import math

import numpy as np
import pandas
import pytest
import umov
import umov.plot
from astropy import units as u
from astropy.coordinates import ICRS, SkyCoord
from astropy.table import Column, QTable, Table
from astropy.time import Time
from umov import _numbers

from conftest import DATA, EXAMPLES, LINES

START, STOP = "2018-01-21T05:10:00Z", "2018-01-21T05:11:00Z"
TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def _aimed(at):
    return umov.Satellite(mesh="a.obj", materials="gold", attitude={"point": "+Z", "at": at}).to_dict()["attitude"]["at"]


def test_directions_among_the_stars():
    """The galactic pole in ICRS: 192.85948, 27.12825 deg (The Hipparcos and Tycho Catalogues, vol. 1, eq. 1.5.10)."""
    pole = _aimed(SkyCoord(0 * u.deg, 90 * u.deg, frame="galactic"))
    assert pole["ra_deg"] == pytest.approx(192.85948, abs=1e-4) and pole["dec_deg"] == pytest.approx(27.12825, abs=1e-4)
    star = SkyCoord(83 * u.deg, -5 * u.deg, distance=8 * u.pc)
    assert _aimed(star) == pytest.approx({"ra_deg": 83, "dec_deg": -5})
    with pytest.raises(umov.UsageError, match="is a place 1.5e.08 km from the barycentre"):
        _aimed(SkyCoord(83 * u.deg, -5 * u.deg, distance=1 * u.au))
    with pytest.raises(umov.UsageError, match="does not go into ICRS .*AltAz needs obstime and location"):
        _aimed(SkyCoord(83 * u.deg, 5 * u.deg, frame="altaz"))
    with pytest.raises(umov.UsageError, match="ra_deg is nan"):
        _aimed(SkyCoord(np.nan * u.deg, 5 * u.deg))


def test_units_of_vertices_and_sites():
    sides = [umov.Satellite(mesh=(one, [[0, 1, 2]]), unit=unit, up="+Z", materials="paper_al")
             for one, unit in ((TRIANGLE, "m"), (100 * np.array(TRIANGLE) * u.cm, None), (TRIANGLE * u.m, "mm"), (TRIANGLE * u.m, u.cm))]
    light = [umov.Engine(one, ["nm:550"]).evaluate([0, 0, 1], [0, 1, 1]) for one in sides]
    for other in light[1:]:
        np.testing.assert_allclose(other, light[0], rtol=1e-12)
    assert umov.Site({"lat_deg": 20 * u.deg, "lon_deg": 0.1 * u.rad, "alt_m": 3 * u.km}).alt_m == 3000


def test_kelvin_as_numbers(glass):
    plain, text = (umov.Engine(glass, ["nm:10000"], temperatures=[one]).evaluate([0, 0, 1], [0, 1, 1]) for one in (300, "300"))
    assert plain.tobytes() == text.tobytes() and plain[0, 0] > 0


def test_times_of_skyfield():
    api = pytest.importorskip("skyfield.api")
    scale = api.load.timescale(builtin=True)
    assert umov.utc(scale.utc(2018, 1, 21, 5, 10)) == "2018-01-21T05:10:00.000Z"
    assert umov.propagate(DATA / "tle/hst.tle", [scale.utc(2018, 1, 21)]).error.tolist() == [[0]]
    # A datetime knows no leap second, and no nanosecond.
    assert umov.utc(scale.utc(2016, 12, 31, 23, 59, 60.5)) == "2016-12-31T23:59:60.500Z"
    assert umov.utc(scale.utc(2018, 1, 21, 5, 10, 0.123456789)) == "2018-01-21T05:10:00.123456789Z"
    several = scale.utc(2018, 1, 21, 5, [10, 11])
    np.testing.assert_array_equal(umov.propagate(DATA / "tle/hst.tle", several).position_km,
                                  umov.propagate(DATA / "tle/hst.tle", [START, STOP]).position_km)
    with pytest.raises(umov.UsageError, match=r"shape \(2,\); a single time was expected"):
        umov.utc(several)


def test_catalogues_of_others():
    """As skyfield and sgp4 hold them: a list of objects; lines as numpy, pandas and a file have them."""
    api, sgp4 = pytest.importorskip("skyfield.api"), pytest.importorskip("sgp4.api")
    expected = umov.propagate(DATA / "tle/hst.tle", START)
    scale = api.load.timescale(builtin=True)
    two = [api.EarthSatellite(*LINES, "a\nname", scale), sgp4.Satrec.twoline2rv(*LINES)]
    found = umov.propagate(two, START)
    assert found.norad_cat_id.tolist() == [20580, 20580]
    for position in found.position_km:  # fields of a TLE hold all of it
        np.testing.assert_array_equal(position, expected.position_km[0])
    with open(DATA / "tle/hst.tle") as file:
        for lines in (np.array(LINES), np.array("\n".join(LINES)), np.array(str(DATA / "tle/hst.tle")), pandas.Series(LINES), file):
            np.testing.assert_array_equal(umov.propagate(lines, START).position_km, expected.position_km)
    assert umov.passes(two[0], "maui", START, "2018-01-21T16:00Z", norad=pandas.Series([20580]))["name"][0] == "a name"


def test_times_and_directions_in_tables():
    def made(attitude):
        satellite = umov.Satellite(mesh=(TRIANGLE, [[0, 1, 2]]), materials="paper_al", attitude=attitude)
        return umov.Scenario(satellite).to_dict()["object"][0]["attitude"]
    spin = {"mode": "spin", "axis": "+Z", "period_s": 2 * u.min}
    assert made({**spin, "epoch": Time(START)}) == made({**spin, "epoch": START}) == made({**spin, "epoch": pandas.Timestamp(START)})
    point = {"point": "+Z", "then": "+X", "toward": "velocity"}
    assert made({**point, "at": ICRS(10 * u.deg, 20 * u.deg)}) == made({**point, "at": {"ra_deg": 10, "dec_deg": 20}})


def test_sites_of_rows():
    row = {"lat_deg": 20.5 * u.deg, "lon_deg": -156 * u.deg, "alt_m": 3 * u.km}
    table = QTable({name: [value] for name, value in row.items()} | {"name": ["here"]})
    assert umov.Site(table[0]) == umov.Site(pandas.Series({"lat_deg": 20.5, "lon_deg": -156, "alt_m": 3000, "name": "here"}))


def test_a_row_of_a_plain_table_has_the_units_of_its_columns():
    """The cells of a Table are numbers alone: 3 km were 3 m, and radians degrees."""
    table = Table({"lat_deg": [0.25], "lon_deg": [-156.0], "alt_m": [3.0], "name": ["here"]},
                  units={"lat_deg": u.rad, "lon_deg": None, "alt_m": u.km}, masked=True)
    site = umov.Site(table[0])
    assert (site.name, site.lon_deg, site.alt_m) == ("here", -156, 3000)
    assert site.lat_deg == pytest.approx(math.degrees(0.25), rel=1e-15)  # the last digit of a double
    table["alt_m"].mask = [True]
    with pytest.raises(umov.UsageError, match="alt_m has masked values"):
        umov.Site(table[0])
    table.replace_column("alt_m", Column([3.0], unit="s"))
    with pytest.raises(umov.UsageError, match="alt_m is .*does not go into m"):
        umov.Site(table[0])


def test_quantities_of_indices_temperatures_and_pictures(plate):
    """5500 Angstrom were taken for 5500 nm."""
    of = umov.Material("gold").refractive_index
    np.testing.assert_allclose(of([5500, 6000] * u.AA), of([550, 600]), rtol=1e-12)  # the conversion rounds
    kelvin = umov.Engine(plate, ["nm:550"], temperatures=[300], cache=False).evaluate([0, 0, 1], [0, 0.1, 1])
    for given in ([300 * u.K], [300] * u.K, np.array([300.0])):
        found = umov.Engine(plate, ["nm:550"], temperatures=given, cache=False).evaluate([0, 0, 1], [0, 0.1, 1])
        np.testing.assert_array_equal(found, kelvin)
    pictures = [umov.render(plate, sun=sun, observer=[0, 1, 1], side=16, samples=1).png for sun in ([1, 1, 1], [1, 1, 1] * u.km)]
    assert pictures[0] == pictures[1]


def test_lists_of_quantities(plate):
    engine = umov.Engine(plate, ["nm:550"], cache=False)
    np.testing.assert_array_equal(engine.evaluate([0 * u.km, 0 * u.m, 1 * u.km], [0, 1, 1]), engine.evaluate([0, 0, 1], [0, 1, 1]))
    np.testing.assert_array_equal(umov.brdf("paper_bk7", 550 * u.nm, [10 * u.deg, 20 * u.deg]), umov.brdf("paper_bk7", 550, [10, 20]))


def test_bands_and_turns_by_numbers(hst):
    curve = hst.light_curve("maui", START, STOP, step_s=30, bands=["nm:425", "nm:550"])
    assert curve.band(np.int64(1)) == curve.band("nm:550") == 1
    with pytest.raises(umov.UsageError, match="no band True"):
        curve.band(True)
    with pytest.raises(umov.UsageError, match="period_s is '3'; a number"):
        umov.plot.folded(curve, "3")
    assert umov.plot.folded(curve, 1 * u.min).get_xlabel() == "turn of 60 s"


@pytest.mark.parametrize("told, metres", [("mm", 0.001), ("millimeters", 0.001), ("meters", 1), ("m", 1), ("cm", 0.01), ("Inches", 0.0254), ("feet", 0.3048)])
def test_a_mesh_of_trimesh_says_its_unit(told, metres):
    """Metres: the inch is 25.4 mm and the foot 12 of them (NIST Handbook 44, appendix C)."""
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(TRIANGLE, [[0, 1, 2]], process=False)
    mesh.units = told
    assert umov.mesh(umov.Satellite(mesh, materials="gold")).vertices.max() == pytest.approx(metres)
    assert umov.mesh(umov.Satellite(mesh, unit="cm", materials="gold")).vertices.max() == pytest.approx(0.01)  # who says so knows better


def test_a_mesh_in_miles():
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(TRIANGLE, [[0, 1, 2]], process=False)
    mesh.units = "miles"
    with pytest.raises(umov.UsageError, match="units = 'miles'; m, mm, cm, in or ft was expected"):
        umov.Satellite(mesh, materials="gold")


def test_times_of_any_shape():
    tle = DATA / "tle/hst.tle"
    none = umov.propagate(tle, [])
    assert none.position_km.shape == none.velocity_km_s.shape == (1, 0, 3) and none.error.shape == (1, 0)
    times = Time(START) + np.arange(4).reshape(2, 2) * u.min
    square, flat = umov.propagate(tle, times), umov.propagate(tle, times.ravel())
    assert square.position_km.shape == (1, 2, 2, 3) and square.error.shape == (1, 2, 2)
    assert square.position_km.tobytes() == flat.position_km.tobytes()
    assert umov.propagate(tle, times[0, 0]).position_km.shape == (1, 1, 3)


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", ">i4", "u8"])
def test_faces_of_short_numbers_name_the_vertices_that_they_name(kind):
    """The last number of its kind, counted from 1, is none of its kind any more: -128 was the first vertex of 128."""
    last = min(np.iinfo(kind).max, 300)
    vertices = np.zeros((last + 1, 3))
    vertices[1], vertices[last] = [1, 0, 0], [0, 2, 0]
    made = umov.mesh(umov.Satellite(mesh=(vertices, np.array([[0, 1, last]], kind)), materials="gold"))
    assert sorted(map(tuple, made.vertices[made.faces[0]].tolist())) == [(0, 0, 0), (0, 2, 0), (1, 0, 0)]


def test_times_of_numpy():
    assert len(umov.ephemeris(DATA / "tle/hst.tle", "maui", START, STOP, step=np.timedelta64(30, "s"))) == 3
    with pytest.raises(umov.UsageError, match="a finite number"):
        umov.ephemeris(DATA / "tle/hst.tle", "maui", START, STOP, step=np.timedelta64("NaT"))
    with pytest.raises(umov.UsageError, match=r"no time zone.*Time.'2018-01-21T05:00'"):
        umov.utc(np.datetime64("2018-01-21T05:00"))


def test_only_magnitudes_are_magnitudes():
    """astropy scales mag/deg2 and decibels into magnitudes: 21 mag/deg2 would be 1.6e-6 mag/arcsec2, 8 dB -2 mag."""
    for good, expected in ((21 * u.mag / u.arcsec**2, 21), (21 * u.mag, 21), (21000 * u.mmag, 21), (u.Magnitude(21, u.mag(u.AB / u.arcsec**2)), 21)):
        assert _numbers.number(good, "sky_mag") == pytest.approx(expected, rel=1e-15)
    assert _numbers.number(8000 * u.mmag, "mag") == pytest.approx(8, rel=1e-15)
    for name, bad in (("sky_mag", 21 * u.mag / u.deg**2), ("mag", 8 * u.dB), ("mag", 8 * u.dex), ("mag", 8 * u.mag / u.arcsec**2), ("sky_mag", 8 * u.dB)):
        with pytest.raises(umov.UsageError, match="a magnitude was expected"):
            _numbers.number(bad, name)


class Foreign:
    """As pint's: a value, units and their dimensions, and an array of the value alone."""

    units, dimensionality = "millimeter", "[length]"

    def __init__(self, magnitude):
        self.magnitude = magnitude

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.magnitude, dtype)

    def __float__(self):
        return float(self.magnitude)


class ForeignArray(np.ndarray):
    """As unyt's."""

    units = "mm"

    def to_value(self, units=None):
        return np.asarray(self)


class Labelled(np.ndarray):
    """As xarray's: the unit is a word among others, as it stood in a netCDF file."""

    attrs = {"units": "mm", "long_name": "step"}


def test_units_among_attributes_do_not_get_lost_in_silence():
    with pytest.raises(umov.UsageError, match=r"phase_deg has attrs\[\"units\"\] = 'mm', which is not read"):
        _numbers.number_array(np.ones(3).view(Labelled), "phase_deg")
    plain = np.ones(3).view(Labelled)
    plain.attrs = {"long_name": "step"}
    assert _numbers.number_array(plain, "phase_deg").tolist() == [1, 1, 1]


@pytest.mark.parametrize("foreign", (Foreign(3.0), [Foreign(3.0), Foreign(4.0)], np.ones(()).view(ForeignArray), np.ones(3).view(ForeignArray)))
def test_quantities_of_others_do_not_lose_their_unit_in_silence(foreign):
    with pytest.raises(umov.UsageError, match="whose unit is not read"):
        _numbers.number_array(foreign, "phase_deg")
    with pytest.raises(umov.UsageError, match="whose unit is not read"):
        umov.Scenario(EXAMPLES / "agena_maui.toml", {"time.step_s": foreign})
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]]).view(ForeignArray)
    with pytest.raises(umov.UsageError, match="whose unit is not read"):
        umov.Satellite((square, np.array([[0, 1, 2]])), materials="gold")
