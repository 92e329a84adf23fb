"""Jobs in parts: whatever ends them, the merged bytes are those of the plain command."""
import contextlib
import json
import math
import os
import random
import re
import signal
import subprocess
import time

import pytest

from conftest import ROOT, UMOV, read_csv

SITE = ("-s", "maui", "--start", "2018-01-21T00:00:00Z", "--stop", "2018-01-21T12:00:00Z")


def signature_of(scenario, poses=400):
    return ["signature", scenario(), "--poses", poses, "--phase", "60", "--accuracy", "0.05"]


def slow_signature_of(umov, scenario, poses):
    """Of a body that hides itself, by rays: milliseconds a pose, so that there is something to end."""
    command = signature_of(scenario, poses)[:-1] + ["0.02", "--visibility", "rays"]
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    return command


def plain(umov, command, *output):
    done = umov(*command, "-o", output[0])
    assert done.code == 0, done.err


def start(tmp_path, *arguments):
    return subprocess.Popen([UMOV, *map(str, arguments)], cwd=tmp_path, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True)


def children(pid):
    """Processes that a process has started."""
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True)
    return [int(line) for line in found.stdout.split()]


def wait_for(what, timeout_s=60):
    until = time.monotonic() + timeout_s
    while time.monotonic() < until:
        if found := what():
            return found
        time.sleep(0.02)
    raise AssertionError("it did not come")


def shards(folder):
    return sorted(path.name for path in (folder / "shards").rglob("*.rows"))


@pytest.mark.parametrize("suffix", ["csv", "fits"])
@pytest.mark.parametrize("per_shard", [400, 123])
def test_a_signature_in_parts_is_the_plain_one(umov, scenario, tmp_path, suffix, per_shard):
    command = signature_of(scenario)
    plain(umov, command, f"plain.{suffix}")
    done = umov("scale", "run", "--per-shard", per_shard, "job", *command)
    assert done.code == 0, done.err
    assert umov("scale", "merge", "job", "-o", f"merged.{suffix}").code == 0
    assert (tmp_path / f"merged.{suffix}").read_bytes() == (tmp_path / f"plain.{suffix}").read_bytes()
    manifest = json.loads((tmp_path / "job/manifest.json").read_text())
    assert [one["file"] for one in manifest["shards"]] == shards(tmp_path / "job")
    assert not list((tmp_path / "job/tmp").iterdir())


@pytest.mark.parametrize("workers", [1, 2])
def test_passes_in_parts_are_the_plain_ones(umov, tmp_path, workers):
    orbits = (ROOT / "tests/data/tle/mixed_979_2018-01-20.tle").read_text().splitlines()[:45]
    (tmp_path / "fifteen.tle").write_text("\n".join(orbits) + "\n")
    command = ["passes", "--orbit", "fifteen.tle", *SITE]
    plain(umov, command, "plain.csv")
    done = umov("scale", "run", "--per-shard", 4, "--workers", workers, "job", *command)
    assert done.code == 0, done.err
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


def test_no_pass_in_any_part_is_said_as_the_plain_command_does(umov, tmp_path):
    orbits = (ROOT / "tests/data/tle/mixed_979_2018-01-20.tle").read_text().splitlines()[:9]
    (tmp_path / "three.tle").write_text("\n".join(orbits) + "\n")
    command = ["passes", "--orbit", "three.tle", *SITE, "--alt-min-deg", 89.9]
    alone = umov(*command, "-o", "plain.csv")
    assert alone.code == 5 and not (tmp_path / "plain.csv").exists()
    assert umov("scale", "run", "--per-shard", 1, "job", *command).code == 0
    merged = umov("scale", "merge", "job", "-o", "merged.csv")
    assert (merged.code, merged.err.splitlines()[-1]) == (5, alone.err.splitlines()[-1])
    assert not (tmp_path / "merged.csv").exists()


