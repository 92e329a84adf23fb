"""Light between the parts of an object."""
from conftest import read_csv


def test_a_convex_mesh_is_the_same_and_a_box_wing_brighter(umov, scenario, tmp_path):
    deep = ("[output]", "[render]\nbounces = 3\naccuracy = 0.02\n[output]")
    plain = ("[output]", "[render]\naccuracy = 0.02\n[output]")
    band = ('set = "paper_rgb"', 'set = ["nm:550"]')
    for name in (scenario(plain, band, name="a.toml"), scenario(deep, band, ('dir = "out"', 'dir = "deep"'), name="b.toml")):
        done = umov("run", name, "--quiet")
        assert done.code == 0, done.err
    a, b = read_csv(tmp_path / "out/lightcurve.csv"), read_csv(tmp_path / "deep/lightcurve.csv")
    for one, two in zip(a, b):  # the cube is convex
        assert one["I"] == two["I"] and float(two["indirect_i"]) == 0 and "indirect_i" not in one
    assert umov("mesh", "make", "box-wing", "--facets", 1000, "-o", "cube.obj").code == 0
    for name in ("a.toml", "b.toml"):
        done = umov("run", name, "--quiet")
        assert done.code == 0, done.err
    a, b = read_csv(tmp_path / "out/lightcurve.csv"), read_csv(tmp_path / "deep/lightcurve.csv")
    assert len(a) == len(b) > 0
    for one, two in zip(a, b):
        if float(two["intensity"]) == 0:
            continue
        whole, error = float(two["intensity"]), float(two["intensity_err"]) + float(one["intensity_err"])
        share = float(two["indirect_i"])
        assert 0 <= share <= 1
        assert abs(whole * (1 - share) - float(one["intensity"])) <= 3 * error + 1e-9 * whole
        # More than the plane of the first reflection knows.
        assert abs(float(two["v"])) <= share + 1e-9
    assert any(float(row["indirect_i"]) > 1e-3 for row in b)


def test_signature_takes_rays_with_bounces(umov, scenario, tmp_path):
    assert umov("mesh", "make", "box-wing", "--facets", 1000, "-o", "cube.obj").code == 0
    name = scenario(("[output]", "[render]\nbounces = 2\naccuracy = 0.05\n[output]"))
    done = umov("signature", name, "--poses", 4, "--phase", 60, "-o", "s.csv")
    assert done.code == 0, done.err
    assert len(read_csv(tmp_path / "s.csv")) == 12
    done = umov("signature", name, "--poses", 4, "--phase", 60, "--visibility", "masks", "-o", "m.csv")
    assert done.code == 2 and "direct light alone" in done.err
