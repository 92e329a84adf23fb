"""What a newcomer does in the first half hour: shapes of given sizes, tables of their own, slips, and how they are told."""
import json
import math
import os
import pty
import re
import subprocess

import pytest
from astropy.table import Table

from conftest import ROOT, UMOV, read_csv

HST = ROOT / "data/tle/hst.tle"
DAY = ("--start", "2018-01-21T04:00:00Z", "--stop", "2018-01-21T08:00:00Z")


def test_a_csv_says_in_its_first_line_how_it_is_read(umov, tmp_path):
    done = umov("passes", "--orbit", HST, "-s", "maui", *DAY, "-o", "p.csv")
    assert done.code == 0, done.err
    first = (tmp_path / "p.csv").read_text().splitlines()[0]
    format_name, comment = re.search(r'Table.read\(NAME, format="(.*?)", comment="(.)"\)', first).groups()
    table = Table.read(tmp_path / "p.csv", format=format_name, comment=comment)
    assert len(table) == len(read_csv(tmp_path / "p.csv")) and "rise_utc" in table.colnames


@pytest.mark.parametrize("text", ["wavelength_nm,n,k\n400,1.5,0.1\n700,1.5,0.1\n", "0.4 1.5 0.1\n0.7 1.5 0.1\n"])
def test_columns_of_n_and_k_are_an_index(umov, tmp_path, text):
    (tmp_path / "mine.csv").write_text(text)
    (tmp_path / "m.toml").write_text('[material.m]\nindex = "mine.csv"\n'
                                     'distribution = { model = "beckmann", alpha = 0.1 }\n')
    done = umov("material", "index", "mine.csv", "--wavelength", "550", "--json")
    assert done.code == 0 and json.loads(done.out)[0]["k"] == pytest.approx(0.1), done.err
    assert umov("brdf", "m.toml", "--theta-i", 30, "--theta-o", 30, "--phi", 180).code == 0
    assert umov("material", "import", "mine.csv", "--name", "mine").code == 0
    assert "[material" in (tmp_path / "mine.toml").read_text()


