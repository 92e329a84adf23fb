"""What goes wrong in a notebook: things of the wrong kind, copies, forks, files that go away."""
import copy
import gc
import math
import multiprocessing
import os
import pathlib
import pickle

import numpy as np
import pandas
import pytest
import umov
import umov.plot
import umov.scale
from astropy import units, units as u
from astropy.coordinates import ICRS, EarthLocation, SkyCoord
from astropy.table import Column, QTable, Table
from astropy.time import Time
from astropy.timeseries import TimeSeries
from astropy.utils.masked import Masked

from conftest import DATA, EXAMPLES

START, STOP = "2018-01-21T05:10:00Z", "2018-01-21T05:11:00Z"
TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
POSES = umov.random_poses(50, 60, seed=3)


@pytest.fixture(scope="module")
def scene():
    """Its shape hides parts of itself, so that an engine looks hiding up."""
    return umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", materials="gold", name="HST")


@pytest.mark.parametrize("way", [copy.deepcopy, lambda engine: pickle.loads(pickle.dumps(engine)),
                                 lambda engine: umov.Engine(engine.scenario, engine.bands),
                                 lambda engine: umov.Engine(umov.Scenario(engine.scenario, set={"seed": 0}), engine.bands),
                                 lambda engine: umov.Engine(pickle.loads(pickle.dumps(engine.scenario)))],
                         ids=["deepcopy", "pickle", "bands", "set", "scenario"])
def test_a_copy_of_an_engine_gives_the_same_bytes(scene, way):
    """What nobody said of accuracy is not said by a copy either: it lit up to forty times more slowly, with other bytes."""
    engine = umov.Engine(scene, bands=["nm:550"])
    same = way(engine)
    assert same.facts["visibility"] == engine.facts["visibility"]
    assert same.evaluate(*POSES).tobytes() == engine.evaluate(*POSES).tobytes()


def test_what_was_said_of_accuracy_goes_along(scene):
    engine = umov.Engine(umov.Scenario(scene, set={"render.accuracy": 0.1, "render.accuracy_floor": 0.3}), bands=["nm:550"])
    assert copy.deepcopy(engine).facts["visibility"] == engine.facts["visibility"]
    assert pickle.loads(pickle.dumps(engine.scenario)).to_dict()["render"]["accuracy_floor"] == 0.3


def _nothing():
    gc.collect()


def test_a_forked_process_takes_no_files_along():
    made = umov.Satellite(mesh=(TRIANGLE, [[0, 1, 2]]), materials="paper_al")
    child = multiprocessing.get_context("fork").Process(target=_nothing)
    child.start()
    child.join(30)
    assert child.exitcode == 0
    assert umov.Engine(made, ["nm:550"]).evaluate([0, 0, 1], [0, 1, 1]).shape == (1, 4)


def test_a_file_that_went_away_is_named(tmp_path):
    mesh = tmp_path / "sat é.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    made = umov.Satellite(mesh=mesh, unit="m", up="+Z", materials="gold")
    engine = umov.Engine(made, ["nm:550"])
    mesh.unlink()
    assert engine.evaluate([0, 0, 1], [0, 1, 1]).shape == (1, 4)  # it holds all that it needs
    with pytest.raises(umov.InputError, match="sat é.obj: no such file"):
        umov.Engine(made, ["nm:550"])


@pytest.mark.parametrize("name", ["mesh", "orbit", "run", "write", "period", "cache"])
def test_names_of_files_that_are_no_utf8(tmp_path, name):
    strange = os.fsdecode(os.fsencode(tmp_path) + b"/\xff.obj")
    calls = {"mesh": lambda: umov.Engine(umov.Satellite(mesh=strange, unit="m", up="+Z", materials="gold")),
             "orbit": lambda: umov.propagate(strange, START), "run": lambda: umov.run(strange),
             "write": lambda: umov.materials().write(strange), "period": lambda: umov.period(strange),
             "cache": lambda: umov.Engine(EXAMPLES / "agena_maui.toml", cache=pathlib.Path(strange))}
    with pytest.raises(umov.UsageError, match="no UTF-8"):
        calls[name]()


class _PathOfANumber(os.PathLike):
    def __fspath__(self):
        return 5


def _list_in_itself():
    out = []
    out.append(out)
    return out


def _in_itself():
    table = {"umov": 1}
    table["object"] = table
    return table


