"""What begins with measurements, and jobs in parts, while a disk is full, breaks or says no at any call: a message and an
exit code of its own, the old result as it was, and the same command goes on to the bytes of an undisturbed one."""
import errno
import pathlib
import shutil

import pytest
from faults import SCENARIO, ROOT, assert_clean_end, contents, place, sample, shim, times  # noqa: F401
from test_disk import assert_same

CUT = (("05:12:00Z", "05:09:40Z"), ("step_s = 20", "step_s = 5"))
OBSERVATION = (("seed = 1", 'seed = 1\ninstrument = "c11_imx250"'), ("05:08:00Z", "05:11:00Z"), ("05:12:00Z", "05:11:03Z"),
               ("step_s = 20\n", ""), ("only = {{ alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true }}\n", ""),
               ('[bands]\nset = "paper_rgb"\n', "[atmosphere]\nseeing = {{ arcsec = 3 }}\n[observation]\n"
                'bands = ["nm:550"]\nwidth_nm = 50\nexposure_s = 0.1\n'), ('dir = "out"', 'dir = "obs"'))
LIBRARY = ("library", "build", "scenario.toml", "--cells", "4", "-o", "lib", "-q")
SEARCH = ("--scenario", "scenario.toml", "--grid", "1000", "-q")
# A job, what it writes, and what it reads of those before it.
JOBS = {
    "observe": (("observe", "observe.toml", "-q"), "obs", ()),
    "reduce": (("reduce", "obs/counts.ecsv", "-o", "stokes.ecsv", "-q"), "stokes.ecsv", ("observe",)),
    "curve": (("run", "scenario.toml", "-q"), "out", ()),
    "invert": (("invert", "pose", "out/lightcurve.csv", *SEARCH, "-o", "pose"), "pose", ("curve",)),
    "library": (LIBRARY, "lib", ()),
    "identify": (("identify", "out/lightcurve.csv", "--library", "lib", *SEARCH, "-o", "who"), "who", ("curve", "library")),
}
POSES = ("signature", "scenario.toml", "--poses", "600", "--phase", "60")


def prepared(place):
    text = SCENARIO
    for old, new in OBSERVATION:
        assert old in text, old
        text = text.replace(old, new)
    place.scenario(*CUT)
    (place.folder / "observe.toml").write_text(text.format(root=ROOT))


def made(place, job):
    """The job done, after what it needs; its arguments, its result and the bytes of that."""
    arguments, result, needs = JOBS[job]
    for one in (*needs, job):
        done = place.umov(*JOBS[one][0])
        assert done.code == 0, done.err
    return arguments, place.folder / result, contents(place.folder / result)


def numbers(place, job, call, arguments):
    """Calls that fail: of a search, which takes seconds, the first, one between and the last."""
    count = place.count(call, *arguments)
    if job in ("invert", "identify"):
        return sorted({1, (count + 1) // 2, count}) if count else []
    return sample(count, times(5, 6))


@pytest.mark.parametrize("call", ["write", "sync", "rename", "open", "mkdir"])
@pytest.mark.parametrize("job", ["observe", "reduce", "invert", "identify"])
def test_every_call_may_fail(place, job, call):
    prepared(place)
    arguments, result, good = made(place, job)
    before = place.names()
    for number in numbers(place, job, call, arguments):
        for fault in (f":{errno.EIO}", f"!{errno.ENOSPC}"):
            done = place.faulty(f"{call}:{number}{fault}", *arguments)
            assert_clean_end(done, {0, 6})
            assert_same(contents(result), good)
            assert place.names() == before, (number, fault)
            assert not place.leftovers()


@pytest.mark.parametrize("call", ["write", "sync", "rename", "open", "mkdir"])
def test_an_object_of_a_library_is_whole_or_not_there(place, call):
    prepared(place)
    _, result, good = made(place, "library")
    shutil.rmtree(result)
    count = place.count(call, *LIBRARY)
    for number in sample(count, times(6, 8)):
        shutil.rmtree(result, ignore_errors=True)
        done = place.faulty(f"{call}:{number}:{errno.ENOSPC}", *LIBRARY)
        assert_clean_end(done, {0, 6})
        assert all(good[name] == text for name, text in (contents(result) or {}).items()), number
        assert not place.leftovers()
        assert place.umov(*LIBRARY).code == 0
        assert contents(result) == good


@pytest.mark.parametrize("call", ["write", "sync", "rename", "open", "mkdir"])
def test_a_job_in_parts_goes_on_after_any_call_that_failed(place, call):
    """Workers are processes of their own: each counts its calls."""
    prepared(place)
    assert place.umov(*POSES, "-o", "plain.csv").code == 0
    plain = (place.folder / "plain.csv").read_bytes()
    begin = ("scale", "run", "job", "--per-shard", "200", *POSES)
    for number in sample(place.count(call, *begin), times(6, 12)):
        shutil.rmtree(place.folder / "job", ignore_errors=True)
        (place.folder / "merged.csv").unlink(missing_ok=True)
        done = place.faulty(f"{call}:{number}:{errno.ENOSPC}", *begin)
        assert_clean_end(done, {0, 3, 4, 6})
        again = place.umov("scale", "run", "job")
        if again.code != 0:  # it had not begun: the folder says so, and goes
            assert again.code in (3, 4, 6) and "job" in again.err, again.err
            shutil.rmtree(place.folder / "job", ignore_errors=True)
            assert place.umov(*begin).code == 0
        assert place.umov("scale", "merge", "job", "-o", "merged.csv").code == 0
        assert (place.folder / "merged.csv").read_bytes() == plain, number
        assert not [one for one in pathlib.Path(place.folder).iterdir() if ".part-" in one.name]
