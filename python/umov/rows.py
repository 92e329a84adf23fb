"""Rows of a job in parts, mapped from the files of its shards (docs/scale.md has their form)."""
from __future__ import annotations

import json
import os
import pathlib
import struct
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from .errors import InputError, UsageError, Where

__all__ = ["Rows"]

_MAGIC = b"UMOVROW1"
_TYPES = {"float64": "<f8", "int64": "<i8", "text": "<u4", "bool": "|u1"}


def _about(path: pathlib.Path) -> dict[str, Any]:
    """What the end of a file says of it."""
    with path.open("rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - 24))
        tail = file.read(24)
        if len(tail) < 24 or tail[16:] != _MAGIC:
            raise InputError("is no whole file of rows; umov.scale.Result(folder).verify() tells more", Where(str(path)))
        begin, length = struct.unpack("<QQ", tail[:16])
        file.seek(begin)
        out: dict[str, Any] = json.loads(file.read(length))
        return out


class Rows:
    """Rows of one table of many files: opened at once, read where they are asked for.

    Parameters
    ----------
    files
        Files of shards, in order.
    table
        Name of the table.

    Examples
    --------
    >>> job = umov.scale.Job("signature", EXAMPLES / "agena_maui.toml", poses=20, phase=60)
    >>> rows = umov.scale.run(job, "agena_rows").rows()
    >>> bool(rows["intensity"].mean() > 0)
    True
    """

    def __init__(self, files: Sequence[pathlib.Path], table: str) -> None:
        self.files, self.table = list(files), table
        self._heads: dict[int, dict[str, Any]] = {}
        self._places: tuple[Any, Any, Any] | None = None
        if not self.files:
            raise InputError("no shard is there")
        head = self._head(0)
        self.columns: list[str] = [column["name"] for column in head["columns"]]
        self.units: dict[str, str] = {column["name"]: column["unit"] for column in head["columns"]}
        self._kinds: dict[str, str] = {column["name"]: column["type"] for column in head["columns"]}

    def _head(self, file: int) -> dict[str, Any]:
        if file not in self._heads:
            tables = {one["name"]: one for one in _about(self.files[file])["tables"]}
            if self.table not in tables:
                raise UsageError(f"table {self.table}: the job has {', '.join(tables)}")
            self._heads[file] = tables[self.table]
        return self._heads[file]

    @property
    def _blocks(self) -> tuple[Any, Any, Any]:
        """Of each block its file, its number there and the first of its rows; of the last also their end."""
        if self._places is None:
            all_ = [(f, b, block["rows"]) for f in range(len(self.files)) for b, block in enumerate(self._head(f)["blocks"])]
            files, numbers, rows = np.array(all_, dtype=np.int64).reshape(-1, 3).T
            self._places = files, numbers, np.concatenate([[0], np.cumsum(rows)])
        return self._places

    @property
    def lengths(self) -> list[int]:
        """Rows of each block."""
        lengths: list[int] = np.diff(self._blocks[2]).tolist()
        return lengths

    def __len__(self) -> int:
        return sum(self._head(f)["rows"] for f in range(len(self.files)))

    def block(self, number: int, column: str) -> Any:
        """One column of one block: mapped, and as texts where it holds text.

        Parameters
        ----------
        number
            Of the block.
        column
            Its name.
        """
        files, numbers, _ = self._blocks
        return self._read(int(files[number]), int(numbers[number]), column)

    def _cells(self, file: int, block: int, column: str) -> tuple[Any, dict[str, int]]:
        """As they stand in the file, mapped: texts by their numbers; and where that is."""
        if column not in self._kinds:
            raise UsageError(f"column {column}: there are {', '.join(self.columns)}")
        about = self._head(file)["blocks"][block]
        place, rows = about["columns"][self.columns.index(column)], about["rows"]
        kind = _TYPES[self._kinds[column]]
        if rows == 0:
            return np.empty(0, dtype=kind), place
        return np.memmap(self.files[file], dtype=kind, mode="r", offset=place["at"], shape=(rows,)), place

    def _read(self, file: int, block: int, column: str) -> Any:
        values, place = self._cells(file, block, column)
        kind = self._kinds[column]
        if kind == "text":
            return np.array(self._texts(file, place) if len(values) else [], dtype=object)[values]
        return values.view(np.bool_) if kind == "bool" else values

    def _texts(self, file: int, place: dict[str, int]) -> list[str]:
        """Those that differ, by their numbers."""
        ends = np.memmap(self.files[file], dtype="<u8", mode="r", offset=place["ends"], shape=(place["texts"],))
        words = bytes(np.memmap(self.files[file], dtype="u1", mode="r", offset=place["words"],
                                shape=(int(ends[-1]),))) if ends[-1] else b""
        begins = np.concatenate([[0], ends[:-1]]).astype(int)
        return [words[a:int(b)].decode() for a, b in zip(begins, ends)]

    def __getitem__(self, column: str) -> Any:
        """A whole column in memory."""
        return np.concatenate([self.block(k, column) for k in range(len(self._blocks[0]))])

    def row(self, number: int) -> dict[str, Any]:
        """One row: only its cells are fetched.

        Parameters
        ----------
        number
            From 0.
        """
        starts = self._blocks[2]
        if not 0 <= number < starts[-1]:
            raise UsageError(f"row {number}: there are {starts[-1]}")
        block = int(np.searchsorted(starts, number, side="right")) - 1
        files, numbers, _ = self._blocks
        about = self._head(int(files[block]))["blocks"][int(numbers[block])]
        with self.files[int(files[block])].open("rb", buffering=0) as shard:
            return {name: self._cell(shard.fileno(), about["columns"][k], self._kinds[name], int(number - starts[block]))
                    for k, name in enumerate(self.columns)}

    @staticmethod
    def _cell(file: int, place: dict[str, int], kind: str, row: int) -> Any:
        """One cell of a column, read by itself; of texts its own alone."""
        width = np.dtype(_TYPES[kind]).itemsize
        value = np.frombuffer(os.pread(file, width, place["at"] + width * row), _TYPES[kind])[0]
        if kind == "bool":
            return np.bool_(value)
        if kind != "text":
            return value
        before = 1 if value else 0  # the end of the text before, where there is one
        ends = struct.unpack(f"<{1 + before}Q", os.pread(file, 8 + 8 * before, place["ends"] + 8 * (int(value) - before)))
        begin = ends[0] if before else 0
        return os.pread(file, ends[-1] - begin, place["words"] + begin).decode()

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[dict[str, Any]]:
        """Block after block: memory does not grow with their number.

        Parameters
        ----------
        columns
            Those wanted; by default all.
        """
        for file in range(len(self.files)):
            for block in range(len(self._head(file)["blocks"])):
                yield {name: self._read(file, block, name) for name in columns or self.columns}

    def to_arrow(self) -> Any:
        """All rows as a pyarrow table, with units in the fields."""
        import pyarrow as pa
        kinds = {"float64": pa.float64(), "int64": pa.int64(), "bool": pa.bool_(), "text": pa.string()}
        schema = pa.schema([pa.field(name, kinds[self._kinds[name]], metadata={"unit": self.units[name]}) for name in self.columns])
        batches = [pa.record_batch([self._arrow(file, block, name) for name in self.columns], schema=schema)
                   for file in range(len(self.files)) for block in range(len(self._head(file)["blocks"]))]
        return pa.Table.from_batches(batches, schema=schema)

    def _arrow(self, file: int, block: int, column: str) -> Any:
        import pyarrow as pa
        if self._kinds[column] != "text":
            return pa.array(self._read(file, block, column))
        values, place = self._cells(file, block, column)  # no object of Python for each row
        texts = self._texts(file, place) if len(values) else []
        return pa.DictionaryArray.from_arrays(pa.array(values), pa.array(texts, pa.string())).cast(pa.string())
