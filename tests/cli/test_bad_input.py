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
    (("seed = 1", "seed = 1\nseed = 2"), ["scenario.toml:3", "keep one"]),
    (('default = "paper_al"', 'default = "paper_all"'), ["paper_all", "paper_al"]),
    (('default = "paper_al"', 'front = "paper_al"'), ["front", "cube"]),
    (('default = "paper_al"', "default = 4"), ["scenario.toml:18:11: default is a number, 4; ", "in quotes"]),
    (("[output]", "[material]\nmine = 4\n[output]"), ["material.mine is a number, 4; a table [material.mine] was"]),
    (("[output]", '[material.mine]\nindex = "SiO2"\nlayers = [4]\n[output]'), ["layers holds a number, 4; tables such as"]),
    (('mode = "nadir"', 'mode = "pieces", pieces = [true]'), ["pieces holds true or false; tables such as"]),
    (("[output]", '[material.mine]\nindex = { n = 1.5, k = [0, "a"] }\n[output]'), ['k holds a string, "a"; a finite number or a list']),
    (('set = "paper_rgb"', "set = [true]"), ["scenario.toml:20:1: set holds true or false; a name"]),
    (('formats = ["ecsv", "csv", "html"]', 'formats = ["csv", 3]'), ["formats holds a number, 3; a string or"]),
    (('set = "paper_rgb"', 'set = ["nm:800"]'), ["800", "425"]),
    (('set = "paper_rgb"', 'set = ["Bessel.Q"]'), ["Bessel.Q", "nm:"]),
    (('unit = "m", ', ""), ["no unit", "unit =", "(named in scenario.toml:15:10)"]),
    (('unit = "m"', 'unit = "furlong"'), ['"furlong"', "m, cm, mm", "(named in scenario.toml:15:10)"]),
    (('up = "+Z", ', ""), ["up", "scenario.toml:15:10"]),
    (('up = "+Z"', 'up = "Z"'), ['"Z"', '"+X"', "scenario.toml:15:10"]),
    (('file = "cube.obj"', 'file = ""'), ["scenario.toml:15:10", 'file = ""', "the name of a mesh was expected"]),
    (("alt_m = 3058", 'alt_m = "3 km"'), ["scenario.toml:6:9", '"3 km"', "a number was expected"]),
    (("seed = 1", "seed = 1.5"), ["scenario.toml:2", "1.5", "whole number"]),
    (("[bands]", "[bands"), ["scenario.toml:19:7", "TOML"]),
    (("start = 2018-01-21T05:08:00Z", "start = 2016-12-31T23:59:60Z"), ["scenario.toml:8:", "in quotes"]),
    (('set = "paper_rgb"', 'set = ["file:nope.vot"]'), ["nope.vot: no such file", "(named in scenario.toml:20:1)"]),
    (("norad = 20580", "norad = 99"), ["99", "20580"]),
    (('mode = "nadir"', 'mode = "nadirr"'), ["nadirr", "nadir"]),
    (('mode = "nadir"', 'mode = "tumble"'), ["inertia", '"shell" or "solid"']),
    (('dir = "out"', 'dir = "out"\npol_frame = "galactic"'), ["galactic", "equatorial"]),
    (("seed = 1", "seed = 1\n[render]\nbounces = 65"), ["bounces = 65", "1 to 64"]),
    (("cube.obj", "missing.obj"), ["missing.obj", "no such file"]),
    (("2018-01-21T05:08:00Z", "2018-04-21T05:08:00Z"), ["stop"]),
    (("step_s = 20", "stepp = 20"), ['"step_s"']),
    (('formats = ["ecsv", "csv", "html"]', "formats = []"), ["scenario.toml:23:1", "empty"]),
    (('mode = "nadir"', 'mode = "nadir", point = "+X"'), ["point", 'mode = "nadir"']),
    (('mode = "nadir"', 'mode = "nadirr"'), ["; nadir, inertial, spin, tumble, aem or pieces was expected"]),
    (('mode = "nadir"', 'at = "nadir", toward = "zenith"'), ["one line at all times"]),
    (("seed = 1", 'seed = 1\n[material.paper_al]\nindex = "paper_au"\n'
      'distribution = { model = "blinn_phong", m = 10 }'), ["paper_al", "the paper's", "scenario.toml:3"]),
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
    ("v 0x1 2 3", ["broken.obj:1:3", "0x1", "-1.25", "export the mesh again"]),
    ("# nothing", ["broken.obj", "face"]),
    ("f 1 2 3", ["broken.obj:1", "no vertex precedes", "export the mesh again"]),
    ("v 0 0 0\nf 1/ 2 3", ['broken.obj:2:3: corner "1/"; v, v/t', "export the mesh again"]),
    ("v 0 0 0\nf /1 2 3", ["broken.obj:2:3", "export the mesh again"]),
    ("v 0 0 0\nf 1 2 3", ['broken.obj:2:5: vertex index "2"; 1 to 1', "1 vertex above", "export the mesh again"]),
    ("v 1e200 0 0", ["broken.obj:1:3", "1e+200"]),
    ("v 0 0 0\n\x01\x02 3", ["broken.obj:2", "no OBJ text"]),
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
    done = umov("brdf", "paper_au", "--batch", "t.csv", "--theta-i", "30")
    assert done.code == 2 and "--batch" in done.err, done.err
    assert "?." not in umov("run", "a.toml", "--accurac", "1").err


