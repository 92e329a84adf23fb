"""Photometry as tables of any kind, in their units."""
import copy

import numpy as np
import pandas
import pytest
import umov
from astropy import units, units as u
from astropy.table import QTable, Table
from astropy.time import Time
from astropy.timeseries import TimeSeries

from conftest import EXAMPLES

START, STOP = "2018-01-21T05:10:00Z", "2018-01-21T05:11:00Z"


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
