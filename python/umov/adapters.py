"""Orbits and meshes of other packages, as the files that a scenario names. The packages are needed
only where their objects are given."""
from __future__ import annotations

import contextlib
import hashlib
import os
import pathlib
import tempfile
import weakref
from collections.abc import Mapping, Sequence, Set
from typing import Any

import numpy as np

from . import _toml, satrecs
from ._numbers import in_unit, joined, number_array, path_text, utf8
from .errors import DeviceError, UsageError
from .times import is_gap

Texts = dict[str, str]


class Files:
    """Files of one object in a folder of their own, gone with it."""

    def __init__(self, texts: Texts) -> None:
        self.texts = {name: utf8(text, name) for name, text in texts.items()}
        folder = tempfile.mkdtemp(prefix="umov-")
        self.folder = pathlib.Path(folder)
        for name, text in texts.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        self.key = hashlib.sha256(repr(sorted(self.texts.items())).encode()).hexdigest()
        self._end = weakref.finalize(self, _remove, folder, list(texts), os.getpid())

    def _moved(self, text: str, folder: Any) -> str:
        names = " and ".join(self.texts)
        if folder is None:
            raise UsageError(f"{names} were made of what was given in memory, and go with this object; a folder for them was expected: "
                             "to_toml(folder=\"...\"), or save them and give their names")
        into = pathlib.Path(path_text(folder, "folder")).absolute()
        try:
            into.mkdir(parents=True, exist_ok=True)
            for name, content in self.texts.items():
                if (into / name).exists() and (into / name).read_text(encoding="utf-8") != content:
                    raise UsageError(f"{into / name} is there already, and is another file; a folder without it was expected")
                (into / name).write_text(content, encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise DeviceError(f"{into}: {names} cannot be written ({error}); a folder for them was expected") from error
        # Within the quotes of a TOML text: a quote or backslash of the folder's name is none of its own.
        return text.replace(str(self.folder), _toml.value_text(str(into))[1:-1])


def put_down(text: str, files: Files | None, folder: Any) -> str:
    """The text of an object as others may read it: files that were made for it (None: none were) are put into a folder and named as
    they stand there; `UsageError` without one."""
    return text if files is None else files._moved(text, folder)


def by_content(text: str, files: Files | None) -> str:
    """The text of an object as it is compared: such files by what they hold instead of where they are."""
    return text if files is None else text.replace(str(files.folder), f"made:{files.key}")


def _remove(folder: str, names: list[str], owner: int) -> None:
    if os.getpid() != owner:  # a forked process ends with copies of what others still need
        return
    for name in names:
        pathlib.Path(folder, name).unlink(missing_ok=True)
    with contextlib.suppress(OSError):  # somebody put a file there, or cleaned up before
        pathlib.Path(folder).rmdir()


def orbit_texts(orbit: Any) -> Texts | None:
    """The file of an sgp4 Satrec, a skyfield EarthSatellite or a list of them, or of a text of two or three lines: its name and what
    it holds; None for what is a file or a table already."""
    if isinstance(orbit, str):
        return {"orbit.tle": orbit} if "\n" in orbit.strip() else None
    if isinstance(orbit, (os.PathLike, Mapping)):
        return None
    if not _is_iterable(orbit) or isinstance(orbit, (bytes, Set)) or hasattr(orbit, "columns"):  # a table gives its names
        orbit = [orbit]
    listed = list(orbit)
    if not listed:
        raise _no_orbit(f"an empty {type(orbit).__name__}")
    if all(isinstance(one, str) for one in listed):
        return {"orbit.tle": "".join(one.rstrip("\r\n") + "\n" for one in listed)}
    if any(isinstance(one, str) for one in listed):
        raise _no_orbit("a list of lines and of objects; one kind")
    return satrecs.texts_of([_satrec(one) for one in listed])


def _satrec(orbit: Any) -> tuple[str, Any]:
    """Name and Satrec of one object of another package."""
    model = getattr(orbit, "model", orbit)  # skyfield keeps its Satrec there
    if not hasattr(model, "satnum") or not hasattr(model, "jdsatepoch"):
        raise _no_orbit(f"a {type(orbit).__name__}")
    return " ".join(str(getattr(orbit, "name", None) or "").split()), model


def _is_iterable(value: Any) -> bool:
    """A single Time or Quantity has __iter__, and refuses."""
    try:
        iter(value)
    except TypeError:
        return False
    return True


def out_of_array(value: Any) -> Any:
    """What an array without dimensions holds; all else as it is."""
    return value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value


def _no_orbit(what: str) -> UsageError:
    return UsageError(f"orbit is {what}; a file, the lines of a TLE, a table of the scenario, an sgp4 Satrec or a skyfield "
                      "EarthSatellite was expected")


#: Units of a mesh by the names that trimesh has for them.
_MESH_UNITS = {name: unit for unit, names in {
    "m": "m meter meters metre metres", "mm": "mm millimeter millimeters millimetre millimetres",
    "cm": "cm centimeter centimeters centimetre centimetres", "in": 'in inch inches "', "ft": "ft foot feet '"}.items()
    for name in names.split()}


def mesh_unit(mesh: Any) -> str | None:
    """What a trimesh mesh, or each part of a scene or of meshes by name, says of its unit; None where none says anything, and for a
    file, a table or bare arrays. `UsageError` where parts differ: one file has one unit."""
    if isinstance(mesh, Mapping) and _is_parts(mesh):
        parts = list(mesh.values())
    else:
        parts = list(mesh.geometry.values()) if _is_scene(mesh) else [mesh]
    units = {_unit_told(one) for one in parts if _is_mesh(one)}
    if len(units) > 1:
        raise UsageError(f"parts of the mesh are in {', '.join(sorted(one or 'no unit' for one in units))}; one unit for all was expected. "
                         "Convert each: part.convert_units(\"meters\"), or say unit=.")
    return units.pop() if units else None


def _unit_told(mesh: Any) -> str | None:
    told = getattr(mesh, "units", None)
    if told is None:
        return None
    unit = _MESH_UNITS.get(str(told).strip().lower())
    if unit is None:
        raise UsageError(f"the mesh has units = {told!r}; m, mm, cm, in or ft was expected. Say which of them by unit=, or "
                         "convert it first: mesh.convert_units(\"meters\").")
    return unit


def mesh_text(mesh: Any, unit: str = "m") -> str | None:
    """An OBJ file of a trimesh mesh or scene, of (vertices, faces) or (vertices, faces, groups), or of several of these by name, a
    Quantity among them in `unit`; None for a file or a table."""
    if isinstance(mesh, (str, os.PathLike)) or (isinstance(mesh, Mapping) and not _is_parts(mesh)):
        return None
    lines, before = [], 0
    for group, part in _parts(mesh):
        points, corners, names = _triangles(part, unit, group)
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
        faces = (corners.astype(np.int64) + 1 + before).tolist()
        for name in dict.fromkeys(names):
            lines.append(f"usemtl {name}")
            lines += [f"f {a} {b} {c}" for (a, b, c), one in zip(faces, names) if one == name]
        before += len(points)
    return "\n".join(lines) + "\n"


def _is_mesh(value: Any) -> bool:
    return hasattr(value, "vertices") and hasattr(value, "faces")


def _is_scene(value: Any) -> bool:
    """A scene of trimesh."""
    return hasattr(value, "geometry") and hasattr(value, "graph")


def _is_parts(mesh: Mapping[Any, Any]) -> bool:
    """Meshes by the names of their groups, no table of a scenario."""
    return bool(mesh) and all(_is_mesh(one) or (isinstance(one, (list, tuple)) and len(one) == 2) for one in mesh.values())


def _parts(mesh: Any) -> list[tuple[str, Any]]:
    """Names and meshes of what is given; "": its own name for its groups."""
    if isinstance(mesh, Mapping):
        if any(is_gap(name) for name in mesh):
            raise UsageError("a mesh has no name (None or nan); meshes by the names of their groups were expected")
        return [(str(name), part) for name, part in mesh.items()]
    if _is_scene(mesh):  # each geometry where its node puts it
        out = []
        for node in mesh.graph.nodes_geometry:
            transform, name = mesh.graph[node]
            part = mesh.geometry[name].copy()
            if _is_mesh(part):
                part.apply_transform(transform)
                out.append((_material_of(part) or str(name), part))
        if not out:
            raise UsageError("the scene of trimesh has no mesh; one with triangles was expected")
        return out
    if isinstance(mesh, Sequence) and any(_is_mesh(one) for one in mesh):
        raise UsageError("mesh is a list of meshes, of which nobody knows the materials; meshes by the names of their groups were expected: "
                         '{"bus": box, "wing": plate}')
    if _is_mesh(mesh) or (isinstance(mesh, Sequence) and len(mesh) in (2, 3)):
        return [("", mesh)]
    raise UsageError(f"mesh is a {type(mesh).__name__}; a file, a table of the scenario, a trimesh mesh or scene, (vertices, faces) or "
                     "(vertices, faces, groups), or several of these by name was expected")


def _material_of(mesh: Any) -> str:
    """The name of the one material that a trimesh mesh has; "" where it has none."""
    name = getattr(getattr(getattr(mesh, "visual", None), "material", None), "name", None)
    return name if isinstance(name, str) else ""


def _groups_of(mesh: Any, group: str, faces: int) -> list[str]:
    """The group of each triangle of a trimesh mesh. Colours have no name to be mapped by."""
    visual: Any = getattr(mesh, "visual", None)
    several = getattr(getattr(visual, "material", None), "materials", None)
    if not group and several and getattr(visual, "face_materials", None) is not None:
        named = [getattr(one, "name", None) or f"material_{k}" for k, one in enumerate(several)]
        return [str(named[int(k)]) for k in visual.face_materials]
    colours = np.unique(np.asarray(visual.face_colors), axis=0) if getattr(visual, "kind", None) == "face" else ()
    if not group and len(colours) > 1:
        from ._jobs import Watch
        Watch(None).warn(f"the trimesh mesh has faces of {len(colours)} colours and no names of materials: all are one group. For "
                         "several give meshes by name, {\"bus\": box, \"wing\": plate}, or (vertices, faces, groups)")
    return [group or _material_of(mesh) or "default"] * faces


def _triangles(part: Any, unit: str, group: str) -> tuple[Any, Any, list[str]]:
    """Vertices, triangles and the group of each."""
    vertices, faces, *more = (part.vertices, part.faces) if _is_mesh(part) else part
    vertices = joined(vertices, "vertices")
    points = number_array(in_unit(vertices, "vertices", unit) if hasattr(vertices, "to_value") and hasattr(vertices, "unit") else vertices, "vertices")
    try:
        if np.ma.is_masked(faces):
            raise ValueError("some of them are masked")
        corners = np.asarray(faces)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"faces are no array of numbers ({error}); (N, 3) was expected") from error
    if points.ndim != 2 or points.shape[1] != 3:
        raise UsageError(f"vertices have shape {points.shape}; (N, 3) was expected")
    if corners.ndim != 2 or corners.shape[1] != 3 or not np.issubdtype(corners.dtype, np.integer):
        raise UsageError(f"faces have shape {corners.shape} of {corners.dtype}; (N, 3) whole numbers were "
                         "expected")
    if corners.size and (corners.min() < 0 or corners.max() >= len(points)):
        raise UsageError(f"faces name vertices {corners.min()} to {corners.max()}; there are {len(points)}, "
                         "counted from 0")
    if not more:
        return points, corners, _checked(_groups_of(part, group, len(corners)))
    given = list(np.ravel(np.asarray(more[0], dtype=object)))
    if np.ma.is_masked(more[0]) or any(is_gap(one) for one in given):
        raise UsageError("groups have gaps (None, nan or masked); a name for each face was expected")
    names = [str(one) for one in given]
    if len(names) != len(corners):
        raise UsageError(f"groups are {len(names)}; a name for each of {len(corners)} faces was expected")
    return points, corners, _checked(names)


def _checked(names: list[str]) -> list[str]:
    """As an OBJ file can hold them."""
    for name in dict.fromkeys(names):
        if not name.strip() or name != name.strip() or not name.isprintable() or "\\" in name or " #" in f" {name}":  # a line that goes on, a comment
            raise UsageError(f"a group is named {name!r}; a name that can be printed was expected, without spaces at its ends, "
                             "a backslash, or a # that begins a word")
    return names
