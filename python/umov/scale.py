"""Jobs in parts on a Dask cluster: the folders of the command ``umov scale``, done by many machines.

The folder is the whole state of a job, and the command writes it; here is only what a cluster needs: who does
which shard. Each Dask worker keeps one process of the command that has the job ready, so that a crash costs a
shard's time and never the worker. Wants ``pip install umov[scale]`` where a cluster is asked for.
"""
from __future__ import annotations

import argparse
import dataclasses
import importlib
import json
import os
import pathlib
import sys
import tempfile
from collections.abc import Sequence
from typing import Any

from . import _scale_store
from ._scale_command import call, call_for_rows, find_program
from ._scale_driver import Cluster, Driver, Hold
from ._scale_store import Store, StoreLease, is_url
from ._numbers import number, path_text, whole_between
from .errors import Error, InputError, Interrupted, UsageError
from .rows import Rows

__all__ = ["Job", "Plan", "Result", "plan", "run"]


@dataclasses.dataclass(frozen=True)
class Job:
    """A verb of the command with its arguments.

    Parameters
    ----------
    verb
        "signature", "passes", "run", "observe", "invert" (with "pose" as first argument and ``each=True``) or "identify"
        (with ``each=True``).
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
    """What a job will cost, as `plan` tells it.

    >>> job = umov.scale.Job("signature", EXAMPLES / "agena_maui.toml", poses=1000, phase=60)
    >>> umov.scale.plan(job).total
    1000
    """

    total: int  #: poses, objects, passes, exposures or curves
    shards: int  #: files
    per_shard: int  #: of the total
    core_hours: float
    gigabytes: float
    wall_s: float  #: with the cores that were told
    shard_s: float  #: of one shard
    setup_cpu_s: float  #: of a process before its first row
    once_cpu_s: float  #: of the whole job: masks, which all processes read


def plan(job: Job, *, cores: int | None = None, reduce: str | Sequence[str] = (), isa: str | None = None,
         program: str | None = None) -> Plan:
    """What a job will cost; nothing is written.

    Parameters
    ----------
    job
        What is to be done.
    cores
        That will be at work; by default those of this machine.
    reduce
        As in `run`.
    isa
        As in `run`.
    program
        The command umov; by default the one beside this package.

    Examples
    --------
    >>> umov.scale.plan(umov.scale.Job("signature", EXAMPLES / "agena_maui.toml", poses=1000, phase=60)).shards
    1
    """
    more = [*(["--cores", cores] if cores else []), *_isa_words(isa), *_reduce_words(reduce)]
    return Plan(**json.loads(call(find_program(program), "plan", "--json", "-q", *more, "not-made", *job.words)))


class Result:
    """The folder of a job: rows that are there, opened when they are asked for.

    Parameters
    ----------
    folder
        That `run` or the command made, or the URL of an object store ("s3://bucket/name"). What reads rows of a store brings
        them into a temporary folder first, once; `fetch` brings them where you like.
    program
        The command umov; by default the one beside this package.

    Examples
    --------
    >>> job = umov.scale.Job("signature", EXAMPLES / "agena_maui.toml", poses=20, phase=60)
    >>> result = umov.scale.run(job, "agena_result")
    >>> umov.scale.Result("agena_result").missing
    []
    >>> len(result.rows()), result.status["is_complete"]
    (60, True)
    """

    def __init__(self, folder: str | os.PathLike[str], program: str | None = None) -> None:
        self._store = Store(str(folder)) if is_url(folder) else None
        if not self._store and not (pathlib.Path(path_text(folder, "folder")) / "job.json").is_file():
            raise InputError(f"{os.fspath(folder)}: there is no job; a folder was expected that umov.scale.run or umov scale run made")
        #: its absolute path, or the URL of a store
        self.folder = self._store.url if self._store else pathlib.Path(folder).absolute()
        self._umov = find_program(program)
        self._fetched: tempfile.TemporaryDirectory[str] | None = None
        text = (_scale_store.read_lock(self._store) if self._store else
                (pathlib.Path(folder) / "job.json").read_bytes())
        self.lock: dict[str, Any] = json.loads(text)

    def fetch(self, folder: str | os.PathLike[str] | None = None) -> Result:
        """All that is there and not yet here, from an object store into a folder of this machine; a folder is itself.

        Parameters
        ----------
        folder
            Where it goes; None: a temporary one, which goes with this object.
        """
        if self._store is None:
            return self
        if folder is None:
            self._fetched = self._fetched or tempfile.TemporaryDirectory(prefix="umov-")
            folder = self._fetched.name
        _scale_store.fetch(self._store, self.lock, pathlib.Path(folder))
        return Result(folder, self._umov)

    @property
    def status(self) -> dict[str, Any]:
        """Shards, done, failed, bytes, is_complete, is_held."""
        if self._store:
            return _scale_store.status(self._store, self.lock)
        out: dict[str, Any] = json.loads(call(self._umov, "status", self.folder, "--json"))
        return out

    @property
    def files(self) -> list[pathlib.Path]:
        """Files of the shards that are there, in order."""
        folder = pathlib.Path(self.fetch().folder)
        return sorted((folder / "shards").rglob(f"????????-{self.lock['key']}-*.rows"), key=lambda p: p.name)

    @property
    def missing(self) -> list[int]:
        """Numbers of the shards that are not."""
        there = (set(_scale_store.shards(self._store, self.lock)) if self._store else
                 {int(path.name[:8]) for path in self.files})
        return [k for k in range(self.lock["shards"]) if k not in there]

    @property
    def failed(self) -> list[dict[str, Any]]:
        """What is known of those that could not be done."""
        if self._store:
            texts = [self._store.read(f"failed/{name}") for name in self._store.names("failed")]
            return [json.loads(text) for text in texts if text is not None]
        return [json.loads(path.read_text()) for path in sorted((pathlib.Path(self.folder) / "failed").glob("*.json"))]

    def _names_of_failed(self) -> set[str]:
        return set(self._store.names("failed") if self._store else
                   (path.name for path in (pathlib.Path(self.folder) / "failed").glob("*.json")))

    def _forget_failed(self, name: str) -> None:
        if self._store:
            self._store.remove(f"failed/{name}")
        else:
            (pathlib.Path(self.folder) / "failed" / name).unlink(missing_ok=True)

    def _tell_failed(self, name: str, text: str) -> None:
        if self._store:
            self._store.write(name, text.encode())
        else:
            (pathlib.Path(self.folder) / name).write_text(text)

    def merge(self, output: str | os.PathLike[str], table: str | None = None) -> None:
        """Writes the table that the plain command would have written.

        Parameters
        ----------
        output
            Its file: .csv, .ecsv, .fits or .json.
        table
            Of a run "lightcurve" (default) or "passes", of an observation "counts" (default) or "truth", of curves "curves"
            (default) or a table of their answers. Curves without an answer are told as a warning.
        """
        call_for_rows(self._umov, "merge", self.fetch().folder, "-q", "-o", output, *(["--table", table] if table else []))

    def verify(self) -> None:
        """Reads all shards and compares them with their hashes; InputError naming what is damaged."""
        call(self._umov, "verify", self.fetch().folder, "-q")

    def repair(self) -> None:
        """Does damaged shards again."""
        if self._store:
            raise UsageError(f"{self.folder} is an object store: fetch it into a folder and repair that, or remove the damaged "
                             "object and run the job again")
        call(self._umov, "repair", self.folder, "-q")

    def rows(self, table: str | None = None) -> Rows:
        """Rows of a table over all shards, mapped: nothing is read until it is asked for. Those of passes stand
        shard by shard here, and by their rise only in what `merge` writes; what is kept of rows (`reduce`) stands here for
        each shard, and is put together by `merge`.

        Parameters
        ----------
        table
            Of a run "lightcurve" (default) or "passes", of an observation "counts" (default) or "truth", of curves "curves"
            (default) or a table of their answers.
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
            rows = Rows([file], table or self.lock["tables"][0]).to_arrow()
            # Numbers that all differ are sought in a dictionary at four times the cost of writing them.
            texts = [name for name in rows.column_names if str(rows.schema.field(name).type) == "string"]
            pq.write_table(rows, growing, compression="zstd", compression_level=1, use_dictionary=texts)
            growing.replace(target)
        return ds.dataset(out, format="parquet")


