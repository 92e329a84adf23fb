"""The scenario: what a run is about, with one meaning as file, text, dictionary and object."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

from . import _toml, _umov, adapters
from ._made import Made
from ._numbers import path_text, text as utf8_text
from .errors import UsageError

if TYPE_CHECKING:
    from .satellites import Satellite

__all__ = ["Scenario", "schema"]

Changes = Mapping[str, Any]


def schema() -> dict[str, Any]:
    """JSON Schema of the scenario, with every key and default.

    >>> umov.schema()["properties"]["render"]["properties"]["bounces"]["default"]
    1
    """
    import json
    out: dict[str, Any] = json.loads(_umov.schema())
    return out


def _change_list(changes: Changes | None) -> list[str]:
    if changes is not None and not isinstance(changes, Mapping):
        raise UsageError(f"set is a {type(changes).__name__}; a dictionary of keys was expected, such as "
                         '{"render.bounces": 2}')
    return [f"{key}={_toml.value_text(value, key)}" for key, value in (changes or {}).items()]


class Scenario(Made):
    """A scenario, read and checked. Give a path, a dictionary or another scenario, and `set` for
    changes ("render.bounces": 2), as `--set` of the command does.

    Parameters
    ----------
    source
        A path, a dictionary, another Scenario or a Satellite.
    set
        Changes of the scenario's keys, such as {"render.bounces": 2}.

    Notes
    -----
    `InputError` with file, line and column for an unknown key (and the nearest one) or a wrong value.

    Examples
    --------
    >>> scenario = umov.Scenario(EXAMPLES / "hst_maui.toml", set={"time.step_s": 5})
    >>> scenario.title, scenario.objects
    ('HST from Maui, polarized RGB', ['HST'])
    >>> scenario.to_dict()["time"]["step_s"]
    5
    """

    def __init__(self, source: AnyScenario, set: Changes | None = None) -> None:
        if isinstance(source, (str, os.PathLike)):
            self._scenario = _umov.Scenario.read(path_text(source, "the path of a scenario"), _change_list(set))
        elif isinstance(source, Mapping):
            self._scenario = _parse(_toml.text_of(source), None, set)
        elif isinstance(source, Scenario):
            self._scenario = (_parse(source._said(), source.file, set) if set else source._scenario)
        elif hasattr(source, "to_scenario_dict"):
            self._scenario = _parse(_toml.text_of(source.to_scenario_dict()), None, set)
        else:
            raise UsageError(f"{source!r} is a {type(source).__name__}; the path of a scenario, a dictionary, "
                             "a Scenario or a Satellite was expected")
        self._keep: Any = source  # files that adapters made live as long as it

    @classmethod
    def from_toml(cls, text: str, path: str | os.PathLike[str] | None = None,
                  set: Changes | None = None) -> Scenario:
        """From a text; `path` is the file that it stands for: relative paths start there.

        Parameters
        ----------
        text
            TOML.
        path
            The file that it stands for: relative paths start there.
        set
            Changes of the scenario's keys, such as {"render.bounces": 2}.
        """
        out = cls.__new__(cls)
        out._scenario, out._keep = _parse(text, path, set), None
        return out

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> Scenario:
        """From the tables of a scenario; relative paths start at the working folder.

        Parameters
        ----------
        document
            Tables as in a file.
        """
        return cls(document)

    def to_toml(self, folder: str | os.PathLike[str] | None = None) -> str:
        """With every default written out, the accuracy of `umov.run` among them, and absolute paths.

        Parameters
        ----------
        folder
            Where a mesh of arrays and an orbit of lines are put, as mesh.obj and orbit.tle or orbit.json: no file holds them. `UsageError` if
            there are some and no folder is given.
        """
        return adapters.put_down(self._scenario.locked, _files_of(self), folder)

    def _told(self) -> str:
        """All of it: what adapters made by what it holds."""
        return adapters.by_content(self._scenario.locked, _files_of(self))

    def _said(self) -> str:
        """The same without what was left to those who use it: `run` and `Engine` ask for another accuracy each."""
        unsaid, lines, table = self._scenario.unsaid, [], ""
        for line in self._scenario.locked.splitlines():
            table = line if line.startswith("[") else table
            if table != "[render]" or line.partition(" = ")[0] not in unsaid:
                lines.append(line)
        return "\n".join(lines) + "\n"

    def to_dict(self) -> dict[str, Any]:
        """The same as tables. Files that were made of arrays or lines are there as long as this object is."""
        import tomllib
        return tomllib.loads(self._scenario.locked)

    @property
    def title(self) -> str:
        """Heading of the report."""
        return self._scenario.title

    @property
    def file(self) -> str:
        """The file that it was read from, as messages name it."""
        return self._scenario.file

    @property
    def objects(self) -> list[str]:
        """Names of the objects."""
        return self._scenario.objects

    @property
    def bands(self) -> list[str]:
        """Names of the bands."""
        return [name for name, _ in self._scenario.bands]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scenario) and self._told() == other._told()

    def __hash__(self) -> int:
        return hash(self._told())

    def __repr__(self) -> str:
        objects = ", ".join(name or "unnamed" for name in self.objects)
        return f"<umov.Scenario {self.title!r}: {objects}; {', '.join(self.bands)}>"

    def _repr_html_(self) -> str:
        import html
        return (f"<details><summary>{html.escape(repr(self))}</summary>"
                f"<pre>{html.escape(self._scenario.locked)}</pre></details>")

    def __reduce__(self) -> tuple[Any, ...]:
        files = _files_of(self)
        return _restore, (self._said(), self.file, None if files is None else (str(files.folder), files.texts))


AnyScenario = Union[str, "os.PathLike[str]", Mapping[str, Any], Scenario, "Satellite"]


def _parse(text: str, path: str | os.PathLike[str] | None, changes: Changes | None) -> _umov.Scenario:
    # Relative paths start at the folder of the file that the text stands for.
    checked = utf8_text(text, "text")
    place = path_text(path, "path") if path is not None else "scenario"
    return _umov.Scenario.parse(checked, place, _change_list(changes))


def _files_of(source: Any) -> adapters.Files | None:
    """The files that adapters made for a scenario."""
    while isinstance(source, Scenario):
        source = source._keep
    return source if isinstance(source, adapters.Files) else getattr(source, "_files", None)


def _restore(text: str, file: str, made: tuple[str, adapters.Texts] | None = None) -> Scenario:
    if made is None:
        return Scenario.from_toml(text, file)
    files = adapters.Files(made[1])  # in a folder of this process
    out = Scenario.from_toml(text.replace(made[0], str(files.folder)), file)
    out._keep = files
    return out
