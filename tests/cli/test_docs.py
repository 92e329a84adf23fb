"""What the pages say holds: conventions name tests that exist, walks through umov can be walked."""
import re
import subprocess

import pytest

from conftest import ROOT, UMOV


def test_every_convention_names_a_test_that_exists():
    sources = "\n".join(path.read_text(encoding="utf-8") for folder in ("src", "tests/cli")
                        for path in (ROOT / folder).rglob("*test*") if path.suffix in (".cpp", ".py"))
    lines = [line for line in (ROOT / "docs/conventions.md").read_text().splitlines()
             if line.startswith("|") and not line.startswith(("| what", "|---"))]
    assert len(lines) > 30
    for line in lines:
        names = re.findall(r"`(\w+\.\w+|test_\w+)`", line.rsplit("|", 2)[1])
        assert names, f"no test named: {line}"
        for name in names:
            if name.startswith("test_"):
                assert f"def {name}(" in sources, name
            else:
                suite, case = name.split(".")
                assert re.search(rf"TEST(_F|_P)?\(\s*{suite},\s*{case}\)", sources), name


@pytest.mark.slow
def test_the_tour_of_the_readme(tmp_path):
    """Every line in its order, in a folder that looks like a clone after ./demo. What takes minutes does a part of its work."""
    tour = re.search(r"^## A tour\n.*?```\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL | re.MULTILINE).group(1)
    for whole, part in (("--poses 1000000", "--poses 3000"), ("umov bench ", "umov bench --only flat --seconds 0.05 --geometries 2 "),
                        ("umov paper ", "umov paper --only fig2 "), ("--frames 40", "--frames 2"),
                        ("observe_hst.toml ", "observe_hst.toml --set time.start=2018-01-21T05:10:00Z --set time.stop=2018-01-21T05:10:20Z ")):
        assert tour.count(whole) == 1, whole
        tour = tour.replace(whole, part)
    for name in ("data", ".deps", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    (tmp_path / "build/release/apps/cli").mkdir(parents=True)
    (tmp_path / "build/release/apps/cli/umov").symlink_to(UMOV)
    done = subprocess.run(["bash", "-c", f"set -e\n{tour}"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert re.fullmatch(r"Length = \d\d+ rows", done.stdout.splitlines()[-1].strip()), done.stdout  # astropy's table
    for made in ("out/agena_maui/report.html", "poses.fits", "hst.csv", "hst.json", "6u.obj", "hst.glb", "gallery.html", "pass.png",
                 "stokes.html", "exposure.html", "out/paper/index.html"):
        assert (tmp_path / made).stat().st_size > 0, made


def test_my_satellite_in_five_steps(tmp_path):
    """Every block of the page, in one shell, from a folder that looks like the project's."""
    blocks = re.findall(r"```sh\n(.*?)```", (ROOT / "docs/my_satellite.md").read_text(), re.DOTALL)
    assert len(blocks) == 5
    for name in ("data", ".deps"):
        (tmp_path / name).symlink_to(ROOT / name)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/umov").symlink_to(UMOV)
    script = 'set -e\nPATH="$PWD/bin:$PATH"\n' + "\n".join(blocks)
    done = subprocess.run(["bash", "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "warning" not in done.stderr and "mag" in done.stdout.splitlines()[-1], done.stdout
    assert (tmp_path / "out/mysat/light/lightcurve.csv").exists()


@pytest.mark.slow
def test_three_nights(tmp_path):
    """The recipes, one after the other, and what they say comes out."""
    blocks = re.findall(r"```sh\n(.*?)```", (ROOT / "docs/recipes.md").read_text(), re.DOTALL)
    assert len(blocks) == 3
    for name in ("data", ".deps", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/umov").symlink_to(UMOV)
    script = 'set -e\nPATH="$PWD/bin:$PATH"\n' + "\n".join(blocks)
    done = subprocess.run(["bash", "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    first = re.search(r"^\S+Z +nm:550 +\d+ +\S+ +1 +([0-9.]+)", done.stdout, re.MULTILINE)  # of umov period: rank 1
    assert first, done.stdout
    found = float(first.group(1))
    # A sine shows the period or its half; a pass turns the bisector by up to a few hundredths of a turn per turn.
    assert min(abs(found - 47), abs(found - 23.5) * 2) < 0.03 * 47, done.stdout
    assert (tmp_path / "out/geo/night/report.html").exists() and (tmp_path / "out/geo/sky.html").exists()
    assert len((tmp_path / "out/geo/night.csv").read_text().splitlines()) > 5


def test_why_the_polarization_was_wrong(tmp_path):
    """Every block of the page, and the figures that it names."""
    from astropy.table import Table
    import numpy
    blocks = re.findall(r"```sh\n(.*?)```", (ROOT / "docs/howto/wrong_polarization.md").read_text(), re.DOTALL)
    assert len(blocks) == 4
    (tmp_path / "data").symlink_to(ROOT / "data")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/umov").symlink_to(UMOV)
    script = 'set -e\nPATH="$PWD/bin:$PATH"\n' + "\n".join(blocks)
    done = subprocess.run(["bash", "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "while the analyser turns" in done.stderr and "misfit" in done.stderr

    def errors(name, counts):
        truth, out = Table.read(tmp_path / f"out/wheel/{counts}/truth.ecsv"), []
        for row in Table.read(tmp_path / f"out/wheel/{name}.ecsv"):
            if "incomplete" in str(row["flags"]) or "saturated" in str(row["flags"]):
                continue
            own = truth[(truth["band"] == row["band"])]
            if name != "series":
                own = own[own["set_id"] == row["set_id"]]
            light = own["I"] / sum(own["I"])
            out += [row["q"] - sum(own["q"] * light), row["u"] - sum(own["u"] * light)]
        return numpy.sqrt(numpy.mean(numpy.square(out)))

    wheel, series, mosaic = errors("static", "counts"), errors("series", "counts"), errors("mosaic", "mosaic")
    assert 0.12 < wheel < 0.25 and series < wheel / 5 and mosaic < wheel / 10


def test_links_of_the_pages_lead_somewhere():
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]
    for page in pages:
        if "site" in page.relative_to(ROOT).parts:  # stands beside the others in the site, where Sphinx looks after it
            continue
        for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text()):
            assert target.startswith("http") or (page.parent / target).exists(), f"{page}: {target}"


def test_the_page_of_keys_is_that_of_the_schema():
    made = subprocess.run(["python3", ROOT / "tools/doc_keys", UMOV], capture_output=True, text=True, check=True).stdout
    assert made == (ROOT / "docs/keys.md").read_text(), "run tools/doc_keys > docs/keys.md"


def test_inputs_of_the_fuzz_targets_name_no_folder_of_a_machine():
    inputs = [path for path in (ROOT / "tests/fuzz/corpus").rglob("*") if path.is_file()]
    assert len(inputs) > 500 and not [path for path in inputs if str(ROOT).encode() in path.read_bytes()]
