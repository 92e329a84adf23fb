"""Jobs in parts on a Dask cluster. Skipped, saying so, where Dask is not installed."""
import contextlib
import json
import os
import pathlib
import pickle
import shutil
import signal
import stat
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import EXAMPLES, UMOV

import umov

pytest.importorskip("distributed", reason="Dask is not installed: umov[scale] is not tested")
psutil = pytest.importorskip("psutil")


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """A box with wings, lit by rays: some ten milliseconds a pose."""
    monkeypatch.chdir(tmp_path)
    subprocess.run([UMOV, "mesh", "make", "cubesat", "--units", "3", "--panels", "2", "-o", "sat.obj"], check=True)
    (tmp_path / "sat.toml").write_text("""umov = 1
[[object]]
name = "sat"
mesh = { file = "sat.obj", unit = "m", up = "+Z", normals = "flat" }
[object.materials]
default = "paper_al"
[bands]
set = "paper_rgb"
""")
    return "sat.toml"


def job_of(scene, poses=400):
    return umov.scale.Job("signature", scene, poses=poses, phase=60, visibility="rays", accuracy=0.05)


def plain_bytes(job, name="plain.csv"):
    subprocess.run([UMOV, *job.words, "-q", "-o", name], check=True)
    return pathlib.Path(name).read_bytes()


def merged_bytes(result):
    result.merge("merged.csv")
    return pathlib.Path("merged.csv").read_bytes()


@pytest.mark.parametrize("cluster", [None, "local:1", "local:2", "local:4"])
def test_clusters_give_the_plain_bytes(scene, cluster):
    job = job_of(scene)
    result = umov.scale.run(job, "out", cluster=cluster, per_shard=60)
    assert not result.missing and not result.failed and result.status["is_complete"]
    assert merged_bytes(result) == plain_bytes(job)
    assert (result.folder / "manifest.json").exists()


@pytest.mark.parametrize("cluster", [None, "local:1"])
def test_curves_without_an_answer_are_told(scene, cluster):
    """The command ends with 3; here all is there, and a warning says what single curves lack."""
    pathlib.Path("place.toml").write_text(pathlib.Path(scene).read_text().replace(
        "umov = 1\n", "umov = 1\n[observer]\nlat_deg = 20.7\nlon_deg = -156.3\nalt_m = 3058\n").replace(
        'name = "sat"\n', f'name = "sat"\norbit = {{ file = "{EXAMPLES.parent}/data/tle/hst.tle", norad = 20580 }}\n'))
    for name in "ab":
        pathlib.Path(f"{name}.csv").write_text("time_utc,band,flux\n2018-01-21T05:09:00Z,nm:425,much\n")
    job = umov.scale.Job("invert", "pose", "a.csv", "b.csv", each=True, scenario="place.toml", grid=2000)
    told = "2 of 2 curves have no answer, the others have theirs: a.csv:2"
    with pytest.warns(umov.UmovWarning, match=told):
        result = umov.scale.run(job, "out", cluster=cluster, per_shard=1)
    assert not result.missing and not result.failed
    with pytest.warns(umov.UmovWarning, match=told):
        result.merge("modes.ecsv", "modes")
    assert pathlib.Path("modes.ecsv").exists()
    done = subprocess.run([sys.executable, "-m", "umov.scale", "run", "out", "--cluster", "local:1", "--program", UMOV],
                          capture_output=True, text=True)
    assert done.returncode == 3 and told in done.stderr  # as umov scale run --cluster


