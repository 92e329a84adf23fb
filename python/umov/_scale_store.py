"""The folder of a job in an object store, through fsspec: objects that appear whole, under names that carry their hash.

A worker makes its shards in a folder of its own machine and puts each one into the store when it is done. What is done
is what the store lists, as with a folder; there is no renaming and no state besides."""
from __future__ import annotations

import importlib
import json
import os
import pathlib
import re
import socket
import tempfile
import threading
import time
from typing import Any

from ._scale_command import call
from ._scale_worker import do_shard
from .errors import DeviceError, Error, InputError, UsageError

#: Where a name is there before all of its bytes are, or where other processes see nothing of it.
_NO_STORES = {"file", "local", "ftp", "sftp", "ssh", "smb", "memory"}
_RENEWED_S, _STALE_S = 30.0, 90.0  # a lease, as that of a folder (docs/scale.md)


def is_url(place: Any) -> bool:
    """Names an object store, not a folder."""
    return isinstance(place, str) and re.match(r"[a-z][a-z0-9+.-]+://", place) is not None


class Store:
    """What a job keeps under a URL such as s3://bucket/name."""

    def __init__(self, url: str) -> None:
        self.url = url.rstrip("/")
        protocol = url.split("://", 1)[0]
        if protocol in _NO_STORES:
            raise UsageError(f"{url}: an object store was expected (s3://, gs://, az:// ...), whose objects appear whole. "
                             "A folder that all machines see is given by its name alone")
        try:
            core: Any = importlib.import_module("fsspec.core")
            self.fs, root = core.url_to_fs(self.url, use_listings_cache=False)
        except ImportError as missing:
            raise DeviceError(f"{url}: {missing}. pip install umov[scale] and fsspec's package for {protocol}") from missing
        except ValueError as problem:
            raise UsageError(f"{url}: {problem}") from problem
        self.root = root.rstrip("/")

    def _ask(self, function: str, *arguments: Any, **more: Any) -> Any:
        """A call of the file system; what it raises besides FileNotFoundError and FileExistsError is a DeviceError."""
        try:
            return getattr(self.fs, function)(*arguments, **more)
        except (FileNotFoundError, FileExistsError):
            raise
        except Exception as problem:  # noqa: BLE001  each store has its own
            raise DeviceError(f"{self.url}: {type(problem).__name__}: {problem}. What is finished is kept") from problem

    def read(self, name: str) -> bytes | None:
        """An object, or None."""
        try:
            return bytes(self._ask("cat_file", f"{self.root}/{name}"))
        except FileNotFoundError:
            return None

    def write(self, name: str, content: bytes) -> None:
        """In place of what there was."""
        self._ask("pipe_file", f"{self.root}/{name}", content)

    def create(self, name: str, content: bytes) -> bool:
        """False if it is there. Two that create at the same moment are told apart by stores that can; in others the last
        one stands, and workers of the first are told that their job is another one."""
        path = f"{self.root}/{name}"
        try:
            self.fs.pipe_file(path, content, mode="create")
        except FileExistsError:
            return False
        except (NotImplementedError, TypeError):
            if self._ask("exists", path):
                return False
            self.write(name, content)
        except OSError as problem:
            raise DeviceError(f"{self.url}: {problem}") from problem
        return True

    def names(self, folder: str) -> dict[str, int]:
        """Of the objects in a folder, in order, with their bytes."""
        try:
            found = self._ask("ls", f"{self.root}/{folder}", detail=True)
        except FileNotFoundError:
            return {}
        return dict(sorted((one["name"].rsplit("/", 1)[-1], one["size"]) for one in found))

    def put(self, file: pathlib.Path, name: str) -> None:
        """A file, with a look at the size that arrived."""
        self._ask("put_file", str(file), f"{self.root}/{name}")
        there = self._ask("info", f"{self.root}/{name}").get("size")
        if there != file.stat().st_size:
            raise DeviceError(f"{self.url}/{name} has {there} bytes; {file.stat().st_size} were sent")

    def get(self, name: str, file: pathlib.Path) -> None:
        """Into a file, which has its name when it is whole."""
        growing = file.with_name(f".{file.name}.{os.getpid()}.part")
        self._ask("get_file", f"{self.root}/{name}", str(growing))
        growing.replace(file)

    def remove(self, name: str) -> None:
        """If it is there."""
        try:
            self._ask("rm_file", f"{self.root}/{name}")
        except FileNotFoundError:
            pass


def read_lock(store: Store) -> bytes:
    """job.json; InputError where there is none."""
    lock = store.read("job.json")
    if lock is None:
        raise InputError(f"{store.url} holds no job; umov.scale.run(job, \"{store.url}\", cluster=...) begins one")
    return lock


