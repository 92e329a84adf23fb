"""Pages as their readers see them: opened from disk in a browser without network, each figure drawn, none too wide for a phone."""
import json
import math
import subprocess
import time

import pytest

from browser import Browser
from conftest import ROOT, UMOV

pytestmark = pytest.mark.slow  # a minute of jobs, then a browser

DAY = ("--start", "2018-01-21T04:00:00Z", "--stop", "2018-01-22T08:00:00Z")


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """One page of each kind, from small jobs."""
    folder = tmp_path_factory.mktemp("pages")

    def umov(*arguments):
        done = subprocess.run([UMOV, *map(str, arguments)], cwd=folder, text=True, capture_output=True, timeout=300)
        assert done.returncode == 0, (arguments, done.stderr)

    example = ROOT / "examples/hst_maui.toml"
    umov("run", example, "--set", "time.step_s=20", "--set", "output.dir=run", "-q")
    umov("passes", "--orbit", ROOT / "data/tle/hst.tle", "-s", "maui", *DAY, "--chart", "chart.html", "-o", "p.csv")
    umov("passes", "--orbit", ROOT / "tests/data/tle/mixed_979_2018-01-20.tle", "-s", "kitt peak", "--start", "2018-01-21T00:00:00Z", "--stop",
         "2018-01-21T06:00:00Z", "--visible", "--model", "sphere", "--material", "aluminium", "--chart", "crowd.html", "-o", "c.csv", "-q")
    umov("material", "plot", "gold", "paint_white", "-o", "material.html")
    umov("observe", ROOT / "examples/observe_hst.toml", "--set", "output.dir=observe", "--set", "time.start=2018-01-21T05:09:16Z", "--set", "time.stop=2018-01-21T05:09:30Z",
         "--set", 'output.formats=["ecsv","html"]', "-q")
    umov("reduce", "observe/counts.ecsv", "-o", "s.ecsv", "--page", "reduce.html", "-q")
    umov("exposure", "--instrument", "c11_imx250", "--band", "Bessell.V", "--page", "exposure.html", "-o", "e.csv", "-q")
    (folder / "sine.csv").write_text("mjd_utc,mag\n" + "\n".join(f"{60000 + t / 86400:.9f},{8 + math.sin(t / 2):.4f}" for t in range(200)) + "\n")
    umov("period", "sine.csv", "--page", "period.html", "-o", "period.csv", "-q")
    umov("mesh", "make", "chamfered-cube", "-o", "cube.obj")
    cube = f'object.0.mesh={{file="{folder}/cube.obj",unit="m",up="+Z"}}'
    umov("run", example, "--set", cube, "--set", 'object.0.materials={default="cell_gaas"}', "--set", "time.step_s=20",
         "--set", "output.dir=cube", "-q")
    umov("run", example, "--set", cube, "--set", 'object.0.materials={default="cell_gaas"}', "--set", "time.step_s=20", "--set", "bands.set=nm:550",
         "--set", "time.only={alt_min_deg=10,sun_alt_max_deg=-6,sunlit=false}", "--set", "output.dir=tracks", "-q")  # in the shadow too: whole passes
    umov("run", "run/scenario.lock.toml", "--set", "time.start=2018-01-21T05:09:30Z", "--set", "time.stop=2018-01-21T05:13:20Z", "--set", "time.step_s=20", "--set",
         "output.dir=short", "-q")  # not a round number of minutes
    umov("invert", "pose", "cube/lightcurve.ecsv", "--scenario", "cube/scenario.lock.toml", "-o", "invert", "--grid", 2000, "-q")
    drift = ("cube/lightcurve.ecsv", "--scenario", "cube/scenario.lock.toml", "-q")
    group = next(line.split()[1] for line in (folder / "cube.obj").read_text().splitlines() if line.startswith("usemtl"))
    umov("invert", "material", *drift, "-o", "mixture", "--group", group, "--candidates", "cell_gaas,paint_white,mli_kapton")
    umov("invert", "health", *drift, "-o", "health", "--drift", f"{group}=paint_white", "--drift", f"{group}=mli_kapton")
    umov("invert", "plan", "--scenario", "cube/scenario.lock.toml", *DAY, "-q", "-o", "plan", "--alternative", "cells", "--alternative",
         f"painted:object.0.materials.{group}=paint_white")
    umov("paper", "--only", "fig2", "-o", "paper", "-q")
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    one = Browser(tmp_path_factory.mktemp("profile"))
    yield one
    one.close()