MASKED = np.ma.array([1.0, 0, 0], mask=[0, 1, 0])
A_PLACE = EarthLocation.from_geodetic(10 * u.deg, 20 * u.deg)
WRONG = {
    "texts": (lambda e: e.evaluate(["1", "0", "0"], [0, 0, 1]), "sun is .*; numbers, directions"),
    "dates": (lambda e: e.evaluate(np.array(["2020", "2021", "2022"], "M8[Y]"), [0, 0, 1]), "sun is .*; numbers"),
    "complex": (lambda e: e.evaluate(np.array([1j, 0, 0]), [0, 0, 1]), "sun is .*; numbers"),
    "structured": (lambda e: e.evaluate(np.zeros(3, [("a", float)]), [0, 0, 1]), "sun is .*; numbers"),
    "masked": (lambda e: e.evaluate(MASKED, [0, 0, 1]), "sun has masked values"),
    "masked quantity": (lambda e: e.evaluate([0, 0, 1], Masked([1.0, 0, 0] * u.m, mask=[0, 1, 0])), "observer has masked"),
    "masked latitude": (lambda e: umov.Site(lat_deg=np.ma.masked, lon_deg=0, alt_m=0), "lat_deg has masked"),
    "truth for a number": (lambda e: umov.Site(lat_deg=True, lon_deg=0, alt_m=0), "lat_deg is True; numbers"),
    "nan for a number": (lambda e: umov.exposure("c11_imx250", mag=np.nan), "mag is nan; a finite number"),
    "masked vertices": (lambda e: umov.Satellite(mesh=(np.ma.array(TRIANGLE, mask=np.eye(3)), [[0, 1, 2]]), materials="gold"),
                        "vertices has masked"),
    "vertices in seconds": (lambda e: umov.Satellite(mesh=(TRIANGLE * u.s, [[0, 1, 2]]), materials="gold"), "does not go into"),
    "accuracy as text": (lambda e: umov.Engine(e.scenario, accuracy="0.1"), "accuracy is '0.1'; a number was"),
    "laser as text": (lambda e: umov.Engine(e.scenario, laser="abcd"), "laser is 'abcd'; numbers"),
    "laser too polarized": (lambda e: umov.Engine(e.scenario, laser=[1, 1, 1, 0]), r"laser is .*; I > 0"),
    "one temperature": (lambda e: umov.Engine(e.scenario, temperatures="300"), "temperatures is '300'; a list"),
    "threads": (lambda e: umov.Engine(e.scenario, threads=-1), "threads is -1; a whole number"),
    "half a thread": (lambda e: umov.run(EXAMPLES / "agena_maui.toml", threads=1.5), "threads is 1.5; a whole number"),
    "progress": (lambda e: e.evaluate(*POSES, progress="yes"), "progress is 'yes'; True, False or a callable"),
    "cache": (lambda e: umov.Engine(e.scenario, cache=5), "cache is a int; the name of a file"),
    "set as a list": (lambda e: umov.Engine(e.scenario, set=["render.bounces=2"]), "set is a list; a dictionary"),
    "set as a text": (lambda e: umov.Scenario(e.scenario, set="render.bounces=2"), "set is a str; a dictionary"),
    "bands as a number": (lambda e: umov.Engine(e.scenario, bands=550), "bands is 550; names"),
    "phase": (lambda e: umov.random_poses(3, 200), "phase_deg is 200; a number from 0 to 180"),
    "altitude": (lambda e: umov.exposure("c11_imx250", alt_deg=-5), "alt_deg is -5; a number from 3 to 90"),
    "masked time": (lambda e: umov.utc(Time(np.ma.array(2458139.7, mask=True), format="jd")), "a Time is masked"),
    "local time": (lambda e: umov.utc(Time("2018-01-21T05:05", scale="local")), "scale local"),
    "several steps": (lambda e: umov.ephemeris(DATA / "tle/hst.tle", "maui", START, STOP, step=[3, 4] * u.s), "step has shape"),
    "masked step": (lambda e: umov.ephemeris(DATA / "tle/hst.tle", "maui", START, STOP, step_s=np.ma.masked), "step_s has masked"),
    "several places": (lambda e: umov.Site(EarthLocation.from_geodetic([1, 2], [0, 0], [0, 0])), r"shape \(2,\); a single place"),
    "no place": (lambda e: umov.Site(EarthLocation.from_geocentric(np.nan, 0, 0, unit="m")), "is nan; a finite number"),
    "half a place": (lambda e: umov.Site({"lat_deg": 20, "lon_deg": 5}), "a site has no alt_m"),
    "attitude as a text": (lambda e: umov.Satellite(mesh="a.obj", materials="gold", attitude="nadir"), "attitude is 'nadir'; a table"),
    "parts as a text": (lambda e: umov.Satellite(mesh="a.obj", materials="gold", parts="wing"), "a part is 'w'; a table"),
    "number for a name": (lambda e: umov.Satellite(mesh="a.obj", materials="gold", name=5), "name is 5; a text"),
    "two columns of time": (lambda e: umov.period(Table({"a": Time([START, STOP]), "b": Time([START, STOP])})), "the times a, b; one"),
    "columns of two lengths": (lambda e: umov.period({"mjd_utc": [1.0, 2.0], "mag": [1.0]}), "columns that are none"),
    "half a pixel": (lambda e: umov.render(e.scenario, sun=[1, 1, 1], observer=[0, 1, 1], side=1.5), "side is 1.5; a whole number"),
    "masked Sun": (lambda e: umov.render(e.scenario, sun=MASKED, observer=[0, 1, 1]), "sun has masked"),
    "a word for yes": (lambda e: umov.passes(DATA / "tle/hst.tle", "maui", START, STOP, visible_only="yes"), "visible_only is 'yes'; True"),
    "another word": (lambda e: umov.propagate(DATA / "tle/hst.tle", START, allow_old_elements="no"), "allow_old_elements is 'no'; True"),
    "bytes of a scenario": (lambda e: umov.Scenario.from_toml(b"umov = 1"), "text is b'umov = 1'; a text"),
    "half a letter": (lambda e: umov.Scenario.from_toml("umov = 1\ntitle = '\udc80'"), "no UTF-8"),
    "third object": (lambda e: umov.mesh(e.scenario, object=2), "object is 2; a whole number from 0 to 0"),
    "figure of a table": (lambda e: umov.plot.qu_plane(umov.materials()), "curve is a Table; a LightCurve was expected"),
    "angles for a direction": (lambda e: e.evaluate([0, 1, 1] * u.deg, [0, 0, 1]), "sun is in deg; a direction was expected"),
    "two columns of a name": (lambda e: umov.period(pandas.DataFrame([[1.0, 2.0, 3.0]], columns=["mjd_utc", "mag", "mag"])),
                              "two columns mag; a name for each"),
    "half a letter in a column": (lambda e: umov.period({"mjd_utc": [58139.0], "mag": [1.0], "band": ["\udc80"]}), "a text that is no UTF-8"),
    "band of a period": (lambda e: umov.period({"mjd_utc": [58139.0], "mag": [1.0]}, band=5), "band is 5; a text"),
    "band of an exposure": (lambda e: umov.exposure("c11_imx250", band=5), "band is 5; a text"),
    "a table in itself": (lambda e: umov.Scenario(_in_itself()), "a table holds itself"),
    "figure of a number": (lambda e: umov.plot.picture(5), "image is a int; a Picture was expected"),
    "period below 0": (lambda e: umov.period({"mjd_utc": [1.0, 2.0], "mag": [1.0, 2.0]}, shortest_s=-5), "shortest_s is -5; a number from 0"),
    "periods turned round": (lambda e: umov.period({"mjd_utc": [1.0], "mag": [1.0]}, shortest_s=9, longest_s=5), "a longest above the"),
    "a broadcast beyond memory": (lambda e: e.evaluate(np.broadcast_to([1.0, 0, 0], (2**20, 1, 3)), np.broadcast_to([0, 1.0, 0], (2**20, 3))),
                                  "broadcast to 1099511627776 poses; at most"),
    "angles beyond memory": (lambda e: umov.brdf("gold", 550, np.zeros((2**15, 1)), np.zeros(2**15)), "1073741824 geometries; at most"),
    "figure of nothing": (lambda e: umov.plot.overview(None), "curve is a NoneType; a LightCurve"),
    "number for axes": (lambda e: umov.plot.picture(umov.render(e.scenario, sun=[1, 1, 1], observer=[0, 1, 1], side=8, samples=1), axes=3),
                        "axes is a int; Axes of matplotlib"),
    "time before calendars": (lambda e: umov.propagate(DATA / "tle/hst.tle", Time(1e9, format="jd")), "is none in UTC .*; one of our calendar"),
    "number for others": (lambda e: umov.Sums(e.scenario, others=3), "others is 3; a list of scenes"),
    "name for others": (lambda e: umov.Sums(e.scenario, others="abc"), "others is 'abc'; a list of scenes"),
    "table for a material": (lambda e: umov.Material({"index": 1}), "name is a dict; the name of a material or of its file"),
    "nothing for a band": (lambda e: umov.band(None), "name is None; a text"),
    "path of a number": (lambda e: umov.Engine(_PathOfANumber()), "a _PathOfANumber that names no file"),
    "empty path": (lambda e: umov.Scenario(""), 'the path of a scenario is ""; the name of a file'),
    "a generator": (lambda e: e.evaluate((one for one in [0, 0, 1]), [0, 0, 1]), "sun is <generator .*; numbers, directions"),
    "a list in itself": (lambda e: e.evaluate(_list_in_itself(), [0, 0, 1]), "numbers, directions"),
    "a direction of the sky": (lambda e: e.evaluate(SkyCoord(1 * u.deg, 2 * u.deg), [0, 0, 1]), "(?s)sun is <SkyCoord .*; numbers, directions"),
    "a place for a direction": (lambda e: e.evaluate(A_PLACE, [0, 0, 1]), "numbers, directions"),
    "corners beyond numbers": (lambda e: umov.Satellite(mesh=(TRIANGLE, np.array([[0, 1, 2**64 - 1]], "u8")), materials="gold"),
                               "faces name vertices 0 to 18446744073709551615"),
    "texts of a table": (lambda e: e.evaluate(np.array(["1", "0", "0"], object), [0, 0, 1]), "sun is .*; numbers, directions"),
    "angles for lengths in a list": (lambda e: e.evaluate([0 * u.deg, 0 * u.deg, 1 * u.deg], [0, 0, 1]), "sun is in deg; a direction"),
    "a list of two quantities": (lambda e: umov.brdf("gold", 550, [10 * u.deg, 1 * u.km]), "theta_i_deg is .*; quantities of one kind"),
    "no time of pandas": (lambda e: umov.utc(pandas.NaT), "NaT is no time"),
    "no time of numpy": (lambda e: umov.utc(np.datetime64("NaT")), "NaT is no time"),
    "times without order": (lambda e: umov.propagate(DATA / "tle/hst.tle", {START, STOP}), "is a set; a time or a list of times"),
    "a frame without a direction": (lambda e: umov.Satellite(mesh="a.obj", materials="gold", attitude={"point": "+Z", "at": ICRS()}),
                                    "ICRS Frame> is no direction"),
    "a list of no orbits": (lambda e: umov.propagate([None], START), "orbit is a NoneType; a file, the lines"),
    "a table of orbits": (lambda e: umov.propagate(pandas.DataFrame({"line": LINES}), START), "orbit is a DataFrame; a file, the lines"),
    "a table of orbits for a satellite": (lambda e: umov.Satellite(mesh="a.obj", materials="gold", orbit=Table({"line": LINES})),
                                          "orbit is a Table; a file, the lines"),
    "no orbits": (lambda e: umov.propagate([], START), r"orbit is an empty list; a file, the lines"),
    "a time for an orbit": (lambda e: umov.propagate(Time(START), START), "orbit is a Time; a file, the lines"),
    "a length for an orbit": (lambda e: umov.propagate(3 * u.m, START), "orbit is a Quantity; a file, the lines"),
    "an array of a number": (lambda e: umov.propagate(np.array(5), START), "orbit is a int; a file, the lines"),
    "numbers without order": (lambda e: umov.passes(DATA / "tle/hst.tle", "maui", START, STOP, norad={20580}), r"norad is \{20580\}; a whole"),
    "wavelengths in seconds": (lambda e: umov.Material("gold").refractive_index(5 * u.s), "does not go into"),
    "texts for wavelengths": (lambda e: umov.Material("gold").refractive_index("550"), "wavelength_nm is '550'; numbers"),
    "masked wavelengths": (lambda e: umov.Material("gold").refractive_index(np.ma.array([550.0, 600.0], mask=[0, 1])), "wavelength_nm has masked"),
    "a time for a temperature": (lambda e: umov.Engine(e.scenario, temperatures=[3 * u.s]), "temperatures is .* does not go into K"),
    "seconds for a direction": (lambda e: umov.render(e.scenario, sun=[1, 1, 1] * u.s, observer=[0, 1, 1]), "sun is in s; a direction"),
    "poses beyond numbers": (lambda e: umov._umov.random_directions(2**63, 30.0, 0, 2**63), "first and count are too large"),
}


