"""The N-th request for memory is refused, alone or with all that follow: a message and exit code 6, the old result as it
was, and never a result that lacks what there was no memory for."""
import errno
import re
import shutil

import pytest
from faults import JOBS, PASSES, ROOT, assert_clean_end, contents, place, shim, times  # noqa: F401
from test_disk import assert_same

# What reads, and prints or writes: arguments, and the result.
READERS = {
    "obj": (("mesh", "convert", "cube.obj", "--unit", "m", "--up", "+Z", "-o", "cube.glb"), "cube.glb"),
    "gltf": (("mesh", "convert", "cube.glb", "-o", "cube.stl"), "cube.stl"),
    "stl": (("mesh", "info", "cube.stl", "--unit", "m", "--up", "+Z"), None),
    "tle": (("orbit", "convert", "--orbit", ROOT / "data/tle/hst.tle", "-o", "hst.xml"), "hst.xml"),
    "omm": (("orbit", "convert", "--orbit", "hst.xml", "-o", "hst.json"), "hst.json"),
    "json": (("orbit", "convert", "--orbit", "hst.json", "--to", "kvn"), None),
    "index": (("material", "show", "aluminium"), None),
    "scenario": (("run", "scenario.toml", "--dry-run"), None),
}


def undated(text):
    """Messages say when they were made."""
    return re.sub(rb"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d", b"", text, count=1)


def spread(count, number):
    """So many calls from the first to the last."""
    return sorted({1 + (count - 1) * k // (number - 1) for k in range(number)})


def sweep(place, arguments, number, check):
    """Refuses one request at a time, then all from there on."""
    for at in spread(place.count("alloc", *arguments), number):
        for fault in (f"alloc:{at}!{errno.ENOMEM}", f"alloc:{at}:{errno.ENOMEM}"):
            done = place.faulty(fault, *arguments)
            assert_clean_end(done, {0, 3, 6})
            check(done, fault)


@pytest.mark.parametrize("job", JOBS)
def test_jobs_without_memory(place, job):
    place.scenario()
    arguments, result = JOBS[job]
    assert place.umov(*arguments).code == 0
    good, before = contents(place.folder / result), place.names()

    def check(done, fault):
        assert_same(contents(place.folder / result), good)
        # What needs memory to be removed may stay where there is none; a later run removes it.
        if "!" not in fault:
            for name in place.leftovers():
                path = place.folder / name
                shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
        assert place.names() == before, fault

    sweep(place, arguments, times(6, 200), check)


@pytest.mark.parametrize("reader", READERS)
def test_readers_without_memory(place, reader):
    place.scenario()
    for arguments, result in READERS.values():  # each makes what the next one reads
        done = place.umov(*arguments)
        assert done.code == 0, done.err
    arguments, result = READERS[reader]
    printed = place.umov(*arguments).out
    written = result and contents(place.folder / result)
    before = place.names()

    def check(done, fault):
        if result:
            assert undated(contents(place.folder / result)) == undated(written), fault
        elif done.code == 0:
            assert undated(done.out.encode()) == undated(printed.encode()), fault
        assert place.names() == before, fault

    sweep(place, arguments, times(6, 200), check)
