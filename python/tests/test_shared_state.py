"""What is handed in and out is nobody else's: who changes a list or a table of it changes nothing here."""
import copy
import pickle

import numpy as np
import pytest
import umov

from conftest import DATA, EXAMPLES


def test_bands_of_a_curve_are_a_copy():
    curve = umov.run(EXAMPLES / "agena_maui.toml", set={"time.step_s": 60})
    shape, names = curve.I.shape, curve.bands
    curve.bands.append("x")
    curve.object(curve.objects[0]).bands.clear()
    assert curve.I.shape == shape and curve.bands == names and pickle.loads(pickle.dumps(curve)).bands == names


def _tables():
    return {"mesh": {"file": "a.obj", "unit": "m", "up": "+Z"}, "orbit": {"file": "a.tle", "norad": 5},
            "attitude": {"mode": "spin", "axis": [0.0, 0.0, 1.0], "period_s": 20.0},
            "materials": {"default": "gold", "wing": {"front": "paper_al", "back": "gold"}},
            "part": [{"groups": ["wing"], "axis": [0.0, 1.0, 0.0]}], "name": "x"}


def _spoilt(table):
    table["mesh"]["unit"] = "ft"
    table["orbit"]["norad"] = 7
    table["attitude"]["axis"][2] = -1.0
    table["materials"]["default"] = "paint_white"
    table["materials"]["wing"]["back"] = "paint_white"
    table["part"][0]["groups"].append("x")
    table["part"][0]["axis"][1] = -1.0


@pytest.mark.parametrize("whose", ["given", "arguments", "to_dict", "to_scenario_dict"])
def test_tables_of_a_satellite_are_copies(whose):
    tables = _tables()
    made = umov.Satellite.from_dict(tables) if whose != "arguments" else umov.Satellite(
        tables["mesh"], orbit=tables["orbit"], attitude=tables["attitude"], materials=tables["materials"], parts=tables["part"], name="x")
    same, text, key = copy.deepcopy(made), made.to_toml(), hash(made)
    _spoilt({"to_dict": made.to_dict, "to_scenario_dict": lambda: made.to_scenario_dict()["object"][0]}.get(whose, lambda: tables)())
    assert made.to_toml() == text and made == same and hash(made) == key


def test_an_array_in_a_table_is_copied():
    axis = np.array([0.0, 0.0, 1.0])
    made = umov.Satellite(DATA / "mesh/hst.obj", unit="m", up="+Z", materials="gold", attitude={"mode": "spin", "axis": axis, "period_s": 20})
    text = made.to_toml()
    axis[:] = 1
    assert made.to_toml() == text


def test_names_of_bands_are_copies():
    names = ["nm:550", "nm:650"]
    bands = umov.Bands(names)
    key = hash(bands)
    names.append("x")
    bands.set.append("x")
    bands.to_dict()["set"].append("x")
    assert bands == umov.Bands(["nm:550", "nm:650"]) and hash(bands) == key