def _local_folder(folder: pathlib.Path, lock: bytes) -> None:
    """What the command needs to work at the job: its lock, and places to put things."""
    for name in ("shards", "failed", "tmp", "masks"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    (folder / "job.json").write_bytes(lock)


def begin(store: Store, program: str, more: list[Any], words: list[str]) -> None:
    """Locks a job, or checks that the one that is there is the same: InputError with the first line that differs."""
    with tempfile.TemporaryDirectory(prefix="umov-") as name:
        folder = pathlib.Path(name) / "job"
        for _ in range(2):
            if (there := store.read("job.json")) is not None:
                _local_folder(folder, there)
            call(program, "lock", "-q", *more, folder, *words)
            locked = (folder / "job.json").read_bytes()
            if locked == there or store.create("job.json", locked):
                return
        raise DeviceError(f"{store.url}/job.json changed twice while the job began: another umov is at work there")


def shards(store: Store, lock: dict[str, Any]) -> dict[int, dict[str, int]]:
    """Names of what is there of the job with their bytes, by number."""
    out: dict[int, dict[str, int]] = {}
    for name, size in store.names("shards").items():
        if re.fullmatch(r"[0-9]{8}-%s-[0-9a-f]{32}\.rows" % re.escape(lock["key"]), name):
            out.setdefault(int(name[:8]), {})[name] = size
    return out


def status(store: Store, lock: dict[str, Any]) -> dict[str, Any]:
    """As that of a folder."""
    done = shards(store, lock)
    return {"shards": lock["shards"], "done": len(done), "failed": len(store.names("failed")),
            "bytes": sum(size for names in done.values() for size in names.values()), "total": lock["total"],
            "unit": lock["unit"], "is_complete": len(done) == lock["shards"], "is_held": _holder(store) is not None}


def fetch(store: Store, lock: dict[str, Any], folder: pathlib.Path) -> None:
    """All that is there and not yet here, as a folder of the job."""
    _local_folder(folder, read_lock(store))
    there = {path.name for path in (folder / "shards").rglob("*.rows")}
    for index, names in shards(store, lock).items():
        # As the command places them: above 10,000 shards in folders of a thousand.
        place = folder / "shards" / (f"{index // 1000:05d}" if lock["shards"] > 10000 else "")
        place.mkdir(exist_ok=True)
        for name in set(names) - there:
            store.get(f"shards/{name}", place / name)
    for name in store.names("failed"):
        store.get(f"failed/{name}", folder / "failed" / name)


def _holder(store: Store) -> dict[str, Any] | None:
    """Who renewed a lease not long ago; `age_s`."""
    try:
        who: dict[str, Any] = json.loads(store.read("lease.json") or b"{}")
        age = time.time() - float(who.get("time", 0))
    except (ValueError, TypeError, AttributeError):  # none that we wrote
        return None
    return {**who, "age_s": age} if age < _STALE_S else None


class StoreLease:
    """Who is at work in a store, so that no work is done twice. Correctness never rests on it."""

    def __init__(self, store: Store) -> None:
        self._store, self._over = store, threading.Event()
        self._me = {"host": socket.gethostname(), "pid": os.getpid()}
        who = _holder(store)
        if who and {key: who.get(key) for key in self._me} != self._me:
            raise DeviceError(f"another umov is at work in {store.url} ({who.get('host')}, process {who.get('pid')}, "
                              f"{who['age_s']:.0f} s ago). join=True works beside it.")
        self._renew()
        self._thread = threading.Thread(target=self._keep, daemon=True)
        self._thread.start()

    def _renew(self) -> None:
        self._store.write("lease.json", json.dumps({**self._me, "time": time.time()}).encode())

    def _keep(self) -> None:
        while not self._over.wait(_RENEWED_S):
            try:
                self._renew()
            except Error:
                pass  # the shards will tell what is wrong with the store

    def end(self) -> None:
        self._over.set()
        self._thread.join()
        self._store.remove("lease.json")


_folders: dict[str, pathlib.Path] = {}
_folders_lock = threading.Lock()


def _folder_of_this_worker(store: Store) -> pathlib.Path:
    """One for each job, in the place of the Dask worker, who clears it when it ends or is started again."""
    with _folders_lock:
        if store.url not in _folders:
            try:
                base = importlib.import_module("distributed").get_worker().local_directory
            except (ImportError, ValueError):
                base = None
            folder = pathlib.Path(tempfile.mkdtemp(prefix="umov-", dir=base))
            _local_folder(folder, read_lock(store))
            _folders[store.url] = folder
        return _folders[store.url]


def do_shard_of_store(index: int, program: str, url: str, threads: int, timeout_s: float,
                      memory_mb: int | None = None) -> dict[str, Any]:
    """One shard, in a Dask worker, and into the store. Never raises: what went wrong is in the record."""
    try:
        store = Store(url)
        folder = _folder_of_this_worker(store)
        record = do_shard(index, program, str(folder), threads, timeout_s, memory_mb)
        if record["status"] in ("done", "there"):
            file = next((folder / "shards").rglob(record["file"]))
            store.put(file, f"shards/{file.name}")
            file.unlink()
            store.remove(f"failed/{index:08d}.json")
        return record
    except (Error, OSError) as problem:
        return {"index": index, "status": "failed", "code": 6, "message": str(problem)}


def do_shards(indices: str, *, program: str, place: str, threads: int, timeout_s: float, memory_mb: int | None,
              at_most_s: float) -> list[dict[str, Any]]:
    """Shards one after the other, in a Dask worker, until one could not be done or so many seconds are over: the record of each that
    was begun; the others are for whoever has time. When the worker is killed, those of a folder that are there are not done again; those
    of an object store are, to the same object. `indices`: their numbers as JSON, which Dask does not look through."""
    do = do_shard_of_store if is_url(place) else do_shard
    until = time.monotonic() + at_most_s
    records: list[dict[str, Any]] = []
    for index in json.loads(indices):
        records.append(do(index, program, place, threads, timeout_s, memory_mb))
        if records[-1]["status"] not in ("done", "there") or time.monotonic() > until:
            break
    return records