def empty_traces(figure):
    """Traces that have something inside their axes and draw nothing, by name."""
    return [trace["name"] for trace in figure["traces"]
            if trace["visible"] and trace["type"] in ("scatter", "scatterpolar") and trace["paths"] == 0
            and (trace["inside"] if trace["inside"] is not None else trace["values"])]


def is_drawn(figure):
    """Something of it is seen: paths, or the canvas of a figure in space."""
    shown = [trace for trace in figure["traces"] if trace["visible"]]
    return figure["height"] > 100 and not figure["note"] and (
        sum(trace["paths"] for trace in shown) > 0 or figure["canvases"] > 0 and any(trace["values"] for trace in shown))


KINDS = {  # page: figures that it must have, marks of its sky chart
    "run/report.html": ({"Brightness against time", "q and u against time", "Degree and angle of linear polarization", "q-u plane",
                         "Q against phase angle", "Track in the sky"}, 0),
    "short/report.html": ({"Brightness against time"}, 0),
    "chart.html": (set(), 10),
    "material.html": (set(), 0),
    "observe/report.html": ({"Counts in the aperture"}, 0),
    "reduce.html": ({"Polarization", "Brightness"}, 0),
    "exposure.html": ({"Error of p", "Signal to noise", "How long until p is known", "What makes the error of p"}, 0),
    "period.html": ({"Brightness", "How it repeats: a sine of each period"}, 0),
    "invert/report.html": ({"Brightness: measured and fitted", "Brightness left over", "Errors of the heaviest attitude: about +X and +Y"}, 0),
    "mixture/report.html": ({"Brightness: measured and fitted", "What each band and Stokes component says by itself"}, 0),
    "health/report.html": ({"Brightness left over", "Polarization: measured and fitted"}, 0),
    "plan/report.html": ({"What each pass tells", "The two that are most alike", "Best pass: brightness in 550 nm", "Best pass: polarization in 550 nm"}, 0),
    "paper/index.html": (set(), 0),
}


@pytest.mark.parametrize("name", KINDS)
def test_figures_are_drawn_and_nothing_scrolls_sideways(pages, browser, name):
    """On a phone, and once the window is wide."""
    titles, marks = KINDS[name]
    assert (pages / name).exists()
    with browser.opened(pages / name, width=390) as tab:
        for width in (390, 1400):
            seen = tab.seen(width)
            assert seen["complaints"] == [] and seen["failure"] == ""
            assert [url for url in seen["requests"] if not url.startswith(("data:", "blob:"))] == [(pages / name).as_uri()]
            assert titles <= {figure["title"] for figure in seen["figures"]} and (seen["figures"] or marks)
            for figure in seen["figures"]:
                assert is_drawn(figure) and empty_traces(figure) == [] and figure["cut"] == [] and figure["twice"] == [], (figure["title"], figure["cut"], figure["twice"])
            assert seen["svg"] >= marks and (not marks or seen["rows"] > 0)
            assert seen["sideways"] == 0, seen["wide"]


@pytest.mark.parametrize("name, begin", [("invert/report.html", "undetermined: "), ("mixture/report.html", "determined: "),
                                         ("health/report.html", "determined: "), ("plan/report.html", "determined: "),
                                         ("exposure.html", "One exposure of ")])
def test_an_answer_stands_before_the_figures(pages, browser, name, begin):
    with browser.opened(pages / name) as tab:
        said = value_of(tab, '(document.getElementById("lead").hidden ? "" : document.getElementById("lead").textContent)')
        assert said.startswith(begin) and said not in value_of(tab, 'document.getElementById("notes").textContent')


