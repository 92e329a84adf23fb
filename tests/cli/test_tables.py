"""The machine-readable forms that scripts rely on."""
import csv
import json
import math

import pytest

from conftest import ROOT, anchors, read_csv


def test_brdf_batch_gives_the_tables_of_the_physics(umov, tmp_path):
    # w M_F with w of Blinn-Phong m = 10, ashikhmin at (60, 60, 180): 1.87418697; Au 550 at phase 120:
    # A = 0.5 (Rs + Rp). Independent here: Fresnel with Python's complex numbers.
    (tmp_path / "au10.toml").write_text(
        '[material.au10]\nindex = "paper_au"\ndistribution = { model = "blinn_phong", m = 10 }\n')
    (tmp_path / "t.csv").write_text(
        "wavelength_nm,theta_i_deg,theta_o_deg,phi_deg\n550,60,60,180\n550,30,60,90\n")
    done = umov("brdf", "au10.toml", "--batch", "t.csv", "-o", "out.csv")
    assert done.code == 0, done.err
    rows = read_csv(tmp_path / "out.csv")

    def fresnel(n, cosine):
        q = (n * n - 1 + cosine * cosine) ** 0.5
        rs = abs((cosine - q) / (cosine + q)) ** 2
        rp = abs((n * n * cosine - q) / (n * n * cosine + q)) ** 2
        return (rs + rp) / 2, (rs - rp) / 2

    for row, w in zip(rows, (1.87418697, 0.12780082)):
        ti, to, phi = (math.radians(float(row[k])) for k in ("theta_i_deg", "theta_o_deg", "phi_deg"))
        cos_phase = math.cos(ti) * math.cos(to) + math.sin(ti) * math.sin(to) * math.cos(phi)
        a, b = fresnel(0.359 + 2.69j, math.sqrt((1 + cos_phase) / 2))
        assert float(row["m00"]) == pytest.approx(w * a, rel=1e-6)
        assert float(row["m10"]) == pytest.approx(w * b, rel=1e-6)


def test_orbit_propagate_against_the_reference_program(umov, tmp_path):
    done = umov("orbit", "propagate", "--orbit", ROOT / "tests/data/tle/mixed_979_2018-01-20.tle",
                "--at", "2018-01-21T00:00:00Z,2018-01-22T00:00:00Z,2018-01-28T00:00:00Z",
                "-o", "out.csv")
    assert done.code == 0, done.err
    ours = {(int(r["norad_cat_id"]), r["time_utc"][:19]): r for r in read_csv(tmp_path / "out.csv")}
    with open(ROOT / "tests/data/sgp4/mixed_979_teme_expected.csv", newline="") as file:
        expected = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert len(expected) > 2900
    for row in expected:
        mine = ours[int(row["norad"]), row["utc"][:19]]
        assert int(mine["error"]) == int(row["error"])
        if int(row["error"]) == 0:
            for axis in "xyz": # the file has 1e-6 km
                assert float(mine[f"teme_{axis}"]) == pytest.approx(float(row[f"{axis}_km"]), abs=1.5e-6)


def test_signature_rows_can_be_used_again(umov, scenario, tmp_path):
    scene = scenario()
    done = umov("signature", scene, "--poses", 5, "--phase", "60,140", "--seed", 7, "-o", "a.csv")
    assert done.code == 0, done.err
    done = umov("signature", scene, "--geometry", "a.csv", "-o", "b.csv")
    assert done.code == 0, done.err
    first, second = read_csv(tmp_path / "a.csv"), read_csv(tmp_path / "b.csv")
    assert len(first) == 5 * 2 * 3
    for row in first:
        assert float(row["phase_angle"]) == pytest.approx(
            60 if int(row["pose"]) < 5 else 140, abs=1e-9)
        if float(row["intensity"]) == 0:
            assert row["q_scat"] == "" and row["u_scat"] == "" and row["v"] == ""
    lit = {(r["sun_x"], r["obs_x"], r["band"]): r["intensity"] for r in first}
    assert len(second) == len(first) # one pose for its three rows, one per band
    for row in second:
        key = (row["sun_x"], row["obs_x"], row["band"])
        assert float(row["intensity"]) == pytest.approx(float(lit[key]), rel=1e-12)


def test_one_material_gives_q_of_the_paper(umov, scenario, tmp_path):
    done = umov("signature", scenario(), "--poses", 40, "--phase", "140", "-o", "a.csv")
    assert done.code == 0, done.err
    # Fig 18 points at 140 deg for aluminium, six digits.
    expected = {"nm:" + row["nm"]: float(row["q"]) for row in anchors("q_140") if row["material"] == "paper_al"}
    seen = 0
    for row in read_csv(tmp_path / "a.csv"):
        if float(row["intensity"]) > 0:
            seen += 1
            assert float(row["q_scat"]) == pytest.approx(expected[row["band"]], abs=1e-6)
    assert seen > 30


