"""Tables and messages of others: what is refused, with place, finding, expectation and remedy."""
import gzip
import json

import pytest

from conftest import ROOT
from test_observe import COUNTS

HEADER = "wavelength_um,n,k\n"
YAML = "DATA:\n  - type: tabulated nk\n    data: |\n"


@pytest.mark.parametrize("name, text, words", [
    ("a.csv", HEADER + "400,1.5,0\n900,1.5,0\n", ["a.csv", "400", "is the table in nm?"]),
    ("a.csv", HEADER + "0.5,1.5,0\n", ["a.csv", "1 row", "two or more", "{ n = 1.5, k = 0 }"]),
    ("a.csv", HEADER, ["a.csv", "0 rows", "two or more"]),
    ("a.csv", HEADER + "0.4,1.5,0\n0.5,1.5,-1\n", ["a.csv:3", "k = -1", "0 or more"]),
    ("a.csv", HEADER + "0.4,0,0\n0.5,1.5,1\n", ["a.csv:2", "n = 0", "positive"]),
    ("a.csv", HEADER + "-0.4,1,0\n0.5,1.5,1\n", ["a.csv:2", "-0.4", "above 0"]),
    ("a.csv", HEADER + "0.4,nan,0\n0.5,1.5,1\n", ["a.csv:2", '"nan"', "n and k"]),
    ("a.csv", HEADER + "0.4,1.5,0\n0.5,many,1\n", ["a.csv:3", '"many"']),
    ("a.csv", HEADER + "0.4,1.5,0\n0.5,1.5\n", ["a.csv:3", "2 numbers in this row, 3 in the first"]),
    ("a.yml", YAML + "        0.5 1.5 0\n", ["a.yml:4", "two or more"]),
    ("a.yml", "DATA:\n  - type: formula 1\n    wavelength_range: 1 0.2\n    coefficients: 0 1 0.1\n",
     ["a.yml:3", "1 to 0.2", "increasing"]),
])
def test_indices(umov, tmp_path, name, text, words):
    (tmp_path / name).write_text(text)
    done = umov("material", "import", name, "-o", "m.toml")
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err
    assert not (tmp_path / "m.toml").exists()


def test_a_cell_of_a_measured_table_that_is_no_number(umov, tmp_path):
    lines = (ROOT / "examples/panel_brdf.csv").read_text().splitlines()
    lines[10] = lines[10].rsplit(",", 1)[0] + ",nan"
    (tmp_path / "p.csv").write_text("\n".join(lines) + "\n")
    done = umov("material", "import", "p.csv", "-o", "p.toml")
    assert done.code == 3 and "p.csv:11:" in done.err and 'm33 is "nan"' in done.err, done.err
    (tmp_path / "p.csv").write_text("\n".join(line.rsplit(",", 1)[0] for line in lines) + "\n")
    done = umov("material", "import", "p.csv", "-o", "p.toml")
    assert done.code == 3 and 'no column "m33"' in done.err, done.err


def test_angles_of_a_table_have_their_line(umov, tmp_path):
    (tmp_path / "g.csv").write_text("wavelength_nm,theta_i_deg,theta_o_deg,phi_deg\n550,10,0,0\n550,100,0,0\n")
    done = umov("brdf", "paper_au", "--batch", "g.csv")
    assert done.code == 3 and "g.csv:3: theta_i 100 deg" in done.err, done.err


@pytest.mark.parametrize("note, words", [
    ("# pol_frame: galactic\n", ['"galactic"', "equatorial"]),
    ("# POLCCONV: COSMO\n", ['"COSMO"', "IAU"]),
])
def test_frames_of_another_kind(umov, scenario, tmp_path, note, words):
    """Signs of u that are not ours would be taken for ours."""
    (tmp_path / "c.csv").write_text(note + COUNTS)
    (tmp_path / "obs.csv").write_text(
        note + ("" if "pol_frame" in note else "# pol_frame: altaz\n") +
        "time_utc,band,I,q,u\n2018-01-21T05:10:00Z,nm:550,1,0.1,0\n")
    for done in (umov("reduce", "c.csv"), umov("invert", "pose", "obs.csv", "--scenario", scenario())):
        assert done.code == 3, done.err
        for word in words:
            assert word in done.err, done.err


def test_rows_out_of_order_are_put_in_order_and_told_of(umov, tmp_path):
    rows = [f"2018-01-21T05:08:{k:02d}Z,{5 + k % 3}\n" for k in range(50)]
    (tmp_path / "a.csv").write_text("time_utc,mag\n" + "".join(rows))
    (tmp_path / "b.csv").write_text("time_utc,mag\n" + "".join(rows[:30] + [rows[31], rows[30]] + rows[32:]))
    right, wrong = umov("period", "a.csv", "--json"), umov("period", "b.csv", "--json")
    assert right.code == wrong.code == 0 and "in order" not in right.err, right.err
    assert "b.csv:33: 1 row lies before the row above in time" in wrong.err, wrong.err
    assert right.out == wrong.out