NO_INPUT = {
    "site": (lambda: umov.Site.from_toml("[["), "site is no TOML"), "bands": (lambda: umov.Bands.from_toml("x"), "bands is no TOML"),
    "satellite": (lambda: umov.Satellite.from_toml("[["), "satellite is no TOML"),
    "calibration": (lambda: umov.Calibration.from_toml("[[").to_dict(), "calibration.toml is no TOML"),
    "half a satellite": (lambda: umov.Satellite.from_dict({"mesh": {"file": "a.obj"}}), "an object has no materials"),
    "no satellite": (lambda: umov.Satellite.from_dict(5), "an object is 5; a table"),
    "no material": (lambda: umov.Material.from_toml(5), "text is 5; a text"),
    "no job": (lambda: umov.scale.Result("/nofolder"), "/nofolder: there is no job"),
    "another calibration": (lambda: umov.Calibration.from_toml("x = 1"), 'calibration.toml.*unknown key "x"'),
    "number for a key": (lambda: umov.Scenario({"umov": 1, 5: 1}), 'unknown key "5"'),
    "number for a job": (lambda: umov.scale.run(5, "x"), "job is a int; a umov.scale.Job"),
    "number for a folder": (lambda: umov.scale.Result(5), "folder is a int"),
}


@pytest.mark.parametrize("name", NO_INPUT)
def test_what_is_no_input_is_told_of(name):
    call, words = NO_INPUT[name]
    with pytest.raises((umov.InputError, umov.UsageError), match=words):
        call()