def test_a_run_in_parts_is_the_plain_one(umov, scenario, tmp_path):
    name = scenario(("stop = 2018-01-21T05:12:00Z", "stop = 2018-01-22T08:00:00Z"),
                    ("sun_alt_max_deg = -6, sunlit = true", "sunlit = true"))
    assert umov("run", name, "-o", "plain").code == 0
    done = umov("scale", "run", "--per-shard", 1, "job", "run", name)
    assert done.code == 0, done.err
    assert len(shards(tmp_path / "job")) > 1
    for table in ("lightcurve.csv", "lightcurve.ecsv", "passes.ecsv"):
        merged = umov("scale", "merge", "job", "--table", table.split(".")[0], "-o", table)
        assert merged.code == 0, merged.err
        assert (tmp_path / table).read_bytes() == (tmp_path / "plain" / table).read_bytes()


def test_several_objects_in_parts_are_the_plain_ones(umov, scenario, tmp_path):
    """Masks of one object are not kept while a plan goes on to the next, and texts may be longer than those of the first shard."""
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    name = scenario(("stop = 2018-01-21T05:12:00Z", "stop = 2018-01-22T08:00:00Z"),
                    ("sun_alt_max_deg = -6, sunlit = true", "sunlit = true"), ('["ecsv", "csv", "html"]', '["ecsv", "csv", "fits"]'))
    text = (tmp_path / name).read_text()
    at = text.index("[[object]]")
    one = text[at:text.index("[bands]")]
    other = re.sub(r'name = "[^"]*"', 'name = "a name that is longer"', one, count=1)
    (tmp_path / name).write_text(text[:at] + one + other + text[at + len(one):])
    assert umov("run", name, "-o", "plain").code == 0
    assert umov("scale", "plan", "job", "run", name).code == 0 and not (tmp_path / "job").exists()
    assert umov("scale", "run", "--per-shard", 1, "job", "run", name).code == 0
    for table in ("lightcurve.csv", "lightcurve.ecsv", "lightcurve.fits"):
        assert umov("scale", "merge", "job", "-o", table).code == 0
        assert (tmp_path / table).read_bytes() == (tmp_path / "plain" / table).read_bytes()


def test_tasks_of_an_array_share_the_shards(umov, scenario, tmp_path):
    command = signature_of(scenario)
    plain(umov, command, "plain.csv")
    script = umov("scale", "script", "slurm", "--tasks", 3, "--per-shard", 50, "job", *command)
    assert script.code == 0 and "#SBATCH --array=0-2" in script.out
    assert re.search(r"scale run \S*job --part \"\$SLURM_ARRAY_TASK_ID/3\"", script.out)
    condor = umov("scale", "script", "condor", "--tasks", 3, "job")
    assert condor.code == 0 and "queue 3" in condor.out
    for task in (2, 0, 1):
        assert umov("scale", "run", "job", "--part", f"{task}/3").code == 0
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


@pytest.mark.slow
def test_kills_of_workers_and_of_all_cost_no_byte(umov, scenario, tmp_path):
    """Ten times something of the job is killed by signal 9; no process is left over."""
    command = slow_signature_of(umov, scenario, 3000)
    lock = umov("scale", "lock", "--per-shard", 30, "job", *command)
    assert lock.code == 0, lock.err
    rng, finished = random.Random(7), set()
    for _ in range(10):
        job = start(tmp_path, "scale", "run", "job", "--threads", 1, "-q")
        workers = wait_for(lambda: children(job.pid) or job.poll() is not None)
        if workers is True:
            break
        time.sleep(rng.uniform(0.2, 2.0))
        victim = rng.choice([job.pid, workers[0]])
        os.kill(victim, signal.SIGKILL)
        if victim != job.pid:
            time.sleep(0.5)
            job.send_signal(signal.SIGINT)
        job.wait(60)
        wait_for(lambda: not [pid for pid in workers if alive(pid)], 20)
        there = set(shards(tmp_path / "job"))
        assert finished <= there  # what was finished stays
        finished = there
    assert umov("scale", "run", "job").code == 0
    assert not list((tmp_path / "job/tmp").iterdir())
    plain(umov, command, "plain.csv")
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


def alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_ctrl_c_says_how_to_go_on(umov, scenario, tmp_path):
    command = slow_signature_of(umov, scenario, 20000)
    assert umov("scale", "lock", "--per-shard", 20, "job", *command).code == 0
    job = start(tmp_path, "scale", "run", "job", "-q")
    wait_for(lambda: shards(tmp_path / "job"))
    job.send_signal(signal.SIGINT)
    _, err = job.communicate(timeout=60)
    assert job.returncode == 130 and f"umov scale run {tmp_path / 'job'} goes on" in err, err
    assert not list((tmp_path / "job/tmp").iterdir())


@pytest.mark.slow
def test_ten_interrupts_and_the_printed_command_give_the_plain_bytes(umov, scenario, tmp_path):
    """Ctrl-C at random moments, from before the first shard on; what is printed is what is called next."""
    command = slow_signature_of(umov, scenario, 6000)
    assert umov("scale", "lock", "--per-shard", 30, "job", *command).code == 0
    rng, call, done = random.Random(10), ["scale", "run", "job"], set()
    for _ in range(10):
        job = start(tmp_path, *call, "--threads", 1, "-q")
        wait_for(lambda: children(job.pid) or job.poll() is not None)  # it listens by then
        time.sleep(rng.uniform(0, 0.6))
        job.send_signal(signal.SIGINT)
        _, err = job.communicate(timeout=60)
        assert job.returncode in (0, 130), err  # 0: the last shard was in hand
        there = set(shards(tmp_path / "job"))
        assert done <= there and not list((tmp_path / "job/tmp").iterdir())
        done = there
        if job.returncode == 130:
            told = re.search(rf"stopped by the user after {len(done)} of 200 shards. umov (scale run \S+) goes on", err)
            assert told, err
            call = told[1].split()
    last = umov(*call)
    assert last.code == 0 and f"{len(done)} of them before" in last.err, last.err
    plain(umov, command, "plain.csv")
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


@pytest.mark.slow
def test_a_worker_that_hangs_is_ended(umov, scenario, tmp_path):
    """Once: another one does its shard. Each time: it is told after two, and the rest is done."""
    command = slow_signature_of(umov, scenario, 2000)
    assert umov("scale", "lock", "--per-shard", 1000, "job", *command).code == 0
    job = start(tmp_path, "scale", "run", "job", "-q", "--timeout-s", 6)
    os.kill(wait_for(lambda: children(job.pid))[0], signal.SIGSTOP)
    _, err = job.communicate(timeout=60)
    assert job.returncode == 0 and len(shards(tmp_path / "job")) == 2, err
    (tmp_path / "job/shards" / shards(tmp_path / "job")[1]).unlink()
    job = start(tmp_path, "scale", "run", "job", "-q", "--timeout-s", 1)
    stopped = set()
    while job.poll() is None:
        for worker in set(children(job.pid)) - stopped:
            with contextlib.suppress(ProcessLookupError):
                os.kill(worker, signal.SIGSTOP)
            stopped.add(worker)
        time.sleep(0.01)
    assert job.returncode == 3 and "it was not done after 1 s" in job.stderr.read() and len(stopped) == 2
    failed = json.loads((tmp_path / "job/failed/00000001.json").read_text())
    assert (failed["attempts"], failed["code"]) == (2, 128 + signal.SIGKILL)
    assert umov("scale", "run", "job").code == 0 and umov("scale", "verify", "job").code == 0
    assert not list((tmp_path / "job/failed").iterdir())


