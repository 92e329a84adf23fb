"""Meshes in every format, written by another program (trimesh), against the same mesh as OBJ; damaged files."""
import base64
import json
import os
import random
import resource
import struct
import subprocess

import numpy as np
import pytest
import trimesh
from conftest import UMOV, read_csv

SHAPES = {"hst": (), "agena": (), "box-wing": ("--facets", 1000)}
FRAME = ("--unit", "m", "--up", "+Z")


def read_obj(path):
    """Corners of the triangles of an OBJ of ours and their normals, per material, as numbers of 32 bits:
    the other formats hold no more, and a ray that grazes an edge may pass on one side or the other."""
    points, normals, groups = [], [], {}
    for line in path.read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            points.append([float(word) for word in words[1:]])
        elif words[0] == "vn":
            normals.append([float(word) for word in words[1:]])
        elif words[0] == "usemtl":
            corners = groups.setdefault(words[1], [])
        elif words[0] == "f":
            corners += [[int(number) - 1 for number in word.split("//")] for word in words[1:]]
    points, normals = (np.array(numbers, np.float32).astype(float) for numbers in (points, normals))
    return {name: (points[[c[0] for c in corners]], normals[[c[-1] for c in corners]])
            for name, corners in groups.items()}


def write_obj(groups, path, has_materials):
    """The corners as they are, as OBJ."""
    lines, count = [], 0
    for name, (points, normals) in groups.items():
        if has_materials:
            lines.append(f"usemtl {name}")
        for key, numbers in (("v", points), ("vn", normals)):
            lines += [f"{key} {x!r} {y!r} {z!r}" for x, y, z in numbers.tolist()]
        lines += ["f " + " ".join(f"{i}//{i}" for i in range(k, k + 3))
                  for k in range(count + 1, count + len(points), 3)]
        count += len(points)
    path.write_text("\n".join(lines) + "\n")


def as_trimesh(points, normals, material=None):
    """Every corner a vertex of its own, as at seams."""
    visual = None
    if material:
        visual = trimesh.visual.TextureVisuals(material=trimesh.visual.material.PBRMaterial(name=material))
    return trimesh.Trimesh(points, np.arange(len(points)).reshape(-1, 3), vertex_normals=normals,
                           visual=visual, process=False)


def as_scene(groups):
    """One node for each material, +Z up as the OBJ has it."""
    scene = trimesh.Scene()
    for name, (points, normals) in groups.items():
        scene.add_geometry(as_trimesh(points, normals, name), node_name="node_" + name, geom_name="mesh_" + name)
    return scene


def write_with_trimesh(groups, kind, path):
    """`kind`: what the tests call the form; GLB and glTF keep materials, the others do not."""
    if kind in ("glb", "gltf"):
        scene = as_scene(groups)
        if kind == "glb":
            path.write_bytes(trimesh.exchange.gltf.export_glb(scene, include_normals=True))
        else:
            for name, data in trimesh.exchange.gltf.export_gltf(scene, include_normals=True).items():
                (path if name.endswith(".gltf") else path.parent / name).write_bytes(data)
        return
    whole = as_trimesh(*(np.concatenate(parts) for parts in zip(*groups.values())))
    data = {"stl": lambda: trimesh.exchange.stl.export_stl(whole),
            "stl_text": lambda: trimesh.exchange.stl.export_stl_ascii(whole),
            "ply": lambda: trimesh.exchange.ply.export_ply(whole, vertex_normal=True),
            "ply_text": lambda: trimesh.exchange.ply.export_ply(whole, encoding="ascii", vertex_normal=True),
            "off": lambda: trimesh.exchange.off.export_off(whole)}[kind]()
    path.write_bytes(data if isinstance(data, bytes) else data.encode())


def suffix(kind):
    return kind.split("_")[0]


SCENE = """umov = 1
[[object]]
mesh = {{ file = "{file}"{frame}, normals = "{normals}" }}
[object.materials]
{materials}
[bands]
set = ["nm:550"]
"""
MATERIALS = 'array_front = "paper_asi"\nforward_shell = "paper_mylar"\nlight_shield = "paper_au"\nbaffle = "paper_au"\ndefault = "paper_al"'