def test_a_key_of_a_million_letters_is_soon_refused():
    """What looked for the nearest of the known keys, and for names in the message, took the product of two lengths: hours here."""
    with pytest.raises(umov.InputError, match="unknown key"):
        umov.Scenario.from_toml("a" * 1_000_000 + " = 1")


def test_what_has_no_numbers_and_what_cannot_be_written(plate, hst, tmp_path):
    curve = hst.light_curve("maui", START, STOP, step_s=30, bands=["nm:550"])
    with pytest.raises(umov.UsageError, match='column "name" holds no numbers'):
        curve.quantity("name")
    with pytest.raises(umov.DeviceError, match="cannot write here: No such file or directory"):
        umov.render(plate, sun=[1, 1, 1], observer=[0, 1, 1], side=16, samples=1).write(tmp_path / "none/x.png")


@pytest.mark.parametrize("name", WRONG)
def test_wrong_things_are_told_of(name, plate):
    call, words = WRONG[name]
    with pytest.raises(umov.UsageError, match=words):
        call(umov.Engine(plate, ["nm:550"]))


def test_an_orbit_and_one_pass_are_asked_for(hst, plate):
    with pytest.raises(umov.UsageError, match="no orbit; light over time needs one"):
        plate.light_curve("maui", START, STOP)
    table = umov.passes(DATA / "tle/hst.tle", "maui", "2018-01-21T04:00Z", "2018-01-21T09:00Z")
    with pytest.raises(umov.UsageError, match=f"a table of {len(table)} passes; one row was expected"):
        hst.light_curve("maui", table)
    with pytest.raises(umov.UsageError, match="render is 'rays'; a table"):
        hst.light_curve("maui", table[0], render="rays")
    with pytest.raises(umov.InputError, match="equatorial, altaz or scattering was expected"):
        hst.light_curve("maui", table[0], pol_frame="icrs")


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