def test_a_figure_that_fails_is_found(pages, browser):
    """The slip of November 2026, put back: rows without limits were asked for them, and q, u and p came out empty."""
    text = (pages / "run/report.html").read_text()
    guard = "row.isLimit ? row.isLimit(band, i) : false"
    assert guard in text
    (pages / "slip.html").write_text(text.replace(guard, "row.isLimit(band, i)").replace("at: (i) => row.isLimit &&", "at: (i) => row.span &&"))
    with browser.opened(pages / "slip.html") as tab:
        assert "q and u against time" in {figure["title"] for figure in tab.seen()["figures"] if not is_drawn(figure)}


def value_of(tab, expression):
    found = tab.ask("Runtime.evaluate", expression=f"JSON.stringify({expression})")
    assert "exceptionDetails" not in found, found
    return json.loads(found["result"]["value"])


def test_a_figure_as_wide_as_the_window_fits_on_paper(pages, browser):
    """What a browser says before and after it prints; A4 within margins of 12 mm has 703 px, and a card its padding."""
    widths = '[...document.querySelectorAll(".plot")].map((plot) => plot._fullLayout.width)'
    heights = widths.replace("width", "height")
    with browser.opened(pages / "paper/index.html") as tab:
        tab.seen(1400)
        before, tall = value_of(tab, widths), value_of(tab, heights)
        assert before and min(before) > 1000
        assert max(value_of(tab, f'(window.dispatchEvent(new Event("beforeprint")), {widths})')) <= 660
        assert max(value_of(tab, heights)) <= max(640, *tall)  # figures in space stay as high as they are
        assert value_of(tab, f'(window.dispatchEvent(new Event("afterprint")), {widths})') == before
        assert value_of(tab, heights) == tall


@pytest.mark.parametrize("width", [1400, 390])
def test_letters_of_the_sky_do_not_cover_each_other(pages, browser, width):
    """Passes of HST that set where each other does: their times, the names of directions and the altitudes."""
    with browser.opened(pages / "tracks/report.html", width) as tab:
        tab.seen()
        texts = value_of(tab, '''[...document.querySelectorAll("#sky .textpoint text, #sky .angularaxistick text, #sky .radial-axis text")]
            .map((one) => { const box = one.getBoundingClientRect(); return [one.textContent.trim(), box.left, box.top, box.right, box.bottom]; })
            .filter(([text]) => text)''')
    assert {"N", "E", "60°"} < {text for text, *_ in texts} and sum(":" in text for text, *_ in texts) >= (8 if width > 1000 else 2), texts
    assert not [(a[0], b[0]) for k, a in enumerate(texts) for b in texts[:k]
                if a[1] < b[3] and b[1] < a[3] and a[2] < b[4] and b[2] < a[4]]


@pytest.mark.parametrize("width", [1400, 390])
def test_a_crowded_sky_names_its_best_and_cuts_no_column(pages, browser, width):
    """Hundreds of tracks of two days, names as long as 24 letters: everywhere a label is over some track."""
    with browser.opened(pages / "crowd.html", width) as tab:
        tab.seen()
        rows, labels, wide = value_of(tab, """(() => { const list = document.getElementById("list"); return [document.querySelectorAll("tbody tr").length,
            [...document.querySelectorAll("#sky g[pointer-events=none] text")].map((one) => one.textContent), list.scrollWidth - list.clientWidth]; })()""")
    assert rows > 200 and len(labels) >= 3 and wide == 0, (rows, labels, wide)


def test_heads_of_a_table_are_no_buttons_on_paper(pages, browser):
    """A head comes again on each sheet, where Chromium leaves buttons blank."""
    buttons = 'document.querySelectorAll("thead button").length'
    with browser.opened(pages / "crowd.html") as tab:
        tab.seen()
        before = value_of(tab, buttons)
        assert before and value_of(tab, f'(window.dispatchEvent(new Event("beforeprint")), {buttons})') == 0
        assert value_of(tab, f'(window.dispatchEvent(new Event("afterprint")), {buttons})') == before


