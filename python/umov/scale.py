"""Jobs in parts on a Dask cluster: the folders of the command ``umov scale``, done by many machines.

The folder is the whole state of a job, and the command writes it; here is only what a cluster needs: who does
which shard. Each Dask worker keeps one process of the command that has the job ready, so that a crash costs a
shard's time and never the worker. Wants ``pip install umov[scale]`` where a cluster is asked for.
"""
from __future__ import annotations

import argparse
import atexit
import dataclasses
import importlib
import json
import os
import pathlib
import queue
import select
import shutil
import subprocess
import sys
import sysconfig
import threading
import time
from typing import Any

from .errors import (DeviceError, Error, InputError, InternalError, Interrupted, NoResult, NumericsError,
                     UsageError)
from .rows import Rows

__all__ = ["Job", "Plan", "Result", "plan", "run"]

_ERRORS: dict[int, type[Error] | type[Interrupted]] = {2: UsageError, 3: InputError, 4: NumericsError, 5: NoResult, 6: DeviceError, 130: Interrupted}
#: What Dask is told, in one place. A worker that dies was ended from outside, as what crashes is a process of its
#: own: no shard is to blame, however often its worker goes.
SETTINGS = {"distributed.scheduler.allowed-failures": 1000, "distributed.scheduler.worker-ttl": "60s",
            "distributed.scheduler.worker-saturation": 1.0, "distributed.worker.memory.terminate": 0.95}
_PATIENCE_S = 30.0  # of shards in hand after Ctrl-C
_LOSSES = 10  # of workers without a shard done between them, after which it is said that none will be


@dataclasses.dataclass(frozen=True)
class Job:
    """A verb of the command with its arguments.

    Parameters
    ----------
    verb
        "signature", "passes" or "run".
    *arguments
        Files, as the verb takes them.
    **options
        Its options: ``alt_min_deg=20`` is ``--alt-min-deg 20``, ``visible=True`` is ``--visible``; a list is
        joined by commas.

    Examples
    --------
    >>> umov.scale.Job("signature", "hst.toml", poses=10**6, phase=[60, 100]).words
    ['signature', 'hst.toml', '--poses', '1000000', '--phase', '60,100']
    """

    words: list[str]

    def __init__(self, verb: str, *arguments: Any, **options: Any) -> None:
        words = [verb, *map(str, arguments)]
        for name, value in options.items():
            option = "--" + name.replace("_", "-")
            if value is True:
                words.append(option)
            elif isinstance(value, (list, tuple)):
                words += [option, ",".join(map(str, value))]
            elif value is not None and value is not False:
                words += [option, str(value)]
        object.__setattr__(self, "words", words)


@dataclasses.dataclass(frozen=True)
class Plan:
    """What a job will cost."""

    total: int  #: poses, objects or passes
    shards: int  #: files
    per_shard: int  #: of the total
    core_hours: float
    gigabytes: float
    wall_s: float  #: with the cores that were told
    shard_s: float  #: of one shard
    setup_cpu_s: float  #: of a process before its first row


def _program(program: str | None) -> str:
    """The command beside this package, or the one of the path."""
    here = pathlib.Path(__file__).parent
    places = [program, pathlib.Path(sysconfig.get_path("scripts")) / "umov", here.parents[1] / "apps/cli/umov",
              shutil.which("umov")]
    for place in places:
        if place and os.access(place, os.X_OK):
            return str(place)
    raise DeviceError("the command umov was not found. Install it with pip install umov, or say program=\"...\".")


def _call(program: str, *words: Any) -> str:
    done = subprocess.run([program, "scale", *map(str, words)], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, check=False)
    if done.returncode == 0:
        return done.stdout
    lines = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    text = lines[-1].removeprefix("error: ") if lines else done.stderr.strip()
    raise _ERRORS.get(done.returncode, InternalError)(text)


