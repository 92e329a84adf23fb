"""Tables of jobs: equal to what they were pickled from, short to look at, whole when they are written."""
import copy
import io
import pickle
import re

import astropy.table
import numpy as np
import pandas as pd
import pytest
from astropy import units as u
from astropy.io import ascii
from astropy.table import QTable, Table
from astropy.time import Time

import umov
from conftest import DATA, EXAMPLES

SPAN = ("maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z")


@pytest.fixture(scope="module")
def curve():
    return umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60})


@pytest.fixture(scope="module")
def passes():
    return umov.passes(DATA / "tle/hst.tle", *SPAN)


def test_what_was_pickled_is_equal(curve):
    for one in (curve, curve.table, curve.passes, curve.object("HST")):
        for same in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
            assert same == one and hash(same) == hash(one) and not same != one
    other = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60, "seed": 1})
    assert curve != other and curve != curve.table and curve.table != 5 and curve != curve.object("HST")
    assert curve.table != curve.passes
    assert umov.materials() == umov.materials()
    table = umov.Table(umov._umov.Table())
    gaps = [umov.tables._unpack([("x", "", "", np.array([1, np.nan]), ("", 0, 0))], []) for _ in range(2)]
    assert umov.Table(gaps[0]) == umov.Table(gaps[1]) != table  # NaN is as NaN


def test_a_table_is_shown_with_few_digits_and_written_with_all(passes, tmp_path):
    assert isinstance(passes, QTable)
    shown = str(passes["rise_az", "culmination_alt"])
    assert "234.4365" in shown and "234.43649" not in shown
    for path, read in (("a.ecsv", QTable.read), ("a.fits", QTable.read), ("a.csv", lambda p: Table.read(p, format="ascii.csv"))):
        passes.write(tmp_path / path)
        assert np.array_equal(np.asarray(read(tmp_path / path)["rise_az"]), passes["rise_az"].value), path
    assert all(passes[name].info.format is None for name in passes.colnames)
    text = io.StringIO()
    ascii.write(passes, text, format="ecsv")
    plain = astropy.table.QTable(passes)
    plain.write(tmp_path / "plain.ecsv")
    for all_digits in (text.getvalue(), (tmp_path / "plain.ecsv").read_text()):
        assert np.array_equal(QTable.read(all_digits, format="ascii.ecsv")["rise_az"].value, passes["rise_az"].value)
    passes.write.list_formats(io.StringIO())
    own = passes.copy()
    own["rise_az"].info.format = ".1f"
    assert "234.4 " in f"{own['rise_az', 'culmination_alt']} " and own["rise_az"].info.format == ".1f"
    own.write(tmp_path / "own.csv")
    assert "234.4," in (tmp_path / "own.csv").read_text()  # a format of one's own is one's own
    assert pickle.loads(pickle.dumps(passes))["rise_az"].value.tolist() == passes["rise_az"].value.tolist()
    for part in (passes[:1], passes["name", "rise_az"], passes[passes["rise_az"].value > 0]):
        part.write(tmp_path / "part.ecsv", overwrite=True)
        assert QTable.read(tmp_path / "part.ecsv")["rise_az"][0] == part["rise_az"][0]
    assert len(str(passes[0]).splitlines()[-1]) < 560


@pytest.mark.filterwarnings("ignore::astropy.io.votable.exceptions.W50")  # mag(AB) is no unit of VOTables
def test_tables_are_written_as_votables(curve, tmp_path):
    """Integers are numpy's own int64: astropy's writer of VOTables asks for the letter of a type."""
    table = curve.to_table()
    integers = [name for name in table.colnames if table[name].dtype == np.int64]
    assert integers
    table.write(tmp_path / "x.vot", format="votable")
    back = Table.read(tmp_path / "x.vot")
    for name in integers:
        assert (back[name] == table[name]).all()


def test_days_keep_their_digits_on_sight(curve):
    """A millisecond is 1e-8 d."""
    table = curve.to_qtable()["mjd_utc", "mag"]
    shown = f"{table['mjd_utc'][0].value:.8f}"
    assert shown in table[:1].pformat()[-1] and f"{shown}0" not in str(table[:1]) and len(shown) == 14
    for text in (repr(table), table._repr_html_(), str(table[0])):
        assert re.search(rf"(?<![0-9]){re.escape(shown)}(?![0-9])", text)


def test_a_format_of_ones_own_takes_no_digits_off_an_answer():
    """What a notebook shows with one digit was searched with one digit."""
    t = np.arange(0, 120, 0.5)
    columns = {"time_utc": [f"{one}Z" for one in (Time("2018-01-21T05:00:00") + t * u.s).isot], "mag": 7 + 0.01 * np.sin(2 * np.pi * t / 8.2)}
    plain, shown = Table(columns), Table(columns)
    shown["mag"].info.format = ".1f"
    assert umov.period(shown)["period"].tolist() == umov.period(plain)["period"].tolist()
    assert shown["mag"].info.format == ".1f"