def test_a_page_and_a_set_of_counts_are_named(umov, tmp_path):
    (tmp_path / "c.csv").write_text(COUNTS)
    done = umov("reduce", "c.csv", "--page", "x.pdf")
    assert done.code == 2 and "--page x.pdf" in done.err and not (tmp_path / "x.pdf").exists(), done.err
    (tmp_path / "c.csv").write_text("\n".join(COUNTS.splitlines()[:3]) + "\n")
    done = umov("reduce", "c.csv")
    assert done.code == 3 and "c.csv: 2 channels" in done.err, done.err


@pytest.mark.parametrize("standards, words", [
    ("name,p_percent,pa_deg\nA,5,2\nA,1,3\n", ["k.csv:3", '"A" stands twice']),
    ("name,p_percent,pa_deg\n,5,2\n", ["k.csv:2", "without a name"]),
    ("name,p_percent,pa_deg\nA,5,2\n", ["c.csv", "no name of the counts (star)", "(A)"]),
])
def test_standards(umov, tmp_path, standards, words):
    head, *rows = COUNTS.splitlines()
    (tmp_path / "c.csv").write_text(head + ",name\n" + "".join(row + ",star\n" for row in rows))
    (tmp_path / "k.csv").write_text(standards)
    done = umov("calibrate", "c.csv", "--standards", "k.csv")
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err


def test_no_text_is_called_so(umov, scenario, tmp_path):
    (tmp_path / "a.gz").write_bytes(gzip.compress((ROOT / "data/tle/hst.tle").read_bytes()))
    (tmp_path / "a.zip").write_bytes(b"PK\x03\x04" + bytes(30))
    (tmp_path / "a.bin").write_bytes(bytes(range(256)))
    (tmp_path / "a.txt").write_text("time_utc,mag\n", encoding="utf-16")
    told = {"a.gz": "gunzip", "a.zip": "ZIP", "a.bin": "byte 1 is 0", "a.txt": "UTF-8"}
    for name, word in told.items():
        for call in (["orbit", "show", "--orbit", name], ["period", name], ["reduce", name],
                     ["signature", scenario(), "--geometry", name], ["material", "import", name]):
            done = umov(*call)
            assert done.code == 3 and f"{name}: is " in done.err and word in done.err, (call, done.err)
            assert len(done.err.splitlines()) <= 2, done.err


@pytest.mark.parametrize("text, words", [
    ("hello\n", ["TLE", "OMM"]),
    ("", ["TLE", "OMM"]),
    ("[]", ["one OMM message or more"]),
    ('[{"A":1},{"A":1,"A":2}]', ["message 2: A stands twice"]),
])
def test_what_is_no_orbit(umov, tmp_path, text, words):
    (tmp_path / "o.json").write_text(text)
    done = umov("orbit", "show", "--orbit", "o.json")
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err


def test_numbers_of_an_omm_are_mended_how(umov, tmp_path):
    text = umov("orbit", "convert", "--orbit", ROOT / "data/tle/hst.tle", "--to", "json").out
    for value, word in (("nan", "Correct it"), ("", "Add it")):
        entry = json.loads(text)
        entry[0]["ECCENTRICITY"] = value
        (tmp_path / "o.json").write_text(json.dumps(entry))
        done = umov("orbit", "show", "--orbit", "o.json")
        assert done.code == 3 and word in done.err and "message 1 (HST)" in done.err, done.err


def test_what_is_no_job(umov, scenario, tmp_path):
    for verb in ("run", "status", "verify"):
        done = umov("scale", verb, "nojob")
        assert done.code == 3 and "nojob: holds no job" in done.err and "begin one" in done.err, done.err
    call = ["signature", scenario(), "--poses", "10", "--phase", "60"]
    done = umov("scale", "run", "d", "--part", "3/2", *call)
    assert done.code == 2 and "--part 3/2" in done.err and not (tmp_path / "d").exists(), done.err


def test_a_failure_of_a_shard_gives_a_terminal_no_orders(umov, scenario, tmp_path):
    assert umov("scale", "run", "d", "signature", scenario(), "--poses", "10", "--phase", "60").code == 0
    (tmp_path / "d/failed/00000000.json").write_text(
        json.dumps({"index": 0, "code": 3, "attempts": 1, "message": "\x1b[2Jgone", "host": "a"}))
    done = umov("scale", "status", "d")
    assert done.code == 0 and "\x1b" not in done.out and "?[2Jgone" in done.out, done.out
    (tmp_path / "d/failed/00000000.json").write_text('{"index": 1e300, "code": -1e300}')
    assert "failed" not in umov("scale", "status", "d").out
