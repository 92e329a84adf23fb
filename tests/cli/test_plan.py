"""umov invert plan: which observations would tell alternatives apart. Expected numbers are made here with numpy from light.ecsv:
normal data of one alternative against another, whose scale (almost free) and zero points (2 %) stand in the covariance."""
import json
import math

import numpy as np
import pytest
from astropy.table import Table

from conftest import ROOT

HST = ROOT / "examples/hst_maui.toml"
SHORT = ("--set", "time.step_s=40", "--visibility", "masks")
PAIR = ("--alternative", "new", "--alternative", "painted:object.materials.array_back=paint_white")


@pytest.fixture
def plan(umov, tmp_path):
    def run(*words, alternatives=PAIR):
        done = umov("invert", "plan", "--scenario", HST, *SHORT, *alternatives, "-o", "plan", "--force", "--json", *words)
        assert done.code == 0, done.err
        return json.loads(done.out), {name: Table.read(tmp_path / f"plan/{name}.ecsv")
                                      for name in ("plan", "choices", "pairs", "sequence", "light")}

    return run


def log_density(residual, columns, variance, sds):
    """ln of the normal density of a residual with C = diag(variance) + sum sd^2 column column^T, without n/2 ln 2 pi."""
    covariance = np.diag(variance) + sum(sd**2 * np.outer(c, c) for sd, c in zip(sds, columns))
    return -0.5 * residual @ np.linalg.solve(covariance, residual) - 0.5 * np.linalg.slogdet(covariance)[1]


