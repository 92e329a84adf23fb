"""Jobs in parts on a disk that is full or breaks at any call: an end with the way on, nothing half done, and the plain bytes in the end."""
import errno
import json
import os
import shutil
import signal
import subprocess

import pytest
from faults import assert_clean_end, place, sample, shim  # noqa: F401

POSES = ("signature", "scenario.toml", "--poses", "200", "--phase", "60")
SHARDS = 10


@pytest.fixture
def job(place):
    """A job that was begun, and its plain bytes."""
    place.scenario()
    assert place.umov(*POSES, "-o", "plain.csv").code == 0
    assert place.umov("scale", "lock", "-q", "--per-shard", str(200 // SHARDS), "first", *POSES).code == 0
    return (place.folder / "plain.csv").read_bytes()


def fresh(place):
    shutil.rmtree(place.folder / "job", ignore_errors=True)
    shutil.copytree(place.folder / "first", place.folder / "job")


def done(folder):
    return sorted(os.listdir(folder / "shards"))


def begun(report):
    """How many files of shards all processes have begun to write."""
    return sum(int(line.split()[1]) for line in report.read_text().splitlines() if line.startswith("open "))


def assert_goes_on(place, folder, plain, shards):
    """What is missing is named, no shard that is there is done again, and the bytes are the plain ones."""
    there = done(folder)
    merged = place.umov("scale", "merge", folder, "-o", "merged.csv")
    if len(there) < shards:
        assert merged.code == 3 and f"{shards - len(there)} of {shards} shards are missing" in merged.err, merged.err
        missing = sorted(set(range(shards)) - {int(name[:8]) for name in there})
        assert f"missing: {', '.join(map(str, missing[:10]))}" in merged.err, merged.err
        assert not (place.folder / "merged.csv").exists()
    times = {name: os.stat(folder / "shards" / name).st_mtime_ns for name in there}
    again = place.umov("scale", "run", folder, "-q")
    assert again.code == 0, again.err
    assert all(os.stat(folder / "shards" / name).st_mtime_ns == at for name, at in times.items())
    assert place.umov("scale", "merge", folder, "-q", "-o", "merged.csv").code == 0
    assert (place.folder / "merged.csv").read_bytes() == plain
    (place.folder / "merged.csv").unlink()


@pytest.mark.parametrize("workers", [1, 2, 3])
@pytest.mark.parametrize("call,code", [("write", errno.ENOSPC), ("write", errno.EIO), ("sync", errno.EIO), ("rename", errno.EIO)])
def test_a_disk_that_fails_ends_the_job_and_it_goes_on(place, job, call, code, workers):
    """From the N-th call of each worker on: behind the first failure none begins another shard."""
    growing = place.folder / "job/tmp"  # the lease and the manifest are the driver's
    report, stops = place.cache / "count.txt", 0
    for number in sample(SHARDS, 6):
        fresh(place)
        report.unlink(missing_ok=True)
        env = {"LD_PRELOAD": str(place.shim), "UMOV_FAULT": f"{call}:{number}:{code}", "UMOV_FAULT_UNDER": str(growing),
               "UMOV_FAULT_COUNT": str(report)}
        ended = place.umov("scale", "run", "job", "--workers", workers, env=env)
        assert_clean_end(ended, {0, 6})
        assert not os.listdir(growing), "what was half done is still there"
        if ended.code == 6:
            stops += 1
            assert "umov scale run" in ended.err and "goes on" in ended.err, ended.err
            assert begun(report) <= len(done(place.folder / "job")) + workers
        assert_goes_on(place, place.folder / "job", job, SHARDS)
    assert stops > 0


@pytest.mark.parametrize("workers", [1, 2])
def test_poison_among_the_shards_is_told_and_the_others_are_done(place, job, workers):
    """A shard that crashes its process, one that never ends, one that takes all memory that its process may have."""
    fresh(place)
    env = {"LD_PRELOAD": str(place.shim), "UMOV_POISON": "2:crash,5:hang,7:memory"}
    ended = place.umov("scale", "run", "job", "--workers", workers, "--timeout-s", 5, "--memory-mb", 500, env=env)
    assert_clean_end(ended, {3})
    assert "3 shards could not be done" in ended.err, ended.err
    assert [int(name[:8]) for name in done(place.folder / "job")] == [0, 1, 3, 4, 6, 8, 9]
    assert not os.listdir(place.folder / "job/tmp")
    told = [json.loads((place.folder / f"job/failed/{k:08d}.json").read_text()) for k in (2, 5, 7)]
    assert [(one["code"], one["attempts"]) for one in told] == [(128 + signal.SIGSEGV, 3), (128 + signal.SIGKILL, 2), (6, 3)]
    assert "500 MB" in told[2]["message"] and "--memory-mb" in told[2]["message"]
    assert place.umov("scale", "run", "job", "-q").code == 0 and not os.listdir(place.folder / "job/failed")
    assert place.umov("scale", "merge", "job", "-q", "-o", "merged.csv").code == 0
    assert (place.folder / "merged.csv").read_bytes() == job


def test_a_job_that_no_process_has_memory_for_ends_at_once(place):
    """A mesh of two hundred thousand triangles in 64 MB: it is not tried for each shard."""
    place.scenario()
    assert place.umov("mesh", "make", "sphere", "--facets", 200_000, "-o", "cube.obj").code == 0
    assert place.umov("scale", "lock", "-q", "--per-shard", 1, "job", *POSES).code == 0
    ended = place.umov("scale", "run", "job", "--memory-mb", 64)
    assert_clean_end(ended, {6})
    assert "--memory-mb" in ended.err and not done(place.folder / "job") and not os.listdir(place.folder / "job/failed"), ended.err


@pytest.fixture
def small_disk(place):
    """A disk of its own for the job, of 400 kB."""
    disk = place.folder / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "tmpfs", disk], capture_output=True, text=True)
    if mounted.returncode:
        pytest.skip(f"no small disk can be mounted here: {mounted.stderr.strip()}")
    yield disk
    subprocess.run(["umount", disk], check=True)


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_a_full_disk_stops_all_workers_and_the_job_goes_on(place, job, small_disk, workers):
    """Begun where there was room: as many shards as fit are there, and behind the first that does not none is begun."""
    poses = (*POSES[:3], "2000", *POSES[4:])
    assert place.umov(*poses, "-o", "plain.csv").code == 0
    assert place.umov("scale", "lock", "-q", "--per-shard", "100", "large", *poses).code == 0
    folder, report = small_disk / "job", place.cache / "count.txt"
    shutil.copytree(place.folder / "large", folder)
    env = {"LD_PRELOAD": str(place.shim), "UMOV_FAULT_UNDER": str(folder / "tmp"), "UMOV_FAULT_COUNT": str(report)}
    ended = place.umov("scale", "run", folder, "--workers", workers, env=env)
    assert_clean_end(ended, {6})
    assert "goes on" in ended.err and not os.listdir(folder / "tmp"), ended.err
    there = [folder / "shards" / name for name in done(folder)]
    assert 0 < len(there) < 20 and begun(report) <= len(there) + workers
    used = sum(path.stat().st_size for path in there)
    assert used + (workers + 1) * there[0].stat().st_size > 300_000  # there was room for no more, with what others had begun
    subprocess.run(["mount", "-o", "remount,size=40m", small_disk], check=True)
    assert_goes_on(place, folder, (place.folder / "plain.csv").read_bytes(), 20)
