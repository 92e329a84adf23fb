"""Every public name has an example that runs; the types are right."""
import doctest
import importlib
import inspect
import json
import re
import subprocess
import sys
import xml.etree.ElementTree as tree

import pytest
import umov
from conftest import BUILD, DATA, EXAMPLES, ROOT

sys.path.insert(0, str(ROOT / "tools/site"))
import equations  # noqa: E402
import gallery as pages  # noqa: E402

PUBLIC = sorted(name for name in umov.__all__ if callable(getattr(umov, name)))
MODULES = ["engines", "errors", "light_curves", "materials", "orbits", "plot", "runs", "satellites", "scenarios",
           "sites", "tables", "times", "abundances", "pictures", "turnable"]


@pytest.mark.parametrize("name", PUBLIC)
def test_has_an_example(name):
    assert ">>>" in (inspect.getdoc(getattr(umov, name)) or ""), f"umov.{name} has no example"


@pytest.fixture(scope="module")
def names():
    hst = umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", orbit=DATA / "tle/hst.tle", norad=20580,
                         attitude={"mode": "nadir"}, materials={"default": "film_silvered"}, name="HST")
    return {"umov": umov, "plot": importlib.import_module("umov.plot"),
            "turnable": importlib.import_module("umov.turnable"), "EXAMPLES": EXAMPLES, "DATA": DATA, "hst": hst,
            "engine": umov.Engine(hst, method="masks"),
            "curve": umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 30})}


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
    return pages.pages()


def test_types_of_the_gallery():
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", "--cache-dir", BUILD / "mypy",
                           *map(str, gallery())], cwd=BUILD / "python", capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_pyright_takes_the_gallery():
    """basedpyright is pyright with its program inside the wheel: nothing is fetched."""
    done = subprocess.run([sys.executable, "-m", "basedpyright"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("page", gallery(), ids=lambda path: path.stem)
def test_gallery(page):
    """A page runs and makes the picture that it shows; what it gave is what the site shows, and a notebook."""
    told = pages.run(page)
    assert told["pictures"]
    made = json.loads(pages.notebook(told))
    assert made["cells"][0]["source"].startswith("# ")
    shown = [output for cell in made["cells"] for output in cell.get("outputs", ())]
    assert any("image/png" in output.get("data", {}) for output in shown)


@pytest.mark.parametrize("name", ["start", *sorted(f"howto/{path.stem}" for path in (ROOT / "docs/howto").glob("*.md"))])
def test_lines_of_the_pages_run(name, tmp_path):
    """Blocks of Python of a page, one after the other, in a folder that looks like the project's."""
    for folder in ("data", "examples"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / f"docs/{name}.md").read_text(), re.DOTALL)
    assert blocks
    done = subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=tmp_path, capture_output=True, text=True,
                          timeout=300)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("text", "expected"), [
    # Set by hand from the MathML of W3C's specification, chapter 3: scripts, roots, fences.
    ("a^2", "<msup><mrow><mi>a</mi></mrow><mrow><mn>2</mn></mrow></msup>"),
    ("E_sun", "<msub><mrow><mi>E</mi></mrow><mrow><mi>sun</mi></mrow></msub>"),
    ("sqrt(theta)", "<msqrt><mi>θ</mi></msqrt>"),
    ("<n.h>", "<mo stretchy='false'>⟨</mo><mi>n</mi><mo>·</mo><mi>h</mi><mo stretchy='false'>⟩</mo>"),
    ("a x b", "<mi>a</mi><mo>×</mo><mi>b</mi>"),
    ("x = -1", "<mi>x</mi><mo>=</mo><mo form='prefix' lspace='0' rspace='0'>−</mo><mn>1</mn>"),
])
def test_equations_are_set(text, expected):
    assert equations.mathml(text) == f"<math display='inline'><mrow>{expected}</mrow></math>"


def test_every_equation_of_the_pages_is_whole():
    """MathML that a parser takes, with the letters of the source in their order."""
    count = 0
    for page in (ROOT / "docs").rglob("*.md"):
        for block in re.findall(r"^<div class='equation'>.*$", equations.with_equations(page.read_text()), re.MULTILINE):
            tree.fromstring(block.replace("&nbsp;", " ").replace("&#x2061;", ""))
            count += 1
    assert count > 80


def test_the_first_lines_of_the_readme_run(tmp_path):
    text = (ROOT / "README.md").read_text()
    code = text.split("```python\n", 1)[1].split("```", 1)[0]
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=300,
                          env={**__import__("os").environ, "MPLCONFIGDIR": str(tmp_path)})
    assert done.returncode == 0, done.stderr
    (ROOT / "hst.png").unlink(missing_ok=True)
