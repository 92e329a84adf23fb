"""Outputs that are no plain files, folders that are not as they were, and names that nobody would choose."""
import os
import stat
import subprocess
import threading

import pytest
from faults import JOBS, POSES, assert_clean_end, contents, place, shim  # noqa: F401

TABLES = ["csv", "ecsv", "json", "fits"]


@pytest.mark.parametrize("suffix", TABLES)
def test_a_pipe(place, suffix):
    place.scenario()
    pipe = place.folder / f"t.{suffix}"
    os.mkfifo(pipe)
    got = []
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()), daemon=True)
    reader.start()
    done = place.umov(*POSES, "-o", pipe.name)
    if suffix == "fits":  # its header is written last
        assert done.code == 6 and "no regular file" in done.err
        pipe.open("wb").close()
    else:
        assert done.code == 0, done.err
        reader.join(60)
        assert place.umov(*POSES, "-o", f"plain.{suffix}").code == 0
        assert got[0] == (place.folder / f"plain.{suffix}").read_bytes()
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert not [name for name in place.names() if "partial" in name or "part-" in name]


@pytest.mark.parametrize("suffix", TABLES)
def test_devices_stay_devices(place, suffix):
    """/dev/full and /dev/null through links, since the suffix says what is written."""
    place.scenario()
    for device in ("full", "null"):
        link = place.folder / f"{device}.{suffix}"
        link.symlink_to(f"/dev/{device}")
        done = place.umov(*POSES, "-o", link.name)
        assert_clean_end(done, {6} if device == "full" or suffix == "fits" else {0})
        assert link.is_symlink() and stat.S_ISCHR(os.stat(f"/dev/{device}").st_mode)


def test_standard_output_full_or_closed(place):
    place.scenario()
    for arguments in ((*POSES,), (*POSES, "--json"), ("run", "scenario.toml"), JOBS["passes"][0][:-2]):
        with open("/dev/full", "wb") as full:
            done = place.umov(*arguments, stdout=full)
        assert_clean_end(done, {6})
        done = place.umov(*arguments, preexec_fn=lambda: os.close(1))
        assert_clean_end(done, {0, 6})


def test_links_and_private_files(place):
    place.scenario()
    for suffix in TABLES:
        real, link = place.folder / f"real.{suffix}", place.folder / f"link.{suffix}"
        real.write_text("old")
        real.chmod(0o600)
        link.symlink_to(real.name)
        done = place.umov(*POSES, "-o", link.name)
        assert done.code == 0, done.err
        assert link.is_symlink() and real.stat().st_size > 1000
        assert stat.S_IMODE(real.stat().st_mode) == 0o600


def as_nobody(place, *arguments):
    """umov without root's rights; they would make every folder writable."""
    if os.geteuid() != 0:
        return place.umov(*arguments)
    for path in (place.folder, *place.folder.parents):
        if len(path.parts) > 2:
            path.chmod(path.stat().st_mode | 0o055)
    return place.umov(*arguments, user=65534, group=65534, env={"XDG_CACHE_HOME": "/nonexistent"})


@pytest.mark.parametrize("job", JOBS)
def test_a_folder_that_may_not_be_written(place, job):
    place.scenario()
    place.folder.chmod(0o555)
    try:
        done = as_nobody(place, *JOBS[job][0])
        assert_clean_end(done, {6})
        assert "Permission denied" in done.err
    finally:
        place.folder.chmod(0o755)
    assert place.names() == ["cube.obj", "scenario.toml"]


@pytest.mark.parametrize("job", ["signature.csv", "signature.fits", "signature.json", "run"])
def test_a_folder_that_vanishes(place, job):
    """While the job runs: a message, and nothing anywhere."""
    place.scenario()
    (place.folder / "gone").mkdir()
    arguments, result = JOBS[job]
    if job == "run":
        arguments = (*arguments, "-o", "gone/out")
    else:
        arguments = (*arguments[:-1], f"gone/{result}")
    stop = threading.Event()

    def remove():
        while not stop.is_set():
            subprocess.run(["rm", "-rf", "gone"], cwd=place.folder, stderr=subprocess.DEVNULL)

    done = []
    remover = threading.Thread(target=remove)
    remover.start()
    try:
        done = place.umov(*arguments)
    finally:
        stop.set()
        remover.join()
    assert_clean_end(done, {0, 6})


NAMES = [b"caf\xe9", b"a\x01b\x1b[2Jc", b"new\nline", b"n" * 250, b"-dash", b"blank  blank", b"'\"$(x)", "Ünï☃".encode()]


@pytest.mark.parametrize("name", NAMES, ids=lambda name: repr(name[:12]))
def test_names_that_nobody_would_choose(place, name):
    place.scenario()
    text = (place.folder / "scenario.toml").read_bytes()
    folder = os.fsencode(place.folder)
    for suffix in TABLES:
        table = name[:255 - len(suffix) - 1] + b"." + suffix.encode()
        done = place.umov(*POSES, "-o", b"./" + table)
        assert done.code == 0, done.err
        assert os.path.getsize(folder + b"/" + table) > 1000
    scene = name[:250] + b".toml"
    with open(folder + b"/" + scene, "wb") as file:
        file.write(text)
    done = place.umov("run", b"./" + scene, "-o", b"./" + name + b"x")
    assert done.code == 0, done.err
    assert "\x1b" not in done.out + done.err
    assert os.path.exists(folder + b"/" + name + b"x/report.html")
    done = place.umov("signature", b"./" + scene, "--geometry", b"./" + name[:251] + b".csv")
    assert done.code == 0, done.err


def test_a_name_that_is_too_long(place):
    place.scenario()
    for arguments in (("-o", "n" * 260 + ".csv"), ("-o", "d/" * 3000 + "t.csv")):
        assert_clean_end(place.umov(*POSES, *arguments), {6})
    assert_clean_end(place.umov("run", "scenario.toml", "-o", "n" * 260), {6})


def test_two_runs_into_one_folder(place):
    """Whichever ends last gives the result: whole, and nothing else is left."""
    place.scenario()
    for _ in range(3):
        both = [place.start("run", "scenario.toml", "--seed", str(seed)) for seed in (1, 2, 3)]
        for process in both:
            _, err = process.communicate(timeout=120)
            assert process.returncode == 0, err
        found = contents(place.folder / "out")
        seeds = [text.split(b"seed = ")[1].split()[0] for name, text in found.items() if name == "scenario.lock.toml"]
        assert seeds in ([b"1"], [b"2"], [b"3"])
        assert place.names() == ["cube.obj", "out", "scenario.toml"]
        assert set(os.listdir(place.folder / "out")) == {"lightcurve.csv", "lightcurve.ecsv", "log.txt", "manifest.json",
                                                         "passes.ecsv", "report.html", "scenario.lock.toml"}
