"""Columns with units, and their way to astropy, pandas and files."""
from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _umov
from ._made import Made
from ._numbers import path_text
from .errors import UsageError

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from astropy.table import QTable

__all__ = ["Table"]

#: Name, unit, description, values; column of its error, decimals and digits of a CSV.
_Column = tuple[str, str, str, Any, tuple[str, int, int]]


def _pack(table: _umov.Table) -> tuple[list[_Column], list[tuple[str, str]]]:
    columns = [(name, unit, text, table.column(name), precision)
               for name, unit, text, precision in zip(table.names, table.units, table.descriptions, table.precisions)]
    return columns, list(table.notes)


def _unpack(columns: list[_Column], notes: list[tuple[str, str]]) -> _umov.Table:
    out = _umov.Table()
    for name, unit, text, values, precision in columns:
        out.add(name, unit, text, values)
        out.set_precision(name, *precision)
    for key, value in notes:
        out.note(key, value)
    return out


def same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    """Equal in shape and in every value; NaN is as NaN."""
    return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=one.dtype.kind == "f" and other.dtype.kind == "f"))


class Table(Made):
    """Rows of a job, column by column. Numbers are read-only numpy views of the library's memory.

    >>> table = umov.materials()
    >>> table.names[:2]
    ['material', 'nm']
    >>> len(table), str(table["material"][0])
    (28, 'paper_au')
    """

    def __init__(self, table: _umov.Table) -> None:
        self._table = table
        self._texts: dict[str, NDArray[Any]] = {}

    @property
    def names(self) -> list[str]:
        """Names of the columns, in order."""
        return self._table.names

    @property
    def notes(self) -> dict[str, str]:
        """What a file's header would say: versions, conventions, object."""
        return dict(self._table.notes)

    def unit(self, name: str) -> str:
        """Unit of a column as astropy spells it; "" for none.

        Parameters
        ----------
        name
            Of the column; `UsageError` with the names for what is none.
        """
        return self._table.units[self._position(name)]

    def description(self, name: str) -> str:
        """What a column holds, in a line.

        Parameters
        ----------
        name
            Of the column.
        """
        return self._table.descriptions[self._position(name)]

    def __getitem__(self, name: str) -> NDArray[Any]:
        self._position(name)
        if name not in self._texts:
            values = self._values(name)
            if values.dtype.kind != "U":
                return values
            values.flags.writeable = False
            self._texts[name] = values
        return self._texts[name]

    def _values(self, name: str) -> NDArray[Any]:
        """Views of numbers; texts as an array of their own."""
        letters = self._table.letters(name)
        if letters is not None:
            return letters.view(f"<U{letters.shape[1]}")[:, 0]
        values = self._table.column(name)
        return np.array(values, dtype=np.str_) if isinstance(values, list) else values

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return self._table.rows

    def to_qtable(self) -> QTable:
        """The same as an astropy QTable: every column of floats has a unit, the notes are in `meta`. It is shown with a few
        digits, and has and writes all; `info.format` of a column is yours."""
        from astropy import units
        from astropy.table import Column

        from ._shown import QTable
        out = QTable(meta=self.notes)
        for name, unit in zip(self.names, self._table.units):
            values = self._values(name)
            if values.dtype == np.int64:  # C's long and long long are one type to numpy, not to all that asks for its letter
                values = values.view(np.int64)
            if unit.startswith("mag("):
                out[name] = units.Magnitude(values, unit=units.Unit(unit), copy=False)
            elif unit or values.dtype.kind == "f":
                out[name] = units.Quantity(values, unit=units.Unit(unit), copy=False)
            else:  # what was made for this table need not be copied
                out.add_column(Column(values, copy=False), name=name, copy=values.dtype.kind != "U")
            out[name].info.description = self.description(name)
        return out

    def to_pandas(self) -> pandas.DataFrame:
        """The same as a pandas DataFrame; units and notes in `attrs`."""
        import pandas
        out = pandas.DataFrame({name: self[name] for name in self.names})
        out.attrs["units"] = dict(zip(self.names, self._table.units))
        out.attrs["notes"] = self.notes
        return out

    def to_arrow(self) -> pyarrow.Table:
        """The same as a pyarrow Table (`pip install pyarrow`): numbers without a copy, units and descriptions as
        metadata of the fields, notes as that of the table.

        >>> umov.materials().to_arrow().column_names[:2]
        ['material', 'nm']
        """
        try:
            import pyarrow
        except ImportError as error:
            raise UsageError("an Arrow table needs the package: pip install pyarrow") from error
        fields, arrays = [], []
        for name, unit in zip(self.names, self._table.units):
            arrays.append(pyarrow.array(self[name]))
            about = {"unit": unit, "description": self.description(name)}
            fields.append(pyarrow.field(name, arrays[-1].type, metadata=about))
        return pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields, metadata=self.notes))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes .csv, .ecsv, .fits or .json: the bytes of the command's file.

        Parameters
        ----------
        path
            Its suffix says the format; `UsageError` for another one, `DeviceError` where it cannot be written.
        """
        self._table.write(path_text(path, "path"))

    def _position(self, name: str) -> int:
        try:
            return self.names.index(name)
        except ValueError:
            raise UsageError(f"there is no column \"{name}\"; there are {', '.join(self.names)}") from None

    def __eq__(self, other: object) -> bool:
        """The same rows, columns, units and notes; NaN is as NaN."""
        if not isinstance(other, Table):
            return NotImplemented
        return self._table is other._table or (
            self.names == other.names and self._table.units == other._table.units and self.notes == other.notes
            and all(same(self[name], other[name]) for name in self.names))

    def __hash__(self) -> int:
        return hash((tuple(self.names), tuple(self._table.units), len(self)))

    def _repr_html_(self) -> str:
        return str(self.to_qtable()[:8]._repr_html_()) + f"<p>{len(self)} rows</p>"

    def __repr__(self) -> str:
        return f"<umov.Table: {len(self)} rows of {', '.join(self.names)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, _pack(self._table)


def _restore(columns: list[_Column], notes: list[tuple[str, str]]) -> Table:
    return Table(_unpack(columns, notes))
