"""What the questions back from a light curve say where it cannot tell: constant light, one epoch, no numbers, times that
contradict, an object that cannot make the data. Curves are made by this program or by rays with its noise; what must not be
said is known from how they were made."""
import json
import random

import pytest
from astropy.table import Table

from test_identify import library  # noqa: F401
from test_invert import CUBESAT, KNOWN, TRUTHS, constant, observe, scene  # noqa: F401

PART = ("--group", "body_my", "--candidates", "paint_white,mli_kapton,cell_gaas")
DRIFTS = ("--drift", "body_my=paint_black", "--drift", "panel_px_front=paint_white")
TURN = ("--axis", "z", "--period", "60", "--no-aliases")
QUESTIONS = {"pose": ("--grid", "10000"), "spin": TURN, "material": PART, "health": DRIFTS}


@pytest.fixture
def ask(umov, scene, tmp_path):
    """ask(question, file, ...): the verdict of fit.toml, the attitude TRUTHS[0]; JSON without inf or nan."""
    scene(TRUTHS[0], "masks", "fit")

    def run(question, file, *words, code=(0, 4)):
        done = umov("invert", question, file, "--scenario", "fit.toml", "--json", *QUESTIONS[question], *words)
        assert done.code in code, done.err
        verdict = json.loads(done.out, parse_constant=lambda name: pytest.fail(f"{name} in JSON"))
        assert (verdict["verdict"] == "no_fit") == (done.code == 4)
        return verdict

    return run


def good(umov, scene, folder, seed=1):
    """A curve of the cubesat in its attitude, S/N 50; lines of good.csv."""
    assert umov("run", scene(TRUTHS[0], "rays", "truth"), "-q").code == 0
    observe(folder, "good.csv", 50, seed)
    return (folder / "good.csv").read_text().splitlines()


def flat(path, with_errors):
    """Brightness 1 at the observer at all times."""
    rows = [f"2018-01-21T05:{8 + k // 5:02d}:{12 * (k % 5):02d}Z,{b},1" + (",0.05" if with_errors else "")
            for k in range(30) for b in ("nm:425", "nm:550", "nm:650")]
    path.write_text("time_utc,band,flux" + (",flux_err" if with_errors else "") + "\n" + "\n".join(rows) + "\n")


@pytest.mark.parametrize("question", [pytest.param(q, marks={"pose": [pytest.mark.long], "spin": [pytest.mark.slow]}.get(q, [])) for q in QUESTIONS])
def test_constant_light_determines_nothing(ask, tmp_path, question):
    for seed, snr in enumerate((3, 20)):
        constant(tmp_path / "obs.csv", snr, seed)
        assert ask(question, "obs.csv")["verdict"] != "determined"
    flat(tmp_path / "obs.csv", with_errors=False)  # errors are the floor's
    found = ask(question, "obs.csv")
    assert found["verdict"] in ("undetermined", "no_fit")
    assert any("does not change by more than its errors" in note for note in found["notes"])


@pytest.mark.slow
def test_constant_light_tells_no_period(umov, scene, ask, tmp_path):
    """A periodogram has a highest peak always; 341 s with 100 % was once the answer here."""
    flat(tmp_path / "obs.csv", with_errors=True)
    done = umov("invert", "spin", "obs.csv", "--scenario", "fit.toml", "--no-aliases", "--axis", "z")
    assert done.code in (0, 4), done.err
    assert "the period is not known" in done.out or "no period explains" in done.out
    assert "no turn shows in it" in done.out or done.code == 4


@pytest.mark.slow
def test_a_body_at_rest_has_no_period(umov, scene, ask, tmp_path):
    good(umov, scene, tmp_path)
    found = ask("spin", "good.csv")
    assert found["verdict"] in ("undetermined", "no_fit")
    assert any("a body that does not turn explains the data as well" in note for note in found["notes"])


def test_one_epoch_of_a_part(umov, scene, ask, tmp_path):
    lines = good(umov, scene, tmp_path)
    for first in (2, 47):  # the sides that are lit are turned away at first
        (tmp_path / "one.csv").write_text("\n".join(lines[:2] + lines[first:first + 3]) + "\n")
        for question in ("material", "health"):
            found = ask(question, "one.csv")
            assert any("one epoch: colours and polarization alone" in note for note in found["notes"])
            assert found["verdict"] == "undetermined" or first == 47