@pytest.mark.parametrize("cluster", [None, "local:1"])
def test_what_is_kept_of_rows_is_small_and_that_of_all_rows(scene, cluster):
    job, reduce = job_of(scene, 300), ["log-histogram:intensity:1e-3:10:20", "most:intensity:7"]
    whole = umov.scale.run(job, "whole", per_shard=300).rows()
    result = umov.scale.run(job, "out", cluster=cluster, reduce=reduce, per_shard=40)
    assert result.lock["tables"] == ["log_histogram_intensity", "most_intensity"]
    assert umov.scale.plan(job, reduce=reduce).gigabytes < 0.5 * umov.scale.plan(job).gigabytes
    result.merge("histogram.csv")
    result.merge("most.csv", "most_intensity")

    def column(file, name):
        lines = [line.split(",") for line in pathlib.Path(file).read_text().splitlines() if not line.startswith("#")]
        return [line[lines[0].index(name)] for line in lines[1:]]

    assert sum(map(int, column("histogram.csv", "count"))) == len(whole) == 900
    counts, _ = np.histogram(whole["intensity"], np.geomspace(1e-3, 10, 21))
    told = np.array(list(map(int, column("histogram.csv", "count")))).reshape(3, 23)[:, :20].sum(axis=0)
    assert told.tolist() == counts.tolist()
    for band in set(whole["band"]):
        best = np.sort(whole["intensity"][whole["band"] == band])[::-1][:7]
        mine = [float(value) for value, of in zip(column("most.csv", "intensity"), column("most.csv", "band")) if of == band]
        assert mine == pytest.approx(best.tolist(), rel=1e-6)  # as a CSV has them


def test_rows_are_opened_lazily(scene):
    result = umov.scale.run(job_of(scene, 100), "out", per_shard=30)
    plain_bytes(job_of(scene, 100))
    rows = result.rows()
    lines = [line for line in pathlib.Path("plain.csv").read_text().splitlines() if not line.startswith("#")]
    assert len(rows) == len(lines) - 1 == 300
    column = lines[0].split(",").index("intensity")
    plain = [float(line.split(",")[column]) for line in lines[1:]]
    assert rows["intensity"].tolist() == plain
    assert rows.row(157)["intensity"] == plain[157] and rows.row(157)["band"] == lines[158].split(",")[1]
    assert result.dask_array(["intensity"]).sum().compute() == pytest.approx(sum(plain), rel=1e-12)
    dataset = result.to_parquet("parquet")
    assert dataset.count_rows() == 300
    assert dataset.to_table(columns=["intensity"])["intensity"].to_pylist() == plain
    assert dataset.to_table(columns=["band"])["band"].to_pylist() == rows["band"].tolist() == [line.split(",")[1] for line in lines[1:]]
    assert str(dataset.schema.field("band").type) == "string" and dataset.schema.field("intensity").metadata[b"unit"] == b"m2 / sr"


@pytest.mark.slow
def test_workers_that_are_killed_cost_no_byte(scene):
    """Once the cluster is up, a worker or its child is killed by signal 9, five times, so far
    apart that a worker can start again between; nothing is left over."""
    job, stop = job_of(scene, 3000), threading.Event()
    me, killed = psutil.Process(), []

    def storm():
        while not list(pathlib.Path("out/shards").glob("*.rows")) and not stop.wait(0.1):
            pass
        while len(killed) < 5 and not stop.wait(0.3 if not killed else 6):
            victims = [p for p in me.children(recursive=True) if "scale worker" in " ".join(p.cmdline())
                       or "spawn_main" in " ".join(p.cmdline())]
            if victims:
                victim = victims[len(killed) % len(victims)]
                killed.append(victim.pid)
                victim.kill()

    thread = threading.Thread(target=storm, daemon=True)
    thread.start()
    try:
        result = umov.scale.run(job, "out", cluster="local:2", per_shard=25)
    finally:
        stop.set()
        thread.join()
    assert killed
    assert merged_bytes(result) == plain_bytes(job)
    assert not list((result.folder / "tmp").iterdir())
    time.sleep(6)
    assert not [p for p in psutil.process_iter(["cmdline"])
                if str(result.folder) in " ".join(p.info["cmdline"] or [])]


