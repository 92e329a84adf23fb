"""Many curves, each a question of its own: answers are those of the curve alone, and those of any part are those of the whole."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

import pytest
from astropy.table import Table

from conftest import ROOT, UMOV, processor_s_of_children
from test_identify import NAMES, library  # noqa: F401
from test_invert import KNOWN, TRUTHS, observe, scene  # noqa: F401
from test_track import TRUTH

POSE = ("modes", "set95", "samples", "twins", "fit")


def write_curves(umov, scene, folder, truths, step):
    """a.csv, b.csv, c.csv of three attitudes, and bad.csv, which is no curve; returns them in an order with bad.csv second."""
    for k, (name, truth) in enumerate(zip("abc", truths)):
        assert umov("run", scene(truth, "masks", "truth", step=step), "-q").code == 0
        observe(folder, f"{name}.csv", 50, k)
    (folder / "bad.csv").write_text("time_utc,band,flux\n2018-01-21T05:09:00Z,nm:425,much\n")
    scene([1, 0, 0, 0], "masks", "fit")
    return ["a.csv", "bad.csv", "b.csv", "c.csv"]


@pytest.fixture
def curves(umov, scene, tmp_path):
    """Curves that tell their attitude, quick to answer."""
    return write_curves(umov, scene, tmp_path, [TRUTHS[0], TRUTH, TRUTHS[2]], 30)


@pytest.fixture
def short_curves(umov, scene, tmp_path):
    """Curves of few epochs, of which two leave much open and are answered by particles."""
    return write_curves(umov, scene, tmp_path, TRUTHS, 60)


def asked(curves):
    """Materials that are known: what many curves share does not depend on it, and each takes a third of the time."""
    return ["invert", "pose", *curves, "--scenario", "fit.toml", "--grid", "2000", *KNOWN]


def error_of(done):
    return [line for line in done.err.splitlines() if line.startswith("error: ")]


def data(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


@pytest.mark.slow
def test_each_curve_has_the_answer_that_it_has_alone(umov, short_curves, tmp_path):
    done = umov(*asked(short_curves), "--each", "-o", "each")
    assert done.code == 3, done.err  # one has no answer
    assert "1 of 4 curves have no answer" in done.err and "bad.csv:2" in done.err
    table = Table.read(tmp_path / "each/curves.ecsv")
    assert list(table["curve"]) == short_curves
    assert table["verdict"][1] == "failed" and "bad.csv:2" in table["problem"][1]
    assert "1 of 4 curves have no answer" in (tmp_path / "each/curves.ecsv").read_text()
    assert not table["answer"][1] and all("chi-square" in table["answer"][k] for k in (0, 2, 3))
    inputs = {one["path"] for one in json.loads((tmp_path / "each/manifest.json").read_text())["inputs"]}
    assert {"a.csv", "b.csv", "c.csv"} <= inputs and any(name.endswith(".tle") for name in inputs)
    for k in (0, 2, 3):
        alone = umov(*asked([short_curves[k]]), "-o", "alone", "--force")
        assert alone.code in (0, 4), alone.err
        for name in POSE:
            rows = [line.split(" ", 1)[1] for line in data(tmp_path / f"each/{name}.ecsv")[1:] if line.startswith(short_curves[k] + " ")]
            assert rows == data(tmp_path / f"alone/{name}.ecsv")[1:], name


@pytest.fixture(scope="module")
def answered(tmp_path_factory):
    """The folder of all curves answered in one go, and what was told of it: the same for every test, as the curves are."""
    return {"folder": tmp_path_factory.mktemp("answered") / "plain", "done": None}


@pytest.fixture
def plain(umov, curves, tmp_path, answered):
    """`plain/`, the answers of all curves in one go; what was told of them."""
    if answered["done"] is None:
        answered["done"] = umov(*asked(curves), "--each", "-o", "plain")
        shutil.copytree(tmp_path / "plain", answered["folder"])
    else:
        shutil.copytree(answered["folder"], tmp_path / "plain")
    return answered["done"]


@pytest.mark.parametrize("per_shard", [pytest.param(1, marks=pytest.mark.long), pytest.param(3, marks=pytest.mark.slow)])
def test_curves_in_parts_are_the_plain_ones(umov, curves, plain, tmp_path, per_shard):
    command = [*asked(curves), "--each"]
    assert plain.code == 3
    done = umov("scale", "run", "--per-shard", per_shard, "job", *command)
    assert done.code == 3 and error_of(done) == error_of(plain)  # all shards are done: what a curve lacks stands in its row
    for name in ("curves", *POSE):
        merged = umov("scale", "merge", "job", "--table", name, "-o", f"{name}.ecsv")
        assert merged.code == 3 and error_of(merged) == error_of(plain)
        assert (tmp_path / f"{name}.ecsv").read_bytes() == (tmp_path / f"plain/{name}.ecsv").read_bytes(), name


@pytest.mark.slow
def test_a_task_of_an_array_tells_of_its_shards_alone(umov, curves, tmp_path):
    """Whoever has them all tells of the curves: what waits for all tasks to end well shall not wait in vain."""
    command = [*asked(curves), "--each"]
    assert umov("scale", "lock", "--per-shard", 2, "job", *command).code == 0
    for k in range(2):
        assert umov("scale", "run", "--part", f"{k}/2", "job").code == 0
    assert umov("scale", "run", "job").code == 3
    assert umov("scale", "verify", "job").code == 0


@pytest.mark.parametrize("per_shard", [1, 2])
def test_tables_without_a_row_are_the_plain_ones(umov, scene, tmp_path, per_shard):
    """No curve has an answer: tables of answers have columns and no row."""
    scene([1, 0, 0, 0], "masks", "fit")
    for name in "ab":
        (tmp_path / f"{name}.csv").write_text("time_utc,band,flux\n2018-01-21T05:09:00Z,nm:425,much\n")
    command = [*asked(["a.csv", "b.csv"]), "--each"]
    plain = umov(*command, "-o", "plain")
    assert plain.code == 3 and "2 of 2 curves have no answer" in plain.err
    assert umov("scale", "run", "--per-shard", per_shard, "job", *command).code == 3
    for name in ("curves", *POSE):
        merged = umov("scale", "merge", "job", "--table", name, "-o", f"{name}.ecsv")
        assert merged.code == 3 and error_of(merged) == error_of(plain)
        assert (tmp_path / f"{name}.ecsv").read_bytes() == (tmp_path / f"plain/{name}.ecsv").read_bytes(), name
    assert len(Table.read(tmp_path / "modes.ecsv")) == 0 and "curve" in Table.read(tmp_path / "modes.ecsv").colnames
    for suffix in ("csv", "fits", "json"):
        assert umov("scale", "merge", "job", "--table", "modes", "-o", f"modes.{suffix}").code == 3
        assert (tmp_path / f"modes.{suffix}").exists()


@pytest.mark.slow
def test_shards_of_curves_are_its_rows(umov, curves, plain, tmp_path):
    command = [*asked(curves), "--each"]
    rows = []
    for k in range(3):
        done = umov(*command, "--shard", f"{k}/3", "-o", f"part_{k}")
        assert done.code == (3 if k == 0 else 0), done.err  # the first part has two curves, bad.csv among them
        rows += data(tmp_path / f"part_{k}/modes.ecsv")[1:]
    assert rows == data(tmp_path / "plain/modes.ecsv")[1:]


@pytest.mark.long
def test_identities_in_parts_are_the_plain_ones(umov, short_curves, library, tmp_path):
    command = ["identify", *short_curves, "--each", "--library", "lib", "--scenario", "place.toml"]
    plain = umov(*command, "-o", "plain")
    assert plain.code == 3 and "bad.csv" in plain.err, plain.err
    identity = Table.read(tmp_path / "plain/identity.ecsv")
    assert set(identity["curve"]) == {"a.csv", "b.csv", "c.csv"}
    assert len(identity) == 3 * (len(NAMES) + 1)
    done = umov("scale", "run", "--per-shard", 2, "job", *command)
    assert done.code == 3 and error_of(done) == error_of(plain)
    for name in ("curves", "identity", "modes", "fit"):
        assert umov("scale", "merge", "job", "--table", name, "-o", f"{name}.ecsv").code == 3
        assert (tmp_path / f"{name}.ecsv").read_bytes() == (tmp_path / f"plain/{name}.ecsv").read_bytes(), name


@pytest.mark.long
def test_objects_are_made_ready_once(umov, short_curves, library, tmp_path):
    """A mesh that goes away when the first curve is answered is missed by none of the others, whose answers are those that
    they have alone."""
    command = ["identify", "a.csv", "b.csv", "c.csv", "--each", "--library", "lib", "--scenario", "place.toml", "--grid", "2000",
               "--objects", "plain.toml"]
    assert umov("scale", "lock", "--per-shard", 1, "job", *command).code == 0
    alone = [umov("identify", name, *command[5:], "-o", name + ".out") for name in ("a.csv", "b.csv", "c.csv")]
    assert all(one.code in (0, 4) for one in alone), alone[0].err
    worker = subprocess.Popen([UMOV, "scale", "worker", "job", "-q"], cwd=tmp_path, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    mesh = next(tmp_path.glob("*.obj"))
    try:
        for k in range(3):
            print(k, file=worker.stdin, flush=True)
            assert json.loads(worker.stdout.readline())["status"] == "done"
            mesh.unlink(missing_ok=True)
    finally:
        worker.stdin.close()
        worker.wait()
    merged = umov("scale", "merge", "job", "-o", "curves.ecsv")
    assert merged.code == 0, merged.err
    for name in ("identity", "modes", "fit"):
        assert umov("scale", "merge", "job", "--table", name, "-o", f"{name}.ecsv").code == 0
        rows = data(tmp_path / f"{name}.ecsv")[1:]
        assert [row.split(" ", 1)[1] for row in rows] == [row for one in "abc" for row in data(tmp_path / f"{one}.csv.out/{name}.ecsv")[1:]]
    by = Table.read(tmp_path / "identity.ecsv")["by"]
    assert sum(by == "model") == 3  # its own light was asked by every curve


@pytest.mark.slow
def test_another_orbit_is_another_job(umov, short_curves, library, tmp_path):
    command = ["identify", *short_curves, "--each", "--library", "lib", "--scenario", "place.toml"]
    orbit, place = tmp_path / "hst.tle", tmp_path / "place.toml"
    orbit.write_text((ROOT / "data/tle/hst.tle").read_text())
    place.write_text(place.read_text().replace(f"{ROOT}/data/tle/hst.tle", "hst.tle"))
    assert umov("scale", "lock", "--per-shard", 2, "job", *command).code == 0
    one, two = orbit.read_text().splitlines()[-2:]
    two = two[:43] + f"{(float(two[43:51]) + 2) % 360:8.4f}" + two[51:68]  # the mean anomaly
    total = sum(int(c) if c.isdigit() else c == "-" for c in two)
    orbit.write_text("\n".join([*orbit.read_text().splitlines()[:-2], one, two + str(total % 10)]) + "\n")
    done = umov("scale", "run", "job")
    assert done.code != 0 and orbit.name in done.err, done.err


@pytest.mark.parametrize("words, told", [(["invert", "pose", "a.csv", "--scenario", "fit.toml", "--shard", "0/2"], "--each"),
                                         (["scale", "run", "job", "invert", "pose", "a.csv", "--scenario", "fit.toml"], "--each"),
                                         (["scale", "run", "job", "invert", "spin", "a.csv", "--scenario", "fit.toml"], "pose")])
def test_what_has_no_parts_is_refused(umov, tmp_path, words, told):
    done = umov(*words)
    assert done.code == 2 and told in done.err, done.err
    assert not (tmp_path / "job").exists()


def processor_s(process):
    """Seconds of the processor that a process has had."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.fixture
