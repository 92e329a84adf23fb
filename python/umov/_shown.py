"""A QTable that shows few digits and writes all of them: astropy's writers of text take a column's format for its digits."""
from __future__ import annotations

from typing import Any

import astropy.table

__all__ = ["QTable", "with_all_digits"]


def with_all_digits(table: Any) -> Any:
    """The table, or where columns have a format for people a copy without."""
    if all(table[name].info.format is None for name in table.colnames):
        return table
    out = table.copy(copy_data=False)
    for name in out.colnames:
        out[name].info.format = None
    return out


class QTable(astropy.table.QTable):  # type: ignore[misc]  # astropy has no types
    """As astropy's, with all digits in what it writes."""

    def write(self, *args: Any, **options: Any) -> Any:
        """As astropy's; numbers to all digits, whatever their format shows."""
        return super(QTable, with_all_digits(self)).write(*args, **options)
