"""One message with place, finding, expectation and remedy; the right code; no half-written output."""
import pytest

from conftest import ROOT

CONFIGURATION = [
    # replacement, words of the message
    (("[bands]\nset", "[bands]\nsett"), ["scenario.toml:20:1", "sett", "set"]),
    (("seed = 1", "sed = 1"), ["scenario.toml:2:1", '"sed"', '"seed"']),
    (("lat_deg = 20.7083", "lat_deg = 120.7"), ["lat_deg", "90"]),
    (("lat_deg = 20.7083", 'lat_deg = "north"'), ["scenario.toml:4", "lat_deg", "number"]),
    (("lat_deg = 20.7083", "lat_deg = nan"), ["lat_deg"]),
    (("start = 2018-01-21T05:08:00Z", "start = 2018-01-21T05:08:00"), ["start", "Z"]),
    (("stop = 2018-01-21T05:12:00Z", "stop = 2018-01-20T05:12:00Z"), ["stop", "before"]),
    (("step_s = 20", "step_s = 0"), ["step_s", "positive"]),
    (("seed = 1", "seed = 1\nseed = 2"), ["scenario.toml:3"]),
    (('default = "paper_al"', 'default = "paper_all"'), ["paper_all", "paper_al"]),
    (('default = "paper_al"', 'front = "paper_al"'), ["front", "cube"]),
    (('set = "paper_rgb"', 'set = ["nm:800"]'), ["800", "425"]),
    (('set = "paper_rgb"', 'set = ["Bessell.V"]'), ["Bessell.V", "nm:"]),
    (('unit = "m", ', ""), ["no unit", "unit ="]),
    (('up = "+Z", ', ""), ["up"]),
    (("norad = 20580", "norad = 99"), ["99", "20580"]),
    (('mode = "nadir"', 'mode = "nadirr"'), ["nadirr", "nadir"]),
    (('mode = "nadir"', 'mode = "tumble"'), ["tumble", "not built yet"]),
    (('dir = "out"', 'dir = "out"\npol_frame = "galactic"'), ["galactic", "equatorial"]),
    (("seed = 1", "seed = 1\n[render]\nbounces = 2"), ["bounces", "not built yet"]),
    (("cube.obj", "missing.obj"), ["missing.obj", "no such file"]),
    (("2018-01-21T05:08:00Z", "2018-04-21T05:08:00Z"), ["stop"]),
]


@pytest.mark.parametrize("replacement, words", CONFIGURATION)
def test_configuration(umov, scenario, tmp_path, replacement, words):
    done = umov("run", scenario(replacement))
    assert done.code == 3, done.err
    assert done.err.count("error:") == 1, done.err
    for word in words:
        assert word in done.err, f"{word!r} not in: {done.err}"
    assert not (tmp_path / "out").exists()


def test_old_elements_are_refused_and_can_be_allowed(umov, scenario):
    late = [("2018-01-21T05:08:00Z", "2018-04-21T00:00:00Z"),
            ("2018-01-21T05:12:00Z", "2018-04-21T00:10:00Z")]
    done = umov("run", scenario(*late))
    assert done.code == 3 and "--allow-old-elements" in done.err, done.err


LINES = [
    # edit of the two lines of HST's set; place and words of the message
    (lambda a, b: (a, b[:68] + str((int(b[68]) + 1) % 10)), ":2:69", ["checksum", "--allow-bad-checksum"]),
    (lambda a, b: (a, b[:60]), ":2", ["60"]),
    (lambda a, b: (b, a), ":1", []),
    (lambda a, b: (a, b.replace("20580", "20581", 1)[:68] + str((int(b[68]) + 1) % 10)), ":2",
     ["20581", "20580"]),
    (lambda a, b: (a.replace(" ", "\u00a0", 1), b), ":1", ["space"]),
    (lambda a, b: ("", ""), "", []),
]


@pytest.mark.parametrize("edit, place, words", LINES)
def test_element_lines(umov, tmp_path, edit, place, words):
    first, second = (ROOT / "data/tle/hst.tle").read_text().splitlines()[-2:]
    (tmp_path / "bad.tle").write_text("\n".join(edit(first, second)) + "\n")
    done = umov("orbit", "propagate", "--orbit", "bad.tle", "--at", "2018-01-21T00:00:00Z",
                "-o", "out.csv")
    assert done.code == 3, done.err
    assert f"bad.tle{place}" in done.err, done.err
    for word in words:
        assert word in done.err, done.err
    assert not (tmp_path / "out.csv").exists()


def test_unmapped_mesh_material_is_named_with_its_area(umov, scenario):
    done = umov("run", scenario(('default = "paper_al"', "")))
    assert done.code == 3
    for word in ('"cube"', "faces", "m2", "default", "umov material list"):
        assert word in done.err, done.err


@pytest.mark.parametrize("line, words", [
    ("v 1 2 nan", ["broken.obj:1:7", "nan"]),
    ("v 1,5 2 3", ["broken.obj:1:3", "1,5"]),
    ("v 0 0 0\nf 1 2 3", ["broken.obj:2", "1 vert"]),
    ("# nothing", ["broken.obj", "face"]),
])
def test_mesh_lines(umov, scenario, tmp_path, line, words):
    (tmp_path / "broken.obj").write_text(line + "\n")
    done = umov("run", scenario(("cube.obj", "broken.obj")))
    assert done.code == 3
    for word in words:
        assert word in done.err, done.err


def test_usage_errors_name_the_nearest_option(umov):
    done = umov("orbit", "propagate", "--orbit", "x", "--att", "2018-01-21T00:00:00Z")
    assert done.code == 2
    done = umov("brdf", "paper_au", "--wavelenght", "550")
    assert done.code == 2 and "--wavelength" in done.err, done.err
    assert umov("run", "a.toml", "--threads", "-1").code == 2
    assert umov("frobnicate").code == 2


def test_missing_input_and_unwritable_output(umov, tmp_path):
    assert umov("run", "nothing.toml").code == 3
    (tmp_path / "folder").mkdir()
    done = umov("mesh", "make", "sphere", "-o", "no/such/folder/a.obj")
    assert done.code == 6, done.err
