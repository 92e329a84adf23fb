"""Slips and how they are told: hints by meaning, by place and all at once."""
import re

import pytest


def test_a_slip_of_the_unit_is_noticed(umov, scenario, tmp_path):
    assert umov("mesh", "make", "cubesat", "-o", "c.obj").code == 0
    lines = (tmp_path / "c.obj").read_text().splitlines()
    scaled = [" ".join(["v", *(repr(1000 * float(x)) for x in line.split()[1:])]) if line.startswith("v ") else line
              for line in lines]
    (tmp_path / "mm.obj").write_text("\n".join(scaled) + "\n")
    done = umov("mesh", "info", "mm.obj", "--unit", "m", "--up", "+Z")
    assert "longer than any satellite" in done.err and "0.341 m" in done.err, done.err
    assert "warning" not in umov("mesh", "info", "mm.obj", "--unit", "mm", "--up", "+Z").err


@pytest.mark.parametrize("changes, words", [
    ([("step_s = 20", "step = 20")], ['Did you mean "step_s"?']),
    ([('default = "paper_al"', 'default = "solar_cell"')], ['Did you mean "cell_']),
    ([('set = "paper_rgb"', "set = [550]")], ['"nm:550"']),
    ([("lat_deg", "lat"), ("lon_deg", "lon"), ("alt_m", "alt"), ("pol", "pol")],
     ['"lat_deg"', '"lon_deg"', '"alt_m"']),
    ([("step_s = 20", "step = 20"), ('set = "paper_rgb"', 'sett = "paper_rgb"')], ['"step_s"', '"set"']),
    ([('mesh = { file = "cube.obj", unit = "m", up = "+Z", normals = "flat" }', 'mesh = "cube.obj"'),
      ('attitude = { mode = "nadir" }', 'attitude = "nadir"')],
     ['as in mesh = { file = "cube.obj" }', 'as in attitude = { mode = "nadir" }']),
    # Values too, of each table and of each material:
    ([('default = "paper_al"', 'default = "solar_cell"\nother = "gildd"'), ("step_s = 20", "step_s = -20"), ("lat_deg = ", "lat_deg = 1"), ('set = "paper_rgb"', 'set = "nm:x"')],
     ["lat_deg = ", "step_s = -20", "nm:x"]),
    ([('default = "paper_al"', 'default = "solar_cell"\nother = "gildd"'), ('attitude = { mode = "nadir" }', 'attitude = { mode = "nadirr" }'), ('set = "paper_rgb"', 'set = "nm:x"')],
     ['"cell_', "gildd", "nadirr", "nm:x"]),
    # Keys and values of one table:
    ([("lat_deg = 20.7083", "lat_dg = 120"), ("lon_deg = -156.2578", "lon_deg = -956"), ("alt_m = 3058", "alt_m = 3e9")],
     ['"lat_dg" in [observer]. Did you mean "lat_deg"?', "lat_deg = 120;", "lon_deg = -956;", "alt_m = 3"]),
    ([("step_s = 20", "step_s = -20\nfoo = 3"), ("alt_min_deg = 10", "alt_min_deg = 100"), ("sun_alt_max_deg = -6", "sun_alt_max_deg = -600"),
      ("start = 2018-01-21T05:08:00Z", 'start = "2018-02-30"')],
     ['"foo"', "step_s = -20;", "alt_min_deg = 100;", "sun_alt_max_deg = -600;", '"2018-02-30" is not in the calendar']),
    ([('unit = "m", up = "+Z", normals = "flat"', 'unit = "m", up = "+Z", normals = "flatt", crease_deg = 300'),
      ('attitude = { mode = "nadir" }', 'attitude = { mode = "spin", axis = "Z", period_s = 0, point = "+X" }'),
      ("norad = 20580", "norad = -1")],
     ['normals = "flatt"', "crease_deg = 300;", "axis: a body axis", "period_s = 0;", 'point has no meaning with mode = "spin"', "norad = -1;"]),
    ([('set = "paper_rgb"', 'set = ["nm:x", "Besell.V"]\nmag_system = "ABB"'), ('formats = ["ecsv", "csv", "html"]', 'formats = ["csvv", "htm"]\npol_frame = "equatoreal"'),
      ('default = "paper_al"', 'default = "mine"\n[material.mine]\nindex = "nosuch.yml"\ndistribution = { model = "ggx", alpha = -3 }\nshadowing = "smth"')],
     ['"nm:x"', '"Besell.V"', 'mag_system = "ABB"', '"csvv"', '"htm"', 'pol_frame = "equatoreal"', "nosuch.yml", "alpha = -3;", 'shadowing = "smth"']),
    # Files that are not there, of all tables:
    ([("/hst.tle", "/nosuch.tle"), ("cube.obj", "nosuch.obj")], ["nosuch.tle: no such file", "nosuch.obj: no such file"]),
    ([("/hst.tle", "/nosuch.tle"), ("cube.obj", "nosuch.obj"), ('default = "paper_al"', 'default = "mine"\n[material.mine]\ntable = "nosuch.csv"')],
     ["nosuch.tle: no such file", "nosuch.obj: no such file", "nosuch.csv: no such file"]),
])
def test_hints_by_meaning_and_all_slips_at_once(umov, scenario, changes, words):
    done = umov("run", scenario(*[c for c in changes if c != ("pol", "pol")]), "--dry-run")
    assert done.code == 3 and all(word in done.err for word in words), done.err
    told = done.err.removeprefix("error: ").split("\n  and ")
    assert len(told) == len(set(told)) and "T00:00:00Z" not in done.err  # each once, as it was written