def large(umov, tmp_path):
    """The scenario of a mesh of 200,000 triangles, which takes seconds to be made ready."""
    umov("mesh", "make", "sphere", "--facets", 200_000, "-o", tmp_path / "ball.obj")
    (tmp_path / "big.toml").write_text(f"""umov = 1
[observer]
name = "maui"
[time]
start = 2018-01-21T05:10:00Z
stop = 2018-01-21T05:11:00Z
[[object]]
mesh = {{ file = "ball.obj", unit = "m", up = "+Z" }}
orbit = {{ file = "{ROOT}/data/tle/hst.tle" }}
attitude = {{ mode = "nadir" }}
materials = {{ default = "gold" }}
[bands]
set = ["nm:550"]
""")


def seconds_to_stop(process, stop):
    """Seconds of the processor that it takes from when its job is being made until it has ended, and what it said of that."""
    while processor_s(process) < 0.4:
        time.sleep(0.01)
    before = processor_s_of_children()
    had = processor_s(process)
    stop(process)
    told = process.stderr.read()
    process.wait(timeout=120)
    return processor_s_of_children() - before - had, told


#: A fifth of a second, and what the pages take that are given back; /proc counts hundredths.
SOON = 0.4


@pytest.mark.parametrize("words", [("invert", "pose", "--each", "--scenario", "big.toml", ROOT / "examples/agena_pass.csv"),
                                   ("scale", "plan", "job", "signature", "big.toml", "--poses", "1000", "--phase", "60")], ids=["each", "scale"])
def test_a_job_is_stopped_while_it_is_made(large, tmp_path, words):
    """Nothing listened until it was."""
    process = subprocess.Popen([UMOV, *map(str, words)], cwd=tmp_path, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    took, told = seconds_to_stop(process, lambda one: one.send_signal(signal.SIGINT))
    assert process.returncode == 130, told
    assert "stopped by the user" in told
    assert took < SOON


@pytest.mark.slow
def test_a_worker_whose_driver_went_ends_while_its_job_is_made(umov, large, tmp_path):
    """It looked when the job was made; nobody is there who would hear of it."""
    assert umov("scale", "lock", "job", "signature", "big.toml", "--poses", "4", "--phase", "60").code == 0
    process = subprocess.Popen([UMOV, "scale", "worker", "job"], cwd=tmp_path, text=True, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE)
    took, told = seconds_to_stop(process, lambda one: one.stdin.close())
    assert (process.returncode, told) == (130, "")
    assert took < SOON
