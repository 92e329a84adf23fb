"""What goes in and comes out: units, times, sites, tables, adapters; and what is refused."""
import datetime
import functools
import pathlib
import pickle
import tomllib

import numpy as np
import pytest
import umov
from astropy import units as u
from astropy.coordinates import EarthLocation, SkyCoord
from astropy.time import Time, TimeDelta
from conftest import DATA, EXAMPLES, ROOT
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

AGENA_PASS = EXAMPLES / "agena_pass.csv"
START, STOP = "2018-01-21T05:08:00Z", "2018-01-21T05:09:00Z"


@pytest.fixture(scope="module")
def curve():
    return umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 30})


def test_light_curve_of_a_satellite_is_that_of_its_scenario(hst):
    ours = hst.light_curve("maui", START, STOP, step=20 * u.s, bands=["nm:550", "nm:650"])
    text = umov.Scenario(hst.to_scenario_dict(["nm:550", "nm:650"], observer={"name": "maui"},
                                              time={"start": START, "stop": STOP, "step_s": 20})).to_toml()
    np.testing.assert_array_equal(ours.I, umov.run(umov.Scenario.from_toml(text)).I)
    assert ours.I.shape == (4, 2)


def test_units_of_astropy_are_those_of_the_names(hst):
    assert umov.Bands([425, 550.5] * u.nm) == umov.Bands([.425 * u.um, "nm:550.5"]) == umov.Bands(["nm:425", "nm:550.5"])
    assert umov.Bands(.55 * u.um).set == "nm:550"
    triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert (umov.Satellite(mesh=triangle, unit=u.mm, materials="paper_al").to_dict()["mesh"]["unit"] == "mm")
    scenario = umov.Scenario(EXAMPLES / "hst_maui.toml", {"time.step_s": .5 * u.min, "object.attitude": {"mode": "spin", "axis": "+X", "rate_deg_s": 2 * u.rad / u.min}})
    changed = tomllib.loads(scenario.to_toml())
    assert changed["time"]["step_s"] == 30
    assert changed["object"][0]["attitude"]["rate_deg_s"] == pytest.approx(6 / np.pi, rel=1e-12)


def test_light_curve_of_a_pass(hst):
    table = umov.passes(hst, "maui", "2018-01-21T04:00Z", "2018-01-21T06:00Z")
    ours = hst.light_curve("maui", table[0], step_s=30)
    assert ours.time[0] >= Time(table["rise_utc"][0].rstrip("Z")) - TimeDelta(1 * u.ms)
    assert ours.time[-1] <= Time(table["set_utc"][0].rstrip("Z")) + TimeDelta(1 * u.ms)


@pytest.mark.parametrize("time", [
    "2018-01-21T05:08:00Z", "2018-01-20T19:08:00-10:00", Time("2018-01-21T05:08:00"),
    Time("2018-01-21T05:08:00").tt, datetime.datetime(2018, 1, 21, 5, 8, tzinfo=datetime.timezone.utc)])
def test_times_of_every_kind_mean_the_same(time):
    assert umov.utc(time) == "2018-01-21T05:08:00.000Z"


@pytest.mark.parametrize("time", [datetime.datetime(2018, 1, 21), "2018-01-21T05:08:00", "today", 58000.0, None,
                                  Time(["2018-01-21", "2018-01-22"]), np.datetime64("2018-01-21")])
def test_times_without_a_zone_are_refused(time):
    with pytest.raises(umov.Error):
        umov.utc(time)


def test_a_naive_datetime_is_told_how_to_mend():
    with pytest.raises(umov.UsageError, match=r"replace\(tzinfo=timezone.utc\)"):
        umov.utc(datetime.datetime(2018, 1, 21))


def test_sites_of_every_kind_mean_the_same():
    from skyfield.api import wgs84
    one = umov.Site(lat_deg=20.5, lon_deg=-156.25, alt_m=3058)
    place = umov.Site(EarthLocation.from_geodetic(-156.25 * u.deg, 20.5 * u.deg, 3058 * u.m))
    topos = umov.Site(wgs84.latlon(20.5, -156.25, 3058))
    # astropy keeps geocentric metres: 1e-9 deg are 0.1 mm
    for other in (place, topos):
        assert abs(other.lat_deg - 20.5) < 1e-9 and abs(other.lon_deg + 156.25) < 1e-9
        assert abs(other.alt_m - 3058) < 1e-4
    assert umov.Site.from_toml(one.to_toml()) == one == umov.Site(one.to_dict())
    back = one.to_earth_location()
    assert abs(back.lat.deg - 20.5) < 1e-9


