"""The installed library as another project meets it: found, built against without a warning, run."""
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"
STRICT = "-Wall -Wextra -Wpedantic -Werror"


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, timeout=600,
                          **options)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="session")
def prefix(tmp_path_factory):
    place = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", BUILD, "--prefix", place)
    return place


@pytest.fixture(scope="session")
def examples(prefix, tmp_path_factory):
    """The installed examples, built from their own folder with find_package(umov)."""
    build = tmp_path_factory.mktemp("examples")
    run("cmake", "-G", "Ninja", "-S", prefix / "share/doc/umov/examples/cpp", "-B", build,
        f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_CXX_FLAGS={STRICT}")
    run("cmake", "--build", build)
    return build


@pytest.mark.slow
def test_one_stokes_vector(examples):
    # The cross-section of a metal cube of 1 m is of the order of its face: between 1e-3 and 1 m2/sr.
    words = run(examples / "one_stokes_vector").split()
    assert words[0] == "I" and 1e-4 < float(words[1]) < 10


def test_light_curve(examples, prefix):
    rows = run(examples / "light_curve", prefix / "share/doc/umov/examples/hst_maui.toml",
               "time.step_s=120").splitlines()
    assert rows and all(" mag, p " in row for row in rows)


def test_passes(examples, prefix):
    rows = run(examples / "passes", prefix / "share/doc/umov/data/tle/hst.tle",
               "20.7083,-156.2578,3058").splitlines()
    assert rows and all(row.startswith("20") for row in rows)


def test_own_material(examples):
    # Reflected light is s-polarized near Brewster's angle: +Q_scat.
    rows = run(examples / "own_material").splitlines()
    assert len(rows) == 6
    assert float(rows[2].split()[-1]) > 0.5


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
@pytest.mark.parametrize("standard", ["c++20", pytest.param("c++23", marks=pytest.mark.slow)])
def test_programs_are_clean(prefix, compiler, standard):
    assert shutil.which(compiler), f"{compiler} is missing: tools/setup installs it"
    # clang 14 is told of C++23 by its working title.
    name = {"c++23": "c++2b"}.get(standard, standard) if compiler == "clang++" else standard
    for source in ("one_stokes_vector", "light_curve"):
        path = prefix / f"share/doc/umov/examples/cpp/{source}.cpp"
        assert len(path.read_text(encoding="utf-8").splitlines()) <= 30
        run(compiler, f"-std={name}", *STRICT.split(), f"-I{prefix}/include", "-fsyntax-only", path)


def test_pkg_config(prefix, tmp_path):
    environment = dict(os.environ, PKG_CONFIG_PATH=str(prefix / "lib/pkgconfig"))
    flags = run("pkg-config", "--cflags", "--libs", "umov", env=environment).split()
    program = tmp_path / "passes"
    run("g++", ROOT / "examples/cpp/passes.cpp", *STRICT.split(), "-o", program, *flags)
    assert run(program, ROOT / "data/tle/hst.tle", "20.7083,-156.2578,3058")


def test_documents(prefix):
    for name in ("share/doc/umov/LICENSE", "share/man/man1/umov.1", "share/doc/umov/conventions.md"):
        assert (prefix / name).stat().st_size > 0
    assert "umov signature" in (prefix / "share/man/man1/umov.1").read_text(encoding="utf-8")
    assert not list((prefix / "include").rglob("paper.h"))