def test_photometry_as_it_comes():
    """One series in all forms in which a notebook has it, with the period that it was made with."""
    t = 0.75 * np.arange(400) + np.random.default_rng(1).uniform(0, 0.5, 400)
    mag = 7 + 0.4 * np.sin(2 * np.pi * t / 11.3)
    time = Time("2024-03-01T20:00:00", scale="utc") + t * u.s
    pandas = pytest.importorskip("pandas")
    expected = umov.period(Table({"time_utc": [f"{one}Z" for one in time.isot], "mag": mag}))["period"][0]
    assert expected == pytest.approx(11.3, abs=0.01)
    for one in (Table({"time": time, "mag": mag}), TimeSeries(time=time, data={"mag": mag * u.mag}),
                TimeSeries(time=time.tdb, data={"mag": mag}), {"mjd_utc": time.mjd, "mag": mag},
                pandas.DataFrame({"mjd_utc": time.mjd, "mag": mag}),
                pandas.DataFrame({"time_utc": pandas.to_datetime(time.datetime64, utc=True).tz_convert("Asia/Tokyo"), "mag": mag}),
                pandas.DataFrame({"time_utc": [f"{one}Z" for one in time.isot], "mag": mag}), TimeSeries(time=time, data={"flux": 10**(-0.4 * mag) * u.Jy})):
        assert umov.period(one)["period"][0] == pytest.approx(expected, rel=1e-5)


def test_tables_of_a_curve_are_photometry_too():
    curve = umov.run(EXAMPLES / "agena_maui.toml", set={"object.attitude": {"mode": "spin", "axis": "+X", "period_s": 23.7}, "time.step_s": 2})
    expected = umov.period(curve, band="nm:550")["period"].tolist()
    for one in (curve.to_qtable(), curve.to_pandas(), curve.table):
        assert umov.period(one, band="nm:550")["period"].tolist() == expected
    assert umov.period(curve.to_timeseries("nm:550"))["period"][0] == pytest.approx(expected[0], rel=1e-6)  # passes of both are told apart
    with pytest.raises(umov.UsageError, match=r"column \w+ of shape \(\d+, 3\); one value a row"):
        umov.period(curve.to_timeseries())


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


def test_a_shallow_copy_has_files_of_its_own():
    """The copy's names of files stood in the table of both, and went with the copy."""
    one = umov.Satellite(mesh=(TRIANGLE, [[0, 1, 2]]), materials="paper_al", orbit=LINES)
    two = copy.copy(one)
    assert one == two
    del two
    gc.collect()
    assert umov.mesh(one).vertices.shape == (3, 3) and umov.propagate(one, START).error.tolist() == [[0]]


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


def test_a_part_of_a_curve_has_its_own_period():
    """`table` of a part is that of the whole: two bodies were taken for one."""
    both = umov.Scenario(EXAMPLES / "agena_maui.toml").to_dict()
    slow = copy.deepcopy(both["object"][0])
    both["object"][0].update(name="fast", attitude={"mode": "spin", "axis": "+X", "period_s": 23.7})
    slow.update(name="slow", attitude={"mode": "spin", "axis": "+X", "period_s": 61.0})
    both["object"].append(slow)
    both["bands"], both["time"]["step_s"] = {"set": ["nm:550"]}, 1
    curve = umov.run(both)
    for name in ("fast", "slow"):
        alone = umov.run({**both, "object": [one for one in both["object"] if one["name"] == name]})
        found, expected = umov.period(curve.object(name)), umov.period(alone)
        assert found["period"].tolist() == pytest.approx(expected["period"].tolist(), rel=1e-9)