GROUPED = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0
g body\nusemtl foil\nf 1 2 3 4\ng wing\nusemtl cell\nf 2 5 6\nusemtl foil\nf 2 6 3
"""


def test_groups_of_an_obj_are_nodes_that_turn(umov, scenario, tmp_path):
    (tmp_path / "g.obj").write_text(GROUPED)
    part = ('[object.materials]\ndefault = "paper_al"\n',
            '[object.materials]\ndefault = "paper_al"\n[[object.part]]\nnodes = ["wing"]\naxis = "+X"\nface = "+Z"\n'
            'toward = "sun"\n')
    assert umov("run", scenario(("cube.obj", "g.obj"), part), "--dry-run").code in (0, 3)
    described = umov("mesh", "info", "g.obj", "--unit", "m", "--up", "+Z", "--json")
    assert described.code == 0, described.err
    nodes = json.loads(described.out)["nodes"]
    assert {node["path"] if "path" in node else node["node"] for node in nodes} == {"body", "wing"}, nodes
    wrong = (part[0], part[1].replace("nodes =", "groups ="))
    done = umov("run", scenario(("cube.obj", "g.obj"), wrong), "--dry-run")
    assert done.code == 3 and 'part "1"' in done.err and 'nodes = ["wing"]' in done.err, done.err


@pytest.mark.parametrize("shape, options, groups", [
    ("cubesat", ("--units", 3, "--panels", 2), {"body_px", "panel_px_front", "panel_mx_back"}),
    ("box-wing", ("--bus", 2, 2, 3, "--wing", 8, 2), {"bus_mz", "wing_py_front", "wing_my_back"}),
    ("rocket-body", ("--length", 6, "--diameter", 2), {"nozzle", "tank", "forward"}),
    ("dish", ("--diameter", 3, "--focus", 1), {"dish_front", "dish_back"}),
])
def test_spacecraft_of_given_sizes(umov, shape, options, groups):
    assert umov("mesh", "make", shape, *options, "-o", "s.obj").code == 0
    done = umov("mesh", "check", "s.obj", "--unit", "m", "--up", "+Z")
    assert done.code == 0, done.out + done.err
    names = {row["name"] for row in json.loads(
        umov("mesh", "info", "s.obj", "--unit", "m", "--up", "+Z", "--json").out)["materials"]}
    assert groups <= names, names


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


def test_a_spin_starts_with_the_scenario(umov, scenario, tmp_path):
    name = scenario(('attitude = { mode = "nadir" }',
                     'attitude = { mode = "spin", axis = "+X", period_s = 20, start = { mode = "nadir" } }'))
    done = umov("run", name)
    assert done.code == 0, done.err
    assert "epoch = 2018-01-21T05:08:00" in (tmp_path / "out/scenario.lock.toml").read_text()


def shown_on_a_terminal(*arguments):
    """What a command prints when its standard output is a terminal."""
    here, there = pty.openpty()
    child = subprocess.Popen([UMOV, *map(str, arguments)], stdout=there, stderr=subprocess.DEVNULL)
    os.close(there)
    out = b""
    while True:
        try:
            part = os.read(here, 65536)
        except OSError:
            break
        if not part:
            break
        out += part
    assert child.wait() == 0
    return out.decode().replace("\r\n", "\n")


def test_a_terminal_gets_few_columns_and_others_by_name():
    arguments = ("passes", "--orbit", HST, "-s", "maui", *DAY)
    lines = shown_on_a_terminal(*arguments).splitlines()
    assert max(map(len, lines)) <= 160 and "mag_min" not in lines[0], lines[0]  # no model: the column is empty
    assert shown_on_a_terminal(*arguments, "-c", "name,rise_az").split()[:2] == ["name", "rise_az"]
    piped = subprocess.run([UMOV, *map(str, arguments)], capture_output=True, text=True, check=True)
    assert "glint_widths" in piped.stdout
    done = subprocess.run([UMOV, *map(str, arguments), "-c", "rise"], capture_output=True, text=True)
    assert done.returncode == 2 and 'Did you mean "rise_' in done.stderr, done.stderr


def test_a_run_says_which_one_it_replaces(umov, scenario):
    name = scenario()
    assert "in place of" not in umov("run", name).out
    assert re.search(r"in place of the run of 20\d\d-\d\d-\d\dT", umov("run", name).out)


def test_the_gallery_draws_every_material(umov, tmp_path):
    done = umov("material", "plot", "--all", "-o", "g.html")
    assert done.code == 0, done.err
    page = json.loads(re.search(r'id="data">(.*?)</script>', (tmp_path / "g.html").read_text()).group(1))
    figures = {figure["title"]: figure for figure in page["figures"]}
    assert len(figures) >= 26
    # A Lambert sphere polarizes nothing; what one reflection does is the paper's B/A: gold at 140 deg, 425 nm, .589.
    assert all(abs(y) < 1e-9 for line in figures["paper_spectralon"]["lines"] for y in line["y"])
    gold = figures["paper_au"]["lines"][0]
    assert gold["y"][gold["x"].index(140)] == pytest.approx(58.9, abs=0.1)


def test_a_site_without_height_stands_at_zero(umov, tmp_path):
    """To the byte the passes of the same site at 0 m, with a remark that -q leaves out."""
    outputs = [umov("passes", "--orbit", HST, *where, *DAY, "-o", f"{k}.csv") for k, where in enumerate((
        ("-s", "20.7,-156.3,0"), ("-s", "20.7,-156.3"), ("--lat-deg", "20.7", "--lon-deg", "-156.3")))]
    assert [done.code for done in outputs] == [0, 0, 0], outputs[1].err
    assert len({(tmp_path / f"{k}.csv").read_text() for k in range(3)}) == 1
    assert "0 m above" not in outputs[0].err
    assert "--site 20.7,-156.3,HEIGHT" in outputs[1].err and "--alt-m tells it" in outputs[2].err
    assert "0 m above" not in umov("passes", "--orbit", HST, "-s", "20.7,-156.3", *DAY, "-q").err


def test_a_date_alone_begins_its_day(umov, scenario, tmp_path):
    for name, clock in (("a", ""), ("b", "T00:00:00Z")):
        done = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21" + clock, "--stop",
                    "2018-01-22" + clock, "-o", name + ".csv")
        assert done.code == 0, done.err
    assert (tmp_path / "a.csv").read_text() == (tmp_path / "b.csv").read_text()
    for quote in ("", '"'):  # a date of TOML, and a string
        done = umov("run", scenario(), "--dry-run", "--set", f"time.start={quote}2018-01-21{quote}", "--set", f"time.stop={quote}2018-01-22{quote}")
        assert done.code == 0, done.err


def test_a_run_tells_programs_what_it_found(umov, scenario, tmp_path):
    done = umov("run", scenario(), "--json", "-o", "told")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    rows = Table.read(tmp_path / "told/lightcurve.ecsv")
    one, bands = told["objects"][0], len(set(rows["band"]))
    assert told["complete"] and told["folder"].endswith("told")
    assert one["epochs"] * bands == len(rows) and one["dark"] >= 0
    first = one["passes"][0]
    # One band, the middle one: a range over several would mix the colour into it.
    known = [row["mag"] for row in rows if row["pass_id"] == first["pass_id"] and row["band"] == one["band_of_passes"] and str(row["mag_limit"]) == "False"]
    assert one["band_of_passes"] == one["bands"][len(one["bands"]) // 2]
    assert first["mag_min"] == pytest.approx(min(known), abs=1e-9)
    assert re.search(r"550 nm: mag \d", umov("run", scenario(), "-o", "other").out)


def test_a_dry_run_as_json_says_what_the_run_will_do(umov, scenario, tmp_path):
    done = umov("run", scenario(), "--dry-run", "--json")
    assert done.code == 0, done.err
    plan = json.loads(done.out)
    assert not (tmp_path / "out").exists()
    made = json.loads(umov("run", scenario(), "--json").out)
    planned, found = plan["objects"], made["objects"]
    assert [one["epochs"] for one in planned] == [one["epochs"] for one in found]
    assert [[p["pass_id"] for p in one["passes"]] for one in planned] == [[p["pass_id"] for p in one["passes"]] for one in found]
    assert plan["bands"] == found[0]["bands"] and plan["folder"] == made["folder"] and plan["method"] == "auto"
    # 05:08 to 05:12 in steps of 20 s, both ends included; a row for each epoch and band
    assert plan["cost"] == {"epochs_searched": 13, "epochs_lit": found[0]["epochs"], "rows": 3 * found[0]["epochs"]}
    part = json.loads(umov("run", scenario(), "--dry-run", "--json", "--shard", "0/1").out)
    assert part["objects"] == planned


def test_a_dry_run_looks_at_the_folder_last(umov, scenario, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.txt").write_text("x")
    done = umov("run", scenario(), "--dry-run", "-o", "mine", "--set", "object.materials.default=paper_all")
    assert done.code == 3 and "paper_all" in done.err, done.err
    done = umov("run", scenario(), "--dry-run", "-o", "mine")
    assert done.code == 6 and "fine;" in done.err, done.err


def test_a_long_search_is_told_before_it_starts(umov, scenario):
    span = ("--set", "time.start=2018-01-21", "--set", "time.stop=2018-01-25", "--set", "time.only.alt_min_deg=88")
    done = umov("run", scenario(), *span, "--set", "time.step_s=1")
    assert "looking for passes among 345601 epochs" in done.err, done.err


def hazy(scenario, haze, *more):
    """HST's orbit with a sphere that reflects nothing but by its haze."""
    return scenario(("cube.obj", "sphere.obj"), ('default = "paper_al"', 'default = "mine"'),
                    ('[bands]\nset = "paper_rgb"', '[material.mine]\nindex = { n = 1.0001, k = 0 }\n'
                     'distribution = { model = "beckmann", alpha = 0.3 }\n'
                     f'haze = {haze}\n[bands]\nset = "nm:550"'), *more)