def wrapper(tmp_path, body):
    """A command that does what `body` says before a shard, and is umov otherwise."""
    script = tmp_path / "umov_that_fails"
    script.write_text(f"""#!{sys.executable}
import os, signal, subprocess, sys, time
if sys.argv[1:3] != ["scale", "worker"]:
    os.execv({str(UMOV)!r}, [{str(UMOV)!r}, *sys.argv[1:]])
child = subprocess.Popen([{str(UMOV)!r}, *sys.argv[1:]], stdin=subprocess.PIPE)
for line in sys.stdin:
    index = int(line)
    {body}
    child.stdin.write(line.encode())
    child.stdin.flush()
child.stdin.close()
""")
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return str(script)


@pytest.mark.slow
def test_poison_is_told_and_the_others_are_done(scene, tmp_path):
    """One shard crashes its process, one hangs: three trials and two, and 18 of 20 are there."""
    program = wrapper(tmp_path, "if index == 3: os.kill(os.getpid(), signal.SIGSEGV)\n"
                                "    if index == 7: time.sleep(1000)")
    begin = time.monotonic()
    with pytest.raises(umov.InputError, match="2 shards could not be done"):
        umov.scale.run(job_of(scene), "out", cluster="local:2", per_shard=20, timeout_s=5, program=program)
    assert time.monotonic() - begin < 300
    result = umov.scale.Result("out")
    assert result.missing == [3, 7]
    assert [(one["index"], one["code"], one["attempts"]) for one in result.failed] == \
        [(3, 128 + signal.SIGSEGV, 3), (7, 128 + signal.SIGKILL, 2)]
    again = umov.scale.run(None, "out")
    assert not again.missing and not again.failed
    assert merged_bytes(again) == plain_bytes(job_of(scene))


def told_words(tmp_path, body=""):
    """A command that writes down with what words each worker was started."""
    return wrapper(tmp_path, f"print(*sys.argv[1:], file=open({str(tmp_path / 'words')!r}, 'a'))\n    {body}")


@pytest.mark.slow
def test_words_of_the_command_reach_the_workers(scene, tmp_path):
    """As umov scale run --cluster starts it: threads, memory, and the time after which a shard that hangs is ended."""
    program = told_words(tmp_path, "if index == 3: time.sleep(1000)")
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "100", "out", *job_of(scene).words], check=True)
    done = subprocess.run([sys.executable, "-m", "umov.scale", "run", "out", "--cluster", "local:1", "--program", program, "--threads", "2",
                           "--timeout-s", "6", "--memory-mb", "700", "--quiet"], capture_output=True, text=True)
    assert done.returncode == 3 and "it was not done after 6 s" in done.stderr, done.stderr
    assert umov.scale.Result("out").missing == [3]
    assert set((tmp_path / "words").read_text().splitlines()) == {f"scale worker {tmp_path / 'out'} --threads 2 --memory-mb 700 -q"}


@pytest.mark.parametrize("memory_mb", [63, 0, -5, 100.5, "200", True, 10**12])
def test_memory_that_is_none_is_refused(scene, memory_mb):
    with pytest.raises(umov.UsageError, match="memory_mb is .* from 64"):
        umov.scale.run(job_of(scene, 20), "out", memory_mb=memory_mb)
    assert not pathlib.Path("out").exists()


@pytest.mark.slow
@pytest.mark.parametrize("cluster", [None, "local:1"])
def test_a_job_without_memory_for_any_shard_ends_soon(scene, cluster):
    """Three bands of a million bins are hundreds of megabytes; ten attempts, and twelve where each shard has its three at once."""
    with pytest.raises(umov.DeviceError, match="1[02] attempts ran out of memory.*umov scale run .*out goes on"):
        umov.scale.run(job_of(scene, 8), "out", cluster=cluster, reduce="histogram:intensity:0:1:1000000", per_shard=2, memory_mb=200)
    assert len(umov.scale.Result("out").missing) == 4
    again = umov.scale.run(None, "out", cluster=cluster)
    assert not again.missing and not again.failed


