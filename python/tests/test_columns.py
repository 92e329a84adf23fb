"""Columns as notebooks have them: objects, times of Python, gaps; and names of tables in messages."""
import datetime as dt

import numpy as np
import pandas as pd
import pytest
from astropy.table import Table

import umov
from conftest import EXAMPLES

START = dt.datetime(2018, 1, 21, 5, 0, tzinfo=dt.timezone.utc)
TIMES = [START + dt.timedelta(seconds=0.5 * k) for k in range(200)]
MAG = [7 + 0.3 * np.sin(2 * np.pi * 0.5 * k / 8.2) for k in range(200)]
TEXTS = [f"{one.replace(tzinfo=None).isoformat(timespec='microseconds')}Z" for one in TIMES]


def _period(light):
    return umov.period(light, peaks=1)["period"].tolist()


@pytest.mark.parametrize("make", [
    lambda: {"time_utc": TIMES, "mag": MAG}, lambda: {"time_utc": np.array(TIMES, object), "mag": MAG},
    lambda: pd.DataFrame({"time_utc": pd.Series(TIMES, dtype=object), "mag": MAG}), lambda: {"time_utc": [pd.Timestamp(one) for one in TIMES], "mag": MAG},
    lambda: Table({"time_utc": np.array(TIMES, object), "mag": MAG}), lambda: pd.DataFrame({"mag": MAG}, index=pd.DatetimeIndex(TIMES)),
    lambda: {"time_utc": TIMES, "mag": np.array(MAG, object)}])
def test_times_of_python_are_times(make):
    assert _period(make()) == _period({"time_utc": TEXTS, "mag": MAG})


@pytest.mark.filterwarnings("ignore:light. 1 row without a measurement")
def test_gaps_are_empty_cells():
    wanted = _period({"time_utc": TEXTS[1:], "mag": MAG[1:]})
    for gap in (None, np.nan, pd.NA):
        assert _period({"time_utc": TIMES, "mag": np.array([gap, *MAG[1:]], object)}) == wanted
    assert _period(pd.DataFrame({"time_utc": TIMES, "mag": pd.Series([None, *MAG[1:]], dtype=object)})) == wanted
    names = umov.period(pd.DataFrame({"time_utc": TIMES, "mag": MAG, "band": ["V", None] * 100}), peaks=1)["band"].tolist()
    assert set(names) == {"V", ""}


@pytest.mark.parametrize(("light", "told"), [
    ({"time_utc": [one.date() for one in TIMES], "mag": MAG}, "light's column time_utc, row 0: datetime.date.*is a date; a time was expected"),
    ({"time_utc": [one.replace(tzinfo=None) for one in TIMES], "mag": MAG}, "light's column time_utc, row 0: .*has no time zone"),
    ({"time_utc": TEXTS, "mag": np.array([object()] * 200)}, "light's column mag, row 0 is .* of type object; numbers, texts or times")])
def test_other_objects_are_told_with_their_row(light, told):
    for one in (light, pd.DataFrame({name: pd.Series(column, dtype=object) for name, column in light.items()})):
        with pytest.raises(umov.UsageError, match=told):
            umov.period(one)


def test_times_without_a_zone_are_told_with_the_way_on():
    frame = pd.DataFrame({"time_utc": pd.to_datetime([one[:-1] for one in TEXTS]), "mag": MAG})
    for light in (frame, {name: frame[name].to_numpy() for name in frame}):
        with pytest.raises(umov.UsageError, match=r'column time_utc has times without a zone.*df\["time_utc"\].dt.tz_localize\("UTC"\)'):
            umov.period(light)
    frame["time_utc"] = frame["time_utc"].dt.tz_localize("UTC")
    assert _period(frame) == _period({"time_utc": TEXTS, "mag": MAG})


def test_messages_call_a_table_by_its_argument():
    """Files that are made of tables are nobody's."""
    good, bad = (pd.DataFrame({"time_utc": TEXTS, name: MAG}) for name in ("mag", "brightness"))
    scenario = EXAMPLES / "agena_maui.toml"
    for given, name in ((bad, "light"), ([good, bad], "light[1]")):
        with pytest.raises(umov.InputError, match="nothing measured") as caught:
            umov.invert_pose(given, scenario, set={"bands.set": ["nm:550"]})
        assert caught.value.where.file == name and str(caught.value).startswith(f"{name}:") and "umov-" not in str(caught.value)


def _without_end():
    table, listed, deep = {}, [], []
    table["a"] = table
    listed.append(listed)
    inner = deep
    for _ in range(5000):
        inner.append([])
        inner = inner[0]
    return table, listed, deep


@pytest.mark.parametrize("which", range(3))
def test_tables_that_hold_themselves_are_refused(which, plate):
    endless = _without_end()[which]
    run = EXAMPLES / "agena_maui.toml"
    for call in (lambda: umov.Scenario(run, set={"render": endless}), lambda: umov.Scenario({"umov": endless}),
                 lambda: umov.Satellite(EXAMPLES / "no.obj", materials="gold", attitude={"mode": endless}),
                 lambda: umov.Material.from_dict("m", {"index": endless})):
        with pytest.raises(umov.UsageError, match="tables within tables, with an end"):
            call()
    for call in (lambda: umov.Bands([endless]), lambda: umov.Engine(plate, bands=[endless])):
        with pytest.raises(umov.UsageError, match="bands has .*; names were expected"):
            call()


def test_texts_of_lists_in_lists_without_number():
    text = "a = " + "[" * 5000 + "]" * 5000
    for kind in (umov.Satellite, umov.Bands, umov.Site, umov.Calibration, umov.Scenario, umov.Material):
        with pytest.raises(umov.InputError, match="hundreds deep|maximum nested"):
            kind.from_toml(text)


@pytest.mark.parametrize("name", ['q"uote', "q'uote", "back\\slash", "new\nline", "tab\t", "žluťoučký"])
def test_a_folder_of_any_name_is_named_in_toml(name, tmp_path, plate):
    assert umov.mesh(umov.Satellite.from_toml(plate.to_toml(tmp_path / name))).vertices.shape == (4, 3)
    assert umov.mesh(umov.Scenario.from_toml(umov.Scenario(plate).to_toml(tmp_path / name))).vertices.shape == (4, 3)


def test_a_series_with_a_zone_in_a_dictionary_has_one():
    series = pd.Series(pd.to_datetime(TEXTS))
    assert _period({"time_utc": series, "mag": MAG}) == _period({"time_utc": TEXTS, "mag": MAG})
    assert _period({"time_utc": pd.DatetimeIndex(TEXTS), "mag": MAG}) == _period({"time_utc": TEXTS, "mag": MAG})


def test_truth_values_among_objects_are_no_numbers():
    for truths in ([True] * 200, [*MAG[1:], np.True_]):
        with pytest.raises(umov.UsageError, match=r"light's column mag, row \d+ is .*True.*; numbers, texts or times"):
            umov.period({"time_utc": TEXTS, "mag": np.array(truths, object)})


def test_columns_named_by_numbers_are_told():
    with pytest.raises(umov.Error, match="light"):
        umov.period({0: TEXTS, 1: MAG})