def test_missing_input_and_unwritable_output(umov, tmp_path):
    assert umov("run", "nothing.toml").code == 3
    (tmp_path / "folder").mkdir()
    done = umov("mesh", "make", "sphere", "-o", "no/such/folder/a.obj")
    assert done.code == 6 and "Make the folder first" in done.err, done.err


def test_an_impossible_folder_is_found_before_any_work(umov, scenario):
    # A folder below a file: no user, not even root, can make one.
    done = umov("run", scenario(), "--dry-run", "--set", "output.dir=scenario.toml/out")
    assert done.code == 6 and "scenario.toml cannot be written to" in done.err.replace(":", ""), done.err


@pytest.mark.parametrize("row, words", [
    ("0,0,0,1,0,0", ["g.csv:2", "sun_x", "0"]),
    ("1,0,x,1,0,0", ["g.csv:2:5", "sun_z"]),
    ("1,0,0,0,1,0,1e30", ["g.csv:2", "1e+30", "whole number"]),
])
def test_directions(umov, scenario, tmp_path, row, words):
    names = ["sun_x", "sun_y", "sun_z", "obs_x", "obs_y", "obs_z", "pose"][:row.count(",") + 1]
    (tmp_path / "g.csv").write_text(",".join(names) + "\n" + row + "\n")
    done = umov("signature", scenario(), "--geometry", "g.csv")
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err


def test_doubtful_meshes_are_told_of(umov, scenario, tmp_path):
    # A triangle whose vertex normals nearly lie in it, twice, and a word that OBJ does not know.
    (tmp_path / "odd.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 1 0 0.1\nfoo 1 2\nf 1//1 2//1 3//1\nf 1//1 2//1 3//1\n")
    done = umov("signature", scenario(("cube.obj", "odd.obj"), ('"flat"', '"smooth"')),
                "--poses", 1, "--phase", "30")
    assert done.code == 0, done.err
    for word in ('odd.obj:5:1: "foo" is no statement', "odd.obj: 1 triangle that repeats",
                 "odd.obj: 1 triangle has vertex normals more than 60 deg off"):
        assert word in done.err, done.err


@pytest.mark.parametrize("override", [
    "time.step_s=0", "time.stepp=1", "render.accuracy=9", "observer.lat_deg=north", "seed=-1",
    "time.only.alt_min_deg=99", "bands.set=x", "observer=3", "object.mesh.file=no.obj",
    "time.start=2018-01-21T05:00:00", "object.materials.default=paper_all", "tim.step_s=1", "object[3].name=x",
])
def test_errors_of_overrides_name_the_option(umov, scenario, override):
    done = umov("run", scenario(), "--set", override)
    assert done.code == 3, done.err
    assert "--set " + override.split("=")[0] in done.err, done.err


@pytest.mark.parametrize("verb", [["signature", "scenario.toml", "--poses", "2", "--phase", "50"],
                                  ["render", "scenario.toml", "-o", "x.png"],
                                  ["library", "build", "scenario.toml", "-o", "lib"]])
def test_a_mesh_without_unit_names_the_scenario(umov, scenario, tmp_path, verb):
    scenario(('unit = "m", ', ""))
    done = umov(*verb)
    assert done.code == 3 and "(named in scenario.toml:15:10)" in done.err, done.err
    assert not (tmp_path / "lib").exists() and not (tmp_path / "x.png").exists()


def test_a_folder_of_the_user_stays_when_a_library_is_refused(umov, scenario, tmp_path):
    (tmp_path / "lib").mkdir()
    assert umov("library", "build", scenario(('unit = "m", ', "")), "-o", "lib").code == 3
    assert (tmp_path / "lib").is_dir()


