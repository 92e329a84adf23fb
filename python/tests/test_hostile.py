"""What goes wrong in a notebook: things of the wrong kind, and what is said of them."""
import os

import numpy as np
import pandas
import pytest
import umov
import umov.plot
import umov.scale
from astropy import units as u
from astropy.coordinates import ICRS, EarthLocation, SkyCoord
from astropy.table import Table
from astropy.time import Time
from astropy.utils.masked import Masked

from conftest import DATA, EXAMPLES, LINES

START, STOP = "2018-01-21T05:10:00Z", "2018-01-21T05:11:00Z"
TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
POSES = umov.random_poses(50, 60, seed=3)


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
    "a time for vertices": (lambda e: umov.Satellite(mesh=(Time(START), [[0, 1, 2]]), materials="gold"), "vertices is .*; numbers were expected"),
    "a table for a material": (lambda e: umov.Material("mine.csv"), r"name is 'mine.csv', a table; .*from_dict\(\"mine\", {\"table\": 'mine.csv'}\)"),
    "a table in capitals": (lambda e: umov.Material("mine.CSV"), r"name is 'mine.CSV', a table; .*from_dict\(\"mine\", {\"table\": 'mine.CSV'}\)"),
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
    "a table in itself": (lambda e: umov.Scenario(_in_itself()), "a table or list holds itself"),
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


def test_what_is_shown_is_short(plate):
    seen = umov.observe(EXAMPLES / "observe_hst.toml", set={"observation.cadence_s": 60})
    assert len(repr(seen)) < 150 and str(seen.exposures) in repr(seen)
    nameless = umov.Satellite(mesh=(TRIANGLE, [[0, 1, 2]]), materials="paper_al")
    assert repr(umov.Engine(nameless, ["nm:550"])).startswith("<umov.Engine unnamed: 1 triangle")


def test_more_rays_than_memory_holds(plate):
    with pytest.raises(umov.UsageError, match=r"side \* samples is 4096 \* 8 = 32768; at most 12288"):
        umov.render(plate, sun=[1, 1, 1], observer=[0, 1, 1], side=4096, samples=8)


@pytest.mark.parametrize("closed", [False, True])
def test_a_bar_that_nobody_sees(closed, plate, monkeypatch, tmp_path):
    stream = open(tmp_path / "err", "w")
    stream.close()
    monkeypatch.setattr("sys.stderr", stream if closed else None)
    assert umov.Engine(plate, ["nm:550"], progress=True).evaluate(*POSES, progress=True).shape == (50, 1, 4)


@pytest.mark.parametrize(("key", "most"), [("n", "1e.06"), ("k", "1e.09")])
def test_an_index_of_no_matter(key, most):
    table = umov.Material("paper_al").to_dict()
    with pytest.raises(umov.InputError, match=f"{key} = 1e.100; .* {most}"):
        umov.Material.from_dict("m", {**table, "index": {"n": 1.5, "k": 0.1, key: 1e100}})


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


def test_a_faint_laser_is_a_laser(plate):
    faint, bright = (umov.Engine(plate, laser=[i, 0, 0, i]).evaluate([0, 0, 1], [0, 0.1, 1]) for i in (1e-320, 1.0))
    np.testing.assert_array_equal(faint, bright)
