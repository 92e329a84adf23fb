"""No magnitude fainter than its floor stands without a mark, wherever a reader meets it: four objects with dark stretches of their own
kind. The floor of a row: light that is not three times its half-width [95 %] is not known, and beyond 30 it is none (docs/theory/photometry.md)."""
import json
import re

import pytest
from astropy.table import Table

from browser import Browser
from conftest import ROOT

SITE = '[observer]\nname = "Maui"\nlat_deg = 20.7083\nlon_deg = -156.2578\nalt_m = 3058\n'
NIGHT = "only = { alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true }\n"
CUBESAT = f"""umov = 1
{SITE}[time]
start = 2018-01-21T05:00:00Z
stop = 2018-01-21T05:20:00Z
step_s = 3
{NIGHT}
[[object]]
name = "3U"
orbit = {{ file = "{ROOT}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "3u.obj", unit = "m", up = "+Z" }}
attitude = {{ mode = "spin", axis = [1, 2, 0.5], period_s = 41, epoch = 2018-01-21T05:00:00Z }}
[object.materials]
default = "aluminium_anodized"
panel_px_front = "cell_gaas"
panel_mx_front = "cell_gaas"
body_pz = "paint_black"
[bands]
set = ["Bessell.B", "Bessell.V"]
mag_system = "Vega"
"""


def recipe(name):
    """A scenario of docs/recipes.md, its paths made whole."""
    text = (ROOT / "docs/recipes.md").read_text()
    return re.search(rf"cat >out/geo/{name} <<'TOML'\n(.*?)TOML\n", text, re.S).group(1).replace("../../data", str(ROOT / "data"))


def made(umov, tmp_path, name):
    """What to run, and the options of a run of seconds."""
    if name == "HST":
        return ROOT / "examples/hst_maui.toml", ("--set", "time.step_s=10")
    if name == "tumbling Agena":
        text = (ROOT / "examples/agena_maui.toml").read_text().replace('"../data', f'"{ROOT}/data')
        tumble = 'attitude = { mode = "spin", axis = "+Y", period_s = 47, epoch = 2018-01-21T05:00:00Z }'
        text, changed = re.subn("(?m)^attitude = .*", tumble, text)
        assert changed == 1
        (tmp_path / "agena.toml").write_text(text)
        return "agena.toml", ("--set", "time.stop=2018-01-21T06:00:00Z", "--set", "time.step_s=4")
    if name == "GEO":
        assert umov("mesh", "make", "box-wing", "--bus", 2.4, 2.4, 3, "--wing", 8, 2.4, "-o", "geo.obj").code == 0
        (tmp_path / "geo.toml").write_text(recipe("geo.toml"))
        return "geo.toml", ("--set", "time.step_s=300")
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "3u.obj").code == 0
    (tmp_path / "cubesat.toml").write_text(CUBESAT)
    return "cubesat.toml", ()


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    one = Browser(tmp_path_factory.mktemp("profile"))
    yield one
    one.close()


def shape_of_the_first_figure(browser, page):
    """Part of the height of its magnitude axis that the curve takes."""
    with browser.opened(page) as tab:
        tab.seen()
        found = tab.ask("Runtime.evaluate", expression="""(() => {
            const plot = document.getElementById("brightness"), [low, high] = plot._fullLayout.yaxis.range;
            const y = plot.data.filter((trace) => trace.mode === "lines+markers").flatMap((trace) => trace.y)
                .filter((value) => value !== null && value < low && value > high);
            return JSON.stringify((Math.max(...y) - Math.min(...y)) / (low - high)); })()""")
    return json.loads(found["result"]["value"])


@pytest.mark.parametrize("name", ["GEO", *(pytest.param(name, marks=pytest.mark.slow) for name in ("HST", "tumbling Agena", "tumbling cubesat"))])
def test_what_is_fainter_than_its_floor_is_marked_everywhere(umov, tmp_path, browser, name):
    scenario, options = made(umov, tmp_path, name)
    done = umov("run", scenario, "-o", "out", *options, "--set", 'output.formats=["ecsv","csv","html"]')
    assert done.code == 0, done.err
    rows = Table.read(tmp_path / "out/lightcurve.ecsv", format="ascii.ecsv")
    lit = rows[rows["intensity"] > 0]
    limit = [str(one) == "True" for one in lit["mag_limit"]]
    assert [bool(row["intensity"] <= 3 * row["intensity_err"] or row["mag"] >= 30) for row in lit] == limit
    assert sum(limit) < len(limit)
    # The same marks in the other table and on the page.
    short = Table.read(tmp_path / "out/lightcurve.csv", format="ascii.csv", comment="#")
    assert [str(one) for one in short["mag_limit"]] == [str(one) for one in rows["mag_limit"]]
    text = (tmp_path / "out/report.html").read_text()
    page = json.loads(re.search(r'id="umov-data" type="application/json">(.*?)</script>', text, re.S).group(1))
    on_page = {(band["name"], time): mark for band in page["bands"] for time, mark in zip(page["epochs"]["time"], band["mag_limit"], strict=True)}
    assert [on_page[row["band"], row["time_utc"]] for row in lit] == [int(one) for one in limit]
    # On the console the faint end of a pass is a limit where a row of it is one.
    for row_id in dict.fromkeys(lit["pass_id"]):
        line = next(one for one in done.out.splitlines() if row_id in one)
        has_limit = any(mark for mark, row in zip(limit, lit) if row["pass_id"] == row_id)
        assert (">" in line or "too faint" in line) == has_limit, line
    assert shape_of_the_first_figure(browser, tmp_path / "out/report.html") > 0.75