def test_a_damaged_or_missing_shard_is_found_and_made_anew(umov, scenario, tmp_path):
    command = signature_of(scenario)
    plain(umov, command, "plain.csv")
    assert umov("scale", "run", "--per-shard", 100, "job", *command).code == 0
    files = shards(tmp_path / "job")
    bad = tmp_path / "job/shards" / files[1]
    bytes_ = bytearray(bad.read_bytes())
    bytes_[200] ^= 1
    bad.write_bytes(bytes_)
    merged = umov("scale", "merge", "job", "-o", "merged.csv")
    assert merged.code == 3 and files[1] in merged.err
    assert not (tmp_path / "merged.csv").exists()
    assert umov("scale", "verify", "job").code == 3
    assert umov("scale", "repair", "job").code == 0
    (tmp_path / "job/shards" / files[3]).unlink()
    merged = umov("scale", "merge", "job", "-o", "merged.csv")
    assert merged.code == 3 and "1 of 4 shards are missing: 3" in merged.err
    assert umov("scale", "run", "job").code == 0
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


def test_unlike_bytes_of_one_shard_are_told(umov, scenario, tmp_path):
    assert umov("scale", "run", "--per-shard", 200, "job", *signature_of(scenario)).code == 0
    first = shards(tmp_path / "job")[0]
    other = first[:26] + "0" * 32 + ".rows"
    (tmp_path / "job/shards" / other).write_bytes((tmp_path / "job/shards" / first).read_bytes())
    merged = umov("scale", "merge", "job", "-o", "merged.csv")
    assert merged.code == 3 and "unlike bytes" in merged.err and other in merged.err


def made_by(told):
    """How many shards a run made by itself, by what it says in the end."""
    done, before = map(int, re.search(r"(\d+) of \d+ shards done, (\d+) of them before", told).groups())
    others = re.search(r"others did (\d+) meanwhile", told)
    return done - before - (int(others[1]) if others else 0)


@pytest.mark.slow
def test_a_second_one_is_refused_unless_it_joins(umov, scenario, tmp_path):
    command = slow_signature_of(umov, scenario, 4000)
    assert umov("scale", "lock", "--per-shard", 20, "job", *command).code == 0
    job = start(tmp_path, "scale", "run", "job", "--threads", 1)
    wait_for(lambda: shards(tmp_path / "job"))
    refused = umov("scale", "run", "job", "-q")
    assert refused.code == 6 and f"{job.pid}" in refused.err and "--join" in refused.err, refused.err
    assert "at work" in umov("scale", "status", "job").out
    joined = umov("scale", "run", "job", "--join", "--threads", 1)
    assert joined.code == 0, joined.err
    _, err = job.communicate(timeout=120)
    assert job.returncode == 0, err
    assert len(shards(tmp_path / "job")) == 200
    made = sum(made_by(text) for text in (joined.err, err))
    assert 200 <= made <= 220  # at most a tenth of the work is done twice
    plain(umov, command, "plain.csv")
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


def test_another_job_or_changed_inputs_are_refused(umov, scenario, tmp_path):
    command = signature_of(scenario)
    assert umov("scale", "run", "--per-shard", 200, "job", *command).code == 0
    other = umov("scale", "run", "--per-shard", 200, "job", *command[:-1], "0.06")
    assert other.code == 3 and "0.06" in other.err and "was " in other.err, other.err
    (tmp_path / "job/shards" / shards(tmp_path / "job")[0]).unlink()
    with open(tmp_path / "cube.obj", "a") as mesh:
        mesh.write("# changed\n")
    changed = umov("scale", "run", "job")
    assert changed.code == 3 and "cube.obj" in changed.err, changed.err


