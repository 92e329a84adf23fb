"""Every public name has an example that runs; the types are right."""
import doctest
import importlib
import inspect
import subprocess
import sys

import pytest
import umov
from conftest import BUILD, DATA, EXAMPLES, ROOT

PUBLIC = sorted(name for name in umov.__all__ if callable(getattr(umov, name)))
MODULES = ["engines", "errors", "light_curves", "materials", "orbits", "plot", "runs", "satellites", "scenarios",
           "sites", "tables", "times"]


@pytest.mark.parametrize("name", PUBLIC)
def test_has_an_example(name):
    assert ">>>" in (inspect.getdoc(getattr(umov, name)) or ""), f"umov.{name} has no example"


@pytest.fixture(scope="module")
def names():
    hst = umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", orbit=DATA / "tle/hst.tle", norad=20580,
                         attitude={"mode": "nadir"}, materials={"default": "film_silvered"}, name="HST")
    return {"umov": umov, "plot": importlib.import_module("umov.plot"), "EXAMPLES": EXAMPLES, "DATA": DATA, "hst": hst,
            "engine": umov.Engine(hst, method="masks"),
            "curve": umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60})}


@pytest.mark.parametrize("module", ["__init__", *MODULES])
def test_examples_run(module, names, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = umov if module == "__init__" else importlib.import_module(f"umov.{module}")
    finder = doctest.DocTestFinder(exclude_empty=True)
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    for test in finder.find(found, globs=dict(names)):
        runner.run(test)
    assert runner.failures == 0
    importlib.import_module("matplotlib.pyplot").close("all")


def test_types():
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", "--cache-dir", BUILD / "mypy", "-p", "umov"],
                          cwd=BUILD / "python", capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def gallery():
    return sorted((ROOT / "python/gallery").glob("*.py"))


def test_types_of_the_gallery():
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", "--cache-dir", BUILD / "mypy",
                           *map(str, gallery())], cwd=BUILD / "python", capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("page", gallery(), ids=lambda path: path.stem)
def test_gallery(page, tmp_path):
    """A page runs as a script and makes the picture that it shows."""
    done = subprocess.run([sys.executable, page], cwd=tmp_path,
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert list(tmp_path.glob("*.png"))


def test_the_first_lines_of_the_readme_run(tmp_path):
    text = (ROOT / "README.md").read_text()
    code = text.split("```python\n", 1)[1].split("```", 1)[0]
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=300,
                          env={**__import__("os").environ, "MPLCONFIGDIR": str(tmp_path)})
    assert done.returncode == 0, done.stderr
    (ROOT / "hst.png").unlink(missing_ok=True)