def test_the_spread_over_the_range_of_haze(umov, scenario, tmp_path):
    """White haze alone is a Lambert surface: light goes with its albedo, magnitudes by 2.5 log10 of it (Pogson)."""
    assert umov("mesh", "make", "sphere", "-o", "sphere.obj").code == 0
    vary = ("[output]", '[materials]\nvary = ["haze"]\n[output]')
    done = umov("run", hazy(scenario, "{ albedo = 0.1, range = [0.05, 0.25] }", vary))
    assert done.code == 0 and "over the ranges of haze: magnitudes change by 1.75" in done.out, done.out + done.err
    rows = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    # The interface reflects 2.5e-9; three runs, each to the half-width of its light.
    for row in rows:
        share = row["intensity_err"] / row["intensity"]
        assert row["intensity_low"] / row["intensity"] == pytest.approx(0.5, rel=2 * share + 1e-4)
        assert row["intensity_high"] / row["intensity"] == pytest.approx(2.5, rel=2 * share + 1e-4)
        assert row["mag"] - row["mag_low"] == pytest.approx(2.5 * math.log10(2.5), abs=3 * share + 2e-4)
        assert row["mag_high"] - row["mag"] == pytest.approx(2.5 * math.log10(2), abs=3 * share + 2e-4)
    plain = hazy(scenario, "{ albedo = 0.1, range = [0.05, 0.25] }")
    assert umov("run", plain, "--set", "output.dir=plain").code == 0
    other = Table.read(tmp_path / "plain/lightcurve.ecsv", format="ascii.ecsv")
    assert "mag_low" not in other.colnames and list(other["intensity"]) == list(rows["intensity"])
    assert umov("run", "out/scenario.lock.toml", "--set", "output.dir=again").code == 0
    assert (tmp_path / "again/lightcurve.ecsv").read_bytes() == (tmp_path / "out/lightcurve.ecsv").read_bytes()