def signature(umov, tmp_path, file, normals="flat", materials='default = "paper_al"', frame=True, more=""):
    (tmp_path / "scene.toml").write_text(SCENE.format(
        file=file, normals=normals, materials=materials,
        frame=', unit = "m", up = "+Z"' if frame else "") + more)
    done = umov("signature", "scene.toml", "--poses", 6, "--phase", "40,100", "--visibility", "rays", "-o", "s.csv")
    assert done.code == 0, done.err
    return [[float(row[name]) for name in ("intensity", "stokes_q", "stokes_u", "stokes_v")]
            for row in read_csv(tmp_path / "s.csv")]


def largest_difference(rows, wanted):
    """Relative to the largest intensity of the pose, or a tenth of the brightest one."""
    scale = max(row[0] for row in wanted)
    return max(abs(a - b) / max(w[0], 0.1 * scale) for r, w in zip(rows, wanted) for a, b in zip(r, w))


@pytest.mark.parametrize("kind", ["glb", "gltf", "stl", "stl_text", "ply", "ply_text", "off"])
@pytest.mark.parametrize("shape", SHAPES)
def test_same_light_as_obj(umov, tmp_path, shape, kind):
    assert umov("mesh", "make", shape, *SHAPES[shape], "-o", "a.obj").code == 0
    name = f"b.{suffix(kind)}"
    groups = read_obj(tmp_path / "a.obj")
    has_materials = kind in ("glb", "gltf")
    write_obj(groups, tmp_path / "rounded.obj", has_materials)
    write_with_trimesh(groups, kind, tmp_path / name)
    # Only HST's groups are mapped by name; `default` takes the rest.
    keys = MATERIALS if has_materials and shape == "hst" else 'default = "paper_al"'
    for normals in ("flat", "smooth") if suffix(kind) not in ("stl", "off") else ("flat",):
        found = signature(umov, tmp_path, name, normals, keys)
        wanted = signature(umov, tmp_path, "rounded.obj", normals, keys)
        print(shape, kind, normals, largest_difference(found, wanted))
        assert largest_difference(found, wanted) < 1e-6
        # The rounding itself: below the accuracy that is asked of a signature by default.
        assert largest_difference(found, signature(umov, tmp_path, "a.obj", normals, keys)) < 5e-3


# ---- damaged files

def damaged(data, rng):
    """One of the usual accidents: cut off, bytes changed, a piece doubled, lost or zeroed."""
    data = bytearray(data)
    kind = rng.choice(["cut", "flip", "flip", "flip", "double", "lose", "zero"])
    begin = rng.randrange(len(data))
    end = min(len(data), begin + rng.choice([1, 4, 50, 400]))
    if kind == "cut":
        return bytes(data[:begin])
    if kind == "flip":  # half of them in the header, where they hurt most
        for _ in range(rng.choice([1, 3, 20])):
            where = rng.randrange(min(len(data), 600)) if rng.random() < 0.5 else rng.randrange(len(data))
            data[where] = rng.choice([0, 255, 127, rng.randrange(256)])
        return bytes(data)
    if kind == "double":
        return bytes(data[:end] + data[begin:])
    if kind == "lose":
        return bytes(data[:begin] + data[end:])
    data[begin:end] = bytes(end - begin)
    return bytes(data)


def one_file(groups, kind, folder):
    """A good file with all in one place."""
    path = folder / f"good.{suffix(kind)}"
    if kind == "gltf":
        write_with_trimesh(groups, "glb", path)
        data = path.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        document = json.loads(data[20:20 + length])
        document["buffers"][0]["uri"] = ("data:application/octet-stream;base64," +
                                         base64.b64encode(data[28 + length:]).decode())
        path.write_text(json.dumps(document))
    elif kind == "obj":
        write_obj(groups, path, True)
    elif kind == "dae":
        path.write_text(collada(*next(iter(groups.values()))))
    elif kind == "3ds":
        path.write_bytes(three_ds(*next(iter(groups.values()))))
    else:
        write_with_trimesh(groups, kind, path)
    return path.read_bytes()


def collada(points, _, unit="1", up="Y_UP"):
    """A COLLADA file with one material, written after its specification (1.4.1)."""
    numbers = " ".join(repr(float(x)) for x in points.ravel())
    indices = " ".join(map(str, range(len(points))))
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="some" meter="{unit}"/><up_axis>{up}</up_axis></asset>
<library_materials><material id="m" name="foil"><instance_effect url="#e"/></material></library_materials>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert/></technique></profile_COMMON></effect>
</library_effects>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="{points.size}">{numbers}</float_array><technique_common>
<accessor source="#pa" count="{len(points)}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(points) // 3}" material="s"><input semantic="VERTEX" source="#v" offset="0"/>
<p>{indices}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="bus" name="bus"><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="s" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


