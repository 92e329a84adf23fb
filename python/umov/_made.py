"""What the classes of this package have in common."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .errors import UsageError


class Made:
    """Objects without a part of their own, as `__new__` alone or a constructor that failed leaves them, say so."""

    if not TYPE_CHECKING:  # which would take any name for one that is there

        def __getattr__(self, name: str) -> Any:
            kind = type(self).__name__
            if not name.startswith("__") and not self.__dict__:  # protocols of Python ask for what may be absent
                raise UsageError(f"this {kind} was never made: its constructor was not called, or failed; one that umov.{kind}(...) gave "
                                 "was expected")
            raise AttributeError(f"'{kind}' object has no attribute '{name}'")
