"""What can go wrong: one class for each exit code of the command, with the command's text."""
from __future__ import annotations

from typing import Any, NamedTuple, NoReturn

from ._words import in_python

__all__ = ["DeviceError", "Error", "InputError", "InternalError", "Interrupted", "NoResult",
           "NumericsError", "UmovWarning", "UsageError", "Where"]


class Where(NamedTuple):
    """A place in an input; 0 where line or column are not known.

    >>> umov.Where("hst.tle", 2, 69)
    Where(file='hst.tle', line=2, column=69)
    """

    file: str = ""  #: as messages name it
    line: int = 0  #: from 1
    column: int = 0  #: from 1


class UmovWarning(UserWarning):
    """Something to know although work went on.

    >>> issubclass(umov.UmovWarning, UserWarning)
    True
    """


class Error(Exception):
    """Base of all errors. `str(error)` is what the command prints, options by the names of their arguments: place, what
    was found, what was expected, what to do.

    Parameters
    ----------
    message
        Found; expected. What to do.
    where
        The place in an input, if there is one.

    Examples
    --------
    >>> try:
    ...     umov.Material("paper_gold")
    ... except umov.Error as error:
    ...     print(error)
    unknown material "paper_gold". Did you mean "paper_al"? Known: umov.materials().
    """

    exit_code = 1
    #: Rows that were complete before the error, where there are any.
    partial: Any = None

    def __init__(self, message: str, where: Where | None = None) -> None:
        self.message = message
        self.where = where or Where()
        super().__init__(message, self.where)

    def __str__(self) -> str:
        place = ""
        if self.where.file:
            numbers = [str(n) for n in (self.where.line, self.where.column) if n > 0]
            place = ":".join([self.where.file, *numbers]) + ": "
        return place + self.message

    def _clauses(self) -> tuple[str, str, str]:
        first, _, remedy = self.message.partition(". ")
        found, _, expected = first.partition("; ")
        return found.rstrip("."), expected.rstrip("."), remedy

    @property
    def found(self) -> str:
        """What was found: the first clause of the message."""
        return self._clauses()[0]

    @property
    def expected(self) -> str:
        """What was expected: the second clause of the message, or ""."""
        return self._clauses()[1]

    @property
    def remedy(self) -> str:
        """What to do: all sentences of the message after the first."""
        return self._clauses()[2]


class InternalError(Error):
    """A fault of umov itself (exit code 1).

    >>> umov.InternalError.exit_code
    1
    """


class UsageError(Error, ValueError):
    """A wrong argument (exit code 2).

    >>> umov.UsageError.exit_code
    2
    """

    exit_code = 2


class InputError(Error, ValueError):
    """An input file or value is wrong or missing (exit code 3).

    >>> try:
    ...     umov.Scenario.from_toml("umov = 1\\nsed = 2\\n")
    ... except umov.InputError as error:
    ...     print(error.where.line, error.found)
    2 unknown key "sed"
    """

    exit_code = 3


class NumericsError(Error, ArithmeticError):
    """Physics or numerics: a decayed orbit, a search that does not converge (exit code 4).

    >>> umov.NumericsError.exit_code
    4
    """

    exit_code = 4


class NoResult(Error, LookupError):
    """Nothing to report, such as no pass in the span (exit code 5).

    >>> umov.NoResult.exit_code
    5
    """

    exit_code = 5


class DeviceError(Error):
    """A device is missing, a disk full or a folder not writable (exit code 6).

    >>> umov.DeviceError.exit_code
    6
    """

    exit_code = 6


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a job; `partial` holds what was complete: rows of `run`, `Satellite.light_curve`, `passes` and
    `ephemeris`, the first poses, in C order, of `Engine.evaluate`, `Engine.light` and `Sums.abundances`, states of
    `propagate` (of those that nobody came to `error` is -1). None of all others. No `Error`, so that `except Exception`
    lets it pass as it does KeyboardInterrupt.

    >>> issubclass(umov.Interrupted, KeyboardInterrupt)
    True
    """

    exit_code = 130
    partial: Any = None


Stopped = tuple[int, str, str, int, int]
_CLASSES: dict[int, type[Error]] = {one.exit_code: one for one in (
    InternalError, UsageError, InputError, NumericsError, NoResult, DeviceError)}


def error_from(told: Stopped) -> Error | Interrupted:
    """The exception for what the library tells: code, message, file, line, column."""
    code, message, file, line, column = told
    message, file = in_python(message), in_python(file)
    if code == Interrupted.exit_code:
        return Interrupted(message)
    return _CLASSES.get(code, InternalError)(message, Where(file, line, column))


def raise_stopped(told: Stopped, partial: object) -> NoReturn:
    """Raises the reason why a job ended early, with what it had done."""
    error = error_from(told)
    error.partial = partial
    raise error