def test_a_spread_that_cannot_be_is_told(umov, scenario):
    assert umov("mesh", "make", "sphere", "-o", "sphere.obj").code == 0
    vary = ("[output]", '[materials]\nvary = ["haze"]\n[output]')
    done = umov("run", hazy(scenario, "{ albedo = 0.1 }", vary))
    assert done.code == 0 and "no material of HST states a range of its haze" in done.err, done.err
    done = umov("run", scenario(("[output]", '[materials]\nvary = ["roughness"]\n[output]')), "--dry-run")
    assert done.code == 3 and '"haze" was expected' in done.err and ":" in done.err, done.err


def test_a_csv_has_as_many_digits_as_its_errors_leave(umov, scenario, tmp_path):
    done = umov("run", scenario())
    assert done.code == 0, done.err
    assert umov("run", "scenario.toml", "--set", "output.dir=all", "--set", "output.csv_digits=all").code == 0
    short, full = (read_csv(tmp_path / f"{name}/lightcurve.csv") for name in ("out", "all"))
    exact = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    assert (tmp_path / "out/lightcurve.ecsv").read_bytes() == (tmp_path / "all/lightcurve.ecsv").read_bytes()
    for few, many, row in zip(short, full, exact, strict=True):
        for name in ("intensity", "mag", "q", "u", "p", "pa"):
            assert float(many[name]) == row[name]
            error = row[f"{name}_err"]
            # Half of the last digit, which is the second one of the error, or the tenth of the value.
            assert abs(float(few[name]) - row[name]) <= max(0.0501 * error, 5.01e-10 * abs(row[name]))
            assert float(few[f"{name}_err"]) == pytest.approx(error, rel=0.05 + 1e-9)
        for name, bound in (("alt", 5e-8), ("range", 5e-7), ("mjd_utc", 5e-9), ("qw", 5e-10)):
            assert abs(float(few[name]) - row[name]) <= 1.001 * bound
        assert few["time_utc"] == many["time_utc"]
    assert (tmp_path / "out/lightcurve.csv").stat().st_size < 0.75 * (tmp_path / "all/lightcurve.csv").stat().st_size


