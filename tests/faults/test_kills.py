"""kill -9 and SIGTERM at any moment: the old complete result or the new one, what is said to be kept can be read,
and the same command goes on to the same bytes."""
import json
import random
import re
import signal
import time

import pytest
from astropy.table import Table
from faults import (JOBS, assert_clean_end, contents, place, read_csv, sample, shim, times)  # noqa: F401

LONG = ("signature", "scenario.toml", "--poses", "20000", "--phase", "60")  # five blocks
STEPS = (("step_s = 20", "step_s = 0.1"),)  # 2,400 epochs: five blocks too


def rows_kept(place, done, total):
    """Opens what a stopped job says it has kept; returns its rows."""
    name = re.search(r"The finished rows are in (\S+)\.(?:\s|$)", done.err)
    if not name:
        return 0
    kept = place.folder / name[1]
    if kept.is_dir():
        assert json.loads((kept / "manifest.json").read_text())["status"] == "stopped early"
        rows = len(Table.read(kept / "lightcurve.ecsv"))
    elif kept.suffix == ".csv":
        rows = len(read_csv(kept))
    elif kept.suffix == ".json":
        rows = len(json.loads(kept.read_text()))
    else:
        rows = len(Table.read(kept))
    assert 0 < rows < total
    return rows


def remove(path):
    if path.is_dir():
        for one in path.iterdir():
            one.unlink()
        path.rmdir()
    else:
        path.unlink(missing_ok=True)


LONG_JOBS = {
    "run": (("run", "scenario.toml"), "out"),
    **{f"signature.{suffix}": ((*LONG, "-o", f"t.{suffix}"), f"t.{suffix}") for suffix in ("csv", "ecsv", "fits", "json")},
}


@pytest.mark.parametrize("job", LONG_JOBS)
def test_killed_at_every_call_and_resumed(place, job):
    place.scenario(*STEPS)
    arguments, result = LONG_JOBS[job]
    result = place.folder / result
    assert place.umov(*arguments).code == 0
    good = contents(result)
    names = place.names()
    went_on = 0
    for call in ("write", "sync", "rename", "open"):
        for number in sample(place.count(call, *arguments), 8):
            for is_there in (False, True):
                if not is_there:
                    remove(result)
                done = place.faulty(f"{call}:{number}!{-signal.SIGKILL}", *arguments)
                assert done.code == -signal.SIGKILL
                assert contents(result) == (good if is_there or result.exists() else None), (call, number)
                done = place.umov(*arguments)
                assert done.code == 0, done.err
                went_on += "going on from" in done.err or "going on from" in done.out
                assert contents(result) == good, (call, number)
                assert [name for name in place.names() if ".part-" not in name] == names
    assert went_on > 0 or job == "run"  # run says it with --verbose


@pytest.mark.parametrize("job", LONG_JOBS)
def test_random_moments(place, job):
    """As a user or a machine ends them: old or new, and what is kept can be read."""
    place.scenario(*STEPS)
    arguments, result = LONG_JOBS[job]
    result = place.folder / result
    begin = time.monotonic()
    assert place.umov(*arguments).code == 0
    seconds = time.monotonic() - begin
    good = contents(result)
    total = 10 ** 9
    moments = random.Random(job)
    kept = 0
    for turn in range(times(6, 300)):
        if turn % 2 and contents(result) is not None:
            remove(result)
        is_there = contents(result) is not None
        how = signal.SIGKILL if turn % 3 else signal.SIGTERM
        process = place.start(*arguments)
        time.sleep(moments.uniform(0, 1.1 * seconds))
        process.send_signal(how)
        out, err = process.communicate(timeout=60)
        done = type("Done", (), {"code": process.returncode, "err": err.decode()})
        # A stopped run stands in the place of none, marked; never in that of a complete one.
        if how == signal.SIGTERM and done.code != -signal.SIGTERM:  # before main() it is the system's end
            assert_clean_end(done, {0, 130})
            kept += rows_kept(place, done, total) > 0
        if done.code != 130 or is_there:
            assert contents(result) in ((good,) if is_there else (good, None))
        if turn % 5 == 4:
            assert place.umov(*arguments).code == 0
            assert contents(result) == good


def test_a_run_that_is_stopped_goes_on_where_it_was(place):
    place.scenario(*STEPS)
    assert place.umov("run", "scenario.toml").code == 0
    good = contents(place.folder / "out")
    remove(place.folder / "out")
    done = place.faulty(f"write:5!{-signal.SIGTERM}", "run", "scenario.toml")
    assert done.code == 130 and "goes on from there" in done.err, done.err
    assert rows_kept(place, done, 10 ** 9) > 0
    done = place.umov("run", "scenario.toml", "-v")
    assert done.code == 0 and re.search(r"going on from .*out\.rows\.partial: \d finished block", done.err), done.err
    assert contents(place.folder / "out") == good
    assert place.names() == ["cube.obj", "out", "scenario.toml"]