def _isa_words(isa: str | None) -> list[str]:
    return ["--isa", isa] if isa else []


def _reduce_words(reduce: str | Sequence[str]) -> list[str]:
    return [word for text in ([reduce] if isinstance(reduce, str) else reduce) for word in ("--reduce", text)]


def run(job: Job | None, output: str | os.PathLike[str], *, cluster: Any = None, reduce: str | Sequence[str] = (),
        per_shard: int | None = None, isa: str | None = None,
        threads: int = 1, timeout_s: float | None = None, memory_mb: int | None = None, join: bool = False,
        yes: bool = False, tls: bool = True,
        quiet: bool = True, program: str | None = None) -> Result:
    """Does what is missing of a job, and gives its folder. Curves without an answer are told as a warning.

    Parameters
    ----------
    job
        What is to be done; None goes on with the job of the folder.
    output
        The folder, or a URL of an object store ("s3://bucket/name"; what it asks for is in fsspec's own configuration): then every
        worker needs the files of the job under the same names, but no shared folder.
    cluster
        None: this machine, by the command alone. "local:N": N workers on this machine, behind the loopback. Any Dask
        cluster or client, or the address of a scheduler ("tls://host:8786"). The folder must be seen by all workers.
    reduce
        What is kept in place of the rows where these are made faster than they can be stored, each a table of the result:
        "histogram:COLUMN:LOW:HIGH:BINS" (LOW belongs to the first bin, HIGH to none), "log-histogram:..." (bins of one
        ratio), "most:COLUMN:COUNT" or "least:COLUMN:COUNT" (whole rows), "likelihood:COLUMN+COLUMN:VALUE+VALUE:ERROR+ERROR"
        (how likely measured values are if each row is as likely as any other). Of each band, or of each value of the columns in
        ":BY+BY" behind it. Its table is "log_histogram_intensity" and so on.
    per_shard
        Poses, objects, passes, exposures or curves of a shard; by default what takes 10 to 120 s.
    isa
        "avx512", "avx2", "sse4" or "baseline": an instruction set that all machines have, for the same bytes on unlike ones; by
        default the best of this one.
    threads
        Of each worker of a cluster.
    timeout_s
        Of a shard; by default ten times what is predicted, at least 60.
    memory_mb
        Of each process that does shards: one that wants more is told as a shard that could not be done. 64 at least. By default
        what Dask gives a thread of a worker, or nine tenths of the machine.
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
    >>> job = umov.scale.Job("signature", EXAMPLES / "agena_maui.toml", poses=20, phase=60)
    >>> result = umov.scale.run(job, "agena_run")  # with cluster="local:8" on eight workers
    >>> result.merge("agena.csv")
    >>> brightness = umov.scale.run(job, "agena_histogram", reduce="log-histogram:intensity:1e-4:100:60")
    >>> brightness.merge("histogram.csv")
    """
    umov = find_program(program)
    if job is not None and not isinstance(job, Job):
        raise UsageError(f"job is a {type(job).__name__}; a umov.scale.Job was expected, or None for that of the folder")
    words = job.words if job else []
    timeout_s = None if timeout_s is None else number(timeout_s, "timeout_s")
    memory_mb = None if memory_mb is None else whole_between(memory_mb, "memory_mb", 64, 1_000_000_000)
    if is_url(output) and cluster is None:
        raise UsageError(f"output is {output}; an object store takes a cluster: cluster=\"local:{os.cpu_count()}\" is this machine")
    more = [*(["--per-shard", per_shard] if per_shard else []), *_isa_words(isa), *(["--yes"] if yes else []), *_reduce_words(reduce)]
    if cluster is None:
        call_for_rows(umov, "run", "-q", *more, *(["--timeout-s", timeout_s] if timeout_s else []),
                      *(["--memory-mb", memory_mb] if memory_mb else []),
                      *(["--join"] if join else []), output, *words)
        return Result(output, umov)
    if words and is_url(output):
        _scale_store.begin(Store(str(output)), umov, more, words)
    elif words:
        call(umov, "lock", "-q", *more, output, *words)
    result = Result(output, umov)
    if not words:
        _refuse_others(result, reduce, per_shard, isa)
    if result.missing:
        _do_missing(result, cluster, threads, timeout_s, join, tls, quiet, memory_mb)
    if result._store is None and not result.missing:  # of a store, `merge` tells
        call_for_rows(umov, "run", "-q", *(["--join"] if join else []), result.folder)
    return result


