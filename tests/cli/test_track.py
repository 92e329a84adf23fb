"""umov invert track: attitudes that are followed. Data are by rays and noise is ours, as in test_invert.py; the start is an
answer of umov invert pose about the first half."""
import json
import shutil
import signal
import subprocess
import time

import pytest
from astropy.table import Table

from conftest import ROOT, UMOV, Outcome
from test_invert import CUBESAT, SCENE, apart, observe, spinning

KNOWN = ["--visibility", "masks", "--slope-sd", "0", "--reflectance-sd", "0", "--haze-sd", "0"]
TRUTH = [0.406, 0.396, -0.231, 0.791]  # whose first half tells it
TABLES = ("modes.ecsv", "track.ecsv", "fit.ecsv", "state.json", "verdict.json", "report.html")


def call(folder, *arguments):
    return Outcome(subprocess.run([UMOV, *map(str, arguments)], cwd=folder, text=True, capture_output=True, timeout=300))


def write_scene(folder, out, method, step, quaternion=TRUTH):
    norm = sum(x * x for x in quaternion) ** 0.5
    (folder / f"{out}.toml").write_text(SCENE.format(root=ROOT, q=[x / norm for x in quaternion], method=method, out=out, step=step,
                                                     mesh="cubesat", materials=CUBESAT))


def epochs_of(path):
    """Head and rows of each time of a CSV of observations."""
    lines = path.read_text().splitlines()
    epochs = {}
    for line in lines[2:]:
        epochs.setdefault(line.split(",")[0], []).append(line)
    return lines[:2], list(epochs.values())


def write_epochs(path, head, epochs):
    path.write_text("\n".join([*head, *(line for rows in epochs for line in rows)]) + "\n")