def test_bands_and_turns_by_numbers(hst):
    curve = hst.light_curve("maui", START, STOP, step_s=30, bands=["nm:425", "nm:550"])
    assert curve.band(np.int64(1)) == curve.band("nm:550") == 1
    with pytest.raises(umov.UsageError, match="no band True"):
        curve.band(True)
    with pytest.raises(umov.UsageError, match="period_s is '3'; a number"):
        umov.plot.folded(curve, "3")
    assert umov.plot.folded(curve, 1 * u.min).get_xlabel() == "turn of 60 s"


def test_what_is_shown_is_short(plate):
    seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 60})
    assert len(repr(seen)) < 150 and str(seen.exposures) in repr(seen)
    nameless = umov.Satellite(mesh=(TRIANGLE, [[0, 1, 2]]), materials="paper_al")
    assert repr(umov.Engine(nameless, ["nm:550"])).startswith("<umov.Engine unnamed: 1 triangle")


def test_errors_stand_beside_what_they_belong_to(hst):
    curve = hst.light_curve("maui", START, STOP, step_s=30, bands=["nm:550"])
    for name in ("mag_err", "q_err", "u_err", "v_err", "p_err", "pa_err", "mag_limit"):
        assert np.array_equal(getattr(curve, name), curve[name], equal_nan=name != "mag_limit")
    assert curve.quantity("pa_err").unit == u.deg


def _series(**columns):
    t = 0.75 * np.arange(400) + np.random.default_rng(1).uniform(0, 0.5, 400)
    return {"mjd_utc": 60000 + t / 86400, "mag": 7 + 0.4 * np.sin(2 * np.pi * t / 11.3), **columns}


@pytest.mark.parametrize("kind", [dict, Table, QTable])
def test_columns_are_taken_in_their_units(kind):
    plain = _series()
    expected = umov.period(plain)["period"].tolist()
    assert expected[0] == pytest.approx(11.3, abs=0.01)
    for one in ({"mjd_utc": plain["mjd_utc"] * 24 * u.h}, {"mag": plain["mag"] * u.mag}, {"mag": plain["mag"] * 1000 * u.mmag},
                {"mag": plain["mag"] * u.ABmag}, {"mag": plain["mag"] * u.dimensionless_unscaled}, {"mjd_utc": plain["mjd_utc"] * u.d}):
        assert umov.period(kind(_series(**one)))["period"][0] == pytest.approx(expected[0], rel=1e-4)
    masked = Table(_series(), masked=True)
    masked["mag"] = np.ma.array(1000 * plain["mag"], mask=np.arange(400) % 50 == 7)
    masked["mag"].unit = "mmag"
    assert umov.period(masked)["period"][0] == pytest.approx(11.3, abs=0.01)


@pytest.mark.parametrize("column, unit, words", [
    ("mjd_utc", u.km, "days"), ("mag", u.Jy, "magnitudes"), ("mag_err", u.s, "magnitudes"), ("flux", u.mag, "a flux"), ("flux", u.ABmag, "a flux"),
    ("flux", u.s, "a flux"), ("flux", u.km, "a flux"), ("flux", u.arcsec, "a flux"), ("q", u.deg, "a part of I")])
def test_columns_of_another_quantity_are_told_of(column, unit, words):
    with pytest.raises(umov.UsageError, match=f"light has the column {column} in {unit.to_string()[:3]}.*; {words}"):
        umov.period(_series(**{column: units.Quantity(_series()["mag"], unit) if unit != u.ABmag else _series()["mag"] * unit}))


def test_an_error_of_another_unit_than_its_flux():
    flux = 10**(-0.4 * _series()["mag"]) * u.Jy
    same, other = (umov.period(_series(flux=flux, flux_err=0.01 * flux.to(unit))) for unit in (u.Jy, u.mJy))
    assert same["period"].tolist() == other["period"].tolist()
    with pytest.raises(umov.UsageError, match="column flux_err in W and flux in Jy; the same unit"):
        umov.period(_series(flux=flux, flux_err=np.ones(400) * u.W))


def test_counts_in_kilometres():
    counts = {"time_utc": ["2018-01-21T05:00:00Z"], "counts": [5.0] * u.km}
    with pytest.raises(umov.UsageError, match="counts has the column counts in km; electrons"):
        umov.reduce(counts)
    seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 20})
    assert umov.reduce(seen.counts.to_qtable())["q"].tobytes() == umov.reduce(seen)["q"].tobytes()


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