def test_a_worker_of_other_memory_is_another(scene, tmp_path):
    from umov import _scale_worker
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "20", "out", *job_of(scene, 60).words], check=True)
    program = told_words(tmp_path)
    try:
        for index, memory_mb in enumerate((500, 700, 500)):
            assert _scale_worker.do_shard(index, program, "out", 1, 60, memory_mb)["status"] == "done"
    finally:
        _scale_worker._end_all()
        _scale_worker._idle.clear()
    assert [line.split()[6] for line in (tmp_path / "words").read_text().splitlines()] == ["500", "700", "500"]


@pytest.mark.parametrize("limit, threads, expected", [(100e6, 4, 64), (8e9, 2, 4000), (0, 2, None), (None, 2, None)])
def test_memory_of_a_dask_worker_is_shared_by_its_threads(monkeypatch, limit, threads, expected):
    """64 MB at least, which is the least that the command takes; no limit: the command's own."""
    import types
    import distributed
    from umov import _scale_worker
    worker = types.SimpleNamespace(memory_manager=types.SimpleNamespace(memory_limit=limit), state=types.SimpleNamespace(nthreads=threads))
    monkeypatch.setattr(distributed, "get_worker", lambda: worker)
    assert _scale_worker._memory_of_this_worker_mb() == expected


class Played:
    """A cluster whose records are made up: `how` says of each call of a shard what comes of it, "lost" or a record."""

    def __init__(self, how):
        self.how, self.asked, self.tasks, self.status, self.client = how, [], [], "running", self
        self.troubles = []  # of fetching records

    def workers(self):
        return {"one"}

    def processing(self):
        return {}

    def cancel(self, futures):
        pass

    def map(self, do, indices, *, pure, key, **same):
        return [self.future(json.loads(text), name) for text, name in zip(indices, key)]

    def future(self, indices, name):
        import types
        self.asked += indices
        self.tasks.append(indices)
        came = []
        for index in indices:
            came.append(self.how(index, self.asked.count(index)))
            if came[-1] == "lost" or came[-1]["status"] != "done":  # as do_shards
                break
        is_lost = came[-1] == "lost"
        return types.SimpleNamespace(key=name, status="lost" if is_lost else "finished", came=came, release=lambda: None)

    def sync(self, function, callback_timeout):
        if self.troubles:
            raise self.troubles.pop()
        return function()

    def gather(self, futures, errors, asynchronous):
        return [future.came for future in futures]


def driver_of(scene, how, shards=20):
    from umov._scale_driver import Driver
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "10", "out", *job_of(scene, 10 * shards).words], check=True)
    played = Played(how)
    return Driver(umov.scale.Result("out"), played, 1, None, True), played


def record(index, status="done"):
    return {"index": index, "status": status, "code": 6 if status == "exhausted" else 0, "message": "too little", "seconds": 1.0, "attempts": 3}


def test_a_record_that_is_lost_is_asked_for_again(scene):
    """Its worker was killed when the shard was done: no other is asked for twice, and nothing has failed."""
    driver, played = driver_of(scene, lambda index, turn: "lost" if index in (3, 4) and turn == 1 else record(index))
    driver.task_s = 0.0  # a task for each
    driver.run()
    assert sorted(played.asked) == sorted([*range(20), 3, 4]) and (driver.done, driver.failed) == (20, 0)


def test_short_shards_share_a_task_and_what_it_leaves_is_asked_for_again(scene):
    """Shards of 0.2 s: five would be a second; one worker has four tasks before it, so the first are of five and the last of one."""
    driver, played = driver_of(scene, lambda index, turn: record(index, "failed" if index == 2 else "done"), 40)
    driver.predicted_s = 0.2
    driver.run()
    assert played.tasks[:2] == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]] and [3] in played.tasks and {len(task) for task in played.tasks} == {1, 2, 3, 5}
    assert sorted(played.asked) == sorted([*range(40), 3, 4]) and (driver.done, driver.failed) == (39, 1)


