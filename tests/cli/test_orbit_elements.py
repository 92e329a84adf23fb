"""Files of mean elements: shown, converted, used in a run whatever their form."""
import json

import pytest

from conftest import ROOT, read_csv

HST = ROOT / "data/tle/hst.tle"


def test_show_lists_every_object(umov, tmp_path):
    done = umov("orbit", "show", "--orbit", ROOT / "tests/data/tle/mixed_979_2018-01-20.tle", "-o",
                "all.csv")
    assert done.code == 0, done.err
    rows = read_csv(tmp_path / "all.csv")
    assert len(rows) == 979
    hst = next(row for row in rows if row["norad_cat_id"] == "20580")
    assert float(hst["inclination"]) == 28.4699 or 28.4 < float(hst["inclination"]) < 28.5
    assert 530 < float(hst["perigee_alt"]) < float(hst["apogee_alt"]) < 550
    assert 95 < float(hst["period"]) < 96


@pytest.mark.parametrize("form", ["tle", "kvn", "xml", "json", "csv"])
def test_a_run_takes_every_form(umov, scenario, tmp_path, form):
    assert umov("orbit", "convert", "--orbit", HST, "-o", f"hst.{form}").code == 0
    plain = scenario(name="plain.toml")
    other = scenario((f'"{HST}"', f'"hst.{form}"'), ('dir = "out"', 'dir = "other"'),
                     name="other.toml")
    for name in (plain, other):
        done = umov("run", name, "--quiet")
        assert done.code == 0, done.err
    assert read_csv(tmp_path / "out/lightcurve.csv") == read_csv(tmp_path / "other/lightcurve.csv")


def test_convert_prints_and_comes_back(umov, tmp_path):
    done = umov("orbit", "convert", "--orbit", HST, "--to", "json", "--norad", 20580)
    assert done.code == 0, done.err
    sets = json.loads(done.out)
    assert all(entry["NORAD_CAT_ID"] == 20580 and entry["OBJECT_ID"] == "1990-037B"
               for entry in sets)
    (tmp_path / "hst.json").write_text(done.out)
    again = umov("orbit", "convert", "--orbit", "hst.json", "--to", "tle")
    ours = [line for line in HST.read_text().splitlines() if line[:2] in ("1 ", "2 ")]
    theirs = [line for line in again.out.splitlines() if line[:2] in ("1 ", "2 ")]
    assert theirs == ours


@pytest.mark.parametrize("arguments, words", [
    (("--to", "oem"), ["--to tle, kvn, xml, json or csv"]),
    (("-o", "hst.pdf"), ["hst.pdf"]),
    ((), ["no form to write"]),
    (("--to", "json", "--norad", 1), ["holds no object 1"]),
])
def test_convert_refuses(umov, tmp_path, arguments, words):
    done = umov("orbit", "convert", "--orbit", HST, *arguments)
    assert done.code in (2, 3) and all(word in done.err for word in words), done.err


def test_a_bad_message_is_named_and_may_be_left_out(umov, tmp_path):
    done = umov("orbit", "convert", "--orbit", ROOT / "tests/data/tle/mixed_979_2018-01-20.tle",
                "-o", "all.json")
    assert done.code == 0
    sets = json.loads((tmp_path / "all.json").read_text())
    del sets[7]["BSTAR"]
    (tmp_path / "all.json").write_text(json.dumps(sets))
    done = umov("orbit", "show", "--orbit", "all.json", "-o", "t.csv")
    assert done.code == 3 and "BSTAR is missing" in done.err and sets[7]["OBJECT_NAME"] in done.err
    assert not (tmp_path / "t.csv").exists()
    done = umov("orbit", "show", "--orbit", "all.json", "--keep-going", "-o", "t.csv")
    assert done.code == 0 and "BSTAR is missing" in done.err
    assert len(read_csv(tmp_path / "t.csv")) == 978