def test_a_dark_side_tells_nothing_of_a_part(umov, scene, ask, tmp_path):
    lines = good(umov, scene, tmp_path)
    (tmp_path / "dark.csv").write_text("\n".join(lines[:8]) + "\n")  # noise about 0
    part = ask("material", "dark.csv", "-o", "part")
    assert part["verdict"] == "undetermined" and part["condition"] is None
    assert any("gives no light at these times" in note for note in part["notes"])
    assert all(row["fraction"] is None and row["detectable"] is None for row in part["materials"])
    health = ask("health", "dark.csv", "-o", "health")
    assert health["verdict"] == "undetermined" and health["chi2_without_change"] > 0
    assert not any(row["visible"] for row in health["health"])
    assert set(Table.read(tmp_path / "health/health.ecsv")["seen"]) == {"not visible"}
    # Nothing can be counted from a baseline that shows nothing.
    counted = ask("health", "good.csv", "--baseline", "dark.csv")
    assert counted["verdict"] == "undetermined" and not any(row["visible"] for row in counted["health"])


def wild(lines, seed):
    """Each epoch of another brightness and polarization: no single body makes it."""
    rng, factor, out = random.Random(seed), {}, lines[:2]
    for line in lines[2:]:
        cells = line.split(",")
        by = factor.setdefault(cells[0], 10**rng.gauss(0, 0.7))
        cells[2:4] = [str(float(x) * by) for x in cells[2:4]]
        if cells[4]:
            cells[4:6] = [f"{rng.uniform(-0.9, 0.9):.4f}" for _ in range(2)]
        out.append(",".join(cells))
    return "\n".join(out) + "\n"


@pytest.mark.slow
def test_data_that_no_such_object_makes(umov, scene, ask, tmp_path):
    (tmp_path / "wild.csv").write_text(wild(good(umov, scene, tmp_path), 3))
    for question in QUESTIONS:
        found = ask(question, "wild.csv", "-o", question)
        assert found["verdict"] == "no_fit" and len(found["notes"]) > 0
    assert set(Table.read(tmp_path / "health/health.ecsv")["seen"]) == {"no fit"}
    told = umov("invert", "pose", "wild.csv", "--scenario", "fit.toml", *QUESTIONS["pose"], *KNOWN)
    assert "nothing is known of the attitude" in told.out and "% of the probability" not in told.out
    based = ask("health", "good.csv", "--baseline", "wild.csv")
    assert based["verdict"] == "no_fit" and any("explains the baseline" in note for note in based["notes"])


@pytest.fixture
def blend(umov, scene, tmp_path):
    """blend(material, part): mixed.csv, light of the cubesat with a part of body_my's white paint of another material, as
    light adds up where surfaces do not light each other; exact to 0.5 %."""

    def make(material, part):
        curves = []
        for materials in (CUBESAT, CUBESAT.replace('body_my = "paint_white"', f'body_my = "{material}"')):
            assert umov("run", scene(TRUTHS[0], "rays", "truth", materials=materials), "-q").code == 0
            curves.append(Table.read(tmp_path / "truth/lightcurve.ecsv"))
        rows = ["time_utc,band,flux,flux_err"]
        for a, b in zip(*curves):
            light = ((1 - part) * a["I"] + part * b["I"]) * 1e12
            rows.append(f"{a['time_utc']},{a['band']},{light:.6g},{0.005 * light + 1e-9:.6g}")
        (tmp_path / "mixed.csv").write_text("\n".join(rows) + "\n")

    return make


def test_a_part_of_two_materials_is_not_the_nearer_one(blend, ask):
    blend("mli_kapton", 0.4)
    found = ask("material", "mixed.csv", "--floor", "0.01")
    assert found["verdict"] == "ambiguous"
    assert any("no candidate alone explains the data" in note for note in found["notes"])
    white = next(row for row in found["materials"] if "paint_white" in row["materials"])
    assert abs(white["fraction"] - 0.6) < max(0.05, 4 * white["fraction_err"])


