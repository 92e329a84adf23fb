"""A QTable that shows few digits and keeps all: `info.format` of its columns is the user's, and whatever writes takes every digit."""
from __future__ import annotations

from typing import Any

import astropy.table

__all__ = ["QTable", "with_all_digits"]


def with_all_digits(table: Any) -> Any:
    """The table, or where columns have a format for people a copy without: astropy's writers of text take it for their digits."""
    if all(table[name].info.format is None for name in table.colnames):
        return table
    out = table.copy(copy_data=False)
    for name in out.colnames:
        out[name].info.format = None
    return out


def _format(name: str, unit: str) -> str:
    """How people are shown a number: angles to .4 deg, days to a millisecond."""
    if unit == "deg" or unit.startswith("mag"):
        return ".4f"
    return ".8f" if name.startswith(("mjd", "jd")) else ".7g"


class _FewDigits(astropy.table.Table.TableFormatter):  # type: ignore[misc]  # astropy has no types
    """Shows floats without a format of their own with few digits."""

    def _pformat_table(self, table: Any, *args: Any, **options: Any) -> Any:
        shown = table.copy(copy_data=False)
        for name in shown.colnames:
            column = shown[name]
            if getattr(getattr(column, "dtype", None), "kind", "") == "f" and column.info.format is None:
                column.info.format = _format(name, str(getattr(column, "unit", None) or ""))
        return super()._pformat_table(shown, *args, **options)


class QTable(astropy.table.QTable):  # type: ignore[misc]  # astropy has no types
    """As astropy's, shown with few digits."""

    TableFormatter = _FewDigits