def test_a_track_without_magnitudes_is_told_by_its_time_on_a_phone(pages, browser):
    with browser.opened(pages / "chart.html", 390) as tab:
        tab.seen()
        labels = value_of(tab, '[...document.querySelectorAll("#sky g[pointer-events=none] text")].map((one) => one.textContent)')
    assert labels and all(label.startswith("HST, ") and label.count(":") == 2 for label in labels), labels


def test_what_hardly_moves_has_a_ring_and_no_arrow(pages, browser):
    """GOES 15, which stays within .2 deg, a five-hundredth of a chart's radius: a dot of a pixel or two without the ring."""
    with browser.opened(pages / "crowd.html") as tab:
        tab.seen()
        rings, tracks = value_of(tab, """[document.querySelectorAll("#sky g[data-track] circle").length,
            [...document.querySelectorAll("#sky g[data-track]")].filter((one) => [...one.querySelectorAll("path")].every((path) => Math.hypot(path.getBoundingClientRect().width, path.getBoundingClientRect().height) < 5)
                && !one.querySelector("circle")).length]""")
    assert rings >= 1 and tracks == 0, (rings, tracks)


def test_marks_of_points_are_seen_in_a_legend(pages, browser):
    """Thousands of points are 2.5 px wide, and lines beside them keep their dashes; 5 px is the least that shows a sign."""
    widths = """[...document.querySelectorAll(".plot .legendpoints path")].map((one) => one.getBoundingClientRect().width)"""
    with browser.opened(pages / "reduce.html") as tab:
        tab.seen()
        assert min(value_of(tab, widths)) >= 5


def test_a_material_has_one_colour_in_all_figures(pages, browser):
    """But for yellow, of which lines are olive."""
    colours = """["contribution", "q_rgb"].map((id) => Object.fromEntries(document.getElementById(id)._fullData.filter((one) => one.showlegend && one.name !== "glint")
        .map((one) => [one.name, one.fillcolor || one.line.color])))"""
    with browser.opened(pages / "run/report.html") as tab:
        tab.seen()
        areas, lines = value_of(tab, colours)
    both = areas.keys() & lines.keys()
    assert len(both) >= 5 and {name: areas[name].replace("#f0e442", "#857a00") for name in both} == {name: lines[name] for name in both}, (areas, lines)


@pytest.mark.parametrize("is_paper", [False, True])
def test_a_colour_bar_is_clear_of_the_axis_above_it(pages, browser, is_paper):
    boxes = """[".xtitle", ".cbtitle"].map((name) => { const box = document.querySelector("#qu_plane " + name).getBoundingClientRect();
        return [box.top, box.bottom]; })"""
    with browser.opened(pages / "run/report.html") as tab:
        tab.seen(1400)
        axis, bar = value_of(tab, f'({"window.dispatchEvent(new Event(`beforeprint`))" if is_paper else 0}, {boxes})')
    assert axis[1] > axis[0] and bar[0] > axis[1], (axis, bar)


def test_errors_of_an_angle_do_not_jump_where_it_goes_round(pages, browser):
    """HST's position angle goes through 0: no outline crosses the figure. Errors reach 90 deg at most."""
    with browser.opened(pages / "run/report.html") as tab:
        tab.seen(1400)
        outlines = value_of(tab, 'document.getElementById("p_pa")._fullData.filter((one) => one.fill === "toself" && one.yaxis === "y2").map((one) => [...one.y])')
        angles = value_of(tab, 'document.getElementById("p_pa")._fullData.filter((one) => one.mode !== "lines" && one.yaxis === "y2").map((one) => [...one.y])')
    assert any(a is None for line in angles for a in line), "it goes round"
    for outline in outlines:
        parts, part = [], []
        for value in [*outline, None]:
            if value is None:
                parts.append(part)
                part = []
            else:
                part.append(value)
        for part in filter(None, parts):
            half = len(part) // 2  # there along the lower bounds, back along the upper ones
            assert all(abs(b - a) < 90 for side in (part[:half], part[half:]) for a, b in zip(side, side[1:])), part


