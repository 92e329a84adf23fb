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
    (("--to", "oem"), ["--start and --stop"]),
    (("--to", "opm"), ["--to tle, kvn, xml, json or csv"]),
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


def test_an_ephemeris_file_serves_as_orbit(umov, scenario, tmp_path):
    """OEM made from elements: the run is that of the elements to the interpolation's error."""
    done = umov("orbit", "convert", "--orbit", HST, "-o", "hst.oem", "--start", "2018-01-21T04:30:00Z",
                "--stop", "2018-01-21T06:30:00Z")
    assert done.code == 0, done.err
    plain = scenario(name="plain.toml")
    other = scenario((f'"{HST}"', '"hst.oem"'), ('dir = "out"', 'dir = "other"'), name="other.toml")
    for name in (plain, other):
        done = umov("run", name, "--quiet")
        assert done.code == 0, done.err
    a, b = (read_csv(tmp_path / folder / "lightcurve.csv") for folder in ("out", "other"))
    assert len(a) == len(b) > 0
    for one, two in zip(a, b):
        assert abs(float(one["range"]) - float(two["range"])) < 1e-5
        assert abs(float(one["phase_angle"]) - float(two["phase_angle"])) < 1e-6
        assert two["elset_age"] == ""  # an ephemeris has no age


def test_messages_between_kvn_and_xml(umov, tmp_path):
    for name in ("oem_cov", "opm_user_defined", "tdm"):
        there = umov("orbit", "convert", "--orbit", ROOT / f"tests/data/ccsds/{name}.kvn", "-o",
                     f"{name}.xml")
        back = umov("orbit", "convert", "--orbit", f"{name}.xml", "--to", "kvn")
        again = umov("orbit", "convert", "--orbit", ROOT / f"tests/data/ccsds/{name}.kvn", "--to", "kvn")
        assert there.code == back.code == again.code == 0, there.err + back.err
        assert back.out == again.out
    done = umov("orbit", "show", "--orbit", "tdm.xml", "--json")
    assert json.loads(done.out)[0]["records"] > 100


def test_an_ephemeris_that_ends_keeps_its_rows(umov, tmp_path):
    done = umov("orbit", "ephemeris", "--orbit", ROOT / "tests/data/ccsds/oem.kvn", "--lat-deg", 0,
                "--lon-deg", 0, "--alt-m", 0, "--start", "2008-09-20T14:20:00Z", "--stop",
                "2008-09-20T15:00:00Z", "-o", "e.csv")
    assert done.code == 4 and "does not cover 2008-09-20T14:26:00.000Z" in done.err, done.err
    assert len(read_csv(tmp_path / "e.partial.csv")) == 6
