"""What a newcomer does in the first half hour: shapes of given sizes, tables of their own, what a terminal shows."""
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


GAAS = ('[object.materials]\ndefault = "paper_al"\n', '[object.materials]\ndefault = "film_aluminized"\n')


@pytest.mark.parametrize("material", ["cell_gaas", "germanium_kapton", "cell_silicon"])
def test_what_flies_is_known_to_the_end_of_the_red_filters(umov, scenario, material):
    done = umov("run", scenario((GAAS[0], GAAS[1].replace("film_aluminized", material)),
                                ('set = "paper_rgb"', 'set = ["Bessell.R", "Bessell.I"]')), "--dry-run")
    assert done.code == 0, done.err


def test_a_night_of_what_never_sets_is_named_by_its_highest_time_in_it(umov):
    done = umov("passes", "--orbit", ROOT / "data/tle/goes15.tle", "-s", "kitt peak", "--start", "2018-02-10T02:00:00Z",
                "--stop", "2018-02-10T13:00:00Z", "--allow-old-elements", "--json")
    assert done.code == 0, done.err
    row = json.loads(done.out)[0]
    when = row["pass_id"].split("-")[1]
    assert "20180210T020000Z" <= when <= "20180210T130000Z", row


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