def _refuse_others(result: Result, reduce: str | Sequence[str], per_shard: int | None, isa: str | None) -> None:
    """What is not that of the job of the folder: the command refuses it with the same words."""
    lock = result.lock
    given, kept, held = _reduce_words(reduce)[1::2], lock.get("reduce", []), lock["instruction_set"]
    for is_other, asked, there in (
            (per_shard and min(per_shard, lock["total"]) != lock["per_shard"], f"per_shard is {per_shard}",
             f"has {lock['per_shard']} {lock['unit']} in a shard"),
            (isa and isa != held, f"isa is {isa}", f"is held to {held or 'no instruction set'}"),
            (given and given != kept, f"reduce is {', '.join(given)}", f"keeps {', '.join(kept) or 'all rows'}")):
        if is_other:
            raise UsageError(f"{asked}; the job of {result.folder} {there}, as was said when it was begun. Leave it out, or begin another "
                             "in a new folder")


def _do_missing(result: Result, cluster: Any, threads: int, timeout_s: float | None, join: bool, tls: bool, quiet: bool,
                memory_mb: int | None = None) -> None:
    """By the workers of a cluster."""
    hold = None if join else StoreLease(result._store) if result._store else Hold(result._umov, pathlib.Path(result.folder))
    try:
        dask = Cluster(cluster, tls)
        try:
            driver = Driver(result, dask, threads, timeout_s, quiet, memory_mb)
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


def _main() -> int:
    parser = argparse.ArgumentParser(prog="python -m umov.scale", description="The cluster's side of umov scale run.")
    parser.add_argument("do", choices=["run"])
    parser.add_argument("folder")
    parser.add_argument("--cluster", required=True)
    parser.add_argument("--program")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--timeout-s", type=float)
    parser.add_argument("--memory-mb", type=int)
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--join", action="store_true")
    given = parser.parse_args()
    try:
        umov = find_program(given.program)
        result = Result(given.folder, umov)
        if result.missing:
            _do_missing(result, given.cluster, given.threads, given.timeout_s, given.join, True, given.quiet, given.memory_mb)
        if not result.missing:
            call(umov, "run", "-q", *(["--join"] if given.join else []), given.folder)
    except (Error, Interrupted) as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(_main())