def three_ds(points, _):
    """A 3DS file: chunks of an identifier, a length and what is in it."""
    def chunk(which, data):
        return struct.pack("<HI", which, 6 + len(data)) + data

    count = len(points)
    faces = b"".join(struct.pack("<4H", k, k + 1, k + 2, 7) for k in range(0, count, 3))
    mesh = chunk(0x4100, chunk(0x4110, struct.pack("<H", count) + points.astype("<f4").tobytes()) +
                 chunk(0x4120, struct.pack("<H", count // 3) + faces))
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)) +
                 chunk(0x3D3D, chunk(0x4000, b"bus\0" + mesh)))


DAMAGED = int(os.environ.get("UMOV_DAMAGED_MESHES", "60"))


@pytest.mark.parametrize("kind", ["glb", "gltf", "stl", "stl_text", "ply", "ply_text", "off", "dae", "3ds", "obj"])
def test_damaged_files_get_a_message(umov, tmp_path, kind):
    assert umov("mesh", "make", "box-wing", "--facets", 100, "-o", "a.obj").code == 0
    good = one_file(read_obj(tmp_path / "a.obj"), kind, tmp_path)
    name = f"damaged.{suffix(kind)}"
    frame = () if kind in ("glb", "gltf", "dae") else FRAME
    done = umov("mesh", "check", f"good.{suffix(kind)}", *frame)
    assert done.code == 0, done.err
    rng = random.Random(f"damaged {kind}")
    refused = 0
    for number in range(DAMAGED):
        (tmp_path / name).write_bytes(damaged(good, rng))
        done = subprocess.run([UMOV, "mesh", "check", name, *frame], cwd=tmp_path, capture_output=True, timeout=20)
        text = done.stderr.decode(errors="replace")
        # What is still a mesh may be read; whatever is refused is refused by name.
        assert done.returncode in (0, 3), (number, done.returncode, text)
        if done.returncode == 3:
            refused += 1
            last = text.strip().splitlines()[-1]
            assert last.startswith(f"error: {name}") and len(last) > 40, (number, text)
    print(f"{kind}: {refused} of {DAMAGED} refused")
    assert refused > DAMAGED // 8


@pytest.mark.parametrize("name, data", [
    ("a.stl", b" " * 80 + b"\xff\xff\xff\xff"),
    ("a.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nproperty double x\n"
              b"property double y\nproperty double z\nend_header\n"),
    ("a.ply", b"ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices\n"
              b"end_header\n\xff\xff\xff\xff"),
    ("a.gltf", b'{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":'
               b'{"POSITION":0}}]}],"accessors":[{"componentType":5126,"count":4294967295,"type":"VEC3"}]}'),
    ("a.glb", b"glTF\2\0\0\0\xff\xff\xff\xff\xff\xff\xff\x7fJSON"),
    ("a.off", b"OFF\n2000000000 2000000000 0\n"),
])
def test_counts_are_not_believed(umov, tmp_path, name, data):
    (tmp_path / name).write_bytes(data)
    # With 256 MiB of data to be had, room for what the header claims would end in exit 6.
    child = subprocess.run([UMOV, "mesh", "info", name, *FRAME], cwd=tmp_path, capture_output=True,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (2**28, 2**28)))
    text = child.stderr.decode()
    assert child.returncode == 3 and name in text, text


# ---- units, axes, trees

@pytest.mark.parametrize("kind", ["stl", "ply", "off"])
def test_unit_and_axis_are_asked_for(umov, tmp_path, kind):
    assert umov("mesh", "make", "chamfered-cube", "-o", "a.obj").code == 0
    write_with_trimesh(read_obj(tmp_path / "a.obj"), kind, tmp_path / f"a.{kind}")
    for frame, missing in (((), "no unit."), (("--unit", "m"), "no up axis.")):
        done = umov("mesh", "info", f"a.{kind}", *frame)
        assert done.code == 3, done.err
        for words in (f"error: a.{kind}: {missing} The bounding box is 1 x 1 x 1", "Give --unit m", "--up +Z"):
            assert words in done.err, done.err