def make_halves(folder, snr=100):
    """obs.csv, its halves a.csv and b.csv, and b.csv in two: b1.csv, b2.csv."""
    observe(folder, "obs.csv", snr, 3)
    head, epochs = epochs_of(folder / "obs.csv")
    half, rest = len(epochs) // 2, len(epochs) * 3 // 4
    for name, some in (("a", epochs[:half]), ("b", epochs[half:]), ("b1", epochs[half:rest]), ("b2", epochs[rest:])):
        write_epochs(folder / f"{name}.csv", head, some)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with the halves, fit.toml and pose/, the answer about the first."""
    folder = tmp_path_factory.mktemp("track")
    assert call(folder, "mesh", "make", "cubesat", "--panels", "1", "-o", "cubesat.obj", "-q").code == 0
    write_scene(folder, "truth", "rays", 8)
    assert call(folder, "run", "truth.toml", "-q").code == 0
    make_halves(folder)
    write_scene(folder, "fit", "masks", 8, [1, 0, 0, 0])
    done = call(folder, "invert", "pose", "a.csv", "--scenario", "fit.toml", "--grid", "20000", *KNOWN, "-o", "pose")
    assert done.code == 0, done.err
    return folder


def track(folder, observations, *more, start="pose", out="answer"):
    return call(folder, "invert", "track", observations, "--scenario", "fit.toml", "--start", start, *KNOWN, "-o", out, *more)


def data(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


def test_a_fixed_body_is_followed_to_the_end(made):
    done = track(made, "b.csv", "--json")
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    start = json.loads((made / "pose/verdict.json").read_text())["verdict"]
    assert verdict["question"] == "track" and verdict["lost_utc"] is None and verdict["epochs_before"] == 0
    assert verdict["verdict"] == "determined" or start == "undetermined"
    best = verdict["modes"][0]
    assert apart(TRUTH, best["q"]) < 4 * best["sd_deg"]  # of three numbers
    assert apart(TRUTH, best["q"]) < 5
    assert all(abs(w) < 0.02 for w in best["rate_deg_s"])  # it stands still
    table = Table.read(made / "answer/track.ecsv")
    assert {"qw", "qx", "qy", "qz", "rate_x", "sd_x", "rate_sd_z", "cov_xy", "chi2", "measurements", "weight"} <= set(table.colnames)
    assert str(table["rate_x"].unit) == "deg / s" and str(table["cov_xx"].unit) == "rad2"
    for when in set(table["time_utc"]):
        assert sum(table["weight"][table["time_utc"] == when]) == pytest.approx(1, abs=1e-6)
    assert len(set(table["time_utc"])) == verdict["epochs"]
    modes = Table.read(made / "answer/modes.ecsv")
    assert {"mode", "weight", "qw", "rate_z", "sd", "scale", "cov_wzwz"} <= set(modes.colnames)
    assert modes.meta["epoch_utc"] == table["time_utc"][-1]
    for name in TABLES:
        assert (made / "answer" / name).exists(), name


def test_a_turning_body_is_followed_from_a_spin(made, tmp_path):
    shutil.copy(made / "cubesat.obj", tmp_path)
    write_scene(tmp_path, "truth", "rays", 4)
    text = (tmp_path / "truth.toml").read_text()
    turning = spinning(text, [9.0, 0.0, 0.0], 4)
    (tmp_path / "truth.toml").write_text(turning.replace("[0.5, 0.5, -0.5, 0.5]", "[0.6, 0.0, 0.8, 0.0]"))
    assert call(tmp_path, "run", "truth.toml", "-q").code == 0
    make_halves(tmp_path)
    write_scene(tmp_path, "fit", "masks", 4, [1, 0, 0, 0])
    done = call(tmp_path, "invert", "spin", "a.csv", "--scenario", "fit.toml", "--axis", "x", "--period", "40.3", *KNOWN, "-o", "spin")
    assert done.code == 0, done.err
    done = track(tmp_path, "b.csv", "--json", start="spin")
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    assert verdict["lost_utc"] is None
    best = verdict["modes"][0]
    assert abs(best["rate_deg_s"][0]) == pytest.approx(9, abs=0.1)  # 1 %: what a body with four alike sides may leave


def test_in_two_goes_it_is_the_same(made):
    assert track(made, "b.csv", out="whole").code == 0
    assert track(made, "b1.csv", out="one").code in (0, 4)
    assert track(made, "b2.csv", start="one", out="two").code == 0
    for name in ("modes.ecsv", "state.json"):
        assert (made / "two" / name).read_bytes() == (made / "whole" / name).read_bytes(), name
    assert data(made / "one/track.ecsv") + data(made / "two/track.ecsv")[1:] == data(made / "whole/track.ecsv")
    # All observations again: those of the start's time and before are left aside, and the answer says so.
    assert track(made, "obs.csv", start="one", out="again").code == 0
    assert (made / "again/state.json").read_bytes() == (made / "whole/state.json").read_bytes()
    assert "not later than the start's own data" in (made / "again/log.txt").read_text()


def test_threads_and_kills_change_no_byte(made):
    assert track(made, "b.csv", "--threads", "1", out="plain").code == 0
    assert track(made, "b.csv", "--threads", "2", out="threads").code == 0
    command = [UMOV, "invert", "track", "b.csv", "--scenario", "fit.toml", "--start", "pose", *KNOWN, "-o", "killed"]
    kills = 0
    for after_s in (0.02, 0.1, 0.3):
        process = subprocess.Popen(command, cwd=made, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(after_s)
        kills += process.poll() is None
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert kills > 0
    assert subprocess.run(command, cwd=made, capture_output=True, check=False).returncode == 0
    for other in ("threads", "killed"):
        for name in TABLES:
            assert (made / other / name).read_bytes() == (made / "plain" / name).read_bytes(), (other, name)


def test_gaps_are_bridged(made):
    """No epochs for a third of the time; bands without a measurement."""
    head, epochs = epochs_of(made / "b.csv")
    third = len(epochs) // 3
    some = epochs[:third] + [rows[:1] for rows in epochs[2 * third:]]
    write_epochs(made / "gap.csv", head, some)
    done = track(made, "gap.csv", "--json", out="gap")
    assert done.code == 0, done.err
    verdict = json.loads(done.out)
    assert verdict["lost_utc"] is None and verdict["epochs"] == len(some)
    assert apart(TRUTH, verdict["modes"][0]["q"]) < 4 * verdict["modes"][0]["sd_deg"]


def test_one_epoch_is_followed(made):
    head, epochs = epochs_of(made / "b.csv")
    write_epochs(made / "one.csv", head, epochs[:1])
    done = track(made, "one.csv", "--json", out="single")
    assert done.code == 0, done.err
    assert json.loads(done.out)["epochs"] == 1


def test_a_constant_curve_is_never_sure(made):
    head, epochs = epochs_of(made / "b.csv")
    flat = []
    for rows in epochs:
        flat.append([",".join([*line.split(",")[:2], "100", "3", "", "", "", ""]) for line in rows])
    write_epochs(made / "flat.csv", head, flat)
    done = track(made, "flat.csv", "--json", out="flat")
    assert done.code in (0, 4), done.err
    assert json.loads(done.out)["verdict"] in ("undetermined", "no_fit")


def test_another_body_is_lost_and_the_time_is_told(made):
    head, epochs = epochs_of(made / "b.csv")
    swapped = []
    for rows in epochs:  # from the fourth epoch on, three times as red
        late = len(swapped) > 3
        swapped.append([",".join([c if k not in (2, 3) or not late or ",nm:425," not in line else f"{4 * float(c):.6f}"
                                  for k, c in enumerate(line.split(","))]) for line in rows])
    write_epochs(made / "other.csv", head, swapped)
    done = track(made, "other.csv", out="other")
    assert done.code == 4, done.out
    verdict = json.loads((made / "other/verdict.json").read_text())
    assert verdict["verdict"] == "no_fit"
    lost = epochs[4][0].split(",")[0][:19]
    assert verdict["lost_utc"].startswith(lost)
    assert f"lost at {lost}" in done.out
    again = track(made, "b2.csv", start="other", out="after")
    assert again.code == 3 and "that tracking was lost at" in again.err


def test_no_light_at_all_is_told(made):
    (made / "nan.csv").write_text("time_utc,band,flux,flux_err\n2018-01-21T05:13:00Z,nm:550,nan,nan\n")
    done = track(made, "nan.csv", out="nan")
    assert done.code == 3 and "no row holds a measurement" in done.err
    assert not (made / "nan").exists()


@pytest.mark.parametrize("start, code, message", [
    ("", 2, "--start is missing"),
    ("nowhere", 3, "nowhere"),
    ("truth", 3, "neither state.json nor modes.ecsv"),
    ("b.csv", 3, 'modes without the column "weight"'),
    ("bad.json", 3, "no state of a tracking"),
    ("unnoted.ecsv", 3, "the header does not say epoch_utc"),
    ("broken.ecsv", 3, 'weight = "much"'),
])
def test_starts_that_are_none_are_told(made, start, code, message):
    (made / "bad.json").write_text('{"question": "pose"}\n')
    modes = (made / "pose/modes.ecsv").read_text()
    (made / "unnoted.ecsv").write_text("\n".join(line for line in modes.splitlines() if "epoch_utc" not in line) + "\n")
    lines = modes.splitlines()
    lines[-1] = " ".join([lines[-1].split()[0], "much", *lines[-1].split()[2:]])
    (made / "broken.ecsv").write_text("\n".join(lines) + "\n")
    words = ["--start", start] if start else []
    done = call(made, "invert", "track", "b.csv", "--scenario", "fit.toml", *words)
    assert done.code == code, done.err
    assert message in done.err, done.err


def test_observations_of_before_are_told(made):
    done = track(made, "a.csv", out="before")
    assert done.code == 3 and "no observation is later than" in done.err


def test_a_state_of_other_options_is_refused(made):
    assert track(made, "b1.csv", out="one").code in (0, 4)
    done = call(made, "invert", "track", "b2.csv", "--scenario", "fit.toml", "--start", "one", "--visibility", "masks")
    assert done.code == 3 and "its parts are others than those of this scenario" in done.err
    # Its modes can be taken up with any.
    done = call(made, "invert", "track", "b2.csv", "--scenario", "fit.toml", "--start", "one/modes.ecsv")
    assert done.code in (0, 4), done.err
