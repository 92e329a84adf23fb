"""What runs in a Dask worker: processes of the command that do shards, so that a crash costs a shard's time alone."""
from __future__ import annotations

import atexit
import importlib
import json
import select
import subprocess
import threading
from typing import Any


#: Of a shard that ends its process or runs out of memory, and of one that hangs: each of those costs ten times what
#: it should have taken.
_ATTEMPTS, _ATTEMPTS_AT_HANGS = 3, 2


class _Server:
    """A process of the command that does shards; ends with this one, as its standard input does."""

    def __init__(self, program: str, folder: str, threads: int, memory_mb: int | None) -> None:
        more = ["--memory-mb", str(memory_mb)] if memory_mb else []
        self.process = subprocess.Popen([program, "scale", "worker", folder, "--threads", str(threads), *more, "-q"],
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
        line = self.process.stdout.readline()
        return line.decode() if line.endswith(b"\n") else ""  # half a record: it ended while it wrote

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


_idle: dict[tuple[str, str, int, int | None], list[_Server]] = {}
_idle_lock = threading.Lock()


@atexit.register
def _end_all() -> None:
    for servers in _idle.values():
        for server in servers:
            server.end(5.0)


def _memory_of_this_worker_mb() -> int | None:
    """What Dask gives a thread of this worker; None: it sets no limit, and nine tenths of the machine are the command's own."""
    try:
        worker = importlib.import_module("distributed").get_worker()
        limit = worker.memory_manager.memory_limit
        return max(64, int(limit / worker.state.nthreads / 1e6)) if limit else None  # 64: the least that the command takes
    except (ImportError, ValueError, AttributeError):
        return None


def do_shard(index: int, program: str, folder: str, threads: int, timeout_s: float,
             memory_mb: int | None = None) -> dict[str, Any]:
    """One shard, in a Dask worker. Never raises: what went wrong is in the record."""
    memory_mb = memory_mb or _memory_of_this_worker_mb()
    key = (program, folder, threads, memory_mb)
    why: dict[str, Any] = {}
    for attempt in range(1, _ATTEMPTS + 1):
        with _idle_lock:
            server = _idle[key].pop() if _idle.get(key) else None
        try:
            server = server or _Server(program, folder, threads, memory_mb)
        except OSError as problem:
            return {"index": index, "status": "failed", "code": 6, "message": f"{program}: {problem}"}
        line = server.ask(index, timeout_s)
        record = {**json.loads(line), "attempts": attempt} if line else None
        if record and record["status"] != "exhausted":
            with _idle_lock:
                _idle.setdefault(key, []).append(server)
            return record
        if line is None:
            server.process.kill()
        code = server.end()
        if record:
            why = record
            continue
        message = (f"it was not done after {timeout_s:.0f} s" if line is None else
                   f"its process was ended by signal {-code}" if code < 0 else f"its process ended with {code}")
        why = {"index": index, "status": "failed", "code": 128 - code if code < 0 else code, "message": message,
               "attempts": attempt}
        if line is None and attempt >= _ATTEMPTS_AT_HANGS:
            break
    return why
