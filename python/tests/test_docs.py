"""Every public name has an example that runs; the types are right."""
import doctest
import importlib
import inspect
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
import stage  # noqa: E402

PUBLIC = sorted(name for name in umov.__all__ if callable(getattr(umov, name)))
MODULES = ["engines", "errors", "light_curves", "materials", "orbits", "plot", "runs", "satellites", "scenarios",
           "sites", "tables", "times", "abundances", "pictures", "turnable", "observing", "passbands", "samples", "periods", "inversions", "tracking", "libraries",
           "measurements", "scale", "rows", "flux_tables", "_turns", "_clouds", "_axes"]


SCALE = importlib.import_module("umov.scale")


@pytest.mark.parametrize("name", [*PUBLIC, *(f"scale.{name}" for name in SCALE.__all__)])
def test_has_an_example(name):
    one = getattr(SCALE, name.removeprefix("scale.")) if "." in name else getattr(umov, name)
    assert ">>>" in (inspect.getdoc(one) or ""), f"umov.{name} has no example"


#: Made by calls, not by users: their class says which.
MADE_BY_CALLS = {"Abundances", "LightCurve", "Picture", "Plan", "Table"}


def callables():
    """Every public function, and every public method and constructor of every public class, by its name."""
    for module in (umov, importlib.import_module("umov.plot"), importlib.import_module("umov.turnable"),
                   importlib.import_module("umov.scale")):
        for name in module.__all__:
            one = getattr(module, name)
            if inspect.isfunction(one):
                yield f"{module.__name__}.{name}", inspect.signature(one), one
            elif inspect.isclass(one):
                if "__init__" in vars(one) and name not in MADE_BY_CALLS:
                    yield name, inspect.signature(one.__init__), one
                for key, method in vars(one).items():
                    found = getattr(method, "__func__", method)
                    if inspect.isfunction(found) and not key.startswith("_"):
                        yield f"{name}.{key}", inspect.signature(found), found


@pytest.mark.parametrize(("name", "signature", "documented"), [pytest.param(*one, id=one[0]) for one in callables()])
def test_every_argument_is_told_of(name, signature, documented):
    """The section Parameters has the arguments, all of them and no others, in their order and with words."""
    text = inspect.cleandoc(documented.__doc__ or "")
    assert text, f"{name} has no docstring"
    _, _, section = text.partition("Parameters\n----------\n")
    told = re.findall(r"^\**(\w+)\n    \S", section.partition("\n\n")[0], re.MULTILINE)
    assert told == [argument for argument in signature.parameters if argument not in ("self", "cls")], name


def test_every_attribute_is_told_of():
    """Properties by a docstring; fields of tuples and attributes of objects by a comment, which the site shows."""
    silent = []
    for name in umov.__all__:
        one = getattr(umov, name)
        if not inspect.isclass(one):
            continue
        for key, value in vars(one).items():
            if isinstance(value, property) and not key.startswith("_") and not hasattr(one, "_fields") and not value.__doc__:
                silent.append(f"{name}.{key}")
        for field in getattr(one, "_fields", ()):
            if not re.search(rf"^    {field}: .*#: \S", inspect.getsource(one), re.MULTILINE):
                silent.append(f"{name}.{field}")
    assert not silent


def test_every_name_is_on_a_page_of_the_site():
    pages = "".join(path.read_text() for path in (ROOT / "docs/site/api").glob("*.md"))
    errors = umov.errors.__all__  # one page has them all
    missing = [name for name in PUBLIC if name not in errors and not re.search(rf"auto\w+:: umov\.{name}(\(\))?\n", pages)]
    assert not missing and all(name in pages for name in errors)


@pytest.fixture(scope="module")
def names():
    hst = umov.Satellite(mesh=DATA / "mesh/hst.obj", unit="m", up="+Z", orbit=DATA / "tle/hst.tle", norad=20580,
                         attitude={"mode": "nadir"}, materials={"default": "film_silvered"}, name="HST")
    return {"umov": umov, "plot": importlib.import_module("umov.plot"),
            "turnable": importlib.import_module("umov.turnable"), "EXAMPLES": EXAMPLES, "DATA": DATA, "hst": hst,
            "engine": umov.Engine(hst, method="masks"),
            "curve": umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 30})}


@pytest.mark.parametrize("module", ["__init__", *(pytest.param(one, marks=pytest.mark.slow) if one in ("inversions", "tracking") else one for one in MODULES)])
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


def test_types_of_the_gallery():
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", "--cache-dir", BUILD / "mypy",
                           *map(str, pages.pages())], cwd=BUILD / "python", capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_pyright_takes_the_gallery():
    """basedpyright is pyright with its program inside the wheel: nothing is fetched."""
    done = subprocess.run([sys.executable, "-m", "basedpyright"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("name", ["start", *(
    pytest.param(f"howto/{stem}", marks=[pytest.mark.slow] if stem in ("identify", "plan") else [])
    for stem in sorted(path.stem for path in (ROOT / "docs/howto").glob("*.md") if "```python" in path.read_text()))])
def test_lines_of_the_pages_run(name, tmp_path):
    """Blocks of Python of a page, one after the other, in a folder that looks like the project's."""
    for folder in ("data", "examples"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / f"docs/{name}.md").read_text(), re.DOTALL)
    assert blocks
    done = subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=tmp_path, capture_output=True, text=True,
                          timeout=300)
    assert done.returncode == 0, done.stderr


def test_help_is_folded_below_its_meaning():
    told = "Which object\n  --none-prior FLOAT=0.05     " + "word " * 30 + "\n" + " " * 30 + "other " * 20
    lines = stage.wrapped(told).splitlines()
    assert " ".join(lines).split() == told.split()
    assert max(map(len, lines)) <= 88 and len(lines) > 4
    assert all(line.startswith(" " * 30) and line[30] != " " for line in lines[2:])


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