def test_colours_of_the_phase_angle_are_seen_on_a_dark_page(pages, browser):
    """3:1 against the card, which WCAG 2.2 (1.4.11) asks of graphics."""
    def luminance(text):
        parts = [int(text[k:k + 2], 16) / 255 for k in (1, 3, 5)]
        return sum(share * (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4) for share, x in zip((0.2126, 0.7152, 0.0722), parts))
    with browser.opened(pages / "run/report.html", dark=True) as tab:
        tab.seen(1400)
        card, scale = value_of(tab, '(({ paper_bgcolor, coloraxis }) => [paper_bgcolor, coloraxis.colorscale.map((one) => one[1])])'
                                    '(document.getElementById("qu_plane")._fullLayout)')
    assert all((luminance(colour) + 0.05) / (luminance(card) + 0.05) > 3 for colour in scale), (card, scale)


def test_marks_of_a_logarithmic_axis_are_whole_numbers_by_themselves(pages, browser):
    with browser.opened(pages / "period.html") as tab:
        tab.seen(1400)
        marks = value_of(tab, """[...document.querySelectorAll(".card")].filter((card) => card.textContent.startsWith("How it repeats")).map((card) =>
            [...card.querySelectorAll(".xaxislayer-above .xtick text")].map((one) => [one.getBoundingClientRect().left, Number(one.textContent)]))[0]""")
    values = [value for _, value in sorted(marks)]
    assert len(values) >= 3 and values == sorted(set(values)), values


def test_light_that_fades_out_leaves_the_rest_tall(pages, browser):
    """As the lit side turns away light falls by dozens of decades, of which five are drawn."""
    with browser.opened(pages / "plan/report.html") as tab:
        tab.seen(1400)
        ranges = value_of(tab, """[...document.querySelectorAll(".plot")].filter((plot) => plot.parentElement.querySelector("h2")
                                      .textContent.startsWith("Best pass: brightness")).map((plot) => plot._fullLayout.yaxis.range)""")
        assert len(ranges) == 3 and all(0 < top - bottom < 5.5 for bottom, top in ranges), ranges


def test_the_cursor_moves_through_all_figures_and_pictures(pages, browser):
    """The pointer over the first figure: a line stands in the others, and the picture nearest in time is framed."""
    with browser.opened(pages / "run/report.html") as tab:
        tab.seen(1400)
        x, y = value_of(tab, """(() => {
            const box = document.querySelector("#brightness .nsewdrag").getBoundingClientRect();
            return [box.left + box.width / 2, box.top + box.height / 2]; })()""")
        for step in range(3):
            tab.ask("Input.dispatchMouseEvent", type="mouseMoved", x=x + step, y=y)
        shown = """(() => [[...document.querySelectorAll(".cursor")].filter((line) => !line.hidden).length,
                           document.querySelectorAll(".frame.near").length])()"""
        deadline = time.monotonic() + 20
        while value_of(tab, shown) == [0, 0] and time.monotonic() < deadline:
            time.sleep(0.1)
        lines, framed = value_of(tab, shown)
        assert lines >= 4 and framed == 1, (lines, framed)


def test_a_figure_that_is_saved_is_light_and_says_what_it_is(pages, browser):
    with browser.opened(pages / "run/report.html", dark=True) as tab:
        tab.seen(1400)
        saved = value_of(tab, """(() => {
            document.documentElement.dataset.theme = "dark";
            let seen = null;
            Plotly.downloadImage = (figure, options) => { seen = { ground: figure.layout.paper_bgcolor, title: figure.layout.title.text, ...options }; };
            document.querySelector("#brightness").parentElement.querySelector('button[title="Save as PNG"]').click();
            return seen; })()""")
        assert saved["ground"] == "#ffffff" and saved["format"] == "png" and saved["filename"] == "HST_brightness_mag"
        assert saved["title"] == "HST: brightness against time"