def test_light_of_the_earth_and_several_objects_go_on_too(place):
    text = (place.folder / place.scenario(("step_s = 20", "step_s = 1"))).read_text()
    objects = text.index("[[object]]"), text.index("[bands]")
    second = text[slice(*objects)].replace('"HST"', '"other"').replace("paper_al", "paper_au")
    text = text[:objects[1]] + second + text[objects[1]:].replace("[bands]", "[render]\nearthshine = { albedo = 0.3 }\n[bands]")
    (place.folder / "two.toml").write_text(text)
    arguments = ("run", "two.toml")
    done = place.umov(*arguments)
    assert done.code == 0, done.err
    good = contents(place.folder / "out")
    for number in sample(place.count("write", *arguments), 6):
        remove(place.folder / "out")
        place.faulty(f"write:{number}!{-signal.SIGKILL}", *arguments)
        assert place.umov(*arguments).code == 0
        assert contents(place.folder / "out") == good


def test_another_job_begins_anew_and_says_so(place):
    place.scenario()
    for change in (("--seed", "5"), ("--accuracy", "0.01"), ("--set", "bands.set=paper_rgb", "--seed", "6")):
        done = place.faulty(f"sync:1!{-signal.SIGKILL}", *LONG, "-o", "t.ecsv")
        assert done.code == -signal.SIGKILL and "t.ecsv.rows.partial" in place.journals()
        assert place.umov(*LONG, *change, "-o", "plain.ecsv").code == 0
        done = place.umov(*LONG, *change, "-o", "t.ecsv")
        assert done.code == 0
        assert done.err.count("of another job") == 1, done.err
        assert contents(place.folder / "t.ecsv") == contents(place.folder / "plain.ecsv")
        assert "t.ecsv.rows.partial" not in place.journals()


def test_a_changed_input_is_another_job(place):
    place.scenario()
    place.faulty(f"sync:1!{-signal.SIGKILL}", *LONG, "-o", "t.csv")
    mesh = (place.folder / "cube.obj").read_text()
    (place.folder / "cube.obj").write_text(mesh + "# another\n")
    done = place.umov(*LONG, "-o", "t.csv")
    assert done.code == 0 and "of another job" in done.err, done.err


def test_a_damaged_journal_costs_its_blocks_only(place):
    place.scenario()
    arguments = (*LONG, "-o", "t.csv")
    assert place.umov(*arguments).code == 0
    good = contents(place.folder / "t.csv")
    (place.folder / "t.csv").unlink()
    place.faulty(f"sync:1!{-signal.SIGKILL}", *arguments)
    journal = place.folder / "t.csv.rows.partial"
    whole = journal.read_bytes()
    spots = random.Random(3)
    for _ in range(times(6, 100)):
        bytes_ = bytearray(whole)
        at = spots.randrange(len(bytes_))
        bytes_[at] ^= 1 << spots.randrange(8)
        journal.write_bytes(bytes_[:spots.randrange(at, len(bytes_))] if spots.random() < 0.5 else bytes_)
        done = place.umov(*arguments)
        assert_clean_end(done, {0})
        assert contents(place.folder / "t.csv") == good
        # What the kill left of the output goes when it is older than a minute.
        assert [n for n in place.names() if ".part-" not in n] == ["cube.obj", "scenario.toml", "t.csv"]
    journal.write_text("my own notes\n")
    done = place.umov(*arguments)
    assert done.code == 6 and "not a file that umov wrote" in done.err
    assert journal.read_text() == "my own notes\n"


def test_what_a_kill_left_goes_with_the_next_run(place):
    """Once it is a minute old: what is younger may just be being made."""
    import os
    place.scenario()
    for arguments, result in (JOBS["signature.csv"], JOBS["signature.fits"], JOBS["run"], JOBS["paper"]):
        place.faulty(f"sync:1!{-signal.SIGKILL}", *arguments) if result != "t.fits" else \
            place.faulty(f"sync:1!{-signal.SIGKILL}", *arguments)
        left = place.leftovers()
        assert left, arguments
        for name in place.names():
            if ".part-" in name:
                os.utime(place.folder / name, (0, 0))
        assert place.umov(*arguments).code == 0
        assert not place.leftovers()


def test_a_large_table(place):
    """10 million rows in the full run."""
    place.scenario()
    poses = times(60_000, 3_400_000)
    arguments = ("signature", "scenario.toml", "--poses", str(poses), "--phase", "60", "--visibility", "masks")
    for suffix in ("csv", "fits"):
        begin = time.monotonic()
        assert place.umov(*arguments, "-o", f"t.{suffix}", timeout=1200).code == 0
        seconds = time.monotonic() - begin
        good = contents(place.folder / f"t.{suffix}")
        assert len(good) > 3 * poses * 100
        moments = random.Random(suffix)
        for turn in range(times(3, 30)):
            process = place.start(*arguments, "-o", f"t.{suffix}")
            time.sleep(moments.uniform(0, seconds))
            process.send_signal(signal.SIGKILL if turn % 3 else signal.SIGTERM)
            process.communicate(timeout=60)
            assert contents(place.folder / f"t.{suffix}") == good
        assert place.umov(*arguments, "-o", f"t.{suffix}", timeout=1200).code == 0
        assert contents(place.folder / f"t.{suffix}") == good