def test_a_folder_with_its_inputs_runs_elsewhere(umov, scenario, tmp_path):
    (tmp_path / "nk.csv").write_text("wavelength_nm,n,k\n400,1.5,0.1\n700,1.5,0.1\n")
    (tmp_path / "foil.toml").write_text('[material.foil]\nindex = "nk.csv"\ndistribution = { model = "beckmann", alpha = 0.1 }\n')
    changed = scenario(('default = "paper_al"', 'default = "foil.toml"'),
                       ("[output]", "[output]\nkeep_inputs = true"))
    done = umov("run", changed)
    assert done.code == 0, done.err
    kept = {path.name for path in (tmp_path / "out/inputs").rglob("*") if path.is_file()}
    assert {"hst.tle", "cube.obj", "nk.csv", "foil.toml"} <= kept
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (tmp_path / "out").rename(elsewhere / "sent")
    for name in ("nk.csv", "foil.toml", "cube.obj", changed):
        (tmp_path / name).unlink()
    done = umov("run", "elsewhere/sent/scenario.lock.toml", "-o", "again")
    assert done.code == 0, done.err
    assert (tmp_path / "again/lightcurve.ecsv").read_bytes() == (elsewhere / "sent/lightcurve.ecsv").read_bytes()
    # The folder is umov's as a whole, until somebody puts a file of his own among the inputs.
    assert umov("run", "again/scenario.lock.toml", "-o", "again").code == 0
    (tmp_path / "again/inputs/mine.txt").write_text("x")
    done = umov("run", "elsewhere/sent/scenario.lock.toml", "-o", "again")
    assert done.code == 6 and "inputs" in done.err, done.err


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


@pytest.mark.parametrize("material", ["cell_gaas", "germanium_kapton", "cell_silicon"])
def test_what_flies_is_known_to_the_end_of_the_red_filters(umov, scenario, material):
    done = umov("run", scenario((GAAS[0], GAAS[1].replace("film_aluminized", material)),
                                ('set = "paper_rgb"', 'set = ["Bessell.R", "Bessell.I"]')), "--dry-run")
    assert done.code == 0, done.err


def test_a_step_that_is_too_long_for_a_turn_is_told(umov, scenario):
    spin = ('attitude = { mode = "nadir" }',
            'attitude = { mode = "spin", axis = "+Y", period_s = 50, epoch = 2018-01-21T05:00:00Z }')
    done = umov("run", scenario(spin), "--dry-run")  # a step of 20 s
    assert done.code == 0 and "turns in 50 s (spin)" in done.err and "step_s = 20" in done.err, done.err
    done = umov("run", scenario(spin), "--dry-run", "--set", "time.step_s=5")
    assert done.code == 0 and "turns in" not in done.err, done.err


def test_a_mesh_behind_a_link_and_dots_is_found(umov, scenario, tmp_path):
    """`link/../x` is beside what the link points to."""
    path, mesh = tmp_path / scenario(), tmp_path / "cube.obj"
    there = tmp_path / "elsewhere" / "deep"
    there.mkdir(parents=True)
    for one in (mesh, mesh.with_suffix(".mtl")):
        one.rename(there.parent / one.name)
    (tmp_path / "link").symlink_to(there)
    path.write_text(path.read_text().replace(f'"{mesh.name}"', f'"link/../{mesh.name}"'))
    done = umov("run", path.name, "-o", "out")
    assert done.code == 0, done.err
    assert umov("run", "out/scenario.lock.toml", "--dry-run").code == 0  # and by its lock again