@pytest.mark.alone
def test_a_task_ends_with_a_shard_that_failed_or_when_its_time_is_over(monkeypatch):
    from umov import _scale_store
    same = {"program": "", "place": "out", "threads": 1, "timeout_s": 60.0, "memory_mb": None}

    def do_shard(index, *_):
        time.sleep(0.05)
        return record(index, "failed" if index == 5 else "done")

    monkeypatch.setattr(_scale_store, "do_shard", do_shard)
    assert [one["index"] for one in _scale_store.do_shards("[1, 4, 5, 6]", at_most_s=60, **same)] == [1, 4, 5]
    assert [one["index"] for one in _scale_store.do_shards("[1, 2, 3, 4]", at_most_s=0.07, **same)] == [1, 2]


def test_shards_without_memory_are_told_where_others_are_done(scene):
    driver, _ = driver_of(scene, lambda index, turn: record(index, "done" if index == 0 else "exhausted"))
    driver.run()
    assert (driver.done, driver.failed) == (1, 19)


def test_time_left_begins_with_what_comes_before_the_first_shard(scene):
    """By hand: 20 shards of which half of one is done, 2 s each, and 30 s before; the first one says that the 30 s are over."""
    driver, _ = driver_of(scene, lambda index, turn: record(index))
    driver.first_s, driver.predicted_s = 30.0, 2.0
    assert driver.seconds_left(1) == pytest.approx(30 + 19.5 * 2, abs=1)
    driver.since = time.monotonic() - 64  # twice what the first should have taken: all takes twice as long
    assert driver.seconds_left(1) == pytest.approx(19.5 * 4, abs=1)
    driver.done, driver.first_took_s = 1, 32.0
    assert driver.seconds_left(1) == pytest.approx(18.5 * 2)


def test_time_in_a_queue_is_not_that_of_a_slow_machine(scene):
    """Ten minutes without a worker say nothing of a shard, which then takes twice what was predicted: 64 s."""
    driver, played = driver_of(scene, lambda index, turn: record(index))
    driver.first_s, driver.predicted_s = 30.0, 2.0
    there, workers, now = {"one"}, set(), time.monotonic
    played.workers = lambda: workers
    with pytest.MonkeyPatch.context() as patch:
        driver._watch()
        patch.setattr(time, "monotonic", lambda: now() + 600)
        driver._watch()
        assert driver.seconds_left(1) == pytest.approx(30 + 19.5 * 2, abs=1)
        workers = there
        patch.setattr(time, "monotonic", lambda: now() + 605)
        driver._watch()
        assert driver.seconds_left(1) == pytest.approx(30 + 19.5 * 2, abs=1)
        driver._take_record({**record(0), "seconds": 64.0})
        assert driver.seconds_left(1) == pytest.approx(18.5 * 4)


def test_records_that_do_not_come_in_time_are_fetched_again(scene):
    """Nothing is done a second time, and after Ctrl-C what was finished is told."""
    driver, played = driver_of(scene, lambda index, turn: record(index))
    played.troubles = [TimeoutError(), OSError(), TimeoutError()]
    driver.run()
    assert sorted(played.asked) == list(range(20)) and driver.done == 20
    driver, played = driver_of(scene, lambda index, turn: record(index))
    played.troubles = [KeyboardInterrupt()]
    with pytest.raises(umov.Interrupted):
        driver.run()
    assert driver.done == len(played.asked) > 0


def test_shards_are_asked_for_again_however_often(scene):
    """A million times: what is left is found at once, and all of it."""
    driver, _ = driver_of(scene, lambda index, turn: record(index))
    driver.workers = 1
    for _ in range(1_000_000):
        driver._ask_again(driver._shards_of_a_task(1))
    left = []
    while shards := driver._shards_of_a_task(1):
        left += shards
    assert sorted(left) == list(range(20)) and driver.waiting == 0