def test_curves_of_files_of_one_name_are_two_bands(tmp_path):
    for folder, nm in (("b1", 500), ("b2", 600)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "my.dat").write_text("".join(f"{nm + dx} {y}\n" for dx, y in ((-20, 0), (0, 1), (20, 0))))
    names = [{"file": str(tmp_path / folder / "my.dat"), "unit": "nm", "detector": "photon"} for folder in ("b1", "b2")]
    scenario = umov.Scenario(EXAMPLES / "agena_maui.toml", set={"bands.set": names, "time.step_s": 60})
    assert scenario.bands == ["file:b1/my.dat", "file:b2/my.dat"]
    found = umov.run(scenario)
    assert found["lambda_eff"][0].round().tolist() == pytest.approx([500, 600], abs=3) and found.bands == scenario.bands
    assert umov.Scenario(EXAMPLES / "agena_maui.toml", set={"bands.set": names[:1]}).bands == ["file:my.dat"]
    with pytest.raises(umov.InputError, match="stands twice"):
        umov.Scenario(EXAMPLES / "agena_maui.toml", set={"bands.set": [names[0], names[0]]})


def test_flux_tables_of_pandas():
    times = pd.date_range("2018-01-21T05:09:00", periods=4, freq="20s", tz="UTC")
    frame = pd.DataFrame({"time": times, "flux": [1.0, 1.2, np.nan, 1.1], "flux_err": 0.1})
    with pytest.warns(umov.UmovWarning, match="1 of 4 rows"):
        found = umov.flux_table(frame, "nm:550")
    assert found["time_utc"].tolist() == [f"2018-01-21T05:09:{s}.000000Z" for s in ("00", "20")] + ["2018-01-21T05:10:00.000000Z"]
    assert found["flux"].tolist() == [1.0, 1.2, 1.1]
    for form in (frame.set_index("time"), frame.assign(time=frame["time"].astype(object)), dict(frame), frame.assign(time=[one.isoformat() for one in times])):
        with pytest.warns(umov.UmovWarning):
            again = umov.flux_table(form, "nm:550")
        assert again["time_utc"].tolist() == found["time_utc"].tolist()
    for wrong, told in ((frame.assign(time=times.tz_localize(None)), "no time zone"), (frame.assign(time=np.arange(4.0)), "numbers without a scale"),
                        (frame.drop(columns="flux"), "no column 'flux'")):
        with pytest.raises(umov.Error, match=told):
            umov.flux_table(wrong, "nm:550")


def test_candidates_may_be_materials(curve):
    """One of one's own, made of the library's table under another name, is what that is."""
    mine = umov.Material.from_dict("mine", umov.Material("paint_white").to_dict())
    asked = {"group": "array_front", "set": {"time.step_s": 60}}
    by_name, by_object = (umov.invert_material(curve, EXAMPLES / "hst_maui.toml", candidates=["cell_silicon", one], **asked).tables["materials"]
                          for one in ("paint_white", mine))
    assert by_object["material"].tolist() == [one.replace("paint_white", "mine") for one in by_name["material"].tolist()]
    assert umov.invert_material(curve, EXAMPLES / "hst_maui.toml", candidates=[umov.Material("cell_silicon"), umov.Material("paint_white")], **asked) \
        .tables["materials"]["material"].tolist() == by_name["material"].tolist()
    health = umov.invert_health(curve, EXAMPLES / "hst_maui.toml", drift={"array_front": mine}, set={"time.step_s": 60})
    assert str(health.tables["health"]["parameter"][0]) == "array_front=mine"
    other = umov.Material.from_dict("mine", umov.Material("gold").to_dict())
    with pytest.raises(umov.UsageError, match="another material of the name mine"):
        umov.invert_material(curve, EXAMPLES / "hst_maui.toml", candidates=["gold", mine], group="array_front", set={"material.mine": other.to_dict()})
    for wrong in ("gold", mine, [], [5]):
        with pytest.raises(umov.UsageError, match="candidates"):
            umov.invert_material(curve, EXAMPLES / "hst_maui.toml", group="array_front", candidates=wrong)


def test_materials_of_one_name_are_refused_and_any_name_is_taken(curve):
    def paint(n, name):
        return umov.Material.from_dict(name, {"index": {"n": n, "k": 0.0}, "distribution": {"model": "ggx", "alpha": 0.3}})

    def asked(*candidates):
        return umov.invert_material(curve, EXAMPLES / "hst_maui.toml", group="array_front", candidates=candidates, cache=False)

    with pytest.raises(umov.UsageError, match="two different materials of the name mine"):
        asked(paint(1.5, "mine"), paint(2.5, "mine"))
    with pytest.raises(umov.UsageError, match="the library has another material of the name gold"):
        asked(paint(1.5, "gold"), "cell_silicon")
    dotted, plain = (asked(paint(1.5, name), "cell_silicon").tables["materials"] for name in ("a.b", "ab"))
    assert dotted["material"].tolist() == [one.replace("ab", "a.b") for one in plain["material"].tolist()]
