"""TOML from dictionaries; the standard library only reads it."""
from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._numbers import no_foreign, plain_key, text, utf8
from .errors import InputError, UsageError
from .times import is_moment, utc, utc_list

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")


def _key(name: str) -> str:
    utf8(name, "a key")
    return name if _BARE.match(name) else json.dumps(name)


def _number(value: float) -> str:
    if math.isnan(value):
        return "nan"
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(float(value))


def _with_an_end() -> UsageError:
    return UsageError("a table or list holds itself, or lists within lists without number; tables within tables, with an end, were expected")


def copied(value: Any) -> Any:
    """Tables, lists and arrays that nobody else holds; what cannot change is itself."""
    try:
        return _copied(value)
    except RecursionError:
        raise _with_an_end() from None  # its trace has a thousand lines


def _copied(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _copied(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_copied(one) for one in value]
    return value.copy() if hasattr(value, "tolist") and hasattr(value, "copy") else value


def value_text(value: Any, name: str = "value") -> str:
    """A value in place, tables too."""
    try:
        return _value_text(value, name)
    except RecursionError:
        raise _with_an_end() from None


def _a_length(value: Any, name: str) -> UsageError:
    return UsageError(f"{name} is {value!r}; a plain number or a text was expected, in the unit that the key says")


def _value_text(value: Any, name: str) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        if "\0" in utf8(value, name):  # the system takes the name of a file to end there: another file
            raise UsageError(f"{name} is {value!r}; a text without the character 0 was expected")
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, os.PathLike):
        return _value_text(os.fspath(value), name)
    if is_moment(value):
        return "[" + ", ".join(utc_list(value)[0]) + "]" if getattr(value, "shape", ()) else utc(value)
    if isinstance(value, (np.ndarray, np.datetime64)) and value.dtype.kind == "M":  # whose list would be one of whole numbers
        return "[" + ", ".join(utc(one) for one in value.ravel()) + "]" if value.ndim else utc(value)
    if isinstance(value, (np.ndarray, np.timedelta64)) and value.dtype.kind == "m":
        raise _a_length(value, name)
    if isinstance(value, Mapping):
        inside = (f"{_key(str(k))} = {_value_text(v, f'dark_mag.{k}' if name.rpartition('.')[2] == 'dark_mag' else str(k))}" for k, v in value.items()
                  if v is not None)
        return "{ " + ", ".join(inside) + " }"
    no_foreign(value, name)
    if hasattr(value, "to_value") and hasattr(value, "unit") and not hasattr(value, "scale"):  # into the unit that the key has
        return value_text(plain_key(value, name), name)
    if hasattr(value, "to_value") or hasattr(value, "scale"):  # a length of time, of which a scenario has its own forms
        raise _a_length(value, name)
    if hasattr(value, "tolist"):  # numpy arrays and numbers
        return _value_text(value.tolist(), name)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, Sequence):
        return "[" + ", ".join(_value_text(one, name) for one in value) + "]"
    raise UsageError(f"{name} is a {type(value).__name__}; a number, text, truth value, time, list "
                     "or table was expected")


def tables_of(source: Any, name: str) -> dict[str, Any]:
    """The tables of a TOML text; `name` stands for it in messages."""
    import tomllib
    try:
        return tomllib.loads(text(source, "text"))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{name} is no TOML: {error}") from error
    except RecursionError:
        raise InputError(f"{name} has lists or tables within each other hundreds deep; a scenario was expected") from None


def _is_tables(value: Any) -> bool:
    return (isinstance(value, Sequence) and not isinstance(value, str) and len(value) > 0
            and all(isinstance(one, Mapping) for one in value))


def text_of(document: Mapping[str, Any]) -> str:
    """A document: plain keys first, then a section for each table of the top."""
    try:
        return _text_of(document)
    except RecursionError:
        raise _with_an_end() from None


def _text_of(document: Mapping[str, Any]) -> str:
    lines: list[str] = []
    sections: list[str] = []
    for name, value in document.items():
        if value is None:
            continue
        if isinstance(value, Mapping):
            sections += _section(f"[{_key(str(name))}]", value)
        elif _is_tables(value):
            for one in value:
                sections += _section(f"[[{_key(str(name))}]]", one)
        else:
            lines.append(f"{_key(str(name))} = {value_text(value, str(name))}")
    return "\n".join(lines + sections) + "\n"


def _section(head: str, table: Mapping[str, Any]) -> list[str]:
    return ["", head, *(f"{_key(str(k))} = {value_text(v, str(k))}"
                        for k, v in table.items() if v is not None)]