@pytest.mark.parametrize("arguments,code,said", [
    (["render", "s.toml"], 2, "signature, passes, run, observe, invert or identify"),
    (["signature", "nothing.toml", "--poses", "5", "--phase", "60"], 3, "nothing.toml"),
    (["signature", "scenario.toml"], 2, "--geometry"),
    (["signature", "scenario.toml", "--poses", "5", "--phase", "60", "-o", "x.csv"], 2, "scale merge"),
    (["signature", "scenario.toml", "--poses", "5", "--phase", "60", "--shard", "0/2"], 2, "--per-shard"),
])
def test_what_is_wrong_is_said_before_anything_is_made(umov, scenario, tmp_path, arguments, code, said):
    scenario()
    done = umov("scale", "run", "job", *arguments)
    assert done.code == code and said in done.err, done.err
    assert not (tmp_path / "job").exists()


def test_a_folder_of_something_else_is_left_alone(umov, scenario, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis/chapter.tex").write_text("")
    assert umov("scale", "run", "thesis", *signature_of(scenario)).code == 6
    assert [path.name for path in (tmp_path / "thesis").iterdir()] == ["chapter.tex"]


REDUCTIONS = ("log-histogram:intensity:1e-3:10:7", "histogram:q_scat:-0.5:0.5:4:band", "most:intensity:5", "least:phase_angle:3:band")


def kept(rows):
    """What is to be kept of the rows of the plain table, by Python alone."""
    bands = list(dict.fromkeys(row["band"] for row in rows))
    out = {"log_histogram_intensity": [], "histogram_q_scat": [], "most_intensity": [], "least_phase_angle": []}
    for band in bands:
        mine = [row for row in rows if row["band"] == band]
        for name, column, low, high, edges in (
                ("log_histogram_intensity", "intensity", 1e-3, 10, [1e-3 * 1e4 ** (k / 7) for k in range(7)] + [10]),
                ("histogram_q_scat", "q_scat", -0.5, 0.5, [-0.5, -0.25, 0, 0.25, 0.5])):
            values = [float(row[column]) for row in mine if row[column]]
            counts = [sum(a <= value < b for value in values) for a, b in zip(edges, edges[1:])]
            counts += [sum(value < low for value in values), sum(value >= high for value in values), len(mine) - len(values)]
            out[name] += [(band, count) for count in counts]
        out["most_intensity"] += sorted(mine, key=lambda row: -float(row["intensity"]))[:5]
        out["least_phase_angle"] += sorted(mine, key=lambda row: float(row["phase_angle"]))[:3]
    return out


@pytest.mark.parametrize("per_shard", [400, 123, 17])
def test_what_is_kept_of_rows_is_that_of_the_plain_table(umov, scenario, tmp_path, per_shard):
    """Histograms and extremes, however the job is cut; some poses are dark, and have no q."""
    command = signature_of(scenario)
    plain(umov, command, "plain.csv")
    words = [word for text in REDUCTIONS for word in ("--reduce", text)]
    done = umov("scale", "run", *words, "--per-shard", per_shard, "job", *command)
    assert done.code == 0, done.err
    expected = kept(read_csv(tmp_path / "plain.csv"))
    for name, rows in expected.items():
        assert umov("scale", "merge", "job", "--table", name, "-o", f"{name}.csv").code == 0
        got = read_csv(tmp_path / f"{name}.csv")
        assert [(row["band"], int(row["count"])) for row in got] == rows if "histogram" in name else got == rows
    again = umov("scale", "run", "job", *command)
    assert again.code == 3 and "reduced to" in again.err, again.err


def passes_of_thirty(tmp_path, *more):
    orbits = (ROOT / "tests/data/tle/mixed_979_2018-01-20.tle").read_text().splitlines()[:90]
    (tmp_path / "thirty.tle").write_text("\n".join(orbits) + "\n")
    return ["passes", "--orbit", "thirty.tle", *SITE, *more]


@pytest.mark.slow
def test_what_is_kept_of_passes_is_that_of_the_plain_table_however_they_are_cut(umov, tmp_path):
    """Shards have passes object by object, the table by their rise: what is the same goes by that."""
    command = passes_of_thirty(tmp_path)
    plain(umov, command, "plain.csv")
    rows = read_csv(tmp_path / "plain.csv")
    most = sorted(rows, key=lambda row: -float(row["sunlit_share"]))[:4]
    assert most[-1]["sunlit_share"] == "1" and sum(row["sunlit_share"] == "1" for row in rows) > 10
    groups = list(dict.fromkeys(row["norad_cat_id"] for row in rows))
    least = [one for group in groups for one in sorted((row for row in rows if row["norad_cat_id"] == group),
                                                       key=lambda row: float(row["sunlit_share"]))[:1]]
    for per_shard in (30, 7, 1):
        job = f"job{per_shard}"
        done = umov("scale", "run", "--per-shard", per_shard, "--reduce", "most:sunlit_share:4", "--reduce",
                    "least:sunlit_share:1:norad_cat_id", "--reduce", "histogram:sunlit_share:0:2:1:norad_cat_id", job, *command)
        assert done.code == 0, done.err
        for table, expected in (("most_sunlit_share", most), ("least_sunlit_share", least)):
            assert umov("scale", "merge", job, "--table", table, "-o", "kept.csv").code == 0
            assert read_csv(tmp_path / "kept.csv") == expected, (per_shard, table)
        assert umov("scale", "merge", job, "--table", "histogram_sunlit_share", "-o", "kept.csv").code == 0
        counted = read_csv(tmp_path / "kept.csv")
        assert [row["norad_cat_id"] for row in counted[::4]] == groups
        assert sum(int(row["count"]) for row in counted) == len(rows)


def test_the_example_of_extremes_of_passes_in_the_page_runs(umov, tmp_path):
    text = re.search(r"`(least:mag_min:[^`]*)`", (ROOT / "docs/scale.md").read_text())[1]
    command = passes_of_thirty(tmp_path, "--model", "sphere", "--size-m", 1, "--material", "paper_al")
    plain(umov, command, "plain.csv")
    done = umov("scale", "run", "--reduce", text, "job", *command)
    assert done.code == 0, done.err
    assert umov("scale", "merge", "job", "-o", "kept.csv").code == 0
    bright = [row for row in read_csv(tmp_path / "plain.csv") if row["mag_min"]]
    expected = [one for group in dict.fromkeys(row["norad_cat_id"] for row in bright) for one in
                sorted((row for row in bright if row["norad_cat_id"] == group), key=lambda row: float(row["mag_min"]))[:3]]
    assert read_csv(tmp_path / "kept.csv") == expected and len(expected) > 5


def test_likelihoods_of_a_measurement_are_those_of_the_plain_table(umov, scenario, tmp_path):
    """Of two columns in each band, by Python's exact sum over the plain rows. Any cut: the same bytes."""
    command = slow_signature_of(umov, scenario, 200)
    plain(umov, command, "plain.csv")
    rows, merged = read_csv(tmp_path / "plain.csv"), set()
    for per_shard in (200, 67, 9):
        job = f"job{per_shard}"
        done = umov("scale", "run", "--reduce", "likelihood:intensity+sun_x:0.03+-0.2:0.01+0.2", "--per-shard", per_shard, job, *command)
        assert done.code == 0, done.err
        assert umov("scale", "merge", job, "-o", "likelihood.csv").code == 0
        merged.add((tmp_path / "likelihood.csv").read_bytes())
    assert len(merged) == 1
    got = read_csv(tmp_path / "likelihood.csv")
    assert [row["band"] for row in got] == list(dict.fromkeys(row["band"] for row in rows))
    for told in got:
        mine = [row for row in rows if row["band"] == told["band"]]
        likely = [math.exp(-((float(row["intensity"]) - 0.03) / 0.01) ** 2 / 2 - ((float(row["sun_x"]) + 0.2) / 0.2) ** 2 / 2) for row in mine]
        assert int(told["count"]) == len(mine) == 200 and max(likely) > 10 * min(likely)
        # 1e-12: the exponents are rounded before exp, here and there.
        assert float(told["log_likelihood"]) == pytest.approx(math.log(math.fsum(likely) / 200 / (2 * math.pi * 0.01 * 0.2)), rel=1e-12)
        assert float(told["effective_rows"]) == pytest.approx(math.fsum(likely) ** 2 / math.fsum(one ** 2 for one in likely), rel=1e-11)


@pytest.mark.parametrize("reduction", ["histogram:sunlit_share:0:1:4", "most:sunlit_share:3"])
def test_a_reduced_search_without_a_pass_ends_as_the_plain_one(umov, tmp_path, reduction):
    command = passes_of_thirty(tmp_path, "--alt-min-deg", 89.9)
    alone = umov(*command, "-o", "plain.csv")
    assert umov("scale", "run", "--per-shard", 9, "--reduce", reduction, "job", *command).code == 0
    merged = umov("scale", "merge", "job", "-o", "merged.csv")
    assert (merged.code, merged.err.splitlines()[-1]) == (5, alone.err.splitlines()[-1])
    assert not (tmp_path / "merged.csv").exists()


def test_what_a_folder_does_not_keep_is_refused(umov, scenario, tmp_path):
    """Without a verb the job is that of the folder: another --reduce would be none."""
    command = signature_of(scenario, 20)
    for job, kept in (("plain", []), ("kept", ["--reduce", "most:intensity:2"])):
        assert umov("scale", "lock", *kept, job, *command).code == 0
        for verb in ("run", "plan", "script slurm"):
            done = umov("scale", *verb.split(), "--reduce", "most:intensity:3", job)
            assert done.code == 2 and "most:intensity:3" in done.err and ("most:intensity:2" if kept else "all rows") in done.err, done.err
    assert not shards(tmp_path / "plain") and not shards(tmp_path / "kept")
    assert umov("scale", "run", "--reduce", "most:intensity:2", "kept").code == 0


@pytest.mark.parametrize("given,kept", [(("--per-shard", 7), "has 10 poses in a shard"), (("--isa", "avx2"), "is held to sse4")])
@pytest.mark.parametrize("with_verb", [False, True])
def test_how_a_folder_was_cut_and_held_stays(umov, scenario, tmp_path, given, kept, with_verb):
    """With the verb behind it, too: neither goes into what is compared there, or only as another job."""
    command = signature_of(scenario, 20)
    assert umov("scale", "lock", "--per-shard", 10, "--isa", "sse4", "job", *command).code == 0
    for verb in ("run", "lock", "script slurm", *([] if with_verb else ["plan"])):
        done = umov("scale", *verb.split(), *given, "job", *(command if with_verb else []))
        assert done.code == 2 and f"{given[0]} {given[1]}" in done.err and kept in done.err, done.err
    assert not shards(tmp_path / "job")
    again = umov("scale", "run", "--per-shard", 10, "--isa", "sse4", "job", *(command if with_verb else []))
    assert again.code == 0 and len(shards(tmp_path / "job")) == 2, again.err


def test_more_than_there_are_in_a_shard_is_all_of_them(umov, scenario, tmp_path):
    command = signature_of(scenario, 20)
    for _ in range(2):
        assert umov("scale", "run", "--per-shard", 1000, "job", *command).code == 0


def test_a_cluster_is_told_all_that_it_was_given(umov, scenario, tmp_path, monkeypatch):
    """python3 is one that only says its words: Dask's side is tested where Dask is."""
    assert umov("scale", "lock", "job", *signature_of(scenario, 20)).code == 0
    (tmp_path / "bin").mkdir()
    python = tmp_path / "bin/python3"
    python.write_text('#!/bin/sh\nshift 2\necho "$@"\n')
    python.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    done = umov("scale", "run", "--cluster", "local:2", "--threads", 3, "--timeout-s", 7.5, "--memory-mb", 300, "--join", "-q", "job")
    assert done.code == 0, done.err
    assert done.out.endswith("--threads 3 --timeout-s 7.5 --memory-mb 300 --join --quiet\n") and "--cluster local:2" in done.out, done.out
    assert "--threads" not in umov("scale", "run", "--cluster", "local:2", "job").out
    for more in (["--part", "0/2"], ["--workers", 2]):
        refused = umov("scale", "run", "--cluster", "local:2", *more, "job")
        assert refused.code == 2 and more[0] in refused.err, refused.err


@pytest.mark.slow
def test_a_job_without_memory_for_any_shard_ends_soon(umov, scenario, tmp_path):
    """Three bands of a million bins are hundreds of megabytes: 20 shards, of which each would be tried three times."""
    assert umov("scale", "lock", "--per-shard", 20, "--reduce", "histogram:intensity:0:1:1000000", "job", *signature_of(scenario)).code == 0
    done = umov("scale", "run", "--memory-mb", 120, "--threads", 1, "job")
    assert done.code == 6 and re.search("10 attempts ran out of memory.*--memory-mb.*umov scale run .*job goes on", done.err), done.err
    assert not shards(tmp_path / "job")


def test_scripts_and_repairs_hold_processes_to_their_memory(umov, scenario, tmp_path):
    assert umov("scale", "lock", "--per-shard", 20, "--reduce", "histogram:intensity:0:1:1000000", "job", *signature_of(scenario, 20)).code == 0
    for system in ("slurm", "condor"):
        script = umov("scale", "script", system, "--memory-mb", 1000, "job")
        assert script.code == 0 and "--memory-mb 900 -q" in script.out, script.out
    assert umov("scale", "repair", "--memory-mb", 120, "job").code == 3
    assert "needs more memory than" in json.loads((tmp_path / "job/failed/00000000.json").read_text())["message"]
    assert umov("scale", "repair", "job").code == 0


def test_passes_without_what_is_asked_for_are_passes(umov, tmp_path):
    """Without a model no pass has a magnitude: none is kept, and yet there are some."""
    assert umov("scale", "run", "--reduce", "least:mag_min:3", "job", *passes_of_thirty(tmp_path)).code == 0
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert read_csv(tmp_path / "merged.csv") == []


@pytest.mark.parametrize("text,said", [
    ("mean:intensity", "no such reduction"), ("histogram:intensity:1:0:5", "LOW < HIGH"), ("histogram:intensity:-1e308:1e308:4", "too far apart"), ("log-histogram:intensity:0:1:5", "0 < LOW < HIGH"),
    ("histogram:intensity:0:1", "a number of bins"), ("most:intensity:0", "from 1 to a million"), ("most:brightness:5", "there are pose, band"),
    ("likelihood:intensity:1:0", "an ERROR above 0"), ("likelihood:intensity:1e+1:1:band:band", "likelihood:COLUMN+COLUMN:VALUE+VALUE:ERROR+ERROR"), ("likelihood:q_scat+u_scat:0:1", "of each column"), ("likelihood:band:1:1", "no column of numbers"),
    ("most:band:5", "no column of numbers"), ("most:intensity:5:sun_x", "whole numbers was expected"),
])
def test_reductions_that_are_none_are_refused_before_anything_is_made(umov, scenario, tmp_path, text, said):
    done = umov("scale", "run", "--reduce", text, "job", *signature_of(scenario))
    assert done.code == 2 and said in done.err, done.err
    assert not (tmp_path / "job").exists()


def test_too_much_asks_first(umov, scenario, tmp_path):
    done = umov("scale", "run", "job", "signature", scenario(), "--poses", 10000000, "--phase",
                ",".join(str(10 + 0.1 * k) for k in range(200)))
    assert done.code in (2, 6), done.err  # 2: --yes is wanted; 6: there is no room for it here
    assert not (tmp_path / "job/job.json").exists()