@pytest.mark.parametrize("name", ["mesh", "orbit", "material", "run", "scenario", "table", "curve", "picture", "passes", "flux", "instrument"])
def test_a_name_of_a_file_does_not_end_at_its_character_0(name, plate, tmp_path):
    mesh, tle, run = DATA / "mesh/hst.obj", DATA / "tle/hst.tle", EXAMPLES / "agena_maui.toml"
    calls = {"mesh": lambda: umov.Satellite(f"{mesh}\0junk", materials="gold"),
             "orbit": lambda: umov.Satellite(mesh, materials="gold", orbit=f"{tle}\0x"),
             "material": lambda: umov.Satellite(mesh, materials="a\0.toml"),
             "run": lambda: umov.run(f"{run}\0x"), "scenario": lambda: umov.Scenario(pathlib.Path(f"{run}\0x")),
             "table": lambda: umov.materials().write(f"{tmp_path}/a\0.csv"),
             "curve": lambda: umov.run(run, set={"time.step_s": 60}).write(f"{tmp_path}/a\0.csv"),
             "picture": lambda: umov.render(plate, sun=[1, 1, 1], observer=[0, 1, 1], side=16, samples=1).write(f"{tmp_path}/a\0.png"),
             "passes": lambda: umov.passes(f"{tle}\0x", "maui", START, STOP), "flux": lambda: umov.flux_table("a.fits\0x", "nm:550"),
             "instrument": lambda: umov.exposure("c11_imx250\0x")}
    with pytest.raises(umov.UsageError, match=r"\\x00.*; the name of a file without the character 0 was expected"):
        calls[name]()
    assert not list(tmp_path.iterdir())


def test_texts_of_a_scenario_have_no_character_0():
    file = f"{DATA}/mesh/agena.obj\0x"
    document = umov.Scenario(EXAMPLES / "agena_maui.toml").to_dict()
    document["object"][0]["mesh"]["file"] = file
    for call in (lambda: umov.Scenario(document), lambda: umov.run(EXAMPLES / "agena_maui.toml", set={"object.mesh.file": file})):
        with pytest.raises(umov.UsageError, match=r"file is .*x00.*; a text without the character 0"):
            call()


def test_fits_is_not_read_as_text(tmp_path):
    path = tmp_path / "counts.fits"
    umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 60}).counts.write(path)
    with pytest.raises(umov.InputError, match="counts.fits: is FITS, which is not read here; counts as ECSV or CSV was expected"):
        umov.reduce(path)


def test_more_rays_than_memory_holds(plate):
    with pytest.raises(umov.UsageError, match=r"side \* samples is 4096 \* 8 = 32768; at most 12288"):
        umov.render(plate, sun=[1, 1, 1], observer=[0, 1, 1], side=4096, samples=8)


def test_times_of_any_shape():
    tle = DATA / "tle/hst.tle"
    none = umov.propagate(tle, [])
    assert none.position_km.shape == none.velocity_km_s.shape == (1, 0, 3) and none.error.shape == (1, 0)
    times = Time(START) + np.arange(4).reshape(2, 2) * u.min
    square, flat = umov.propagate(tle, times), umov.propagate(tle, times.ravel())
    assert square.position_km.shape == (1, 2, 2, 3) and square.error.shape == (1, 2, 2)
    assert square.position_km.tobytes() == flat.position_km.tobytes()
    assert umov.propagate(tle, times[0, 0]).position_km.shape == (1, 1, 3)


def test_a_site_stays_a_site():
    site = umov.Site("maui")
    before = site.to_dict()
    for name, value, error in (("lat_deg", "north", umov.UsageError), ("lat_deg", 91, umov.InputError), ("alt_m", np.nan, umov.UsageError),
                               ("lon_deg", None, umov.UsageError), ("name", 5, umov.UsageError)):
        with pytest.raises(error, match=str(name)):
            setattr(site, name, value)
    assert site.to_dict() == before
    site.lat_deg = 20 * u.deg
    assert site.lat_deg == 20 and copy.deepcopy(site) == site


@pytest.mark.parametrize("closed", [False, True])
def test_a_bar_that_nobody_sees(closed, plate, monkeypatch, tmp_path):
    stream = open(tmp_path / "err", "w")
    stream.close()
    monkeypatch.setattr("sys.stderr", stream if closed else None)
    assert umov.Engine(plate, ["nm:550"], progress=True).evaluate(*POSES, progress=True).shape == (50, 1, 4)


LINES = [line for line in (DATA / "tle/hst.tle").read_text().splitlines() if line[:2] in ("1 ", "2 ")][:2]


