"""No threads, little memory, a clock that is set back, other languages: the same bytes, or a message and exit 6."""
import errno
import os
import subprocess

import pytest
from faults import JOBS, assert_clean_end, contents, limited, place, sample, shim, times  # noqa: F401

LAST = {"run": ("run", "scenario.toml", "--threads", "4"), "signature.csv": None, "passes": None, "paper": None}
MANY = ("signature", "scenario.toml", "--poses", "9000", "--phase", "60", "-o", "t.csv", "--threads", "4")


# Not "run": what draws its pictures goes through TBB, inside Embree, which ends the program when it
# gets no thread.
@pytest.mark.parametrize("job", ["signature.csv", "passes"])
def test_no_thread_is_to_be_had(place, job):
    place.scenario()
    arguments, result = (MANY, "t.csv") if job == "signature.csv" else JOBS[job]
    assert place.umov(*arguments).code == 0
    good = contents(place.folder / result)
    for number in (1, 2, 3, 5):
        done = place.faulty(f"thread:{number}:{errno.EAGAIN}", *arguments)
        assert done.code == 0, done.err
        assert contents(place.folder / result) == good


def memory_limits(lowest_mb, highest_mb, few):
    step = max(1, (highest_mb - lowest_mb) // times(few, 150))
    return range(lowest_mb, highest_mb, step)


@pytest.mark.parametrize("job", ["run", "signature.csv", "signature.fits", "passes", "paper"])
def test_little_memory(place, job):
    """From where the program can just be loaded to where the job is done: never a signal."""
    place.scenario()
    arguments, result = JOBS[job]
    assert place.umov(*arguments).code == 0
    good = contents(place.folder / result)
    lowest = next(mb for mb in range(60, 400, 10)
                  if place.umov("--version", preexec_fn=limited(AS=mb << 20)).code == 0)
    ends = set()
    for mb in memory_limits(lowest, 620, 16):
        done = place.umov(*arguments, preexec_fn=limited(AS=mb << 20, CORE=0))
        assert_clean_end(done, {0, 6})
        assert contents(place.folder / result) == good, mb
        ends.add(done.code)
    assert 0 in ends


def test_a_clock_that_is_set_back(place):
    place.scenario()
    for job in ("run", "signature.csv", "passes"):
        arguments, result = JOBS[job]
        assert place.umov(*arguments).code == 0
        good = contents(place.folder / result)
        for number in (1, 2, 3, 10):
            done = place.faulty(f"clock:{number}!0", *arguments)
            assert done.code == 0, done.err
            assert contents(place.folder / result) == good
            assert " -" not in done.out, done.out  # no duration below 0


@pytest.mark.parametrize("language", ["de_DE", "tr_TR"])
def test_other_languages(place, tmp_path, language):
    """A comma in numbers, and an i whose capital is not I."""
    subprocess.run(["localedef", "-i", language, "-f", "UTF-8", tmp_path / f"{language}.UTF-8"], check=True)
    env = {"LOCPATH": str(tmp_path), "LC_ALL": f"{language}.UTF-8"}
    probe = subprocess.run(["locale", "decimal_point"], env={**os.environ, **env}, capture_output=True, text=True)
    assert probe.stdout == ",\n"
    place.scenario()
    for job, (arguments, result) in JOBS.items():
        if job in ("paper", "chart"):
            continue
        assert place.umov(*arguments).code == 0
        good = contents(place.folder / result)
        assert place.umov(*arguments, env=env).code == 0
        assert contents(place.folder / result) == good, job