@pytest.mark.parametrize("site", ["atlantis", 3, {"lat_deg": 1}, {"lat_deg": 91, "lon_deg": 0, "alt_m": 0}])
def test_sites_that_are_none_are_refused(site):
    with pytest.raises(umov.Error):
        umov.Site(site)
    with pytest.raises(umov.UsageError):
        umov.Site(lat_deg=3)


def test_orbits_of_other_packages_give_the_same_numbers():
    from sgp4.api import Satrec
    from skyfield.api import EarthSatellite, load
    lines = [line for line in (DATA / "tle/hst.tle").read_text().splitlines() if line[:2] in ("1 ", "2 ")][:2]
    (expected := umov.propagate("\n".join(lines) + "\n", START))
    satrec = Satrec.twoline2rv(*lines)
    for orbit in (lines, satrec, EarthSatellite(*lines, "HST", load.timescale(builtin=True))):
        np.testing.assert_array_equal(umov.propagate(orbit, START).position_km, expected.position_km)
    # SGP4 of another hand: micrometres
    error, position, _ = satrec.sgp4(*(float(x) for x in (Time(START.rstrip("Z")).jd1, Time(START.rstrip("Z")).jd2)))
    assert error == 0 and np.abs(expected.position_km[0, 0] - position).max() < 1e-6


def test_meshes_of_trimesh(plate):
    import trimesh
    box = trimesh.creation.box((1, 1, 1))
    cube = umov.Engine(umov.Satellite(mesh=box, materials="paper_al"), bands=["nm:550"])
    assert cube.facts["triangles"] == 12 and cube.facts["is_convex"]
    face = umov.Engine(plate, bands=["nm:550"])
    # Of a cube lit and seen along a normal only that face counts: the plate of 1 m.
    np.testing.assert_allclose(cube.evaluate([0, 0, 1], [0, 0.1, 1]), face.evaluate([0, 0, 1], [0, 0.1, 1]), rtol=1e-6)


def test_tables(curve, tmp_path):
    table = curve.to_table()
    from astropy.table import QTable
    curve.write(tmp_path / "a.ecsv")
    read = QTable.read(tmp_path / "a.ecsv")
    assert table.colnames == read.colnames and len(table) == len(read)
    for name in table.colnames:
        if table[name].dtype.kind == "f":
            assert table[name].unit == read[name].unit, name
    assert table["range"].unit == u.km and table.meta["object"] == "HST"
    frame = curve.to_pandas()
    assert list(frame.columns) == table.colnames and frame.attrs["units"]["range"] == "km"
    np.testing.assert_array_equal(frame["I"], curve["I"].ravel())
    series = curve.to_timeseries()
    assert series["I"].shape == curve.I.shape and series["az"].shape == (len(curve),)
    assert abs((series.time - Time([t.rstrip("Z") for t in curve["time_utc"][:, 0]])).sec).max() < 5.1e-4
    curve.write(tmp_path / "a.fits")
    assert (tmp_path / "a.fits").read_bytes()[:6] == b"SIMPLE"
    with pytest.raises(umov.UsageError):
        curve.write(tmp_path / "a.docx")


def test_arrow_tables(curve):
    table = curve.to_arrow()
    assert table.column_names == curve.table.names and table.num_rows == len(curve.table)
    assert table.schema.field("range").metadata[b"unit"] == b"km" and table.schema.metadata[b"object"] == b"HST"
    np.testing.assert_array_equal(table["I"].to_numpy(), curve["I"].ravel())
    ours = curve.table["range"]
    assert table["range"].chunk(0).buffers()[1].address == ours.__array_interface__["data"][0]  # no copy


def test_a_direction_of_the_sky_may_be_astropys():
    pointed = {"point": "+Z", "then": "+X", "toward": "sun"}
    made = [umov.Satellite(mesh="a.obj", materials="paper_al", attitude={**pointed, "at": at}).to_dict()["attitude"]["at"]
            for at in ({"ra_deg": 83.8, "dec_deg": -5.4}, SkyCoord(83.8, -5.4, unit="deg"),
                       SkyCoord(83.8, -5.4, unit="deg").galactic)]
    for one in made[1:]:
        assert abs(one["ra_deg"] - 83.8) < 1e-9 and abs(one["dec_deg"] + 5.4) < 1e-9


