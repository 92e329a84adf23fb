"""Copies, pickles and forks, and files that were made of arrays and lines."""
import copy
import gc
import multiprocessing
import pickle

import numpy as np
import pytest
import umov
from astropy import units as u

from conftest import DATA, LINES

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


def test_a_shallow_copy_has_files_of_its_own():
    """The copy's names of files stood in the table of both, and went with the copy."""
    one = umov.Satellite(mesh=(TRIANGLE, [[0, 1, 2]]), materials="paper_al", orbit=LINES)
    two = copy.copy(one)
    assert one == two
    del two
    gc.collect()
    assert umov.mesh(one).vertices.shape == (3, 3) and umov.propagate(one, START).error.tolist() == [[0]]


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


@pytest.mark.parametrize("name", ["Satellite", "Engine", "Sums", "LightCurve", "Table", "Scenario", "Material", "Calibration", "Bands"])
def test_objects_that_were_never_made_say_so(name):
    kind = getattr(umov, name)
    dead = kind.__new__(kind)
    with pytest.raises(umov.UsageError, match=f"this {name} was never made"):
        repr(dead)
    assert not hasattr(dead, "__array__")