def test_a_message_about_a_table_stands_at_its_header(umov, tmp_path):
    text = "umov = 1\n\n\n[observer]\nlat_deg = 1\nlon_deg = 2\nalt_m = 3\n\n\n\n[[object]]\nname = \"x\"\n\n\n[time]\nstep_s = 1\n"
    (tmp_path / "s.toml").write_text(text)
    done = umov("run", "s.toml", "--dry-run")
    assert done.code == 3 and "s.toml:15:1: [time]" in done.err, done.err


def test_a_night_of_what_never_sets_is_named_by_its_highest_time_in_it(umov):
    done = umov("passes", "--orbit", ROOT / "data/tle/goes15.tle", "-s", "kitt peak", "--start", "2018-02-10T02:00:00Z",
                "--stop", "2018-02-10T13:00:00Z", "--allow-old-elements", "--json")
    assert done.code == 0, done.err
    row = json.loads(done.out)[0]
    when = row["pass_id"].split("-")[1]
    assert "20180210T020000Z" <= when <= "20180210T130000Z", row


def on_a_terminal(*arguments, cwd):
    """What umov draws on a terminal."""
    here, there = pty.openpty()
    run = subprocess.Popen([UMOV, *map(str, arguments)], cwd=cwd, stdout=subprocess.DEVNULL, stderr=there)
    os.close(there)
    drawn = b""
    while True:
        try:
            part = os.read(here, 4096)
        except OSError:
            break
        if not part:
            break
        drawn += part
    run.wait()
    os.close(here)
    return run.returncode, drawn.decode()


HEAVY = """umov = 1
[[object]]
name = "box-wing"
orbit = {{ file = "{tle}", norad = 20580 }}
mesh = {{ file = "heavy.obj", unit = "m", up = "+Z" }}
attitude = {{ point = "+Z", at = "observer" }}
[object.materials]
bus = "film_aluminized"
panels = "film_aluminized"
dish = "film_aluminized"
tank = "film_aluminized"
[observer]
name = "maui"
lat_deg = 20.7084
lon_deg = -156.2571
alt_m = 3058
[time]
start = 2018-01-21T05:00:00Z
stop = 2018-01-21T05:30:00Z
step_s = 60
"""


def test_a_first_run_moves_and_says_why_on_a_terminal_only(umov, tmp_path):
    """A line every quarter of a second: the masks of so many facets take several seconds on any machine."""
    made = umov("mesh", "make", "box-wing", "--facets", 200000, "--crumple", 0.02, "-o", "heavy.obj")
    assert made.code == 0, made.err
    (tmp_path / "heavy.toml").write_text(HEAVY.format(tle=ROOT / "data/tle/hst.tle"))
    run = ("run", "heavy.toml", "--no-cache")
    code, drawn = on_a_terminal(*run, "-o", "a", cwd=tmp_path)
    assert code == 0 and "light curve [" in drawn, drawn
    assert "the first run of a shape traces what hides what" in drawn, drawn
    done = umov(*run, "-o", "b")
    assert done.code == 0 and "light curve" not in done.err and "\r" not in done.err, done.err