def test_bands_are_a_table_of_the_scenario(hst):
    vega = umov.Bands(["Bessell.V", "nm:550"], mag_system="AB")
    assert umov.Bands.from_dict(vega.to_dict()) == vega == umov.Bands.from_toml(vega.to_toml())
    curve = hst.light_curve("maui", START, START, step_s=1, bands=umov.Bands(["Bessell.V"], mag_system="Vega"))
    assert curve.mag_system == "Vega" and curve.bands == ["Bessell.V"]
    assert umov.Engine(hst, vega).bands == ["Bessell.V", "nm:550"]
    for wrong in (lambda: umov.Bands(["Bessel.V"]), lambda: umov.Bands("paper_rgb", mag_system="vega"),
                  lambda: umov.Bands.from_dict({"sets": "paper_rgb"}), lambda: umov.Bands(3)):
        with pytest.raises(umov.Error):
            wrong()


def test_a_calibration_goes_round_and_is_taken_out(tmp_path):
    """Counts made by hand of an efficiency of 0.95: what calibrate finds makes reduce find the truth."""
    def rows(efficiency, q):
        head = "time_utc,set_id,name,band,counts,sky,sky_err,var_read,w0,w1,w2,w3"
        return "\n".join([head, *(
            f"2018-01-21T05:00:00Z,{k},{name},nm:550,{1e8 * (1 + efficiency * p * w1)},0,0,1,0.5,{w1 / 2},{w2 / 2},0"
            for k, (name, p) in enumerate(q.items()) for w1, w2 in ((1, 0), (-1, 0), (0, 1), (0, -1)))]) + "\n"

    (tmp_path / "stars.csv").write_text("name,p_percent,pa_deg\ncalm,0,0\nstriped,10,0\n")
    (tmp_path / "counts.csv").write_text(rows(0.95, {"calm": 0.0, "striped": 0.1}))
    (tmp_path / "mine.csv").write_text(rows(0.95, {"sat": 0.2}))
    found = umov.calibrate(tmp_path / "counts.csv", tmp_path / "stars.csv")
    assert abs(found.to_dict()["efficiency"] - 0.95) < 1e-3  # 1e8 electrons: 1e-4 of noise in the variance alone
    assert umov.Calibration.from_toml(found.to_toml()) == found == pickle.loads(pickle.dumps(found))
    (tmp_path / "found.toml").write_text(found.to_toml())
    plain, mended = umov.reduce(tmp_path / "mine.csv"), umov.reduce(tmp_path / "mine.csv", calibration=found)
    assert abs(plain["q"][0] - 0.19) < 1e-3 and abs(mended["q"][0] - 0.2) < 1e-3
    again = umov.reduce(tmp_path / "mine.csv", calibration=tmp_path / "found.toml")
    np.testing.assert_array_equal(again["q"], mended["q"])


def test_materials_add_up(curve):
    sides = curve.scenario.to_dict()["object"][0]["materials"].values()
    assert set(curve.contributions) == {name for side in sides for name in side.values()}
    # Sums of the same floats in another order.
    np.testing.assert_allclose(sum(curve.contributions.values()), curve.intensity, rtol=1e-6, atol=1e-12)
    again = pickle.loads(pickle.dumps(curve))
    np.testing.assert_array_equal(again.contributions["film_silvered"], curve.contributions["film_silvered"])


def test_places_are_those_that_astropy_turns_into_altitudes(curve):
    from astropy.coordinates import ITRS, AltAz
    place = umov.Site(curve.scenario.to_dict()["observer"]).to_earth_location()
    seen = curve.to_skycoord().transform_to(ITRS(obstime=curve.time, location=place)).transform_to(
        AltAz(obstime=curve.time, location=place))
    # astropy takes the aberration of the Earth's motion, 20.5 arcsec, off what was geometric, the other way round for
    # light that came with us; and UT1 of its own table.
    assert np.abs(seen.alt.deg - curve.alt).max() < 25 / 3600
    away = np.angle(np.exp(1j * np.radians(seen.az.deg - curve.az)), deg=True) * np.cos(np.radians(curve.alt))
    assert np.abs(away).max() < 25 / 3600
    np.testing.assert_allclose(seen.distance.to_value("km"), curve.range, rtol=1e-4)


