"""Names of files that are odd, or that nobody gave."""
import os
import pathlib

import pytest
import umov

from conftest import DATA, EXAMPLES

START, STOP = "2018-01-21T05:10:00Z", "2018-01-21T05:11:00Z"


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


@pytest.mark.filterwarnings("ignore::umov.UmovWarning")
def test_messages_name_no_file_that_nobody_made():
    with pytest.raises(umov.Error) as caught:
        umov.Engine(umov.Satellite(mesh=([[0, 0, 0]] * 3, [[0, 1, 2]]), materials="paper_al"))
    assert "umov-" not in str(caught.value) and "mesh of arrays" in str(caught.value)


def test_a_text_of_toml_does_not_end_at_its_character_0():
    text = umov.Scenario(EXAMPLES / "agena_maui.toml").to_toml()
    with pytest.raises(umov.InputError, match=r"character 0 \(.u0000\)"):
        umov.Scenario.from_toml(text.replace("agena.obj", "agena.obj\\u0000x"))