def test_gltf_says_unit_and_axis_itself(umov, tmp_path):
    """What has +Y up in a file without unit and axis is +Z up in the body; a scenario may leave both out too."""
    assert umov("mesh", "make", "agena", "-o", "a.obj").code == 0
    groups = read_obj(tmp_path / "a.obj")
    write_obj(groups, tmp_path / "rounded.obj", True)
    write_with_trimesh({name: (np.stack([p[:, 0], p[:, 2], -p[:, 1]], 1), np.stack([n[:, 0], n[:, 2], -n[:, 1]], 1))
                        for name, (p, n) in groups.items()}, "glb", tmp_path / "a.glb")
    found = signature(umov, tmp_path, "a.glb", frame=False)
    assert largest_difference(found, signature(umov, tmp_path, "rounded.obj")) < 1e-6
    # Given ones win: millimetres, and +Z up as it stands.
    info = json.loads(umov("mesh", "info", "a.glb", "--unit", "mm", "--up", "+Z", "--json").out)
    own = json.loads(umov("mesh", "info", "a.glb", "--json").out)
    assert own["format"] == "glTF" and own["closed"] and {one["path"] for one in own["nodes"]} == {
        "node_" + name for name in groups}
    assert info["upper_m"][1] == pytest.approx(own["upper_m"][2] / 1000)


@pytest.mark.parametrize("verb", ["info", "check"])
def test_what_a_mesh_holds_goes_to_a_file(umov, tmp_path, verb):
    assert umov("mesh", "make", "agena", "-o", "a.obj").code == 0
    for name in ("m.json", "m.csv"):
        done = umov("mesh", verb, "a.obj", *FRAME, "-o", name)
        assert done.code == 0 and not done.out, done.err
    whole = json.loads((tmp_path / "m.json").read_text())
    assert whole == json.loads(umov("mesh", verb, "a.obj", *FRAME, "--json").out)
    assert {row["material"]: int(row["triangles"]) for row in read_csv(tmp_path / "m.csv")} == {
        one["name"]: one["triangles"] for one in whole["materials"]}
    assert umov("mesh", verb, "a.obj", *FRAME, "-o", "a.obj").code == 2
    assert umov("mesh", verb, "a.obj", *FRAME, "-o", "m.txt").code == 2