GAAS = ('[object.materials]\ndefault = "paper_al"\n', '[object.materials]\ndefault = "film_aluminized"\n')


def test_a_band_that_a_material_does_not_cover_is_told_where_it_stands(umov, scenario, tmp_path):
    """PET is known from 400 nm on, Bessell's B begins at 360."""
    name = scenario(GAAS, ('set = "paper_rgb"', 'set = "Bessell.B"'))
    done = umov("run", name, "--dry-run")
    lines = (tmp_path / name).read_text().splitlines()
    line = next(k for k, text in enumerate(lines, 1) if text.startswith("default ="))
    assert done.code == 3 and f"{name}:{line}:" in done.err, done.err
    assert 'materials.default = "film_aluminized"' in done.err and "PET_Zhang" in done.err, done.err
    named = done.err.split("Materials that cover it: ")[1]
    assert "cell_gaas" in named and "film_silvered" in named and "film_aluminized" not in named, done.err


def test_a_tail_of_a_band_is_taken_from_the_end_of_a_table_and_told(umov, scenario):
    """Below the 400 nm from which PET is known Gaia's G has a few percent of its response (Riello et al. 2021)."""
    done = umov("run", scenario(GAAS, ('set = "paper_rgb"', 'set = "gaia.G"')), "--dry-run")
    assert done.code == 0, done.err
    share = float(re.search(r"the ends beyond, ([0-9.]+) % of its response", done.err).group(1))
    assert 1 < share < 5, done.err


def test_a_message_about_a_table_stands_at_its_header(umov, tmp_path):
    text = "umov = 1\n\n\n[observer]\nlat_deg = 1\nlon_deg = 2\nalt_m = 3\n\n\n\n[[object]]\nname = \"x\"\n\n\n[time]\nstep_s = 1\n"
    (tmp_path / "s.toml").write_text(text)
    done = umov("run", "s.toml", "--dry-run")
    assert done.code == 3 and "s.toml:15:1: [time]" in done.err, done.err


@pytest.mark.parametrize("arguments", [
    ("run", "x.toml", "--accuracy"), ("signature", "x.toml", "--poses", 3, "--phase", 60, "--accuracy"), ("exposure", "--instrument", "x", "--mag"),
    ("invert", "pose", "x.csv", "--scenario", "x.toml", "--floor"), ("period", "x.csv", "--gap-s")])
@pytest.mark.parametrize("value", ["nan", "-nan", "inf"])
def test_what_is_no_number_is_no_value_of_an_option(umov, arguments, value):
    done = umov(*arguments[:-1], f"{arguments[-1]}={value}")
    assert done.code == 2 and arguments[-1] in done.err, done.err


def test_hints_name_what_the_reader_can_type(umov, scenario, tmp_path):
    assert umov("mesh", "make", "cubesat", "-o", "c.obj").code == 0
    done = umov("mesh", "info", "c.obj")
    assert done.code == 3 and "Give --unit m" in done.err and "--up +Z" in done.err, done.err
    done = umov("run", scenario(("05:08:00Z", "01:08:00Z"), ("05:12:00Z", "01:12:00Z")))
    assert done.code == 5 and '""' not in done.err and "from the site" in done.err, done.err
    assert umov("library", "build", scenario(), "-o", "lib", "--range", "1:0").code == 2
    done = umov("library", "build", scenario(), "-o", "lib", "--range", "0:2")
    assert done.code == 2 and "the job has 1 scenarios" in done.err, done.err
    (tmp_path / "job").mkdir()
    (tmp_path / "job/job.json").write_text("")
    done = umov("scale", "status", "job")
    assert done.code == 3 and "job.json: is empty" in done.err and "begin the job again" in done.err, done.err


@pytest.mark.parametrize(("given", "words"), [("mine.csv", "--geometry FILE.csv"), ("1e3", "1 to 10000000"), ("0", "1 to 10000000"),
                                              ("10000001", "1 to 10000000"), ("99999999999999999999", "1 to 10000000")])
def test_a_file_given_as_a_number_of_poses(umov, scenario, given, words):
    done = umov("signature", scenario(), "--poses", given, "--phase", 60)
    assert done.code == 2 and given in done.err and words in done.err
    assert ("--geometry" in done.err) == (not given.isdigit())


def test_words_to_choose_from_are_told_as_in_a_sentence(umov, scenario):
    done = umov("run", scenario(), "--set", "output.pol_frame=icrs")
    assert done.code == 3 and "equatorial, altaz or scattering was expected" in done.err


def test_one_material_of_front_and_back_is_told_once(umov, scenario):
    done = umov("run", scenario(('default = "paper_al"', 'default = "paint_whit"')), "--dry-run")
    assert done.code == 3 and done.err.count('unknown material "paint_whit"') == 1, done.err
