"""Jobs in parts on a disk that is full or breaks at any call: an end with the way on, nothing half done, and the plain bytes in the end."""
import errno
import os
import shutil

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


def done(place):
    return sorted(os.listdir(place.folder / "job/shards"))


@pytest.mark.parametrize("call,code", [("write", errno.ENOSPC), ("write", errno.EIO), ("sync", errno.EIO), ("rename", errno.EIO)])
def test_a_disk_that_fails_ends_the_job_and_it_goes_on(place, job, call, code):
    """From the N-th call of the worker on: one worker, so that at most one shard was begun."""
    shards = place.folder / "job/tmp"  # they grow here; the lease and the manifest are the driver's
    stops = 0
    for number in sample(SHARDS, 6):
        fresh(place)
        ended = place.faulty(f"{call}:{number}:{code}", "scale", "run", "job", "--workers", "1", under=shards)
        assert_clean_end(ended, {0, 6})
        assert not os.listdir(place.folder / "job/tmp"), "what was half done is still there"
        there = done(place)
        if ended.code == 6:
            stops += 1
            assert "umov scale run" in ended.err and "goes on" in ended.err, ended.err
            merged = place.umov("scale", "merge", "job", "-o", "merged.csv")
            assert merged.code == 3 and f"{SHARDS - len(there)} of {SHARDS} shards are missing" in merged.err
            assert not (place.folder / "merged.csv").exists()
        times = {name: os.stat(place.folder / "job/shards" / name).st_mtime_ns for name in there}
        assert place.umov("scale", "run", "job", "-q").code == 0
        assert all(os.stat(place.folder / "job/shards" / name).st_mtime_ns == at for name, at in times.items())
        assert place.umov("scale", "merge", "job", "-q", "-o", "merged.csv").code == 0
        assert (place.folder / "merged.csv").read_bytes() == job
        (place.folder / "merged.csv").unlink()
    assert stops > 0