@pytest.mark.parametrize("what", ["satellite", "scenario"])
def test_arrays_and_lines_are_files_only_where_one_says(what, tmp_path):
    def make(size=1.0):
        made = umov.Satellite(mesh=(np.array(TRIANGLE) * size, [[0, 1, 2]]), materials="paper_al", orbit=LINES)
        return made if what == "satellite" else umov.Scenario(made)

    one = make()
    same = pickle.loads(pickle.dumps(one))
    assert one == make() == same and hash(one) == hash(make()) == hash(same) and one != make(2.0)
    with pytest.raises(umov.UsageError, match="orbit.tle.* a folder for them was expected"):
        one.to_toml()
    text = one.to_toml(tmp_path / "kept")
    assert one.to_toml(tmp_path / "kept") == text  # the same files once more
    del one, same
    gc.collect()
    again = umov.Satellite.from_toml(text) if what == "satellite" else umov.Scenario.from_toml(text)
    assert umov.mesh(again).vertices.shape == (3, 3)
    with pytest.raises(umov.UsageError, match="is there already"):
        make(2.0).to_toml(tmp_path / "kept")
    (tmp_path / "file").write_text("")
    with pytest.raises(umov.DeviceError, match="cannot be written"):
        make().to_toml(tmp_path / "file")


@pytest.mark.filterwarnings("ignore::umov.UmovWarning")
def test_messages_name_no_file_that_nobody_made():
    with pytest.raises(umov.Error) as caught:
        umov.Engine(umov.Satellite(mesh=([[0, 0, 0]] * 3, [[0, 1, 2]]), materials="paper_al"))
    assert "umov-" not in str(caught.value) and "mesh of arrays" in str(caught.value)


@pytest.mark.parametrize(("key", "most"), [("n", "1e.06"), ("k", "1e.09")])
def test_an_index_of_no_matter(key, most):
    table = umov.Material("paper_al").to_dict()
    with pytest.raises(umov.InputError, match=f"{key} = 1e.100; .* {most}"):
        umov.Material.from_dict("m", {**table, "index": {"n": 1.5, "k": 0.1, key: 1e100}})


def test_a_text_of_toml_does_not_end_at_its_character_0():
    text = umov.Scenario(EXAMPLES / "agena_maui.toml").to_toml()
    with pytest.raises(umov.InputError, match=r"character 0 \(.u0000\)"):
        umov.Scenario.from_toml(text.replace("agena.obj", "agena.obj\\u0000x"))


@pytest.mark.parametrize("name", ["Satellite", "Engine", "Sums", "LightCurve", "Table", "Scenario", "Material", "Calibration", "Bands"])
def test_objects_that_were_never_made_say_so(name):
    kind = getattr(umov, name)
    dead = kind.__new__(kind)
    with pytest.raises(umov.UsageError, match=f"this {name} was never made"):
        repr(dead)
    assert not hasattr(dead, "__array__")


def test_options_of_the_command_are_arguments_here():
    from umov._words import in_python
    told = {"Give newer ones or pass --allow-old-elements (in Python allow_old_elements=True).":
            "Give newer ones or pass allow_old_elements=True.",
            "a larger --grid or --floor may help": "a larger grid or floor may help",
            "(--objects), --alt 3: --gap-s.": "(objects), alt_deg 3: gap_s.", "take --device cpu or auto": 'take device="cpu" or auto',
            "/a/--floor.tle: no such file --x": "/a/--floor.tle: no such file --x", "x --floor.tle": "x --floor.tle"}
    assert {text: in_python(text) for text in told} == told
    with pytest.raises(umov.UsageError, match="^stop lies before start"):
        umov.passes(DATA / "tle/hst.tle", "maui", STOP, START)
    with pytest.raises(umov.UsageError, match="year of stop mistyped"):
        umov.passes(DATA / "tle/hst.tle", "maui", START, "2999-01-01T00:00Z", allow_old_elements=True)


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", ">i4", "u8"])
def test_faces_of_short_numbers_name_the_vertices_that_they_name(kind):
    """The last number of its kind, counted from 1, is none of its kind any more: -128 was the first vertex of 128."""
    last = min(np.iinfo(kind).max, 300)
    vertices = np.zeros((last + 1, 3))
    vertices[1], vertices[last] = [1, 0, 0], [0, 2, 0]
    made = umov.mesh(umov.Satellite(mesh=(vertices, np.array([[0, 1, last]], kind)), materials="gold"))
    assert sorted(map(tuple, made.vertices[made.faces[0]].tolist())) == [(0, 0, 0), (0, 2, 0), (1, 0, 0)]


def test_a_faint_laser_is_a_laser(plate):
    faint, bright = (umov.Engine(plate, laser=[i, 0, 0, i]).evaluate([0, 0, 1], [0, 0.1, 1]) for i in (1e-320, 1.0))
    np.testing.assert_array_equal(faint, bright)


def test_times_of_numpy():
    assert len(umov.ephemeris(DATA / "tle/hst.tle", "maui", START, STOP, step=np.timedelta64(30, "s"))) == 3
    with pytest.raises(umov.UsageError, match="a finite number"):
        umov.ephemeris(DATA / "tle/hst.tle", "maui", START, STOP, step=np.timedelta64("NaT"))
    with pytest.raises(umov.UsageError, match=r"no time zone.*Time.'2018-01-21T05:00'"):
        umov.utc(np.datetime64("2018-01-21T05:00"))