def plan(job: Job, *, cores: int | None = None, program: str | None = None) -> Plan:
    """What a job will cost; nothing is written.

    Parameters
    ----------
    job
        What is to be done.
    cores
        That will be at work; by default those of this machine.
    program
        The command umov; by default the one beside this package.

    Examples
    --------
    >>> umov.scale.plan(job).shards  # doctest: +SKIP
    40
    """
    more = ["--cores", cores] if cores else []
    return Plan(**json.loads(_call(_program(program), "plan", "--json", "-q", *more, "not-made", *job.words)))


class Result:
    """The folder of a job: rows that are there, opened when they are asked for."""

    def __init__(self, folder: str | os.PathLike[str], program: str | None = None) -> None:
        self.folder = pathlib.Path(folder).absolute()
        self._umov = _program(program)
        self.lock: dict[str, Any] = json.loads((self.folder / "job.json").read_text())

    @property
    def status(self) -> dict[str, Any]:
        """Shards, done, failed, bytes, is_complete, is_held."""
        out: dict[str, Any] = json.loads(_call(self._umov, "status", self.folder, "--json"))
        return out

    @property
    def files(self) -> list[pathlib.Path]:
        """Files of the shards that are there, in order."""
        return sorted((self.folder / "shards").rglob(f"????????-{self.lock['key']}-*.rows"), key=lambda p: p.name)

    @property
    def missing(self) -> list[int]:
        """Numbers of the shards that are not."""
        there = {int(path.name[:8]) for path in self.files}
        return [k for k in range(self.lock["shards"]) if k not in there]

    @property
    def failed(self) -> list[dict[str, Any]]:
        """What is known of those that could not be done."""
        return [json.loads(path.read_text()) for path in sorted((self.folder / "failed").glob("*.json"))]

    def merge(self, output: str | os.PathLike[str], table: str | None = None) -> None:
        """Writes the table that the plain command would have written.

        Parameters
        ----------
        output
            Its file: .csv, .ecsv, .fits or .json.
        table
            Of a run: "lightcurve" (default) or "passes".
        """
        _call(self._umov, "merge", self.folder, "-q", "-o", output, *(["--table", table] if table else []))

    def verify(self) -> None:
        """Reads all shards and compares them with their hashes; InputError naming what is damaged."""
        _call(self._umov, "verify", self.folder, "-q")

    def repair(self) -> None:
        """Does damaged shards again."""
        _call(self._umov, "repair", self.folder, "-q")

    def rows(self, table: str | None = None) -> Rows:
        """Rows of a table over all shards, mapped: nothing is read until it is asked for. Those of passes stand
        shard by shard here, and by their rise only in what `merge` writes.

        Parameters
        ----------
        table
            Of a run: "lightcurve" (default) or "passes".
        """
        return Rows(self.files, table or self.lock["tables"][0])

    def dask_array(self, columns: list[str], table: str | None = None) -> Any:
        """Columns of numbers as a dask array (row, column), a block for each block of a shard.

        Parameters
        ----------
        columns
            Their names.
        table
            As in `rows`.
        """
        import numpy as np
        da: Any = importlib.import_module("dask.array")
        rows = self.rows(table)

        def read(block_info: Any = None) -> Any:
            number = block_info[None]["chunk-location"][0]
            return np.stack([rows.block(number, name) for name in columns], axis=1).astype("f8")

        return da.map_blocks(read, chunks=(tuple(rows.lengths), (len(columns),)), dtype="f8")

    def to_parquet(self, folder: str | os.PathLike[str], table: str | None = None) -> Any:
        """Writes a folder of Parquet files, one for each shard, and opens it as a pyarrow dataset. A file that is
        there already is left as it is.

        Parameters
        ----------
        folder
            Where they go; a shard's file has its name.
        table
            As in `rows`.
        """
        import pyarrow.dataset as ds
        import pyarrow.parquet as pq
        out = pathlib.Path(folder)
        out.mkdir(parents=True, exist_ok=True)
        for file in self.files:
            target = out / (file.stem + ".parquet")
            if target.exists():
                continue
            growing = out / f".{file.stem}.{os.getpid()}.part"
            pq.write_table(Rows([file], table or self.lock["tables"][0]).to_arrow(), growing, compression="zstd",
                           compression_level=1)
            growing.replace(target)
        return ds.dataset(out, format="parquet")


