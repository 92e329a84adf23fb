"""Meshes of memory: of trimesh with its materials, of arrays with groups, of parts by name."""
import numpy as np
import pytest
from astropy import units as u

import umov

trimesh = pytest.importorskip("trimesh")
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def _named(mesh, name):
    mesh.visual = trimesh.visual.TextureVisuals(material=trimesh.visual.material.PBRMaterial(name=name))
    return mesh


def _groups(made):
    """Triangles of each group."""
    got = umov.mesh(made)
    return {name: int((got.groups == k).sum()) for k, name in enumerate(got.group_names)}


def test_a_scene_of_trimesh_keeps_its_materials_and_places():
    scene = trimesh.Scene()
    scene.add_geometry(_named(trimesh.creation.box((1, 1, 1)), "gold foil"))
    scene.add_geometry(_named(trimesh.creation.box((0.1, 3, 1)), "cells"), transform=trimesh.transformations.translation_matrix([0, 2, 0]))
    made = umov.Satellite(scene, materials={"gold foil": "mli_kapton", "cells": "cell_silicon"})
    assert _groups(made) == {"gold foil": 12, "cells": 12}
    vertices = umov.mesh(made).vertices
    assert vertices[:, 1].min() == -0.5 and vertices[:, 1].max() == 3.5  # the wing's 3 m about y = 2
    with pytest.raises(umov.InputError, match='"foil" is no material of'):
        umov.Engine(umov.Satellite(scene, materials={"foil": "mli_kapton", "default": "cell_silicon"}), bands=["nm:550"])


def test_meshes_by_name_are_groups():
    box = trimesh.creation.box((1, 1, 1))
    made = umov.Satellite({"bus": box, "wing": (SQUARE, HALVES)}, unit="m", materials={"bus": "gold", "wing": "cell_silicon"})
    assert _groups(made) == {"bus": 12, "wing": 2}
    assert "bus" in made.to_dict()["materials"]
    scaled = umov.Satellite({"wing": (1000 * SQUARE * u.mm, HALVES)}, materials="gold")
    assert umov.mesh(scaled).vertices.max() == 1


def test_a_list_of_meshes_has_no_names():
    with pytest.raises(umov.UsageError, match='mesh is a list of meshes.*"bus": box'):
        umov.Satellite([trimesh.creation.box(), trimesh.creation.box()], materials="gold")


def test_arrays_with_groups():
    made = umov.Satellite((SQUARE, HALVES, ["left", "right"]), materials={"left": "gold", "right": "aluminium_anodized"})
    assert _groups(made) == {"left": 1, "right": 1}
    sun, observer = [0, 0, 1.0], [0, 0.1, 1.0]
    light = umov.Engine(made, bands=["nm:550"], method="rays").evaluate(sun, observer)
    halves = [umov.Engine(umov.Satellite((SQUARE, HALVES[k:k + 1]), materials=name), bands=["nm:550"], method="rays").evaluate(sun, observer)
              for k, name in enumerate(("gold", "aluminium_anodized"))]
    np.testing.assert_allclose(light, halves[0] + halves[1], rtol=1e-9)  # light of parts that hide nothing adds up
    with pytest.raises(umov.UsageError, match="groups are 1; a name for each of 2 faces"):
        umov.Satellite((SQUARE, HALVES, ["left"]), materials="gold")
    with pytest.raises(umov.UsageError, match="a group is named ''"):
        umov.Satellite((SQUARE, HALVES, ["left", ""]), materials="gold")


def test_one_mesh_of_trimesh_has_the_name_of_its_material():
    assert _groups(umov.Satellite(_named(trimesh.creation.box(), "mli"), materials={"mli": "gold"})) == {"mli": 12}
    assert _groups(umov.Satellite(_named(trimesh.creation.box(), "mli"), materials="gold")) == {"mli": 12}
    assert _groups(umov.Satellite(trimesh.creation.box(), materials="gold")) == {"default": 12}


def test_colours_without_names_are_told_of():
    box = trimesh.creation.box()
    box.visual.face_colors[:6] = [255, 0, 0, 255]
    with pytest.warns(umov.UmovWarning, match='faces of 2 colours and no names of materials.*"bus": box'):
        umov.Satellite(box, materials="gold")


def test_an_mtl_that_nobody_needs_is_not_missed(tmp_path, recwarn):
    """Materials are those of the call: of an MTL umov takes names alone."""
    (tmp_path / "a.obj").write_text("mtllib gone.mtl\nusemtl foil\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for materials in ("gold", {"foil": "gold"}):
        assert _groups(umov.Satellite(tmp_path / "a.obj", unit="m", up="+Z", materials=materials)) == {"foil": 1}
    assert [str(one.message) for one in recwarn if issubclass(one.category, umov.UmovWarning)] == []
    with pytest.raises(umov.InputError, match='"foil".* no entry'):
        umov.mesh(umov.Satellite(tmp_path / "a.obj", unit="m", up="+Z", materials={}))


def test_glb_of_trimesh_is_turned_only_where_one_says_so(tmp_path):
    """Its specification has +Y up (glTF 2.0, section 3.4); trimesh writes z as z."""
    path = tmp_path / "tall.glb"
    trimesh.creation.box((1, 1, 5)).export(path)
    height = {up: np.ptp(umov.mesh(umov.Satellite(path, up=up, materials="gold")).vertices, axis=0).tolist() for up in (None, "+Z")}
    assert height == {None: [1, 5, 1], "+Z": [1, 1, 5]}
    assert "+Y up" in umov.Satellite.__doc__


@pytest.mark.parametrize("name", ("wing\\", "a\\b", "a\x7fb", "a\x85b", "a\u2028b", "a\u200bb", "#b", "a # b"))
def test_a_group_that_an_obj_cannot_name_is_refused(name):
    """A backslash at the end of a line of an OBJ takes the next line, a triangle, for its own."""
    with pytest.raises(umov.UsageError, match="a group is named"):
        umov.Satellite((SQUARE, HALVES, [name, "other"]), materials="gold")
    with pytest.raises(umov.UsageError, match="a group is named"):
        umov.Satellite({name: (SQUARE, HALVES)}, materials="gold")


@pytest.mark.parametrize("groups", (["a", None], ["a", np.nan], np.ma.array(["a", "b"], mask=[False, True])))
def test_a_group_without_a_name_is_refused(groups):
    with pytest.raises(umov.UsageError, match="gaps"):
        umov.Satellite((SQUARE, HALVES, groups), materials="gold")
    with pytest.raises(umov.UsageError, match="no name"):
        umov.Satellite({None: (SQUARE, HALVES)}, materials="gold")


def _box(units):
    box = trimesh.creation.box((1, 1, 1))
    if units is not None:  # which trimesh would take for a text
        box.units = units
    return box


def test_units_of_parts_are_read():
    for parts in ({"bus": _box("mm"), "wing": _box("mm")}, trimesh.Scene([_box("mm"), _box("mm")])):
        vertices = umov.mesh(umov.Satellite(parts, materials="gold")).vertices
        assert np.ptp(vertices, axis=0) == pytest.approx(1e-3, rel=1e-12)  # a millimetre; doubles
    for other in ("m", None):
        for parts in ({"bus": _box("mm"), "wing": _box(other)}, trimesh.Scene([_box("mm"), _box(other)])):
            with pytest.raises(umov.UsageError, match="parts of the mesh are in .*mm.*one unit"):
                umov.Satellite(parts, materials="gold")
