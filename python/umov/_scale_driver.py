"""Who does which shard of a job's folder on a Dask cluster, and what is told of it."""
from __future__ import annotations

import collections
import importlib
import itertools
import json
import os
import pathlib
import subprocess
import sys
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ._scale_store import do_shards, is_url
from .errors import DeviceError, Error, Interrupted, UsageError, error_from

if TYPE_CHECKING:
    from .scale import Result

#: What Dask is told, in one place. A worker that dies was ended from outside, as what crashes is a process of its
#: own: no shard is to blame, however often its worker goes.
SETTINGS = {"distributed.scheduler.allowed-failures": 1000, "distributed.scheduler.worker-ttl": "60s",
            "distributed.scheduler.worker-saturation": 1.0, "distributed.worker.memory.terminate": 0.95}
_PATIENCE_S = 30.0  # of shards in hand after Ctrl-C
_EXHAUSTED = 10  # attempts without memory before the first shard is done, after which no other is made
_LOSSES = 10  # of workers without a shard done between them, after which it is said that none will be
_FETCH_S = 5.0  # of records of one batch, twice as long where that was too short: a worker may have died with some of them
_LOOK_S = 0.05  # between two looks at what has ended: what is taken together costs the scheduler one message
_TASK_S = 1.0  # a task costs two processes a millisecond each, however short it is: shards that are short share one


def _loopback(address: str) -> bool:
    host = address.rsplit("://", 1)[-1].rsplit(":", 1)[0]
    return host in ("localhost", "::1", "[::1]") or host.startswith("127.")


class Cluster:
    """A Dask client for whatever was given, and what of it is ours to close."""

    def __init__(self, cluster: Any, tls: bool) -> None:
        try:
            dask: Any = importlib.import_module("dask")
            distributed: Any = importlib.import_module("distributed")
        except ImportError as missing:
            raise DeviceError(f"a cluster takes the package {missing.name}. pip install umov[scale]; without a cluster "
                              "umov works on this machine.") from missing
        self._ours: list[Any] = []
        self.client: Any = None
        dask.config.set(SETTINGS)
        self.is_local = False
        if isinstance(cluster, distributed.Client):
            self.client = cluster
        elif isinstance(cluster, str) and cluster.startswith("local:"):
            self._start_local(cluster, tls, distributed)
        elif isinstance(cluster, str):
            if not cluster.startswith("tls://") and not _loopback(cluster):
                raise UsageError(f"cluster {cluster}: tls://HOST:PORT was expected. Who reaches a Dask scheduler runs "
                                 "programs as its owner: start it with certificates (distributed.comm.tls).")
            self.client = distributed.Client(cluster, timeout=30)
            self._ours = [self.client]
        else:
            self.client = cluster.get_client()
            self._ours = [self.client]

    def _start_local(self, cluster: str, tls: bool, distributed: Any) -> None:
        try:
            workers = int(cluster.removeprefix("local:"))
        except ValueError:
            workers = 0
        if workers < 1:
            raise UsageError(f"cluster {cluster}: local:N with a number of workers was expected")
        security = distributed.Security.temporary() if tls else None
        try:
            local = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, host="127.0.0.1",
                                             dashboard_address="127.0.0.1:0", security=security,
                                             protocol="tls" if tls else "tcp", silence_logs=50)
        except (RuntimeError, OSError) as problem:
            raise DeviceError(f"the workers of {cluster} do not start: {problem}") from problem
        self.is_local = True
        self.client = distributed.Client(local, security=security)
        self._ours = [self.client, local]

    def close(self) -> None:
        for one in self._ours:
            try:
                one.close()
            except Exception:  # noqa: BLE001  a scheduler that is gone cannot be closed
                pass

    def workers(self) -> set[str]:
        return set(self.client.scheduler_info(n_workers=-1)["workers"])