def test_pictures_and_triangles(hst, plate):
    import io

    from matplotlib.image import imread
    picture = umov.render(plate, sun=[0, 0, 1], observer=[0, 0, 1], up=[0, 1, 0], side=50, samples=1)
    image = imread(io.BytesIO(picture.png))
    assert image.shape[:2] == (50, 50)
    # The square of 1 m in a picture of 2.08 bounding radii (0.707 m): 34 pixels of 50 along a side.
    sky, square = image[0, 0, :3], image[25, 25, :3]
    assert not np.allclose(sky, square)
    assert abs(np.all(np.isclose(image[25, :, :3], square, atol=0.02), axis=-1).sum() - 34) <= 2
    made = umov.mesh(plate)
    assert made.vertices.shape == (4, 3) and made.faces.shape == (2, 3) and made.group_names == ["default"]
    assert "data:image/png" in hst._repr_html_()
    for wrong in ({"shade": "heat"}, {"sun": [1, 0, 0]}, {"sun": [0, 0, 0], "observer": [1, 0, 0]}, {"side": 0}):
        with pytest.raises(umov.Error):
            umov.render(plate, **wrong)


def test_a_picture_at_a_time_takes_elements_of_that_time():
    """The elements of the example are of 2018-01-20; at 12 h they have HST in the Earth's shadow (`umov orbit ephemeris`)."""
    example, small = EXAMPLES / "hst_maui.toml", {"side": 16, "samples": 1}
    with pytest.raises(umov.InputError, match="allow_old_elements=True"):
        umov.render(example, time="2030-01-01T00:00:00Z", **small)
    with pytest.warns(umov.UmovWarning, match="below the horizon"), pytest.warns(umov.UmovWarning, match="kilometres"):
        umov.render(example, time="2030-01-01T00:00:00Z", allow_old_elements=True, **small)
    with pytest.warns(umov.UmovWarning, match="in the Earth's shadow .sunlit share 0, altitude"):
        umov.render(example, time="2018-01-21T12:00:00Z", **small)


@pytest.mark.parametrize("material", ["paint_white", "aluminium_anodized", "film_silvered"])
def test_sums_serve_other_materials_and_bands(hst, material):
    """What is applied to sums is what an engine of those materials gives: to rounding, but where it mends what
    mirrors show of an edge, within the half-widths of both."""
    sun, observer = umov.random_poses(200, phase_deg=70, seed=3)
    bands = ["nm:450", "nm:650"]
    plain = umov.Satellite.from_dict({**hst.to_dict(), "materials": {"default": material}})
    sums = umov.Sums(plain, cache=False)
    made = sums.abundances(sun, observer)
    assert made.sum.shape == (200, len(made.columns)) and not made.sum.flags.writeable
    engine = umov.Engine(plain, bands=bands, method="masks", cache=False).light(sun, observer)
    ours = sums.apply(made, bands=bands)
    away = np.abs(ours.stokes - engine.stokes)
    assert (away <= ours.half_width + engine.half_width).all()
    assert (away[..., 0] > 1e-9 * engine.stokes[..., 0]).mean() < (0 if material == "paint_white" else 0.1) + 1e-9
    # Another substance with the same roughness.
    table = {**umov.Material(material).to_dict(), "index": {"n": 1.0, "k": 6.0}}
    table.pop("layers", None)
    other = umov.Material.from_dict("other", table)
    another = umov.Satellite.from_dict({**hst.to_dict(), "materials": {"default": "other"}, "material": {"other": table}})
    expected = umov.Engine(another, bands=bands, method="masks", cache=False).light(sun, observer)
    applied = sums.apply(made, another, bands=bands)
    assert (np.abs(applied.stokes - expected.stokes) <= applied.half_width + expected.half_width).all()
    np.testing.assert_array_equal(sums.apply(made, materials={"default": other}, bands=bands).stokes, applied.stokes)


def test_scenarios_go_round(tmp_path):
    one = umov.Scenario(EXAMPLES / "hst_maui.toml")
    assert umov.Scenario.from_toml(one.to_toml()) == one
    assert umov.Scenario(one.to_dict()) == one
    assert umov.Scenario(one, set={"render.bounces": 2}).to_dict()["render"]["bounces"] == 2


def test_own_materials_go_with_the_satellite():
    own = umov.Material.from_dict("own", {"index": {"n": 1.5, "k": 0.0}, "distribution": {"model": "ggx", "alpha": 0.3}})
    mesh = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    lit = umov.Engine(umov.Satellite(mesh=mesh, materials=own), bands=["nm:550"]).evaluate([0, 0, 1], [0, 1, 1])
    other = umov.Engine(umov.Satellite(mesh=mesh, materials="paper_al"), bands=["nm:550"]).evaluate([0, 0, 1], [0, 1, 1])
    assert lit[0, 0] > 0 and lit[0, 0] != other[0, 0]