class _Server:
    """A process of the command that does shards; ends with this one, as its standard input does."""

    def __init__(self, program: str, folder: str, threads: int) -> None:
        self.process = subprocess.Popen([program, "scale", "worker", folder, "--threads", str(threads), "-q"],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)

    def ask(self, index: int, timeout_s: float) -> str | None:
        """The record, "" if the process ended before it gave one, None if it took too long."""
        assert self.process.stdin and self.process.stdout
        try:
            self.process.stdin.write(b"%d\n" % index)
            self.process.stdin.flush()
        except OSError:
            return ""
        if not select.select([self.process.stdout], [], [], timeout_s)[0]:
            return None
        return self.process.stdout.readline().decode()

    def end(self, patience_s: float = 0.0) -> int:
        """Its exit code; negative for a signal. With patience it keeps its masks first."""
        if self.process.stdin:
            try:
                self.process.stdin.close()
            except OSError:
                pass
        try:
            return self.process.wait(patience_s) if patience_s else self.process.poll() or self._kill()
        except subprocess.TimeoutExpired:
            return self._kill()

    def _kill(self) -> int:
        try:
            return self.process.wait(0.5)  # it may be ending by itself, and its own code is wanted
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()


_idle: dict[tuple[str, str, int], list[_Server]] = {}
_idle_lock = threading.Lock()


@atexit.register
def _end_all() -> None:
    for servers in _idle.values():
        for server in servers:
            server.end(5.0)


def _shard(index: int, program: str, folder: str, threads: int, timeout_s: float) -> dict[str, Any]:
    """One shard, in a Dask worker. Never raises: what went wrong is in the record."""
    key = (program, folder, threads)
    why: dict[str, Any] = {}
    for attempt in range(1, 4):
        with _idle_lock:
            server = _idle[key].pop() if _idle.get(key) else None
        try:
            server = server or _Server(program, folder, threads)
        except OSError as problem:
            return {"index": index, "status": "failed", "code": 6, "message": f"{program}: {problem}"}
        line = server.ask(index, timeout_s)
        if line:
            with _idle_lock:
                _idle.setdefault(key, []).append(server)
            return {**json.loads(line), "attempts": attempt}
        if line is None:
            server.process.kill()
        code = server.end()
        message = (f"it was not done after {timeout_s:.0f} s" if line is None else
                   f"its process was ended by signal {-code}" if code < 0 else f"its process ended with {code}")
        why = {"index": index, "status": "failed", "code": 128 - code if code < 0 else code, "message": message,
               "attempts": attempt}
    return why


def _loopback(address: str) -> bool:
    host = address.rsplit("://", 1)[-1].rsplit(":", 1)[0]
    return host in ("localhost", "::1", "[::1]") or host.startswith("127.")


class _Cluster:
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