@pytest.mark.parametrize("scale, told", [([0, 0, 0], "all corners are one point"), ([0, 0, 1], "lie on a line")])
def test_a_mesh_without_area_is_told(umov, tmp_path, scale, told):
    """The scale of a node is the file's: no other unit gives it an area."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]], np.float32).tobytes()
    (tmp_path / "z.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "scale": scale}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": len(corners)}],
        "buffers": [{"byteLength": len(corners), "uri": "data:application/octet-stream;base64," + base64.b64encode(corners).decode()}]}))
    done = umov("mesh", "info", "z.gltf")
    assert done.code == 0 and "the mesh has no area" in done.err and told in done.err, done.err
    assert "it is 0 m" not in done.err


def turned(points, angle, axis=2):
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(3)
    turn[np.ix_([a for a in range(3) if a != axis], [a for a in range(3) if a != axis])] = [[c, -s], [s, c]]
    return points @ turn.T


def craft(folder):
    """A bus and two wings that share mesh and material, hung into a tree by turned, moved and mirrored nodes;
    the same triangles as OBJ with a material for each."""
    box = trimesh.creation.box((2, 2, 2))
    panel = trimesh.creation.box((3, 0.1, 1.5))
    for mesh, name in ((box, "bus"), (panel, "cells")):
        mesh.visual = trimesh.visual.TextureVisuals(material=trimesh.visual.material.PBRMaterial(name=name))
    right, left = np.eye(4), np.diag([-1.0, 1, 1, 1])
    right[:3, :3] = turned(np.eye(3), 0.3)
    right[:3, 3] = left[:3, 3] = 3, 0, 0.5
    left[0, 3] = -3
    scene = trimesh.Scene()
    scene.add_geometry(box, node_name="bus", geom_name="box")
    scene.add_geometry(panel, node_name="wing_right", geom_name="panel", parent_node_name="bus", transform=right)
    scene.add_geometry(panel, node_name="wing_left", geom_name="panel", parent_node_name="bus", transform=left)
    (folder / "craft.glb").write_bytes(scene.export(file_type="glb"))
    groups = {}
    for name, mesh, place in (("bus", box, np.eye(4)), ("right", panel, right), ("left", panel, left)):
        faces = mesh.faces[:, ::-1] if np.linalg.det(place) < 0 else mesh.faces
        points = mesh.vertices @ place[:3, :3].T + place[:3, 3]
        corners = points[faces.ravel()]
        groups[name] = corners, np.tile([0.0, 0, 1], (len(corners), 1))
    write_obj(groups, folder / "craft.obj", True)


PART = '[[object.part]]\nname = "{0}"\n{1}\naxis = "+X"\npivot_m = [0, 0, 0.5]\ntoward = "sun"\n'


def test_nodes_turn_as_groups_do(umov, scenario, tmp_path):
    craft(tmp_path)
    info = json.loads(umov("mesh", "info", "craft.glb", *FRAME, "--json").out)
    assert [one["name"] for one in info["materials"]] == ["bus", "cells"]
    assert info["closed"] and info["inward_parts"] == 0 and info["inconsistent_edges"] == 0
    assert info["volume_m3"] == pytest.approx(8 + 2 * 0.45, rel=1e-6)
    assert {one["path"]: one["origin_m"] for one in info["nodes"]}["bus/wing_left"] == [-3, 0, 0.5]
    curves = []
    for file, keys in (("craft.obj", ['groups = ["left"]', 'groups = ["right"]']),
                       ("craft.glb", ['nodes = ["wing_left"]', 'nodes = ["bus/wing_right"]'])):
        parts = "".join(PART.format(name, key) for name, key in zip("ab", keys))
        name = scenario(("cube.obj", file), ("[bands]", parts + "[bands]"), ("step_s = 20", "step_s = 60"))
        done = umov("run", name, "--force")
        assert done.code == 0, done.err
        curves.append([float(row["intensity"]) for row in read_csv(tmp_path / "out/lightcurve.csv")])
        done = umov("run", "out/scenario.lock.toml", "--force", "--set", "output.dir=again")
        assert done.code == 0, done.err
        assert (tmp_path / "again/lightcurve.csv").read_text().splitlines()[-1] == (
            tmp_path / "out/lightcurve.csv").read_text().splitlines()[-1]
    assert len(curves[0]) > 3 and curves[1] == pytest.approx(curves[0], rel=5e-3)
    for nodes, words in (("wing", 'no node "wing" with faces; it has bus, bus/wing_left'),
                         ("bus", 'part "b"')):
        parts = PART.format("a", f'nodes = ["{nodes}"]') + PART.format("b", 'nodes = ["nothing"]')
        done = umov("run", scenario(("cube.obj", "craft.glb"), ("[bands]", parts + "[bands]")), "--force")
        assert done.code == 3 and words in done.err, done.err
    done = umov("run", scenario(("[bands]", PART.format("a", 'nodes = ["cube"]') + "[bands]")), "--force")
    assert done.code == 3 and "has no tree of nodes" in done.err, done.err


def test_gltf_materials_are_mapped_by_name(umov, tmp_path):
    craft(tmp_path)
    (tmp_path / "scene.toml").write_text(SCENE.format(file="craft.glb", normals="flat", frame="",
                                                      materials='bus = "paper_al"\ncels = "paper_asi"'))
    done = umov("signature", "scene.toml", "--poses", 1, "--phase", "40")
    assert done.code == 3 and 'Did you mean "cells"? It has bus, cells.' in done.err, done.err
    (tmp_path / "scene.toml").write_text(SCENE.format(file="craft.glb", normals="flat", frame="",
                                                      materials='bus = "paper_al"'))
    done = umov("signature", "scene.toml", "--poses", 1, "--phase", "40")
    # Message 4 of the catalogue: faces and area of both wings together.
    assert done.code == 3 and 'material "cells" (24 faces, 19.8 m2) has no entry' in done.err, done.err


def test_buffers_beside_the_file_are_inputs(umov, tmp_path):
    assert umov("mesh", "make", "chamfered-cube", "-o", "a.obj").code == 0
    write_with_trimesh(read_obj(tmp_path / "a.obj"), "gltf", tmp_path / "a.gltf")
    document = json.loads((tmp_path / "a.gltf").read_text())
    first = document["buffers"][0]["uri"]
    (tmp_path / first).rename(tmp_path / "my buffer.bin")
    document["buffers"][0]["uri"] = "my%20buffer.bin"
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    assert umov("mesh", "info", "a.gltf").code == 0
    (tmp_path / "my buffer.bin").unlink()
    done = umov("mesh", "info", "a.gltf")
    assert done.code == 3 and "my buffer.bin" in done.err and "GLB" in done.err, done.err


@pytest.mark.parametrize("unit, up, longest", [("1", "Y_UP", 1), ("0.01", "Z_UP", 2), ("0.0254", "X_UP", 0)])
def test_collada_says_unit_and_axis_itself(umov, tmp_path, unit, up, longest):
    """A box of 1 x 2 x 3 in the axes of the file: its up axis becomes +Z of the body."""
    box = trimesh.creation.box((1, 2, 3))
    corners = box.vertices[box.faces.ravel()]
    (tmp_path / "a.dae").write_text(collada(corners, None, unit, up))
    info = json.loads(umov("mesh", "info", "a.dae", "--json").out)
    assert info["materials"][0]["name"] == "foil" and info["closed"] and info["volume_m3"] > 0
    size = np.subtract(info["upper_m"], info["lower_m"]) / float(unit)
    assert size[2] == pytest.approx([1, 2, 3]["XYZ".index(up[0])], rel=1e-6)
    assert sorted(size) == pytest.approx([1, 2, 3], rel=1e-6)
    # Both given: the numbers as they stand.
    info = json.loads(umov("mesh", "info", "a.dae", *FRAME, "--json").out)
    assert np.subtract(info["upper_m"], info["lower_m"]) == pytest.approx([1, 2, 3], rel=1e-6)
    done = umov("mesh", "info", "a.dae", "--unit", "m")
    assert done.code == 3 and "give both" in done.err, done.err


def test_3ds_has_the_axes_of_its_numbers(umov, tmp_path):
    box = trimesh.creation.box((1, 2, 3))
    (tmp_path / "a.3ds").write_bytes(three_ds(box.vertices[box.faces.ravel()], None))
    info = json.loads(umov("mesh", "info", "a.3ds", *FRAME, "--json").out)
    assert np.subtract(info["upper_m"], info["lower_m"]) == pytest.approx([1, 2, 3], rel=1e-6)
    assert info["closed"] and info["volume_m3"] == pytest.approx(6, rel=1e-6)


# ---- umov mesh convert

@pytest.mark.parametrize("kind", ["glb", "gltf", "stl", "ply"])
def test_convert_there_and_back(umov, tmp_path, kind):
    assert umov("mesh", "make", "hst", "-o", "a.obj").code == 0
    done = umov("mesh", "convert", "a.obj", *FRAME, "-o", f"b.{kind}")
    has_materials = kind in ("glb", "gltf")
    assert done.code == 0 and ("holds no materials" in done.err) != has_materials, done.err
    # Another program finds the same body in it.
    other = trimesh.load(tmp_path / f"b.{kind}", force="mesh")
    wanted = json.loads(umov("mesh", "info", "a.obj", *FRAME, "--json").out)
    assert len(other.faces) == wanted["triangles"] and other.volume == pytest.approx(wanted["volume_m3"], rel=1e-5)
    assert other.bounds[1][1 if has_materials else 2] == pytest.approx(wanted["upper_m"][2], rel=1e-6)
    frame = () if has_materials else FRAME
    assert umov("mesh", "convert", f"b.{kind}", *frame, "-o", "c.obj").code == 0
    again = json.loads(umov("mesh", "info", "c.obj", *FRAME, "--json").out)
    assert again["volume_m3"] == pytest.approx(wanted["volume_m3"], rel=1e-6)
    if has_materials:
        assert [one["name"] for one in again["materials"]] == [one["name"] for one in wanted["materials"]]


def test_convert_says_what_it_writes(umov, tmp_path):
    assert umov("mesh", "make", "plate", "-o", "a.obj").code == 0
    done = umov("mesh", "convert", "a.obj", *FRAME, "-o", "a.fbx")
    assert done.code == 2 and ".obj, .glb, .gltf, .stl or .ply was expected" in done.err, done.err
    done = umov("mesh", "convert", "a.obj", "-o", "b.obj")
    assert done.code == 3 and "no unit" in done.err and not (tmp_path / "b.obj").exists()
    done = umov("mesh", "convert", "none.stl", *FRAME, "-o", "b.obj")
    assert done.code == 3 and "no such file" in done.err