def test_the_period_of_a_table_of_anybodys_is_that_of_astropy(umov, tmp_path):
    import numpy as np
    from astropy.timeseries import LombScargle
    seconds = np.sort(np.random.default_rng(3).uniform(0, 300, 200))
    mag = 7 + 0.3 * np.sin(2 * np.pi * seconds / 13.7) + np.random.default_rng(4).normal(0, 0.1, 200)
    days = 60000 + seconds / 86400
    rows = "\n".join(f"{day:.12f},{m:.6f}" for day, m in zip(days, mag))
    (tmp_path / "mine.csv").write_text("mjd_utc,mag\n" + rows + "\n")
    done = umov("period", "mine.csv", "--peaks", 1, "--json")
    assert done.code == 0, done.err
    found = json.loads(done.out)[0]
    x = (seconds - seconds[0]) / (seconds[-1] - seconds[0])
    rest = mag - np.polyval(np.polyfit(x, mag, 2), x)
    search = LombScargle(seconds, rest)
    near = np.linspace(0.95 / 13.7, 1.05 / 13.7, 20001)
    power = search.power(near)
    # A parabola through three of five values a peak finds its top to a few hundredths of the error of the period.
    assert found["period"] == pytest.approx(1 / near[power.argmax()], abs=0.3 * found["period_err"])
    assert found["power"] == pytest.approx(power.max(), rel=0.1)  # the highest of the grid, not of the parabola
    assert abs(found["period"] - 13.7) < 4 * found["period_err"]
    # Noise alone: 200 values of it are hardly ever as high.
    assert found["false_alarm"] < 1e-10
    assert umov("period", "mine.csv", "--band", "V").code == 3


def noisy_sine(path, period_s, seed, amplitude=0.3):
    import numpy as np
    noise = np.random.default_rng(seed)
    seconds = np.arange(0, 300, 1.5)
    mag = 7 + amplitude * np.sin(2 * np.pi * seconds / period_s) + noise.normal(0, 0.1, len(seconds))
    path.write_text("mjd_utc,mag\n" + "\n".join(f"{60000 + t / 86400:.12f},{m:.6f}" for t, m in zip(seconds, mag)) + "\n")


def test_a_period_says_which_spins_it_may_mean_and_noise_is_none(umov, tmp_path):
    noisy_sine(tmp_path / "sine.csv", 13.7, 5)
    done = umov("period", "sine.csv", "--json")
    rows = json.loads(done.out)
    # White noise has a peak above the chance of .01 in one series of a hundred: of this seed none.
    assert [row["meaning"] for row in rows] == ["period"] and rows[0]["false_alarm"] < 1e-10, rows
    twice = float(re.search(r"twice that, ([0-9.]+) s", done.err).group(1))
    assert abs(twice - 2 * rows[0]["period"]) < 0.01 and "half of it" in done.err
    everything = json.loads(umov("period", "sine.csv", "--json", "--false-alarm", 1).out)
    assert len(everything) == 5 and all(row["false_alarm"] > 0.01 for row in everything[1:])
    noisy_sine(tmp_path / "noise.csv", 13.7, 6, amplitude=0)
    done = umov("period", "noise.csv")
    assert done.code == 5 and "stands out of noise" in done.err and "--false-alarm 1" in done.err, done.err


def test_parts_and_multiples_of_a_period_are_named(umov, tmp_path):
    """A spin of 40 s with two sides that differ a little: half of it is the highest, the spin itself lower."""
    import numpy as np
    seconds = np.arange(0, 600, 1.0)
    turn = 2 * np.pi * seconds / 40
    mag = 7 + 0.4 * np.sin(2 * turn) + 0.2 * np.sin(turn) + 0.1 * np.sin(4 * turn)
    (tmp_path / "two.csv").write_text("mjd_utc,mag\n" + "\n".join(
        f"{60000 + t / 86400:.12f},{m:.6f}" for t, m in zip(seconds, mag)) + "\n")
    rows = json.loads(umov("period", "two.csv", "--json", "--peaks", 3).out)
    assert [row["meaning"] for row in rows] == ["period", "twice rank 1", "half of rank 1"], rows
    assert rows[0]["period"] == pytest.approx(20, abs=0.1) and rows[1]["period"] == pytest.approx(40, abs=0.4)