class _Driver:
    """Gives shards to a cluster, so many at a time, until none is missing."""

    def __init__(self, result: Result, cluster: _Cluster, threads: int, timeout_s: float | None, quiet: bool) -> None:
        lock = result.lock
        predicted = lock["predicted"]["setup_cpu_s"] + lock["predicted"]["cpu_s"] * lock["per_shard"]
        self.result, self.cluster, self.quiet = result, cluster, quiet
        self.arguments = (result._umov, str(result.folder), threads, timeout_s or max(60.0, 10 * predicted))
        self.todo = iter(result.missing)
        self.futures: dict[str, Any] = {}
        self.ended: queue.Queue[Any] = queue.Queue()
        self.left = len(result.missing)
        self.done = self.failed = self.lost = 0
        self.known: set[str] = set()
        self.told = self.looked = time.monotonic()
        self.stopped: Error | Interrupted | None = None
        self.stopped_at = 0.0
        self.resume = f"umov scale run {result.folder} goes on."

    def run(self) -> None:
        self._submit(max(200, 4 * len(self.cluster.workers())))
        while self.futures:
            try:
                self._watch()
                try:
                    future = self.ended.get(timeout=0.5)
                except queue.Empty:
                    if self.stopped and time.monotonic() - self.stopped_at > _PATIENCE_S:
                        break
                    continue
                if self.futures.pop(future.key, None) is None:
                    continue  # it was taken back
                self._take(future)
                if not self.stopped:
                    self._submit(1)
            except KeyboardInterrupt:
                if self.stopped:
                    break
                self._stop(Interrupted("stopped by the user"))
        if self.stopped:
            raise type(self.stopped)(f"{str(self.stopped).rstrip('.')}. {self.resume}")

    def _submit(self, count: int) -> None:
        for _, index in zip(range(count), self.todo):
            # No two clients' tasks of one name: what a second one asks for is its own.
            future = self.cluster.client.submit(_shard, index, *self.arguments, pure=False,
                                                key=f"umov-{self.result.lock['key']}-{index}-{os.getpid()}")
            self.futures[future.key] = future
            future.add_done_callback(self.ended.put)

    def _take(self, future: Any) -> None:
        if future.status != "finished":
            why = future.exception() if future.status == "error" else future.status
            self._stop(DeviceError(f"Dask lost a shard ({why})"))
            return
        record = future.result()
        future.release()
        self.known = set()
        self.lost = 0
        if record["status"] in ("done", "there"):
            self.done += 1
        elif record["status"] == "refused" or record["code"] in (6, 130):
            self._stop(_ERRORS.get(record["code"], InternalError)(record["message"]))
        else:
            self.failed += 1
            self._tell_failed(record)

    def _tell_failed(self, record: dict[str, Any]) -> None:
        lock, index = self.result.lock, record["index"]
        first = index * lock["per_shard"]
        text = {"index": index, "first": first, "count": min(lock["per_shard"], lock["total"] - first),
                "code": record["code"], "attempts": record.get("attempts", 1), "message": record["message"], "host": ""}
        (self.result.folder / "failed" / f"{index:08d}.json").write_text(json.dumps(text, indent=1))

    def _stop(self, why: Error | Interrupted) -> None:
        """Nothing new is begun; what no worker has begun is taken back."""
        if self.stopped:
            return
        self.stopped, self.stopped_at = why, time.monotonic()
        try:
            running = {key for keys in self.cluster.client.processing().values() for key in keys}
            waiting = [future for key, future in self.futures.items() if key not in running]
            for future in waiting:
                del self.futures[future.key]
            self.cluster.client.cancel(waiting)
        except Exception:  # noqa: BLE001  a scheduler that is gone has nothing that could be taken back
            self.futures.clear()

    def _watch(self) -> None:
        """Once in two seconds: does the scheduler live, do workers live long enough, is it time for a line."""
        now = time.monotonic()
        if now - self.looked < 2:
            return
        self.looked = now
        if self.cluster.client.status not in ("running", "connecting"):
            self.futures.clear()
            self._stop(DeviceError("the Dask scheduler is gone; finished shards are kept"))
            return
        workers = self.cluster.workers()
        self.lost += len(self.known - workers)
        self.known = workers
        if self.lost == _LOSSES:
            predicted = self.result.lock["predicted"]["cpu_s"] * self.result.lock["per_shard"]
            print(f"{_LOSSES} workers were lost without a shard done between them: a shard takes about "
                  f"{predicted:.0f} s, which is longer than they live. Shorter shards (--per-shard) or longer lives "
                  "are needed.", file=sys.stderr, flush=True)
        if not self.quiet and now - self.told > 5:
            self.told = now
            print(f"shards {self.done} of {self.left}, {self.failed} failed, {len(workers)} workers", file=sys.stderr,
                  flush=True)


