"""Orbits and meshes of other packages, as the files that a scenario names. The packages are needed
only where their objects are given."""
from __future__ import annotations

import os
import pathlib
import tempfile
import weakref
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._numbers import number_array
from .errors import UsageError

Texts = dict[str, str]


class Files:
    """Files of one object in a folder of their own, gone with it."""

    def __init__(self, texts: Texts) -> None:
        self.texts = texts
        folder = tempfile.mkdtemp(prefix="umov-")
        self.folder = pathlib.Path(folder)
        for name, text in texts.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        self._end = weakref.finalize(self, _remove, folder, list(texts))


def _remove(folder: str, names: list[str]) -> None:
    for name in names:
        pathlib.Path(folder, name).unlink(missing_ok=True)
    pathlib.Path(folder).rmdir()


def orbit_text(orbit: Any) -> str | None:
    """TLE lines of an sgp4 Satrec, a skyfield EarthSatellite or a text of two or three lines; None
    for what is a file or a table already."""
    if isinstance(orbit, str):
        return orbit if "\n" in orbit.strip() else None
    if isinstance(orbit, (os.PathLike, Mapping)):
        return None
    if isinstance(orbit, Sequence) and all(isinstance(line, str) for line in orbit):
        return "\n".join(orbit) + "\n"
    name = getattr(orbit, "name", None) or ""
    model = getattr(orbit, "model", orbit)  # skyfield keeps its Satrec there
    if hasattr(model, "satnum") and hasattr(model, "jdsatepoch"):
        try:
            from sgp4.exporter import export_tle
        except ImportError as error:
            raise UsageError("an sgp4 Satrec needs the package sgp4: pip install sgp4") from error
        return "\n".join([*([name] if name else []), *export_tle(model)]) + "\n"
    raise UsageError(f"orbit is a {type(orbit).__name__}; a file, the lines of a TLE, a table of the scenario, "
                     "an sgp4 Satrec or a skyfield EarthSatellite was expected")


def mesh_text(mesh: Any) -> str | None:
    """An OBJ file of a trimesh mesh or of (vertices, faces); None for a file or a table."""
    if isinstance(mesh, (str, os.PathLike, Mapping)):
        return None
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        vertices, faces = mesh.vertices, mesh.faces
    elif isinstance(mesh, Sequence) and len(mesh) == 2:
        vertices, faces = mesh
    else:
        raise UsageError(f"mesh is a {type(mesh).__name__}; a file, a table of the scenario, a trimesh mesh or "
                         "(vertices, faces) was expected")
    try:
        points = number_array(vertices, "vertices")
        corners = np.asarray(faces)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"vertices or faces are no arrays of numbers ({error}); (N, 3) each was expected") from error
    if points.ndim != 2 or points.shape[1] != 3:
        raise UsageError(f"vertices have shape {points.shape}; (N, 3) was expected")
    if corners.ndim != 2 or corners.shape[1] != 3 or not np.issubdtype(corners.dtype, np.integer):
        raise UsageError(f"faces have shape {corners.shape} of {corners.dtype}; (N, 3) whole numbers were "
                         "expected")
    if corners.size and (corners.min() < 0 or corners.max() >= len(points)):
        raise UsageError(f"faces name vertices {corners.min()} to {corners.max()}; there are {len(points)}, "
                         "counted from 0")
    lines = ["usemtl default"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (corners + 1).tolist()]
    return "\n".join(lines) + "\n"