def test_an_attitude_without_epoch_says_from_when_it_turns(umov, scenario, tmp_path):
    """The lock keeps it: a trimmed span has the same attitude, and umov passes sees what umov run computes."""
    spin = 'attitude = { mode = "spin", axis = [1, 2, 0.5], period_s = 97 }'
    done = umov("run", scenario(('attitude = { mode = "nadir" }', spin)))
    assert done.code == 0 and "no epoch" in done.err and "epoch = 2018-01-21T05:08:00.000Z" in done.err, done.err
    whole = {row["time_utc"]: row["mag"] for row in read_csv(tmp_path / "out/lightcurve.csv") if row["band"] == "nm:550"}
    trimmed = umov("run", "out/scenario.lock.toml", "--set", "time.start=2018-01-21T05:10:00Z", "--set", "output.dir=late")
    assert trimmed.code == 0 and "no epoch" not in trimmed.err, trimmed.err
    late = {row["time_utc"]: row["mag"] for row in read_csv(tmp_path / "late/lightcurve.csv") if row["band"] == "nm:550"}
    assert late and all(late[time] == whole[time] for time in late)
    done = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:00:00Z", "--stop", "2018-01-21T05:20:00Z",
                "--scene", "scenario.toml", "--band", "nm:550", "-o", "p.csv")
    assert done.code == 0 and "no epoch" in done.err, done.err
    other = umov("passes", "--orbit", HST, "-s", "maui", "--start", "2018-01-21T05:04:00Z", "--stop", "2018-01-21T05:20:00Z",
                 "--scene", "out/scenario.lock.toml", "--band", "nm:550", "-o", "other.csv")
    assert other.code == 0 and "no epoch" not in other.err, other.err
    one, same = (float(read_csv(tmp_path / name)[0]["mag_min"]) for name in ("p.csv", "other.csv"))
    assert one == pytest.approx(same, abs=1e-4)  # searches of two spans end at times that differ a little


def test_an_exposure_ends_with_what_it_means(umov):
    exposure = ("exposure", "--instrument", "c11_imx250")
    fine = umov(*exposure, "--mag", 8)
    assert "S/N" in fine.err and "does not saturate" in fine.err and "the error of p that is wanted (--sd-p 0.01)" in fine.err, fine.err
    # Photons make nearly all of the noise: a twelfth of the time has a twelfth of them, and twelve or thirteen frames do.
    seconds = float(re.search(r"One exposure of ([0-9.]+) s", fine.err).group(1))
    short = umov(*exposure, "--mag", 8, "--exposure-s", seconds / 12)
    assert re.search(r"1[2-4] of them tell p to 0.01", short.err), short.err
    error = float(re.search(r"error of p ([0-9.]+);", short.err).group(1))
    assert error == pytest.approx(0.01 * math.sqrt(12), rel=0.12)  # two digits, and each frame is read
    full = umov(*exposure, "--mag", 0, "--exposure-s", 1)
    assert "it saturates" in full.err and "Expose at most" in full.err, full.err
    longest = float(re.search(r"full after ([0-9.e-]+) s", full.err).group(1))
    allowed = float(re.search(r"at most ([0-9.e-]+) s", full.err).group(1))
    assert allowed == pytest.approx(longest / 2, rel=0.01)
    assert "does not saturate" in umov(*exposure, "--mag", 0, "--exposure-s", allowed).err


def test_the_shipped_instruments_do_not_warn_of_themselves(umov, tmp_path):
    text = (ROOT / "examples/observe_hst.toml").read_text().replace("../data", f"{ROOT}/data")
    for name in ("c11_imx250", "moptop_2m"):
        (tmp_path / "o.toml").write_text(text.replace("c11_imx250", name))
        done = umov("observe", "o.toml", "--set", "time.start=2018-01-21T05:10:00Z", "--set", "time.stop=2018-01-21T05:10:02Z",
                    "--set", "output.dir=o", "--force")
        assert done.code == 0 and "a well of" not in done.err, done.err


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
