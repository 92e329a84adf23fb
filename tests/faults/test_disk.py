"""A disk that is full, breaks or says no at any call: a message and exit 6, and the old result as it was."""
import errno

import pytest
from faults import JOBS, assert_clean_end, contents, limited, place, sample, shim, times  # noqa: F401


def made(place, job):
    """Runs the job and then again over its result, with the number of its calls."""
    place.scenario()
    arguments, result = JOBS[job]
    assert place.umov(*arguments).code == 0
    return arguments, place.folder / result, contents(place.folder / result)


def assert_same(found, good):
    """But for where a run tells of what went wrong on its way."""
    if isinstance(good, dict):
        found, good = ({name: text for name, text in all.items() if name not in ("report.html", "log.txt")}
                       for all in (found, good))
    assert found == good


@pytest.mark.parametrize("call", ["write", "sync", "rename", "open", "mkdir"])
@pytest.mark.parametrize("job", JOBS)
def test_every_call_may_fail(place, job, call):
    arguments, result, good = made(place, job)
    (before := place.names()).sort()
    count = place.count(call, *arguments)
    for number in sample(count, 6):
        for code in (errno.ENOSPC, errno.EIO) if call == "write" else (errno.EIO,):
            for once in (":", "!"):
                done = place.faulty(f"{call}:{number}{once}{code}", *arguments)
                assert_clean_end(done, {0, 6})
                # Done all the same: what failed was not needed. Else the old result stands.
                assert_same(contents(result), good)
                assert place.names() == before, (number, once)
                if done.code == 6:
                    assert place.umov(*arguments).code == 0
                assert not place.journals()


@pytest.mark.parametrize("job", ["run", "signature.csv", "signature.fits", "signature.json", "paper"])
def test_no_room_at_any_byte(place, job):
    """RLIMIT_FSIZE reaches what no preloaded library does, such as the streams inside CFITSIO."""
    arguments, result, good = made(place, job)
    before = place.names()
    size = max(map(len, good.values())) if isinstance(good, dict) else len(good)
    steps = times(8, 100)
    for limit in sorted({0, 1, 100, max(0, size - 5000), max(0, size - 2000), size - 1, *(size * k // steps for k in range(1, steps + 1))}):
        done = place.umov(*arguments, preexec_fn=limited(FSIZE=limit))
        assert_clean_end(done, {0, 6})
        assert done.code == 6 or limit >= size
        assert_same(contents(result), good)
        assert place.names() == before, limit


@pytest.mark.parametrize("job", ["run", "signature.csv", "passes"])
def test_a_read_error_is_no_end_of_file(place, job):
    arguments, result, good = made(place, job)
    for under in (place.folder, __file__.split("/tests/faults")[0] + "/data"):
        count = place.count("read", *arguments, under=under)
        for number in sample(count, 6):
            done = place.faulty(f"read:{number}:{errno.EIO}", *arguments, under=under)
            assert_clean_end(done, {0, 3, 6})
            assert contents(result) == good
