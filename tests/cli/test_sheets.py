"""A two-sided sheet gives one light, however its two faces are written and cut."""
import math

import pytest
from conftest import read_csv

SCENE = """umov = 1
[[object]]
name = "sheet"
mesh = {{ file = "{mesh}.obj", unit = "m", up = "+Z" }}
[object.materials]
{materials}
[material.white]
index = {{ n = 1.0, k = 0.0 }}
distribution = {{ model = "blinn_phong", m = 10 }}
body = {{ reflectance = 0.8 }}
[material.black]
index = {{ n = 1.0, k = 0.0 }}
distribution = {{ model = "blinn_phong", m = 10 }}
body = {{ reflectance = 0.001 }}
[bands]
set = ["nm:550"]
[render]
sun = "point"
"""
POSES = "sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n0,0,1,0.6,0,0.8\n0,0.6,-0.8,0,0,-1\n0.6,0,0.8,0,0,-1\n"
CORNERS = {"quad": "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n",
           "hexagon": "".join(f"v {math.cos(a)} {math.sin(a)} 0\n" for a in (k * math.pi / 3 for k in range(6)))}
AREA = {"quad": 2, "hexagon": 1.5 * math.sqrt(3)}
BACK = {"quad": ["4 3 2 1", "3 2 1 4", "2 1 4 3"], "hexagon": ["6 5 4 3 2 1", "4 3 2 1 6 5"]}


def light(umov, tmp_path, mesh, materials):
    (tmp_path / "s.toml").write_text(SCENE.format(mesh=mesh, materials=materials))
    (tmp_path / "g.csv").write_text(POSES)
    done = umov("signature", "s.toml", "--geometry", "g.csv", "--visibility", "rays", "-o", "o.csv")
    assert done.code == 0, done.err
    return [float(row["intensity"]) for row in read_csv(tmp_path / "o.csv")], done.err


@pytest.mark.parametrize("shape, back", [(s, b) for s, faces in BACK.items() for b in faces])
def test_a_sheet_of_two_polygons_is_one_sheet(umov, tmp_path, shape, back):
    front = " ".join(str(k + 1) for k in range(len(back.split())))
    (tmp_path / "sheet.obj").write_text(f"{CORNERS[shape]}usemtl one\nf {front}\nusemtl two\nf {back}\n")
    done = umov("mesh", "check", "sheet.obj", "--unit", "m", "--up", "+Z", "--json")
    assert done.code == 0 and '"closed": false' in done.out, done.out
    assert f'"opposite_pairs": {len(back.split()) - 2}' in done.out
    # A Lambert sheet: A R/pi times the two cosines (n = 1 reflects nothing at the interface).
    for materials, reflectance in (('default = "white"', (0.8, 0.8)), ('one = "white"\ntwo = "black"', (0.8, 0.001))):
        found, said = light(umov, tmp_path, "sheet", materials)
        one, two = (AREA[shape] * r * 0.8 / math.pi for r in reflectance)
        assert found == pytest.approx([one, two, 0], rel=1e-6, abs=1e-12)
        assert "two-sided" in said


def test_overlaps_that_remain_are_named(umov, tmp_path):
    (tmp_path / "sheet.obj").write_text(CORNERS["quad"] + "v 1 0 0\nv 1 1 0\nv 3 1 0\nv 3 0 0\n"
                                        "usemtl one\nf 1 2 3 4\nusemtl two\nf 5 6 7 8\n")
    done = umov("mesh", "check", "sheet.obj", "--unit", "m", "--up", "+Z")
    _, said = light(umov, tmp_path, "sheet", 'default = "white"')
    for text in (done.err, said):
        assert '"one" and "two" lie upon each other in one plane over 1 m2, facing opposite ways' in text, text