def test_half_a_record_is_that_of_a_process_that_ended(scene, tmp_path):
    from umov import _scale_worker
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "20", "out", *job_of(scene, 40).words], check=True)
    flag = str(tmp_path / "was_here")
    program = wrapper(tmp_path, f"if not os.path.exists({flag!r}): open({flag!r}, 'w'); "
                                "os.write(1, b'half a record'); os.kill(os.getpid(), signal.SIGKILL)")
    try:
        told = _scale_worker.do_shard(1, program, "out", 1, 60)
    finally:
        _scale_worker._end_all()
        _scale_worker._idle.clear()
    assert (told["status"], told["attempts"]) == ("done", 2)


def test_what_is_not_that_of_the_folder_is_refused(scene):
    umov.scale.run(job_of(scene, 20), "out", reduce="most:intensity:2", per_shard=10, isa="sse4")
    for cluster in (None, "local:1"):
        for given, said in (({"reduce": "most:intensity:3"}, "most:intensity:3.*most:intensity:2"), ({"per_shard": 5}, "5.*has 10 poses in a shard"),
                            ({"isa": "avx2"}, "avx2.*held to sse4")):
            with pytest.raises(umov.UsageError, match=said):
                umov.scale.run(None, "out", cluster=cluster, **given)
        assert not umov.scale.run(None, "out", cluster=cluster, reduce="most:intensity:2", per_shard=10, isa="sse4").missing
    with pytest.raises(umov.UsageError, match="5.*has 10 poses in a shard"):
        umov.scale.run(job_of(scene, 20), "out", cluster="local:1", reduce="most:intensity:2", per_shard=5)


@pytest.mark.slow
def test_a_full_disk_ends_the_job_on_a_cluster_and_it_goes_on(scene, tmp_path):
    """A disk of 400 kB for a job of ten times as much: no worker begins a shard behind the first that has no room."""
    disk, job = tmp_path / "disk", job_of(scene, 3000)
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "tmpfs", disk], capture_output=True, text=True)
    if mounted.returncode:
        pytest.skip(f"no small disk can be mounted here: {mounted.stderr.strip()}")
    try:
        subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "100", "large", *job.words], check=True)
        shutil.copytree("large", disk / "out")
        with pytest.raises(umov.DeviceError, match="umov scale run .*out goes on"):
            umov.scale.run(None, disk / "out", cluster="local:2")
        result = umov.scale.Result(disk / "out")
        there = {path: path.stat().st_mtime_ns for path in result.files}
        assert 2 <= len(there) < 30 and not list((disk / "out/tmp").iterdir()) and not result.failed
        subprocess.run(["mount", "-o", "remount,size=40m", disk], check=True)
        done = umov.scale.run(None, disk / "out", cluster="local:2")
        assert all(path.stat().st_mtime_ns == at for path, at in there.items())
        assert merged_bytes(done) == plain_bytes(job)
    finally:
        subprocess.run(["umount", disk], check=True)


