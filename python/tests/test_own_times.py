"""Light at times of one's own."""
import datetime as dt

import numpy as np
import pandas as pd
import pytest
from astropy import units as u
from astropy.table import QTable
from astropy.time import Time

import umov

MINE = Time("2018-01-21T05:10:00.123456") + np.array([0.0, 0.7, 3.1, 20.0]) * u.s
BANDS = {"bands": ["nm:550"], "cache": False}


def test_light_comes_at_the_times_that_were_given(hst):
    """What a run in even steps gives at those of its epochs that are among them. Times are texts of nanoseconds, in which HST goes
    8 micrometres; an angle of a flat part turns by 1e-12 rad in them."""
    even = hst.light_curve("maui", "2018-01-21T05:10:00Z", "2018-01-21T05:10:20Z", step_s=2, **BANDS)
    some = hst.light_curve("maui", even.time[[0, 3, 4, 10]], **BANDS)
    for name in ("I", "q", "u", "az", "alt", "mjd_utc"):
        np.testing.assert_allclose(getattr(some, name), getattr(even, name)[[0, 3, 4, 10]], rtol=1e-9, err_msg=name)
    own = hst.light_curve("maui", MINE, **BANDS)
    assert np.abs((own.time - MINE).to_value("s")).max() < 2e-9  # times are texts of nanoseconds
    assert own.scenario.to_dict()["time"]["epochs"][0].microsecond == 123456
    again = umov.run(own.scenario)
    assert again.I.tobytes() == own.I.tobytes() and umov.Scenario.from_toml(own.scenario.to_toml()) == own.scenario


@pytest.mark.parametrize("form", [lambda t: list(t), lambda t: t.isot.tolist(), lambda t: [one.to_datetime(dt.timezone.utc) for one in t],
                                  lambda t: pd.to_datetime(t.isot, utc=True), lambda t: pd.Series(pd.to_datetime(t.isot, utc=True))])
def test_forms_of_times(form, hst):
    whole = Time("2018-01-21T05:10:00") + np.arange(3) * u.s
    given = form(whole)
    given = [f"{one}Z" if isinstance(one, str) else one for one in given] if isinstance(given, list) else given
    assert hst.light_curve("maui", given, **BANDS).I.tobytes() == hst.light_curve("maui", whole, **BANDS).I.tobytes()


@pytest.mark.parametrize(("more", "told"), [({"step_s": 1}, "start holds several times"), ({"stop": "2018-01-21T05:11:00Z"}, "start holds several times")])
def test_times_stand_alone(more, told, hst):
    with pytest.raises(umov.UsageError, match=told):
        hst.light_curve("maui", MINE, **{**BANDS, **more})


def test_times_out_of_order_or_beside_a_span_are_refused(hst):
    with pytest.raises(umov.InputError, match="epoch 2 is .*; epochs in order of time, each once and a millisecond apart, were expected"):
        hst.light_curve("maui", MINE[::-1], **BANDS)
    with pytest.raises(umov.InputError, match="epoch 2 is .*each once"):
        hst.light_curve("maui", MINE[[0, 0]], **BANDS)
    with pytest.raises(umov.InputError, match="epochs has none"):
        hst.light_curve("maui", [], **BANDS)
    own = hst.light_curve("maui", MINE, **BANDS).scenario
    with pytest.raises(umov.InputError, match="step_s: epochs stand in place of start, stop and step_s"):
        umov.Scenario(own, set={"time.step_s": 2})
    for wrong, told in (([1, 2], "1 is not a time"), (["noon"], "noon.* is not a time")):
        with pytest.raises(umov.InputError, match=told):
            umov.Scenario(own, set={"time.epochs": wrong})
    with pytest.raises(umov.NoResult, match=r"no epoch of \[time\] epochs falls in a pass|no sunlit pass"):
        hst.light_curve("maui", MINE + np.arange(1, 5) * u.h, **BANDS)


def test_an_observation_takes_exposures_between_two_times():
    from conftest import EXAMPLES
    document = umov.Scenario(EXAMPLES / "observe_hst.toml").to_dict()
    document["time"] = {"epochs": list(MINE.isot + np.array("Z"))}
    with pytest.raises(umov.InputError, match=r"\[time\] has epochs; start and stop were expected"):
        umov.observe(document)


def test_a_table_is_no_time(hst):
    table = QTable({"time": MINE, "flux": np.ones(4)})
    frame = pd.DataFrame({"time": pd.to_datetime(MINE.isot, utc=True), "flux": 1.0})
    for given in (table, frame, hst.light_curve("maui", MINE, **BANDS).table):
        with pytest.raises(umov.UsageError, match=r"a table with the columns .*Give its column of time, such as table\[.time"):
            hst.light_curve("maui", given, **BANDS)
    assert hst.light_curve("maui", table["time"], **BANDS).I.tobytes() == hst.light_curve("maui", MINE, **BANDS).I.tobytes()


def test_epochs_of_a_scenario_are_times(hst):
    scenario = hst.light_curve("maui", MINE, **BANDS).scenario
    for epochs in (MINE, list(MINE), pd.to_datetime(MINE.datetime, utc=True)):
        assert umov.Scenario(scenario, {"time.epochs": epochs}) == scenario
        assert umov.Scenario(scenario, {"time": {**scenario.to_dict()["time"], "epochs": epochs}}) == scenario
    for epochs in (MINE.datetime64, MINE.datetime64[0], list(MINE.datetime64)):  # which were whole numbers
        with pytest.raises(umov.UsageError, match="has no time zone"):
            umov.Scenario(scenario, {"time.epochs": epochs})
    with pytest.raises(umov.UsageError, match="step_s is .*a plain number"):
        umov.Scenario(scenario, {"time.step_s": np.timedelta64(2, "s")})


@pytest.mark.parametrize("sunlit", (None, 1, "no"))
def test_sunlit_is_true_or_false(sunlit, hst):
    with pytest.raises(umov.UsageError, match="sunlit is .*; True or False"):
        hst.light_curve("maui", MINE, sunlit=sunlit, **BANDS)