def test_shipped_meshes_are_what_the_command_makes(umov, tmp_path):
    for name, shape in (("hst", ["hst"]), ("agena", ["agena"]),
                        ("box_wing", ["box-wing", "--bus", 2.4, 2.4, 3, "--wing", 8, 2.4])):
        assert umov("mesh", "make", *shape, "-o", f"{name}.obj").code == 0
        made = (tmp_path / f"{name}.obj").read_text().split()
        kept = (ROOT / f"data/mesh/{name}.obj").read_text().split()
        assert len(made) == len(kept)
        for a, b in zip(made, kept):
            if a != b: # another libm may round the last bit of a sine
                assert float(a) == pytest.approx(float(b), rel=1e-12, abs=1e-12)


def test_a_decaying_orbit_ends_the_ephemeris_at_its_first_failure(umov, tmp_path):
    first, second = (ROOT / "data/tle/hst.tle").read_text().splitlines()[-2:]
    first = first[:53] + " 99999+0" + first[61:]
    digits = sum(int(c) if c.isdigit() else c == "-" for c in first[:68])
    (tmp_path / "low.tle").write_text(first[:68] + str(digits % 10) + "\n" + second + "\n")
    done = umov("orbit", "ephemeris", "--orbit", "low.tle", "--lat-deg", 20, "--lon-deg", 0, "--alt-m", 0,
                "--start", "2018-01-20T12:00:00Z", "--stop", "2018-02-10T12:00:00Z", "--step-s", 600,
                "-o", "out.csv")
    assert done.code == 4, done.err
    rows = read_csv(tmp_path / "out.partial.csv")
    assert rows and all(row["time_utc"].startswith("2018-") for row in rows)
    # The message names the epoch right after the last good row.
    failed = done.err.split("SGP4 fails at ")[1][:16]
    assert rows[-1]["time_utc"][:16] < failed
    assert len(rows) < 3025 and "-4713" not in done.err


def test_a_catalogue_of_old_elements_is_refused(umov, tmp_path):
    arguments = ("orbit", "propagate", "--orbit", ROOT / "data/tle/hst.tle")
    done = umov(*arguments, "--at", "2018-04-21T00:00:00Z")
    assert done.code == 3 and "--allow-old-elements" in done.err, done.err
    done = umov(*arguments, "--at", "2018-04-21T00:00:00Z", "--allow-old-elements")
    assert done.code == 0 and "kilometres" in done.err, done.err


def test_mesh_info_as_json_has_the_box(umov):
    done = umov("mesh", "info", ROOT / "data/mesh/hst.obj", "--unit", "m", "--up", "+Z", "--json")
    assert done.code == 0, done.err
    found = json.loads(done.out)
    assert found["triangles"] == sum(m["triangles"] for m in found["materials"])
    assert len(found["lower_m"]) == 3 and found["area_m2"] > 0


def test_doctor_and_schema_answer(umov):
    assert umov("doctor").code == 0
    assert all(line["ok"] for line in json.loads(umov("doctor", "--json").out))
    done = umov("schema")
    assert done.code == 0 and '"$schema"' in done.out
    assert umov("material", "list", "--json").out.count("paper_") >= 6


def test_the_output_file_is_checked_before_any_work(umov, scenario, tmp_path):
    for name, code in (("x.txt", 2), ("none/x.csv", 6)):
        assert umov("signature", "missing.toml", "--poses", 1, "--phase", 30, "-o", name).code == code
        assert umov("orbit", "propagate", "--orbit", "missing.tle", "--at", "2018-01-21T00:00:00Z",
                    "-o", name).code == code
    assert umov("signature", scenario(), "--geometry", "").code == 2


def test_poses_keep_the_numbers_of_their_file(umov, scenario, tmp_path):
    (tmp_path / "g.csv").write_text("pose,sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n"
                                    "7,1,0,0,0,1,0\n9,1,0,0,0,0,1\n7,0,1,0,0,0,1\n")
    done = umov("signature", scenario(), "--geometry", "g.csv", "--set", 'bands.set=["nm:550"]',
                "-o", "o.csv")
    assert done.code == 0, done.err
    assert [row["pose"] for row in read_csv(tmp_path / "o.csv")] == ["7", "9", "7"]
    (tmp_path / "t.csv").write_text("pose,sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\nA,1,0,0,0,1,0\n")
    assert umov("signature", scenario(), "--geometry", "t.csv").code == 0


def test_a_stop_without_rows_writes_no_table(umov, tmp_path):
    first, second = (ROOT / "data/tle/hst.tle").read_text().splitlines()[-2:]
    first = first[:53] + " 99999+0" + first[61:]
    digits = sum(int(c) if c.isdigit() else c == "-" for c in first[:68])
    (tmp_path / "low.tle").write_text(first[:68] + str(digits % 10) + "\n" + second + "\n")
    done = umov("orbit", "ephemeris", "--orbit", "low.tle", "--lat-deg", 20, "--lon-deg", 0, "--alt-m", 0,
                "--start", "2018-02-09T12:00:00Z", "--stop", "2018-02-10T12:00:00Z", "-o", "out.csv")
    assert done.code == 4 and "finished rows" not in done.err, done.err
    assert not list(tmp_path.glob("out*"))


def test_mesh_check_looks_at_what_is_left(umov, tmp_path):
    (tmp_path / "twice.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\ncall other.obj\n")
    done = umov("mesh", "check", "twice.obj", "--unit", "m", "--up", "+Z", "--require-closed")
    assert done.code == 3 and "not closed" in done.err and "geometry that is not read" in done.err, done.err