def expected_ln_bayes(light, pass_id, truth, other, floor=0.02, floor_median=0.01, zero_point=0.02, polarization=True):
    """Equations 3, 4 and 11 anew: zero points as a covariance, as wide as the scale without them says, the scale (log-flat)
    integrated on a grid."""
    rows = light[light["pass_id"] == pass_id]
    data, model = rows[rows["alternative"] == truth], rows[rows["alternative"] == other]
    i, m = np.array(data["intensity"]), np.array(model["intensity"])
    variance = np.array(data["intensity_err"])**2 + (floor * i)**2 + (floor_median * np.sort(i)[len(i) // 2])**2
    bands = [np.array(data["band"] == b, float) for b in dict.fromkeys(data["band"])]
    value = {}
    for name, light_of in (("own", i), ("other", m)):
        first = (i * light_of / variance).sum() / (light_of**2 / variance).sum()

        def ln(scale, light_of=light_of, first=first):
            return log_density(i - scale * light_of, [first * light_of * b for b in bands], variance,
                               [zero_point] * len(bands))

        steps = np.linspace(math.log(0.02), math.log(50), 4001)
        values = np.array([ln(math.exp(x)) for x in steps[::40]])
        middle = steps[::40][values.argmax()]
        near = np.linspace(middle - 0.12, middle + 0.12, 481)
        values = np.array([ln(math.exp(x)) for x in near])
        top = values.max()
        value[name] = top + math.log(np.exp(values - top).sum() * (near[1] - near[0]))
        if polarization:
            q = np.array(data["q_scat"]) - np.array(rows[rows["alternative"] == (truth if name == "own" else other)]["q_scat"])
            u = np.array(data["u_scat"]) - np.array(rows[rows["alternative"] == (truth if name == "own" else other)]["u_scat"])
            error = np.array(data["q_err"])**2 + (floor / 2)**2
            known = np.isfinite(error)
            value[name] -= 0.5 * ((q**2 + u**2) / error)[known].sum()
    return value["own"] - value["other"]


def test_expected_bayes_factors_are_those_of_normal_data(plan):
    _, tables = plan("--snr", "30")
    light, checked = tables["light"], 0
    for row in tables["pairs"]:
        if row["pass_id"] != tables["plan"]["pass_id"][0]:
            continue
        for column, polarization in (("ln_bayes", True), ("ln_bayes_i", False)):
            expected = expected_ln_bayes(light, row["pass_id"], row["true"], row["other"], polarization=polarization)
            # The fit integrates over the scale by its curvature, here it is a grid: some hundredths.
            assert row[column] == pytest.approx(expected, abs=0.1, rel=1e-4)
            checked += 1
    assert checked == 4


def test_numbers_of_two_alternatives_follow_from_their_bayes_factors(plan):
    verdict, tables = plan("--snr", "5", "--floor", "0.2")
    for row in tables["plan"]:
        pairs = [p["ln_bayes"] for p in tables["pairs"] if p["pass_id"] == row["pass_id"]]
        phi = lambda x: 0.5 * math.erfc(-x / math.sqrt(2))  # noqa: E731
        sure = np.mean([phi((d - math.log(19)) / math.sqrt(2 * d)) if d > 0 else 0 for d in pairs])
        assert row["decided"] == pytest.approx(sure, abs=0.005)  # a step on 1601 points
        assert row["ln_bayes"] == pytest.approx(min(pairs))
        assert 0 <= row["information"] <= 1
        assert row["polarization_adds"] == pytest.approx(row["information"] - row["information_i"])
    ranks = list(tables["plan"]["information"])
    assert ranks == sorted(ranks, reverse=True) or max(np.diff(ranks)) < 2e-3
    assert verdict["alternatives"] == ["new", "painted"]
    assert tables["sequence"]["decided"][-1] >= tables["plan"]["decided"][0] - 1e-9
    bands = set(tables["choices"]["bands"])
    assert bands == {"all", *verdict["bands"]} and len(tables["choices"]) == 2 * len(bands) * len(tables["plan"])


def test_better_data_tell_more_and_alike_alternatives_nothing(plan):
    _, poor = plan("--snr", "3", "--floor", "0.3")
    _, good = plan("--snr", "100")
    assert max(good["plan"]["ln_bayes"]) > 5 * max(poor["plan"]["ln_bayes"])
    verdict, same = plan(alternatives=("--alternative", "a", "--alternative", "b"))
    assert verdict["verdict"] == "undetermined" and max(same["plan"]["information"]) == pytest.approx(0, abs=1e-9)
    assert any("stay alike" in note for note in verdict["notes"])


def test_a_known_brightness_tells_sizes_apart(umov, plan, tmp_path):
    """The same shape three per cent larger: only where brightness is known."""
    assert umov("mesh", "make", "cubesat", "-o", "small.obj", "-q").code == 0
    lines = (tmp_path / "small.obj").read_text().splitlines()
    (tmp_path / "large.obj").write_text("\n".join(
        "v " + " ".join(str(float(x) * 1.5) for x in line.split()[1:4]) if line.startswith("v ") else line for line in lines) + "\n")
    shape = 'object.mesh={{file="{}",unit="m",up="+Z"}}'
    cubes = [word for name in ("small", "large") for key in (shape.format(tmp_path / f"{name}.obj"), 'object.materials={default="paint_white"}')
             for word in ("--alternative", f"{name}:{key}")]
    free, _ = plan(alternatives=cubes)
    known, _ = plan("--scale-sd", "0.05", alternatives=cubes)
    assert free["verdict"] == "undetermined" and known["verdict"] == "determined"


def test_an_instrument_makes_the_noise(umov, plan, tmp_path):
    """The errors are those that umov reduce finds in the counts of umov observe, another text."""
    frames = ("--set", 'instrument="c11_imx250"', "--set", "observation.exposure_s=0.05")
    verdict, tables = plan(*frames)
    assert "exposures of 0.05 s" in verdict["noise"]
    assert umov("observe", HST, *frames, "--set", "time.step_s=40", "--set", "observation.cadence_s=40", "--set", "output.dir=obs",
                "--set", 'output.formats=["ecsv"]', "-q").code == 0
    assert umov("reduce", "obs/counts.ecsv", "-o", "stokes.ecsv", "-q").code == 0
    planned = {(str(r["time_utc"])[:19], r["band"]): r for r in tables["light"] if r["alternative"] == "new"}
    compared = 0
    for row in Table.read(tmp_path / "stokes.ecsv"):
        mine = planned.get((str(row["time_utc"])[:19], row["band"]))
        if mine is None or not np.isfinite(mine["q_err"]) or not np.isfinite(row["cov_qq"]):
            continue
        # Scintillation makes most of the first; the second is for an aperture of one width, the frames' is of two.
        assert mine["intensity_err"] / mine["intensity"] == pytest.approx(row["I_err"] / row["I"], rel=0.02)
        assert mine["q_err"] == pytest.approx(math.sqrt(row["cov_qq"]), rel=0.35)
        compared += 1
    assert compared >= 3
    _, dark = plan(*frames, "--sky-mag", "5")
    both = np.isfinite(tables["light"]["intensity_err"]) & np.isfinite(dark["light"]["intensity_err"])
    assert (dark["light"]["intensity_err"][both] > tables["light"]["intensity_err"][both]).all()


@pytest.mark.parametrize(("words", "told"), [
    (("--alternative", "new"), ["1 alternative", "two or more"]),
    (("--alternative", "a", "--alternative", "a"), ["a is named already"]),
    (("--alternative", "a", "--alternative", "b:gold"), ["b:gold", "NAME:KEY=VALUE"]),
    (("--alternative", "a", "--alternative", "object.materials.array_front=gold"), ["NAME:KEY=VALUE"]),
    (("--alternative", "a", "--alternative", "b:object.material.x=gold"), ["material"]),
    (("--alternative", "a", "--alternative", "b:nowhere.toml"), ["nowhere.toml"]),
    (("--alternative", "a", "--alternative", "b:object.materials.array_front=gould"), ["gould"])])
def test_bad_alternatives_are_told(umov, words, told):
    done = umov("invert", "plan", "--scenario", HST, *SHORT, *words)
    assert done.code in (2, 3) and all(text in done.err for text in told), done.err


def test_a_span_without_a_pass_names_the_next_one(umov):
    done = umov("invert", "plan", "--scenario", HST, *SHORT, *PAIR, "--start", "2018-01-20T20:00:00Z", "--stop", "2018-01-20T20:30:00Z")
    assert done.code != 0 and "next pass is near 2018-01-2" in done.err


def modes_text(rows, epoch=None):
    """A table of modes as umov invert writes one, with rates [deg/s] where an epoch is given."""
    size = "xyz" if epoch is None else ("x", "y", "z", "wx", "wy", "wz")
    pairs = [f"cov_{a}{b}" for k, a in enumerate(size) for b in size[k:]]
    names = ["weight", "qw", "qx", "qy", "qz", *(["rate_x", "rate_y", "rate_z"] if epoch else []), *pairs]
    diagonal = [1e-6 if name[4:len(name) // 2 + 2] == name[len(name) // 2 + 2:] else 0 for name in pairs]
    lines = [",".join(str(x) for x in [*row, *diagonal]) for row in rows]
    return "\n".join([*([f"# epoch_utc: {epoch}"] if epoch else []), ",".join(names), *lines]) + "\n"


@pytest.mark.parametrize("epoch", [None, "2018-01-21T05:08:00Z"])
def test_modes_of_an_answer_are_alternatives(umov, tmp_path, epoch):
    """As if each were named with its attitude, or its spin about an axis of the body; below 1 % none is."""
    q = [[0.5, 0.5, -0.5, 0.5], [0.8, 0.0, 0.6, 0.0], [0.1, 0.7, 0.7, 0.1]]
    rate = [[0, 0, 0.3], [0.2, 0, 0]]
    rows = [[w, *q[k], *(rate[k % 2] if epoch else [])] for k, w in enumerate((0.6, 0.395, 0.005))]
    (tmp_path / "modes.csv").write_text(modes_text(rows, epoch))
    laws = []
    for k in range(2):
        still = f'{{mode="inertial",quaternion={q[k]}}}'
        axis, turn = ("+Z", 0.3) if k == 0 else ("+X", 0.2)
        laws.append(still if epoch is None else f'{{mode="spin",axis="{axis}",rate_deg_s={turn},epoch={epoch},start={still}}}')
    named = [word for k, law in enumerate(laws) for word in ("--alternative", f"mode {k + 1}:object.attitude={law}")]
    light = []
    for words in (("--modes", "modes.csv"), named):
        done = umov("invert", "plan", "--scenario", HST, *SHORT, *words, "-o", "plan", "--force", "--json")
        assert done.code in (0, 4), done.err
        assert json.loads(done.out)["alternatives"] == ["mode 1", "mode 2"]
        light.append(Table.read(tmp_path / "plan/light.ecsv"))
    for column in ("alternative", "time_utc", "band"):
        assert list(light[0][column]) == list(light[1][column])
    for column in light[0].columns:
        if light[0][column].dtype.kind == "f":
            assert np.asarray(light[0][column]) == pytest.approx(np.asarray(light[1][column]), rel=1e-9, abs=1e-18, nan_ok=True)


def test_modes_that_leave_nothing_open_are_refused(umov, tmp_path):
    (tmp_path / "modes.csv").write_text(modes_text([[1, 1, 0, 0, 0]]))
    done = umov("invert", "plan", "--scenario", HST, *SHORT, "--modes", "modes.csv")
    assert done.code == 3 and "modes.csv: 1 mode above 1 % of the probability: nothing is left to decide" in done.err
    text = modes_text([[1, 1, 0, 0, 0, 0, 0, 1], [1, 0, 1, 0, 0, 0, 0, 1]], "2018-01-21T05:08:00Z")
    (tmp_path / "modes.csv").write_text(text.split("\n", 1)[1])
    done = umov("invert", "plan", "--scenario", HST, *SHORT, "--modes", "modes.csv")
    assert done.code == 3 and "no epoch_utc" in done.err