@pytest.mark.parametrize("call", [
    lambda hst: hst.light_curve("maui", START, STOP, step=20),
    lambda hst: hst.light_curve("maui", START, STOP, step=20 * u.m),
    lambda hst: hst.light_curve("maui", START, STOP, step=1 * u.s, step_s=1),
    lambda hst: hst.light_curve("maui", START),
    lambda hst: hst.light_curve("maui", START, STOP, bands=["V"]),
    lambda hst: hst.light_curve("maui", START, STOP, bands=3 * u.s),
    lambda hst: umov.Satellite(mesh=([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), unit=u.s, materials="paper_al", orbit=DATA / "tle/hst.tle")
    .light_curve("maui", START, STOP, step_s=1),
    lambda hst: umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 3 * u.m}),
    lambda hst: umov.Engine(hst, method="guess"),
    lambda hst: umov.Engine(hst, laser=[1, 0]),
    lambda hst: umov.Engine(hst, laser=[1, 2, 0, 0]),
    lambda hst: umov.Engine(hst, accuracy=2),
    lambda hst: umov.Satellite(mesh=3, materials="paper_al"),
    lambda hst: umov.Satellite(mesh=([[0, 0, 0]], [[0, 1, 2]]), materials="paper_al"),
    lambda hst: umov.Satellite(mesh=([[0, 0, float("nan")]], [[0, 0, 0]]), materials="paper_al"),
    lambda hst: umov.Satellite(mesh="a.obj", materials=3),
    lambda hst: umov.Satellite(mesh="a.obj", materials="paper_al", orbit=3),
    lambda hst: umov.Satellite.from_toml("umov = 1"),
    lambda hst: umov.run(3),
    lambda hst: umov.run(EXAMPLES / "hst_maui.toml", set={"render.bounce": 2}),
    lambda hst: umov.run({"umov": 1, "object": object()}),
    lambda hst: umov.run(EXAMPLES / "nothing.toml"),
    lambda hst: umov.passes(hst, "maui", STOP, START),
    lambda hst: umov.passes(hst, "maui", START, START, shadow="cone"),
    lambda hst: umov.passes(hst, "maui", START, STOP, sort="size"),
    lambda hst: umov.passes(DATA / "tle/hst.tle", "maui", START, STOP, mag_max=3),
    lambda hst: umov.passes(DATA / "tle/hst.tle", "maui", START, STOP, band="nm:550"),
    lambda hst: umov.ephemeris(hst, "maui", START, STOP),
    lambda hst: umov.brdf("paper_al", theta_i_deg=[1, 2], theta_o_deg=[1, 2, 3]),
    lambda hst: umov.brdf("paper_al", theta_i_deg=91),
    lambda hst: umov.brdf("paper_al", theta_i_deg=float("nan")),
    lambda hst: umov.brdf("paper_al", theta_i_deg="steep"),
    lambda hst: umov.brdf("paper_al", theta_i_deg=3 * u.m),
    lambda hst: umov.random_poses(-1, 60),
    lambda hst: umov.random_poses(1, 200),
    lambda hst: umov.materials()["colour"],
    lambda hst: hst.light_curve("maui", START, STOP, pol_frame="galactic"),
    lambda hst: umov.Engine(hst, ["nm:550"], method="masks").evaluate(SkyCoord(1, 2, unit="deg"), [0, 0, 1]),
    lambda hst: umov.Engine(hst, ["nm:550"], method="masks").evaluate([0, 0, 1], EarthLocation.from_geodetic(0 * u.deg, 0 * u.deg)),
    lambda hst: umov.Satellite(mesh="a.obj", materials="gold", attitude={"at": SkyCoord([1, 2], [3, 4], unit="deg")}),
    lambda hst: umov.reduce(umov.bands()),
    lambda hst: umov.reduce(EXAMPLES / "panel_brdf.csv", harmonics=0),
    lambda hst: umov.exposure("c11_imx250", alt_deg=-5),
    lambda hst: umov.observe(EXAMPLES / "hst_maui.toml"),
    lambda hst: umov.reduce(EXAMPLES / "panel_brdf.csv", period_s=5, knot_s=5),
    lambda hst: umov.tdm(umov.bands().to_qtable(), EXAMPLES / "panel_brdf.csv"),
    lambda hst: umov.invert_pose(AGENA_PASS, EXAMPLES / "agena_maui.toml", fit=umov.Fit(grid=3)),
    lambda hst: umov.invert_pose(AGENA_PASS, EXAMPLES / "agena_maui.toml", fit={"grid": 3000}),
    lambda hst: umov.invert_pose([], EXAMPLES / "agena_maui.toml"),
    lambda hst: umov.invert_pose(umov.bands(), EXAMPLES / "agena_maui.toml"),
    lambda hst: umov.invert_spin(AGENA_PASS, EXAMPLES / "agena_maui.toml", axis="w"),
    lambda hst: umov.invert_track(AGENA_PASS, EXAMPLES / "agena_maui.toml", 3),
    lambda hst: umov.invert_track(AGENA_PASS, EXAMPLES / "agena_maui.toml", "", rate_noise=-1),
    lambda hst: umov.invert_material(AGENA_PASS, EXAMPLES / "agena_maui.toml", group="wing", candidates=["gold"]),
    lambda hst: umov.invert_material(AGENA_PASS, EXAMPLES / "agena_maui.toml", group="body", candidates="gold"),
    lambda hst: umov.invert_health(AGENA_PASS, EXAMPLES / "agena_maui.toml", drift={"wing": "gold"}),
    lambda hst: umov.invert_health(AGENA_PASS, EXAMPLES / "agena_maui.toml", drift={}),
    lambda hst: umov.invert_plan(EXAMPLES / "agena_maui.toml", {"one": {}}),
    lambda hst: umov.invert_plan(EXAMPLES / "agena_maui.toml", ["one", "two"]),
    lambda hst: umov.invert_plan(EXAMPLES / "agena_maui.toml", {"one": {}, "two": {}}, priors={"three": 1}),
    lambda hst: umov.invert_plan(EXAMPLES / "agena_maui.toml", {"one": {}, "two": {}}, snr=-1),
    lambda hst: umov.invert_plan(EXAMPLES / "agena_maui.toml", {"one": {}, "two": {"object.materials.wing": "gold"}}),
    lambda hst: umov.build_library([], "lib"),
    lambda hst: umov.build_library([EXAMPLES / "agena_maui.toml"], "lib", cells=3),
])
def test_what_does_not_fit_is_refused(call, hst):
    with pytest.raises(umov.Error) as caught:
        call(hst)
    assert isinstance(caught.value, (umov.UsageError, umov.InputError)) and len(str(caught.value)) > 20