@pytest.mark.slow
def test_ctrl_c_then_the_printed_command(scene):
    job = job_of(scene, 4000)
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "20", "out", *job.words], check=True)
    driver = subprocess.Popen([sys.executable, "-m", "umov.scale", "run", "out", "--cluster", "local:2"],
                              stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 90
    while not list(pathlib.Path("out/shards").iterdir()) and time.monotonic() < until:
        time.sleep(0.1)
    driver.send_signal(signal.SIGINT)
    _, err = driver.communicate(timeout=90)
    assert driver.returncode == 130 and "umov scale run" in err, err
    assert 0 < len(umov.scale.Result("out").files) < 200
    done = umov.scale.run(None, "out")
    assert merged_bytes(done) == plain_bytes(job)


@pytest.mark.slow
def test_a_scheduler_that_is_killed_ends_the_client_with_the_way_on(scene, tmp_path):
    """Kill -9 of a scheduler of its own: within ten seconds the resume command is told, and what was finished is there."""
    job, file = job_of(scene, 4000), tmp_path / "scheduler.json"
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "20", "out", *job.words], check=True)

    def dask(what, *words):
        program = f"from distributed.cli.dask_{what} import main; main()"
        return subprocess.Popen([sys.executable, "-c", program, "--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", file, *words],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    scheduler = dask("scheduler", "--port", "0")
    while not file.exists():
        time.sleep(0.05)
    worker = dask("worker", "--nthreads", "1", "--local-directory", tmp_path)
    ended = []

    def kill():
        while len(list(pathlib.Path("out/shards").iterdir())) < 3:
            time.sleep(0.05)
        scheduler.kill()
        ended.append(time.monotonic())

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    try:
        with pytest.raises(umov.DeviceError, match="umov scale run .*out goes on"):
            umov.scale.run(None, "out", cluster=json.loads(file.read_text())["address"])
        assert time.monotonic() - ended[0] < 10
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.wait()
    there = {path.name for path in umov.scale.Result("out").files}
    assert 3 <= len(there) < 200
    done = umov.scale.run(None, "out")
    assert there <= {path.name for path in done.files} and merged_bytes(done) == plain_bytes(job)


def test_no_file_of_a_folder_is_unpickled(scene, tmp_path):
    """A pickle that would make a file when it is loaded, in place of each file: told, or left alone."""

    class Trap:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "sprung"),)

    result = umov.scale.run(job_of(scene, 40), "out", per_shard=20)
    (result.folder / "failed/00000001.json").write_text("{}")
    for file in [path for path in result.folder.rglob("*") if path.is_file()]:
        whole = file.read_bytes()
        file.write_bytes(pickle.dumps(Trap()))
        for call in (lambda: umov.scale.Result("out").rows()["intensity"], lambda: umov.scale.Result("out").merge("merged.csv"),
                     lambda: umov.scale.Result("out").failed, lambda: umov.scale.run(None, "out", cluster="local:1")
                     if file.name == "job.json" else None):
            with contextlib.suppress(umov.Error, ValueError):
                call()
            assert not (tmp_path / "sprung").exists(), file
        file.write_bytes(whole)


def test_a_second_client_is_refused(scene):
    subprocess.run([UMOV, "scale", "lock", "-q", "--per-shard", "20", "out", *job_of(scene).words], check=True)
    with subprocess.Popen([UMOV, "scale", "hold", "out"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        with pytest.raises(umov.DeviceError, match="another umov is at work"):
            umov.scale.run(None, "out", cluster="local:1")
        holder.stdin.close()


@pytest.mark.parametrize("cluster", ["tcp://10.1.2.3:8786", "10.1.2.3:8786", "local:0", "local:x"])
def test_addresses_that_are_refused(scene, cluster):
    with pytest.raises(umov.UsageError):
        umov.scale.run(job_of(scene), "out", cluster=cluster, per_shard=100)


def test_nothing_listens_but_on_the_loopback(scene):
    """Every listening socket of this process and of all below it, while a cluster is up."""
    from umov._scale_driver import Cluster
    cluster = Cluster("local:1", True)
    try:
        cluster.client.wait_for_workers(1, timeout=60)
        addresses = set()
        for process in [psutil.Process(), *psutil.Process().children(recursive=True)]:
            for one in process.net_connections("inet"):
                if one.status == psutil.CONN_LISTEN:
                    addresses.add(one.laddr.ip)
        assert addresses == {"127.0.0.1"}
        import distributed
        with pytest.raises(Exception):
            distributed.Client(cluster.client.scheduler.address.replace("tls", "tcp"), timeout=5)
        with pytest.raises(Exception):
            distributed.Client(cluster.client.scheduler.address, timeout=5,
                               security=distributed.Security.temporary())
    finally:
        cluster.close()


def test_plan_says_what_is_to_come(scene):
    plan = umov.scale.plan(job_of(scene, 2000), cores=1)
    assert plan.total == 2000 and plan.shards >= 1 and plan.core_hours > 0
    assert not pathlib.Path("not-made").exists()