class _Hold:
    """The command's lease on the folder."""

    def __init__(self, program: str, folder: pathlib.Path) -> None:
        self.process = subprocess.Popen([program, "scale", "hold", str(folder), "-q"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        start_new_session=True)  # Ctrl-C is for who holds it
        assert self.process.stdout and self.process.stderr
        if self.process.stdout.readline() != "held\n":
            text = self.process.stderr.read().strip().removeprefix("error: ")
            raise _ERRORS.get(self.process.wait(), InternalError)(text)

    def end(self) -> None:
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait()


def run(job: Job | None, output: str | os.PathLike[str], *, cluster: Any = None, per_shard: int | None = None,
        threads: int = 1, timeout_s: float | None = None, join: bool = False, yes: bool = False, tls: bool = True,
        quiet: bool = True, program: str | None = None) -> Result:
    """Does what is missing of a job, and gives its folder.

    Parameters
    ----------
    job
        What is to be done; None goes on with the job of the folder.
    output
        The folder.
    cluster
        None: this machine, by the command alone. "local:N": N workers on this machine, behind the loopback. Any Dask
        cluster or client, or the address of a scheduler ("tls://host:8786"). The folder must be seen by all workers.
    per_shard
        Poses, objects or passes of a shard; by default what takes 10 to 120 s.
    threads
        Of each worker of a cluster.
    timeout_s
        Of a shard; by default ten times what is predicted, at least 60.
    join
        Take part in a job that another is at.
    yes
        Begin also above 100 core-hours or 100 GB.
    tls
        Of "local:N": certificates made for this run, as others may be on this machine.
    quiet
        No progress.
    program
        The command umov; by default the one beside this package.

    Raises
    ------
    InputError
        Shards that could not be done; the others are there.
    DeviceError
        A full disk, a scheduler that is gone, another umov at work in the folder.
    Interrupted
        Ctrl-C. The message says how to go on.

    Examples
    --------
    >>> result = umov.scale.run(job, "lib/hst", cluster="local:8")  # doctest: +SKIP
    >>> result.merge("hst.fits")  # doctest: +SKIP
    """
    umov = _program(program)
    words = job.words if job else []
    more = (["--per-shard", per_shard] if per_shard else []) + (["--yes"] if yes else [])
    if cluster is None:
        _call(umov, "run", "-q", *more, *(["--timeout-s", timeout_s] if timeout_s else []),
              *(["--join"] if join else []), output, *words)
        return Result(output, umov)
    if words:
        _call(umov, "lock", "-q", *more, output, *words)
    result = Result(output, umov)
    if not result.missing:
        return result
    hold = None if join else _Hold(umov, result.folder)
    try:
        dask = _Cluster(cluster, tls)
        try:
            driver = _Driver(result, dask, threads, timeout_s, quiet)
            driver.run()
        finally:
            dask.close()
    finally:
        if hold:
            hold.end()
    if driver.failed:
        first = result.failed[0]
        raise InputError(f"{driver.failed} shards could not be done; shard {first['index']}: {first['message']}. "
                         f"All of them stand in {result.folder}/failed; {driver.resume}")
    return result


def _main() -> int:
    parser = argparse.ArgumentParser(prog="python -m umov.scale", description="The cluster's side of umov scale run.")
    parser.add_argument("do", choices=["run"])
    parser.add_argument("folder")
    parser.add_argument("--cluster", required=True)
    parser.add_argument("--program")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--join", action="store_true")
    given = parser.parse_args()
    try:
        run(None, given.folder, cluster=given.cluster, program=given.program, threads=given.threads, join=given.join,
            quiet=False)
    except (Error, Interrupted) as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    from umov import scale  # not as __main__, which workers do not have
    sys.exit(scale._main())