def test_faces_that_look_inward_are_told_of(umov, scenario, tmp_path):
    name = scenario()
    call = ("signature", name, "--poses", 1, "--phase", "30")
    assert "inward" not in umov(*call).err
    lines = (tmp_path / "cube.obj").read_text().splitlines()
    (tmp_path / "cube.obj").write_text("\n".join(
        "f " + " ".join(line.split()[:0:-1]) if line.startswith("f ") else line for line in lines) + "\n")
    done = umov(*call)
    assert done.code == 0 and "the faces of 1 closed part look inward" in done.err, done.err


@pytest.mark.parametrize("text, words", [
    ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n", ["a.off:6", "names vertex 9", "there are 3"]),
    ("OFF\n4000000000 1 0\n", ["a.off:2", "4000000000", "cannot hold"]),
    ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", ["a.off:", "face 1 of 1 is missing"]),
    ("OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ["a.off:3", "2 numbers", "3 were expected"]),
    ("hello\n", ["a.off:1", '"OFF"']),
])
def test_off_is_held_against_its_header(umov, tmp_path, text, words):
    """Assimp takes another vertex for one that is not there, without a word."""
    (tmp_path / "a.off").write_text(text)
    done = umov("mesh", "info", "a.off", "--unit", "m", "--up", "+Z")
    assert done.code == 3, done.out
    for word in words:
        assert word in done.err, done.err


@pytest.mark.parametrize("arguments, words", [
    (["orbit", "propagate", "--orbit", ROOT / "data/tle/hst.tle", "--at", "noon"], ['--at "noon"']),
    (["orbit", "ephemeris", "--orbit", ROOT / "data/tle/hst.tle", "--site", "maui", "--start", "noon", "--stop",
      "2018-01-22"], ['--start "noon"']),
    (["passes", "--orbit", ROOT / "data/tle/hst.tle", "--site", "maui", "--start", "2018-01-21", "--stop",
      "2018-01-21T05:00:00"], ["--stop", "no zone"]),
    (["run", "scenario.toml", "--dry-run", "--eop", "nope"], ["nope: no such file"]),
])
def test_what_an_option_names_is_not_laid_to_the_scenario(umov, scenario, arguments, words):
    scenario()
    done = umov(*arguments)
    assert done.code == 3, done.err
    assert "named in" not in done.err, done.err
    for word in words:
        assert word in done.err, done.err


@pytest.mark.parametrize("option, value", [("--shard", "3/2"), ("--range", "0:x")])
def test_a_dry_run_checks_the_part_too(umov, scenario, option, value):
    done = umov("run", scenario(), "--dry-run", option, value)
    assert done.code == 2 and f"{option} {value}" in done.err, done.err


def test_pages_have_their_suffix(umov, tmp_path):
    done = umov("passes", "--orbit", ROOT / "data/tle/hst.tle", "--site", "maui", "--start", "2018-01-21", "--stop",
                "2018-01-22", "--chart", "x.pdf")
    assert done.code == 2 and "--chart x.pdf" in done.err, done.err
    done = umov("render", "a.toml", "-o", "x.png", "--half-width", "-1")
    assert done.code == 2 and len(done.err) < 200, done.err


def test_a_job_that_cannot_end_leaves_no_rows_behind(umov, scenario, tmp_path):
    """An attitude that ends before the span: what would be kept belongs to a scenario that must change."""
    line = "2018-01-20T00:00:0{} 0 0 0 1\n"
    (tmp_path / "a.aem").write_text(
        "CCSDS_AEM_VERS = 1.0\nCREATION_DATE = 2018-01-20T00:00:00\nORIGINATOR = A\nMETA_START\nOBJECT_NAME = A\n"
        "OBJECT_ID = 1990-037B\nREF_FRAME_A = EME2000\nREF_FRAME_B = SC_BODY_1\nATTITUDE_DIR = A2B\n"
        "TIME_SYSTEM = UTC\nSTART_TIME = 2018-01-20T00:00:00\nSTOP_TIME = 2018-01-20T00:00:01\n"
        "ATTITUDE_TYPE = QUATERNION\nQUATERNION_TYPE = LAST\nMETA_STOP\nDATA_START\n"
        + line.format(0) + line.format(1) + "DATA_STOP\n")
    done = umov("run", scenario(('mode = "nadir"', 'mode = "aem", file = "a.aem"')))
    assert done.code == 4 and "Shorten [time]" in done.err, done.err
    assert not list(tmp_path.glob("*.partial")) and not (tmp_path / "out").exists()