class Driver:
    """Gives shards to a cluster, so many at a time, until none is missing."""

    def __init__(self, result: Result, cluster: Cluster, threads: int, timeout_s: float | None, quiet: bool,
                 memory_mb: int | None = None) -> None:
        lock = result.lock
        predicted = lock["predicted"]
        shard_s = predicted["setup_cpu_s"] + predicted.get("once_cpu_s", 0.0) + predicted["cpu_s"] * lock["per_shard"]
        self.result, self.cluster, self.quiet = result, cluster, quiet
        self.threads, self.timeout_s, self.memory_mb = threads, timeout_s or max(60.0, 10 * shard_s), memory_mb
        self.do, self.task_s = do_shards, _TASK_S
        missing = result.missing
        self.todo: Iterator[int] = iter(missing)
        self.again: collections.deque[int] = collections.deque()  # before those
        self.submits = self.workers = 0
        self.has_rest = False
        self.futures: dict[str, tuple[Any, list[int]]] = {}  # of each task, with its shards
        self.left = self.waiting = len(missing)
        self.failed_before = result._names_of_failed()
        self.done = self.failed = self.lost = self.exhausted = 0
        self.seconds: list[float] = []
        self.first_took_s = 0.0  # the longest of those before which much comes: masks
        self.since: float | None = None  # there are workers
        self.fetch_s = _FETCH_S
        self.first_s: float = predicted["setup_cpu_s"] + predicted.get("once_cpu_s", 0.0) / threads
        self.predicted_s: float = predicted["cpu_s"] * lock["per_shard"] / threads
        self.known: set[str] = set()
        self.told = self.looked = time.monotonic()
        self.stopped: Error | Interrupted | None = None
        self.stopped_at = 0.0
        self.resume = (f"umov.scale.run(None, \"{result.folder}\", cluster=...) goes on." if is_url(result.folder) else
                       f"umov scale run {result.folder} goes on.")

    def run(self) -> None:
        self._see_workers()
        self._submit(self._window())
        while self.futures:
            try:
                self._watch()
                if not self._take_what_ended() and self.stopped and time.monotonic() - self.stopped_at > _PATIENCE_S:
                    break
                # Several at once: each message costs the scheduler as much as a task, and nobody is idle meanwhile.
                free = self._window() - len(self.futures)
                if not self.stopped and (free >= self._window() // 8 or self.has_rest):
                    self.has_rest = False
                    self._submit(free)
            except KeyboardInterrupt:
                if self.stopped:
                    break
                self._stop(Interrupted("stopped by the user"))
        if self.stopped:
            raise type(self.stopped)(f"{str(self.stopped).rstrip('.')}. {self.resume}")

    def _window(self) -> int:
        """Tasks that are with the scheduler at a time: its memory does not grow with the job."""
        return max(200, 4 * self.workers)

    def _take_what_ended(self) -> bool:
        """All of it; waits half a second for the first. Many are looked at less often."""
        until = time.monotonic() + 0.5
        while True:
            time.sleep(max(_LOOK_S, 1e-5 * len(self.futures)))
            ended = [(future, shards, status) for future, shards in self.futures.values() if (status := future.status) != "pending"]
            if ended or time.monotonic() > until:
                break
        if not ended or self._scheduler_is_gone():
            return False
        return self._take(ended)

    def _submit(self, count: int) -> None:
        """So many tasks."""
        if self._scheduler_is_gone():
            return
        together = self.task_s / max(self._shard_s(), 1e-9)
        tasks = [shards for _ in range(count) if (shards := self._shards_of_a_task(together))]
        if not tasks:
            return
        # No two clients' tasks of one name: what a second one asks for is its own.
        self.submits += 1
        keys = [f"umov-{self.result.lock['key']}-{shards[0]}-{os.getpid()}-{self.submits}" for shards in tasks]
        futures = self.cluster.client.map(self.do, [json.dumps(shards) for shards in tasks], pure=False, key=keys,
                                          program=self.result._umov, place=str(self.result.folder), threads=self.threads,
                                          timeout_s=self.timeout_s, memory_mb=self.memory_mb, at_most_s=3 * self.task_s)
        self.futures.update((future.key, (future, shards)) for future, shards in zip(futures, tasks))

    def _shards_of_a_task(self, together: float) -> list[int]:
        """So many, or fewer towards the end: each worker has several tasks before it."""
        count = max(1, int(min(together, self.waiting / (4 * max(1, self.workers)))))
        shards = [self.again.popleft() for _ in range(min(count, len(self.again)))]
        shards += itertools.islice(self.todo, count - len(shards))
        self.waiting -= len(shards)
        return shards

    def _take(self, ended: list[tuple[Any, list[int], str]]) -> bool:
        """False: nothing came. What is finished is out of what is with the scheduler when its records are here, so that nothing is
        done twice for Ctrl-C."""
        finished = []
        for future, shards, status in ended:
            if status == "finished":
                finished.append((future, shards))
                continue
            self.futures.pop(future.key, None)
            if status == "lost":  # a worker was killed with the records in its hands: the shards may be there
                self._ask_again(shards)
            else:
                self._stop(DeviceError(f"Dask lost a shard ({future.exception() if status == 'error' else status})"))
        records = self._records([future for future, _ in finished])
        if records is None:
            return len(finished) < len(ended)
        for future, shards in finished:
            self.futures.pop(future.key, None)
            future.release()
            for index in shards:
                if index in records:
                    self._take_record(records[index])
            self._ask_again([index for index in shards if index not in records])
        return True

    def _take_record(self, record: dict[str, Any]) -> None:
        self.known = set()
        self.lost = 0
        if record["status"] in ("done", "there"):
            self.done += 1
            if (name := f"{record['index']:08d}.json") in self.failed_before:
                self.result._forget_failed(name)
            # The first shard of a worker says nothing of the others where much comes before it: masks.
            if record["status"] == "there":
                self.since = self.since and time.monotonic()
            elif self.done > self.workers or self.first_s < 0.2 * self.predicted_s:
                self.seconds.append(record["seconds"])
            else:
                self.first_took_s = max(self.first_took_s, record["seconds"])
        elif record["status"] == "refused" or (record["status"] == "failed" and record["code"] in (6, 130)):
            self._stop(error_from((record["code"], record["message"], "", 0, 0)))
        else:
            self.failed += 1
            self._tell_failed(record)
            self.exhausted += record["attempts"] if record["status"] == "exhausted" else -self.exhausted
            if self.exhausted >= _EXHAUSTED and self.done == 0:
                self._stop(DeviceError(f"{self.exhausted} attempts ran out of memory one after the other, and no shard was done: "
                                       f"{record['message']}"))

    def _ask_again(self, shards: list[int]) -> None:
        if shards:
            self.again.extend(shards)
            self.waiting += len(shards)
            self.has_rest = True

    def _records(self, futures: list[Any]) -> dict[int, dict[str, Any]] | None:
        """What the tasks told, by the shard, without those that Dask has nothing of. None: it did not come in time, and is fetched at
        another look. Of a worker that died with records in its hands, the tasks are pending again, which Dask itself waits for until
        they are done a second time, and with them for all others; of a scheduler that ends, its client notices it a moment later."""
        if not futures:
            return {}
        client = self.cluster.client
        try:
            came = client.sync(lambda: client.gather(futures, errors="skip", asynchronous=True), callback_timeout=self.fetch_s)
        except TimeoutError:
            self.fetch_s *= 2
            return None
        except OSError:  # CommClosedError
            for _ in range(20):
                if self._scheduler_is_gone():
                    break
                time.sleep(0.05)
            return None
        self.fetch_s = _FETCH_S
        return {record["index"]: record for told in came for record in told}

    def _tell_failed(self, record: dict[str, Any]) -> None:
        lock, index = self.result.lock, record["index"]
        first = index * lock["per_shard"]
        text = {"index": index, "first": first, "count": min(lock["per_shard"], lock["total"] - first),
                "code": record["code"], "attempts": record.get("attempts", 1), "message": record["message"], "host": ""}
        self.result._tell_failed(f"failed/{index:08d}.json", json.dumps(text, indent=1))

    def _stop(self, why: Error | Interrupted) -> None:
        """Nothing new is begun; what no worker has begun is taken back."""
        if self.stopped:
            return
        self.stopped, self.stopped_at = why, time.monotonic()
        if not self.futures:
            return
        try:
            running = {key for keys in self.cluster.client.processing().values() for key in keys}
            waiting = [future for key, (future, _) in self.futures.items() if key not in running and future.status == "pending"]
            for future in waiting:
                del self.futures[future.key]
            self.cluster.client.cancel(waiting)
        except Exception:  # noqa: BLE001  a scheduler that is gone has nothing that could be taken back
            self.futures.clear()

    def _scheduler_is_gone(self) -> bool:
        """Its client looks for it half a minute, and all that it is asked meanwhile waits; the tasks are lost at once."""
        if self.cluster.client.status == "running":
            return False
        self.futures.clear()
        self._stop(DeviceError("the Dask scheduler is gone; finished shards are kept"))
        return True

    def _watch(self) -> None:
        """Once in two seconds: does the scheduler live, do workers live long enough, is it time for a line."""
        now = time.monotonic()
        if now - self.looked < 2:
            return
        self.looked = now
        if self._scheduler_is_gone():
            return
        workers = self._see_workers()
        self.lost += len(self.known - workers)
        self.known = workers
        if self.lost == _LOSSES:
            predicted = self.result.lock["predicted"]["cpu_s"] * self.result.lock["per_shard"]
            print(f"{_LOSSES} workers were lost without a shard done between them: a shard takes about "
                  f"{predicted:.0f} s, which is longer than they live. Shorter shards, of fewer rows each, or "
                  "longer lives are needed.", file=sys.stderr, flush=True)
        if not self.quiet and now - self.told > 5:
            self.told = now
            print(f"shards {self.done} of {self.left}, {self.failed} failed, {len(workers)} workers, "
                  f"about {self.seconds_left(len(workers)):.0f} s left", file=sys.stderr, flush=True)

    def _see_workers(self) -> set[str]:
        workers = self.cluster.workers()
        self.workers = max(self.workers, len(workers))
        self.since = (self.since or time.monotonic()) if workers else None
        return workers

    def seconds_left(self, workers: int) -> float:
        """From what the later half of the shards have taken; by the prediction until there is one, with what comes before the
        first. Of those in hand half is done, a task of each worker."""
        workers = max(1, workers)
        rest = self.left - self.done - self.failed
        before = max(0.0, self._slower() * self.first_s - self._worked_s()) if not self.done else 0.0
        in_hand = min(workers * max(1.0, self.task_s / max(self._shard_s(), 1e-9)), rest)
        return before + (rest - in_hand / 2) * self._shard_s() / workers

    def _shard_s(self) -> float:
        lately = self.seconds[len(self.seconds) // 2:]
        return sum(lately) / len(lately) if lately else self._slower() * self.predicted_s

    def _slower(self) -> float:
        """Than predicted, by the first shards: other work may have a share of the machine."""
        took = self.first_took_s or self._worked_s()
        return max(1.0, took / max(self.first_s + self.predicted_s, 1e-9))

    def _worked_s(self) -> float:
        """Since there were workers: that they are waited for says nothing of how quick they are."""
        return 0.0 if self.since is None else time.monotonic() - self.since


class Hold:
    """The command's lease on the folder."""

    def __init__(self, program: str, folder: pathlib.Path) -> None:
        self.process = subprocess.Popen([program, "scale", "hold", str(folder), "-q"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        start_new_session=True)  # Ctrl-C is for who holds it
        assert self.process.stdout and self.process.stderr
        if self.process.stdout.readline() != "held\n":
            text = self.process.stderr.read().strip().removeprefix("error: ")
            raise error_from((self.process.wait(), text, "", 0, 0))

    def end(self) -> None:
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait()
