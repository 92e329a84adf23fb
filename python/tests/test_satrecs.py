"""Orbits that sgp4 and skyfield have in memory: what umov makes of them stands where theirs do."""
import math
import types
import warnings

import numpy as np
import pytest
from astropy.time import Time

import umov
from conftest import DATA, LINES

sgp4 = pytest.importorskip("sgp4.api")
TIMES = Time("2018-01-21T00:00:00") + np.array([0.0, 0.3, 2.0, 4.0])


def _made(model=None, mode="i", **changes):
    """A Satrec of sgp4init: the elements of LINES, changed beyond the digits of a TLE."""
    base = sgp4.Satrec.twoline2rv(*LINES)
    got = {"num": base.satnum, "bstar": base.bstar + 3e-10, "ecco": base.ecco + 3e-8, "argpo": base.argpo + 4e-7, "inclo": base.inclo + 4e-7,
           "mo": base.mo + 3e-7, "no": base.no_kozai + 1e-12, "nodeo": base.nodeo + 4e-7, **changes}
    out = sgp4.Satrec()
    out.sgp4init(sgp4.WGS72 if model is None else model, mode, got["num"], base.jdsatepoch - 2433281.5 + base.jdsatepochF + 3e-9, got["bstar"], 0, 0,
                 got["ecco"], got["argpo"], got["inclo"], got["mo"], got["no"], got["nodeo"])
    return out


def _off_m(satrec):
    """How far umov has it from where sgp4 itself has it, at the most [m]."""
    ours = umov.propagate(satrec, TIMES).position_km[0]
    _, theirs, _ = satrec.sgp4_array(TIMES.jd1, TIMES.jd2)
    return float(np.linalg.norm(ours - theirs, axis=1).max()) * 1e3


@pytest.mark.parametrize("changes", [{}, {"argpo": -1.0}, {"nodeo": 7.0}, {"ecco": 0.0}, {"num": 339999}, {"mo": 2 * math.pi - 1e-9}])
def test_elements_of_memory_keep_all_their_digits(changes):
    """A TLE has 1e-4 deg, which is 12 m at HST; 1e-3 m is the epoch's last digit (1 ns is 8 micrometres) and rounding, with room."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", umov.UmovWarning)
        assert _off_m(_made(**changes)) < 1e-3


def test_those_of_lines_go_as_lines():
    satrec = sgp4.Satrec.twoline2rv(*LINES)
    assert umov.propagate(satrec, TIMES).position_km.tobytes() == umov.propagate(LINES, TIMES).position_km.tobytes()
    two = umov.propagate([satrec, _made()], TIMES)  # one file, of the one form that holds both
    assert two.position_km.shape == (2, 4, 3) and np.abs(two.position_km[0] - umov.propagate(LINES, TIMES).position_km[0]).max() < 1e-6


def test_other_constants_are_told_of():
    """The warning says what the same elements differ by: 177 m after some days were silent."""
    satrec = sgp4.Satrec.twoline2rv(*LINES, sgp4.WGS84)
    with pytest.warns(umov.UmovWarning, match="Satrec of 20580 has constants other than those of WGS72.*sgp4.api.WGS72"):
        assert _off_m(satrec) > 10
    with pytest.warns(umov.UmovWarning, match='operation mode "a"'):
        _off_m(_made(mode="a"))
    with warnings.catch_warnings():
        warnings.simplefilter("error", umov.UmovWarning)
        _off_m(sgp4.Satrec.twoline2rv(*LINES, sgp4.WGS72))


@pytest.mark.parametrize(("changes", "told"), [
    ({"mo": math.nan}, "has mo = nan; a finite number"), ({"inclo": 4.0}, "has inclo = 4.0; a number from 0 to 3.14159"),
    ({"ecco": 1.2}, "has ecco = 1.2; a number from 0 to 1"), ({"no": 50.0}, "has no_kozai = 50.0; a number from")])
def test_what_is_wrong_is_told_by_the_words_of_a_satrec(changes, told):
    with pytest.raises(umov.UsageError, match=f"the Satrec of 20580 {told}"):
        umov.propagate(_made(**changes), TIMES)


def test_a_satellite_keeps_them_too(tmp_path):
    precise = umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", materials="gold", orbit=_made())
    told = umov.ephemeris(precise, "maui", "2018-01-21T05:00:00Z", "2018-01-21T05:00:20Z", step_s=10)
    assert told["range"].value.tolist() == umov.ephemeris(_made(), "maui", "2018-01-21T05:00:00Z", "2018-01-21T05:00:20Z", step_s=10)["range"].value.tolist()
    again = umov.Satellite.from_toml(precise.to_toml(tmp_path))
    assert (tmp_path / "orbit.json").exists() and umov.ephemeris(again, "maui", "2018-01-21T05:00:00Z", "2018-01-21T05:00:20Z", step_s=10)["range"].value.tolist() == told["range"].value.tolist()


class _Named:
    """As skyfield has it."""

    def __init__(self, name, model):
        self.name, self.model = name, model


@pytest.mark.parametrize("name", ["HST", "20580", "1 20580U", "2 HST", "x" * 300, "Müller", "0 HST", "# HST", "(HST)"])
def test_any_name_of_an_object_is_its_name(name):
    """A line of TLEs cannot tell a number, or what begins like an element line, from a name."""
    satrec = sgp4.Satrec.twoline2rv(*LINES)
    table = umov.passes(_Named(name, satrec), "maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z")
    assert set(table["name"].tolist()) == {name} and len(table) == len(umov.passes(satrec, "maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z"))


@pytest.mark.parametrize(("key", "value", "told"), [("jdsatepoch", 1e9, "has its epoch at JD 1000000000"), ("jdsatepoch", 0.0, "has its epoch at JD"),
                                                    ("ndot", math.inf, "has ndot = inf; a finite number"), ("nddot", math.nan, "has nddot = nan")])
def test_what_no_message_can_hold_is_told(key, value, told):
    whole = sgp4.Satrec.twoline2rv(*LINES)
    keys = ("satnum", "jdsatepoch", "jdsatepochF", "ecco", "inclo", "nodeo", "argpo", "mo", "no_kozai", "bstar", "ndot", "nddot", "mu", "radiusearthkm")
    other = types.SimpleNamespace(**{**{one: getattr(whole, one) for one in keys}, key: value})
    with pytest.raises(umov.UsageError, match=f"the Satrec of 20580 {told}"):
        umov.propagate(other, TIMES)