def test_less_than_none_of_a_group_is_no_sure_change(blend, ask):
    """A side half as bright again as all of it can be: something else than the drift that was asked for."""
    blend("paint_black", -0.5)
    found = ask("health", "mixed.csv", "--floor", "0.01")
    row = found["health"][0]
    assert row["visible"] and abs(row["change"] + 0.5) < max(0.05, 4 * row["change_err"])
    assert found["verdict"] == "ambiguous" and any("cannot be" in note for note in found["notes"])


def test_every_question_refuses_what_is_no_curve(umov, scene, library, ask, tmp_path):
    lines = good(umov, scene, tmp_path)
    gap = [line if k < 2 else ",".join(line.split(",")[:2]) + ",nan,nan,,,," for k, line in enumerate(lines)]
    other = ",".join([*lines[2].split(",")[:2], "7", *lines[2].split(",")[3:]])
    cases = {"gap": (gap, "no row holds a measurement"), "twice": (lines[:3] + [other] + lines[3:], "twice.csv:4"),
             "night": ([line.replace("T05:", "T06:") for line in lines], "do times, orbit and site belong together?")}
    for name, (text, message) in cases.items():
        (tmp_path / f"{name}.csv").write_text("\n".join(text) + "\n")
        for question, words in QUESTIONS.items():
            done = umov("invert", question, f"{name}.csv", "--scenario", "fit.toml", *words)
            assert done.code == 3 and message in done.err, (name, question, done.err)
        done = umov("identify", f"{name}.csv", "--library", "lib", "--scenario", "place.toml")
        assert done.code == 3 and message in done.err, (name, done.err)


def test_a_plan_of_what_cannot_be_told(umov, scene, ask, tmp_path):
    assert umov("mesh", "make", "sphere", "--radius", "0.2", "--facets", "500", "-o", "ball.obj", "-q").code == 0
    ball = scene(TRUTHS[0], "masks", "ball", mesh="ball", materials='default = "paint_white"', step=60)
    turned = ("--alternative", "a", "--alternative", "b:object.attitude.quaternion=[0.6,0.8,0,0]")
    done = umov("invert", "plan", "--scenario", ball, *turned, "--json")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    assert told["verdict"] == "undetermined" and any("stay alike" in note for note in told["notes"])
    dark = umov("invert", "plan", "--scenario", "fit.toml", "--alternative", "a", "--alternative",
                "b:object.materials.body_px=paint_white", "--stop", "2018-01-21T05:08:30Z", "--json")
    assert dark.code == 0, dark.err
    told = json.loads(dark.out)
    assert told["verdict"] == "undetermined" and any("no alternative gives light" in note for note in told["notes"])
    later = umov("invert", "plan", "--scenario", "fit.toml", *turned, "--start", "2018-01-21T06:20:00Z", "--stop",
                 "2018-01-21T06:30:00Z")
    assert later.code != 0 and "the next pass is near" in later.err


@pytest.mark.parametrize("question", ["material", "health"])
def test_polarization_of_the_instrument_is_told(umov, scene, ask, tmp_path, question):
    """3 % along the altaz axes, some ten times its error from 120 numbers of u at S/N 50; none in the other curve."""
    head, names, *rows = good(umov, scene, tmp_path)
    polarized = [[*row.split(",")[:4], f"{float(row.split(',')[4]) + 0.03:.5f}", *row.split(",")[5:]] if row.split(",")[4] else row.split(",") for row in rows]
    (tmp_path / "polarized.csv").write_text("\n".join([head, names, *map(",".join, polarized)]) + "\n")
    clean, told = (ask(question, f"{name}.csv") for name in ("good", "polarized"))
    assert not clean["u_null_test"]["flagged"] and not any("polarization of the instrument" in note for note in clean["notes"])
    u = told["u_null_test"]
    assert u["flagged"] and any("polarization of the instrument" in note for note in told["notes"])
    if question == "health":
        based = ask(question, "good.csv", "--baseline", "polarized.csv")
        assert not based["u_null_test"]["flagged"] and any(note.startswith("the baseline: U of") for note in based["notes"])
    assert abs(u["q0"] - 0.03) < 4 * u["q0_sd"] and abs(u["u0"]) < 4 * u["u0_sd"]