def test_no_pass_is_no_result(hst):
    with pytest.raises(umov.NoResult, match="no pass"):
        umov.passes(hst, "maui", "2018-01-21T04:00Z", "2018-01-21T04:05Z")


@pytest.fixture(scope="module")
def engine(plate):
    return umov.Engine(plate, bands=["nm:550"])


ANY = st.floats(allow_nan=True, allow_infinity=True, width=64)


@settings(max_examples=500, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(sun=arrays.arrays(np.float64, arrays.array_shapes(min_dims=0, max_dims=3, max_side=4), elements=ANY),
       observer=arrays.arrays(np.float64, arrays.array_shapes(min_dims=0, max_dims=3, max_side=4), elements=ANY))
def test_any_array_gives_light_or_an_error(engine, sun, observer):
    try:
        stokes = engine.evaluate(sun, observer)
    except umov.Error as error:
        assert "was expected" in str(error) or "were expected" in str(error)
        return
    assert stokes.shape == (*np.broadcast_shapes(sun.shape, observer.shape)[:-1], 1, 4)
    assert np.isfinite(stokes).all()
    assert (np.linalg.norm(stokes[..., 1:], axis=-1) <= stokes[..., 0] * (1 + 1e-6)).all()


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(shape=arrays.array_shapes(min_dims=1, max_dims=3, max_side=3))
def test_light_does_not_depend_on_the_shape_or_layout(engine, shape):
    sun, observer = umov.random_poses(int(np.prod(shape)), 50, seed=3)
    flat = engine.evaluate(sun, observer)
    shaped = engine.evaluate(sun.reshape(*shape, 3), np.asfortranarray(observer.reshape(*shape, 3)))
    np.testing.assert_array_equal(shaped.reshape(flat.shape), flat)


def test_kinds_of_light(plate):
    sun, observer = [0, 0, 1], [0, 0.05, 1]
    laser = umov.Engine(plate, bands=["nm:550"], laser=[1, 0, 0, 1]).evaluate(sun, observer)
    assert abs(laser[0, 3] / laser[0, 0]) > 0.9  # a metal near its normal keeps the circle and turns it
    heat = umov.Engine(plate, bands=["nm:10000"], temperatures=["300"], set={
        "material.black": {"index": {"n": 1.5, "k": 0.5}, "distribution": {"model": "ggx", "alpha": 0.2}},
        "object.materials.default": "black"}).evaluate(sun, observer)
    assert heat[0, 0] > 0


def test_where_things_are_found(curve, hst):
    for one in (curve, hst, umov.Site("maui"), umov.Scenario(EXAMPLES / "hst_maui.toml"), umov.materials(),
                umov.Material("gold"), umov.Engine(hst, bands=["nm:550"])):
        assert "object at 0x" not in repr(one)
    assert "data:image/png" in curve._repr_html_()
    assert "<table" in umov.materials()._repr_html_()


def test_adapters_leave_no_files(plate):
    import gc
    made = umov.Satellite(mesh=([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), materials="paper_al")
    folder = pathlib.Path(made.to_dict()["mesh"]["file"]).parent
    engine = umov.Engine(made)
    assert folder.is_dir()
    del made, engine
    gc.collect()
    assert not folder.exists()


# What somebody may hand over by mistake.
ODD = st.one_of(st.none(), st.booleans(), st.integers(-10**20, 10**20), ANY, st.text(max_size=12), st.binary(max_size=8),
                st.lists(ANY, max_size=4), st.dictionaries(st.text(max_size=5), ANY, max_size=2), st.just(object()),
                st.sampled_from([3 * u.m, [1, 2] * u.deg, np.array(["a"]), np.zeros((2, 3), dtype=complex), u.s,
                                 Time("2018-01-21"), TimeDelta(3 * u.s), datetime.datetime(2018, 1, 21),
                                 umov.Material, EarthLocation.from_geodetic(0 * u.deg, 0 * u.deg), np.ma.masked]))
TLE = DATA / "tle/hst.tle"
MATERIALS = functools.cache(umov.materials)


@functools.cache
def PLATE():
    return umov.Engine(umov.Satellite(mesh=([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), materials="paper_al"), ["nm:550"])


CALLS = {
    "Site": umov.Site, "Site.lat_deg": lambda x: umov.Site(lat_deg=x, lon_deg=0, alt_m=0), "utc": umov.utc,
    "mesh": lambda x: umov.Satellite(mesh=x, materials="paper_al"), "Material": umov.Material,
    "vertices": lambda x: umov.Satellite(mesh=(x, [[0, 1, 2]]), materials="paper_al"),
    "faces": lambda x: umov.Satellite(mesh=([[0, 0, 0], [1, 0, 0], [0, 1, 0]], x), materials="paper_al"),
    "orbit": lambda x: umov.propagate(x, START), "times": lambda x: umov.propagate(TLE, x),
    "theta": lambda x: umov.brdf("paper_al", theta_i_deg=x), "wavelength": lambda x: umov.brdf("paper_al", wavelength_nm=x),
    "phase": lambda x: umov.random_poses(3, x), "count": lambda x: umov.random_poses(x, 60) if not isinstance(x, int) or x < 1000 or x > 1e9 else None,
    "norad": lambda x: umov.passes(TLE, "maui", START, STOP, norad=x), "stop": lambda x: umov.passes(TLE, "maui", START, x),
    "step": lambda x: umov.ephemeris(TLE, "maui", START, START, step=x),
    "step_s": lambda x: umov.ephemeris(TLE, "maui", START, START, step_s=x),
    "set": lambda x: umov.Scenario(EXAMPLES / "hst_maui.toml", set={"render.accuracy": x}), "Scenario": umov.Scenario,
    "column": lambda x: MATERIALS()[x],
    "sun": lambda x: PLATE().evaluate(x, [0, 0, 1]), "observer": lambda x: PLATE().light([0, 0, 1], x),
    "counts": umov.reduce, "period_s": lambda x: umov.reduce(EXAMPLES / "panel_brdf.csv", period_s=x),
    "standards": lambda x: umov.calibrate(EXAMPLES / "panel_brdf.csv", x), "instrument": umov.instrument,
    "mag": lambda x: umov.exposure("c11_imx250", mag=x), "sd_p": lambda x: umov.exposure("c11_imx250", sd_p=x),
    "light": lambda x: umov.period(x), "gap_s": lambda x: umov.period(AGENA_PASS, gap_s=x),
    "pose": lambda x: umov.invert_pose(x, EXAMPLES / "agena_maui.toml"),
    "fit": lambda x: umov.invert_pose(AGENA_PASS, EXAMPLES / "agena_maui.toml", fit=x),
    "drift": lambda x: umov.invert_health(AGENA_PASS, EXAMPLES / "agena_maui.toml", drift=x),
    "candidates": lambda x: umov.invert_material(AGENA_PASS, EXAMPLES / "agena_maui.toml", group="body", candidates=x),
    "library": lambda x: umov.build_library(x, "/dev/null/lib"),
    "folder": lambda x: umov.build_library(["nothing.toml"], x) if not isinstance(x, str) else None,
    "stokes": lambda x: umov.score(x, EXAMPLES / "panel_brdf.csv"),
    "frames": lambda x: umov.observe(EXAMPLES / "hst_maui.toml", frames=x) if not isinstance(x, (str, bytes)) else None,
    "Bands": umov.Bands, "band": umov.band, "example": umov.example,
    "attitude": lambda x: umov.Satellite(mesh="a.obj", materials="gold", attitude={"at": x}).to_toml(),
}


def test_there_are_500_odd_cases():
    assert 25 * len(CALLS) >= 500


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(odd=ODD)
@pytest.mark.parametrize("name", CALLS)
def test_odd_arguments_are_told_of(name, odd):
    """Hundreds of cases in all (500 and more): what does not fit is an error of ours, with words of what was found."""
    try:
        CALLS[name](odd)
    except umov.Error as error:
        assert len(str(error)) > 10 and not isinstance(error, umov.InternalError)


def test_periods_are_those_of_the_report():
    """The numbers of astropy that the library's own test has (tests/data/periodogram), through Python."""
    rows = [line.split(",") for line in (ROOT / "tests/data/periodogram/astropy.csv").read_text().splitlines()]
    series = np.array([[float(x) for x in row[1:]] for row in rows if row[0] == "series"])
    expected = np.array([[float(x) for x in row[1:]] for row in rows if row[0] == "power"])
    period, power, best = umov._umov.periodogram(series[:, 0].copy(), series[:, 1].copy())
    np.testing.assert_allclose(period[::8][:25], expected[:, 0], rtol=1e-9)  # twelve digits are printed
    np.testing.assert_allclose(power[::8][:25], expected[:, 1], atol=1e-10)
    assert abs(best - 11.7) < 0.04  # as the series was made; see periodogram_test.cpp


def test_a_tumbling_body_has_its_period():
    spin = 23.7
    curve = umov.run(EXAMPLES / "agena_maui.toml", set={
        "time.step_s": 1, "object.attitude": {"mode": "spin", "axis": "+X", "period_s": spin}})
    found = float(umov.plot.periodogram(curve).get_title().split()[0])
    # It looks alike twice a turn, and the bisector turns a few percent with the pass (a synodic period).
    assert min(abs(found * turns / spin - 1) for turns in (1, 2)) < 0.05


def test_materials_of_one_name_are_kept_apart(tmp_path):
    """[material.NAME] is one thing in a scenario: the last of a name stood for all, and for the library's."""
    def paint(n, name):
        return umov.Material.from_dict(name, {"index": {"n": n, "k": 0.0}, "distribution": {"model": "ggx", "alpha": 0.3}})

    def light(front, back, **more):
        plate = umov.Satellite(umov.example("hst.obj"), unit="m", up="+Z", materials={"array_front": front, "default": back, **more})
        engine = umov.Engine(plate, bands=["nm:550"])
        return engine.evaluate([[1, 0, 0], [0, 0, 1]], [[1, 0.1, 0], [0, 0.1, 1]])[:, 0, 0], plate

    apart, _ = light(paint(1.5, "a"), paint(2.5, "b"))
    alike, plate = light(paint(1.5, "paint"), paint(2.5, "paint"))
    assert np.array_equal(apart, alike) and sorted(plate.to_dict()["material"]) == ["paint", "paint_2"]
    again, _ = light(paint(1.5, "paint"), paint(2.5, "paint"))
    assert np.array_equal(alike, again) and umov.Satellite.from_toml(plate.to_toml()) == plate
    other, _ = light(paint(1.5, "x"), "gold")
    for gold in ("gold", umov.Material("gold")):  # before and after the one that takes its name
        own, _ = light(paint(1.5, "gold"), gold)
        assert np.array_equal(own, other)
        own, _ = light(gold, paint(1.5, "gold"))
        assert not np.array_equal(own, other)
    one = paint(1.5, "paint")
    assert list(light(one, one)[1].to_dict()["material"]) == ["paint"]
