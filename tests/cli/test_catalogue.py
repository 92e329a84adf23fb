"""Input that is wrong in the ways that files of others are, as far as no other test has it: one row a case. What is told names the file
and the place, what was found and what was expected; nothing is written, and a hostile file costs neither time nor memory."""
import gzip
import json
import math
import os
import re
import resource
import struct
import subprocess

import pytest

from conftest import ROOT, SCENARIO, UMOV
from test_observe import COUNTS

HST = ROOT / "data/tle/hst.tle"
AT = ("--at", "2018-01-21T00:00:00Z", "-o", "out.csv")


@pytest.fixture
def refused(umov, tmp_path):
    """refused(files, call, words): files by name, one error with all words, and nothing new in the folder."""

    def look(files, call, words, code=3):
        for name, content in files.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        before = sorted(tmp_path.rglob("*"))
        done = umov(*call, timeout=120)  # of a machine that others load
        assert done.code == code, (done.out, done.err)
        assert done.err.count("error:") == 1, done.err
        for word in words:
            assert word in done.err, f"{word!r} not in: {done.err}"
        assert sorted(tmp_path.rglob("*")) == before
        return done

    return look


@pytest.fixture(scope="module")
def forms():
    """Hubble's elements in the four forms of an OMM."""
    return {form: subprocess.run([UMOV, "orbit", "convert", "--orbit", HST, "--to", form], capture_output=True, text=True, check=True).stdout
            for form in ("kvn", "xml", "json", "csv")}


FIELDS = ["OBJECT_NAME", "OBJECT_ID", "EPOCH", "MEAN_MOTION", "ECCENTRICITY", "INCLINATION", "RA_OF_ASC_NODE", "ARG_OF_PERICENTER",
          "MEAN_ANOMALY", "BSTAR", "MEAN_MOTION_DOT", "MEAN_MOTION_DDOT"]


def without(text, form, key):
    """The message without a field."""
    if form == "kvn":
        return re.sub(rf"(?m)^{key} =.*\n", "", text)
    if form == "xml":
        return re.sub(rf"<{key}[ >].*\n", "", text)
    if form == "json":
        return json.dumps([{name: value for name, value in json.loads(text)[0].items() if name != key}])
    head, row = text.splitlines()[-2:]
    at = head.split(",").index(key)
    return "".join(",".join(cell for k, cell in enumerate(line.split(",")) if k != at) + "\n" for line in (head, row))


@pytest.mark.parametrize("form", ["kvn", "xml", "json", "csv"])
@pytest.mark.parametrize("key", FIELDS)
def test_a_field_that_every_omm_has(refused, forms, form, key):
    text = without(forms[form], form, key)
    assert text != forms[form]
    refused({"o.txt": text}, ["orbit", "propagate", "--orbit", "o.txt", *AT], ["o.txt", "message 1", f"{key} is missing, expected"])


@pytest.mark.parametrize("form", ["json", "csv"])
@pytest.mark.parametrize("key, value, wanted", [
    ("MEAN_ELEMENT_THEORY", "DSST", "SGP4"), ("TIME_SYSTEM", "TAI", "UTC"), ("REF_FRAME", "EME2000", "TEME"), ("CENTER_NAME", "MARS", "EARTH")])
def test_what_sgp4_takes_for_granted(refused, forms, form, key, value, wanted):
    """JSON and CSV may leave these out; what they say must be so."""
    was = json.loads(forms["json"])[0][key]
    refused({"o.txt": forms[form].replace(was, value)}, ["orbit", "propagate", "--orbit", "o.txt", *AT],
            ["o.txt", f'{key} is "{value}", expected {wanted}'])


def changed(form, edit):
    return lambda forms: edit(forms[form])


@pytest.mark.parametrize("make, words", [
    (changed("csv", lambda text: text.replace("BSTAR", "BSTAR,BSTAR", 1)), ["o.txt:1: BSTAR stands twice among the keywords"]),
    (changed("json", lambda text: text[:100]), ["o.txt:2:", "is no JSON", "Fetch the sets again"]),
    (changed("xml", lambda text: text[:300]), ["o.txt:12: ", "is no XML", "fetch the file again"]),
    (lambda forms: "[" * 10000, ["o.txt:1: ", "nested deeper", "Fetch the sets again"])])
def test_broken_omm(refused, forms, make, words):
    refused({"o.txt": make(forms)}, ["orbit", "propagate", "--orbit", "o.txt", *AT], words)


def test_a_number_that_no_double_holds_has_its_place(refused, forms):
    text = re.sub('"BSTAR":[^,]*', '"BSTAR":1e400', forms["json"]).replace('"HST"', '"a \\\\\\" 1e400"')
    line, column = next((k, row.index("1e400", row.index("BSTAR")) + 1) for k, row in enumerate(text.splitlines(), 1) if "BSTAR" in row)
    refused({"o.txt": text}, ["orbit", "propagate", "--orbit", "o.txt", *AT],
            [f"o.txt:{line}:{column}: ", "'1e400'", "a finite number was expected", "Correct it"])


def test_columns_of_spreadsheets_without_a_keyword(umov, refused, forms, tmp_path):
    head, row = forms["csv"].splitlines()[-2:]
    for name, end in (("plain.csv", ""), ("ends.csv", ",,")):
        (tmp_path / name).write_text(f"{head}{end}\n{row}{end}\n")
    told = [umov("orbit", "show", "--orbit", name, "--json") for name in ("plain.csv", "ends.csv")]
    assert told[0].code == told[1].code == 0 and told[0].out == told[1].out, told[1].err
    column = len(row.split(",")) + 2
    refused({"o.txt": f"{head},,\n{row},,7\n"}, ["orbit", "propagate", "--orbit", "o.txt", *AT], ["o.txt:2", f'"7" stands below no keyword, in column {column}'])


def gltf(change, binary=None):
    """A square, then a change of its document or of its buffer."""
    data = struct.pack("<12f", 0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                           {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
             "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
             "buffers": [{"byteLength": 60, "uri": "s.bin"}]}
    scene.update(change)
    return {"m.gltf": json.dumps(scene), "s.bin": data}


@pytest.mark.parametrize("change, words", [
    ({"extensionsRequired": ["EXT_meshopt_compression"]}, ["EXT_meshopt_compression", "Export it without"]),
    ({"nodes": [{"children": [k + 1]} for k in range(10000)] + [{"mesh": 0}]}, ["deep in the tree", "was expected"]),
    ({"nodes": [{"mesh": 0, "matrix": [math.nan] + 15 * [0]}]}, ["m.gltf:1:", "is broken"]),
    ({"buffers": [{"byteLength": 60, "uri": "http://a/b"}]}, ["http://a/b", "leaves the folder"]),
    ({"buffers": [{"byteLength": 1 << 30, "uri": "s.bin"}]}, ["1073741824", "at most 60"])])
def test_scenes_of_others(refused, change, words):
    refused(gltf(change), ["mesh", "info", "m.gltf"], ["m.gltf", *words])


MESH = ("--unit", "m", "--up", "+Z")


@pytest.mark.parametrize("name, content, words", [
    ("a.stl.gz", gzip.compress(b"solid a\nendsolid a\n", mtime=0), ["a.stl.gz", "gunzip"]),
    ("a.obj.zip", b"PK\x03\x04" + bytes(30), ["a.obj.zip", "ZIP"]),
    ("a.stl", bytes(80) + struct.pack("<I12fH", 1, 0, 0, 1, math.nan, 0, 0, 1, 0, 0, 0, 1, 0, 0), ["a.stl", "triangle 1 of 1", "finite"]),
    ("a.ply", "ply\nformat ascii 1.0\nelement vertex -3\nproperty float x\n", ["a.ply:3: ", '"-3"', "a count"])])
def test_meshes_of_others(refused, name, content, words):
    refused({name: content}, ["mesh", "info", name, *MESH], words)


@pytest.mark.parametrize("name, call, limit", [
    ("big.gltf", ["mesh", "info", "big.gltf"], "256 MiB"), ("big.tle", ["orbit", "show", "--orbit", "big.tle"], "256 MiB"),
    ("big.toml", ["run", "big.toml"], "16 MiB")])
def test_large_files_are_refused_before_they_fill_the_memory(tmp_path, name, call, limit):
    """Five gigabytes that take no room on the disk, in one of address space; what a program needs in any case has its place in it."""
    with open(tmp_path / name, "wb") as file:
        file.truncate(5 << 30)
    done = subprocess.run([UMOV, *call], cwd=tmp_path, capture_output=True, text=True, timeout=60,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30)))
    assert done.returncode == 3 and f"{name}: larger than the limit of {limit}" in done.stderr and "split it" in done.stderr, done.stderr


def test_a_micrometre_in_latin_1(umov, tmp_path):
    (tmp_path / "a.csv").write_bytes(b"wavelength (\xb5m),n,k\n0.4,1.5,0\n0.7,1.6,0\n")
    done = umov("material", "index", "a.csv", "--wavelength", "550", "--json")
    assert done.code == 0 and json.loads(done.out)[0]["n"] == pytest.approx(1.55, abs=1e-12), done.out  # half way


@pytest.mark.parametrize("text, words", [
    ("wavelength_um,n,k\n400,1.5,0\n700,1.6,0\n", ["a.csv:2: ", "is the table in nm?"]),
    ("wavelength_nm,n,k\n0.4,1.5,0\n0.7,1.6,0\n", ["a.csv:2: ", "is the table in um?"])])
def test_units_of_indices_have_their_line(refused, text, words):
    refused({"a.csv": text}, ["material", "index", "a.csv", "--wavelength", "550"], words)


@pytest.mark.parametrize("old, new, words", [
    ("step_s = 20", "step_s = nan", ["scenario.toml:10:10: ", "step_s is nan", "finite"]),
    ("step_s = 20", "step_s = inf", ["scenario.toml:10:10: ", "step_s is inf", "finite"]),
    ("step_s = 20", "step_s = 1e-9", ["scenario.toml:9:1: ", "the limit is 10000000", "Take a longer step"]),
    ("seed = 1", "seed = 99999999999999999999", ["scenario.toml:2:28: ", "smaller number"]),
    ("seed = 1", "seed = -1", ["scenario.toml:2:1: ", "seed = -1", "0 or more"]),
    ("seed = 1", 'seed = 1\ninclude = "../../etc/passwd"', ["scenario.toml:3:1: ", 'unknown key "include"']),
    ("seed = 1", "seed = 1\nx = " + "[" * 5000 + "]" * 5000, ["scenario.toml:3:", "nested", "Simplify"]),
    ("[bands]", "[time]\n[bands]", ["scenario.toml:19:1: ", "'time'", "keep one of them"]),
    ("umov = 1", "umov = 2", ["scenario.toml:1:1: ", "umov = 2", "reads 1"]), ("umov = 1\n", "", ["scenario.toml:1:1: ", '"umov"', "Add it"]),
    ('mode = "nadir"', 'mode = "inertial", quaternion = [1.001, 0, 0, 0]', ["scenario.toml:16:33: ", "length 1.001", "1 within 1e-6"]),
    ('mode = "nadir"', 'mode = "inertial", quaternion = [0, 0, 0, 0]', ["scenario.toml:16:33: ", "length 0"])])
def test_configurations(refused, scenario, old, new, words):
    name = scenario((old, new))
    refused({}, ["run", name], words)


@pytest.mark.parametrize("content, words", [
    (bytes(range(256)), ["a.toml:1:1: ", "A TOML file was expected"]), (SCENARIO.encode("utf-16"), ["a.toml:1:1: ", "Save the file as UTF-8"]),
    (b"", ["a.toml", '"umov"']), (SCENARIO.replace('"HST"', '"H\xfcb"').format(root=ROOT).encode("latin-1"), ["a.toml:13:", "UTF-8"])])
def test_what_is_no_configuration(refused, content, words):
    refused({"a.toml": content}, ["run", "a.toml"], words)


def times(head, row, count=20):
    return head + "\n" + "".join(row(k) + "\n" for k in range(count))


def cards(*lines):
    return b"".join(line.encode().ljust(80) for line in (*lines, "END")).ljust(2880)


HUGE = cards("SIMPLE  =                    T", "BITPIX  =                    8", "NAXIS   =                    0", "EXTEND  =                    T") + cards(
    "XTENSION= 'BINTABLE'", "BITPIX  =                    8", "NAXIS   =                    2", "NAXIS1  =                   16",
    "NAXIS2  =           2000000000", "PCOUNT  =                    0", "GCOUNT  =                    1", "TFIELDS =                    2",
    "TTYPE1  = 'mjd_utc '", "TFORM1  = 'D       '", "TTYPE2  = 'mag     '", "TFORM2  = 'D       '")


@pytest.mark.parametrize("name, content, words", [
    ("a.csv", times("time_tt,mag", lambda k: f"2018-01-21T05:08:{k:02d}Z,5"), ["a.csv:1: ", "time_utc", "time_tt"]),
    ("a.csv", times("BJD_TDB,mag", lambda k: f"{2458139.5 + k},5"), ["a.csv:1: ", "time_utc", "BJD_TDB"]),
    ("a.csv", times("time_utc;mag", lambda k: f"2018-01-21T05:08:{k:02d}Z;5,3"), ["a.csv:1: ", "semicolons", "commas were expected"]),
    ("a.txt", "# MMT\n" + times("2018-01-21 05:08:00.1 5.2 5.3 0.1 100 30 1 1", lambda k: f"2018-01-21 05:08:{k:02d}.1 5.2 5.3 0.1 100 30 1 1"),
     ["a.txt:2: ", "numbers where the names of the columns were expected", "write a line of names", "time_utc"]),
    ("a.csv.gz", gzip.compress(bytes(200_000_000), mtime=0), ["a.csv.gz", "gunzip"]),
    *[("a.csv", text, ["a.csv:1: ", "semicolons", "commas were expected"]) for text in (
        "time_utc;mag\n2018-01-21 05:08:10;5,3\n", "time_utc; mag\n2018-01-21T05:08:10Z; 5.3\n", '"time_utc";"mag"\n"2018-01-21T05:08:10Z";"5.3"\n',
        "time_utc;mag;mag (V, AB)\n2018-01-21T05:08:10Z;5.3;1\n")],
    *[("a.csv", text, ["a.csv:1: ", "numbers where the names of the columns were expected"]) for text in (
        times("2018-01-21T05:08:10Z,5.3", lambda k: f"2018-01-21T05:08:{k + 11}Z,5.3"), "2018-01-21T05:08:10Z,V,5.3,0.1\n2018-01-21T05:08:11Z,V,5.3,0.1\n",
        "2018-01-21T05:08:10Z,V,5.3,V\n2018-01-21T05:08:11Z,V,5.3,V\n", "58139.1 5.3 0.1 0.1\n58139.2 5.3 0.1 0.1\n")],
    *[("a.csv", text, ["a.csv:1: ", '"mag" stands twice']) for text in (  # beside names that are numbers
        "time_utc,mag,mag,mag,1,2,3,4,5\n2018-01-21T05:08:10Z,5.3,6,7,1,1,1,1,1\n", "mag,time_utc,1,2,mag,3,4,5\n9.9,2018-01-21T05:08:10Z,6,7,5,1,1,1\n")],
    ("a.csv", "time,400,500,600,mag\n2018-01-21T05:08:05Z,1,2,3,4\n", ["a.csv:1: no column of time"]),
    ("a.fits", b"SIMPLE  =                    T" + bytes(3000), ["a.fits", "FITS", "Export or fetch it again"]),
    ("a.fits", HUGE, ["a.fits: part 2 ", "32000000000 bytes of data, of which 0 are there", "Export or fetch it again"]),
    ("a.fits", HUGE.replace(b"2000000000", b"    x    1"), ["a.fits: part 2 ", 'NAXIS2 = "x    1"', "a whole number was expected"]),
    ("a.fits", HUGE.replace(b"TFIELDS", b"TFIELD "), ["a.fits: part 2 ", "no TFIELDS"]), ("a.fits", HUGE.replace(b"END" + b" " * 77, b"FOO" + b" " * 77), ["a.fits: part 1 ", "without an END"])])
def test_light_curves_of_others(refused, name, content, words):
    refused({name: content}, ["period", name], words)


HEAD = "# pol_frame: altaz\ntime_utc,band,I,I_err,q,u,q_err,u_err\n"


@pytest.mark.parametrize("row, told", [
    ("nm:550,1e-9,1e-11,.9,.9,.01,.01", None), ("nm:550,1e-9,1e-11,1.04,0,.01,.01", None),  # by less than five of .01
    ("nm:550,1e-9,1e-11,1.06,0,.01,.01", "obs.csv:3: 1 row with |q| or |u| above 1 by more than five standard deviations"),
    ("nm:550,1e-9,1e-11,.1,-1.06,.01,.01", "obs.csv:3: 1 row with |q| or |u| above 1"),
    ("nm:550,1e-9,1e-11,1.000000001,0,,", None), ("nm:550,1e-9,1e-11,-1.009,0,,", None),
    ("nm:550,1e-9,1e-11,1.02,0,,", "obs.csv:3: 1 row with |q| or |u| above 1.01 and no error"),
    ("nm:550,1e-9,1e-11,0,-1.02,.01,", "obs.csv:3: 1 row with |q| or |u| above 1.01 and no error"),
    ("nm:550,1e-9,1e-11,1.02,0,0,0", "obs.csv:3: 1 row with an error of 0"),  # one fault, one warning
    ("nm:550,1e-9,0,.1,0,.01,.01", "obs.csv:3: 1 row with an error of 0"), ("nm:550,1e-9,1e-11,.1,0,0,.01", "obs.csv:3: 1 row with an error of 0")])
def test_values_that_are_hardly_measured(umov, scenario, tmp_path, row, told):
    (tmp_path / "obs.csv").write_text(HEAD + f"2018-01-21T05:08:05Z,{row}\n")
    done = umov("invert", "pose", "obs.csv", "--scenario", scenario(), "--grid", "1000")
    assert done.code in (0, 4), done.err
    assert told in done.err if told else "obs.csv:3: " not in done.err, done.err
    assert done.err.count("obs.csv:3") == (told is not None), done.err


STARS, SEMICOLONS = "ra_deg,dec_deg,mag\n", "are parted by semicolons"
OBSERVATION = ('[observation]\nexposure_s = 1\nlevel = "image"\nstars = "s.csv"\n[atmosphere]\nseeing = { arcsec = 3 }\n')


@pytest.mark.parametrize("text, words", [
    ("", ["s.csv", '"ra_deg"']),
    ("# unit: deg\nra,dec,mag\n1,2,3\n", ["s.csv:2: ", '"ra_deg"']), (STARS + "1,2\n", ["s.csv:2: ", "2 cells in a table of 3 columns"]),
    (STARS + "1,2,nan\n", ["s.csv:2: ", 'mag = "nan"']), (bytes(range(256)), ["s.csv", "is no text"]), (STARS.replace(",", ";") + "1;2;3\n", ["s.csv:1: ", SEMICOLONS])])
def test_fields_of_stars(refused, scenario, tmp_path, text, words):
    scenario()
    own = (tmp_path / "scenario.toml").read_text().replace("umov = 1\n", 'umov = 1\ninstrument = "c11_imx250"\n').replace('"paper_rgb"', '["nm:550"]')
    refused({"scenario.toml": own + OBSERVATION, "s.csv": text}, ["observe", "scenario.toml"], words)


def test_an_empty_field_is_warned_of(umov, scenario, tmp_path):
    scenario()
    own = (tmp_path / "scenario.toml").read_text().replace("umov = 1\n", 'umov = 1\ninstrument = "c11_imx250"\n').replace('"paper_rgb"', '["nm:550"]')
    told = {}
    for name, text in (("with", own + OBSERVATION), ("without", (own + OBSERVATION).replace('stars = "s.csv"\n', ""))):
        (tmp_path / name).mkdir()
        for path in [path for path in tmp_path.iterdir() if path.is_file()]:
            (tmp_path / name / path.name).write_bytes(path.read_bytes())
        (tmp_path / name / "scenario.toml").write_text(text)
        (tmp_path / name / "s.csv").write_text(STARS)
        told[name] = umov("observe", f"{name}/scenario.toml", "-o", f"{name}/out", timeout=120)
        assert told[name].code == 0, told[name].err
    assert "s.csv: no star in this table: the field is empty" in told["with"].err and "no star" not in told["without"].err
    rows = [[line for line in (tmp_path / name / "out/counts.csv").read_text().splitlines() if not line.startswith("#")] for name in told]
    assert rows[0] == rows[1] and len(rows[0]) > 1


@pytest.mark.parametrize("text, words", [
    (COUNTS.replace("counts", "cnts", 1), ["c.csv:1: ", '"counts"']), ("# note: a\n" + COUNTS.replace("counts", "cnts", 1), ["c.csv:2: ", '"counts"']),
    (COUNTS.splitlines()[0] + "\n", ["c.csv", "no row of counts"]), (COUNTS.replace("sky_err", "sky", 1), ["c.csv:1: ", '"sky" stands twice']),
    (COUNTS.replace("V", '"V', 1), ["c.csv:2: ", "a quote is not closed"]), (COUNTS.replace(",", ";"), ["c.csv:1: ", SEMICOLONS]),
    (COUNTS.split("\n", 1)[1], ["c.csv:1: ", "names of the columns were expected"])])
def test_tables_of_counts(refused, text, words):
    refused({"c.csv": text}, ["reduce", "c.csv"], words)


@pytest.mark.parametrize("text, words", [
    ("p_percent,pa_deg\n5,2\n", ["k.csv:1: ", '"name"']), ("# by: me\np_percent,pa_deg\n5,2\n", ["k.csv:2: ", '"name"']),
    ("name,p_percent,pa_deg\nstar,200,2\n", ["k.csv:2: ", '"200"', "0 to 100"]), ("name,p_percent,pa_deg\n", ["k.csv", "no standard in this table"]),
    ("name;p_percent;pa_deg\n", ["k.csv:1: ", SEMICOLONS])])
def test_tables_of_standards(refused, text, words):
    refused({"c.csv": COUNTS, "k.csv": text}, ["calibrate", "c.csv", "--standards", "k.csv"], words)


def test_angles_parted_by_semicolons(refused):
    refused({"l.csv": "angle_deg;counts\n0 ;100\n60 ;50\n"}, ["calibrate", "l.csv", "--polarizer"], ["l.csv:1: ", SEMICOLONS])


def test_one_angle_is_not_angles(refused):
    refused({"l.csv": "angle_deg,counts\n0,100\n"}, ["calibrate", "l.csv", "--polarizer"], ["1 angle of the polarizer", "three different ones"])


@pytest.mark.parametrize("text, words", [
    ("[x", ["k.toml:1:3: ", "A TOML file was expected"]), ("", ["k.toml", '"efficiency"', "Add it"]),
    ('efficiency = "high"\n', ["k.toml:1:14: ", "efficiency is a string", "a number was expected"])])
def test_calibrations(refused, text, words):
    refused({"c.csv": COUNTS, "k.toml": text}, ["reduce", "c.csv", "--calibration", "k.toml"], words)


INSTRUMENT = (ROOT / "data/instruments/c11_imx250.toml").read_text()


@pytest.mark.parametrize("text, words", [
    ("[telescope\n", ["my.toml:1:11: ", "A TOML file was expected"]), ("", ["my.toml", '"description"', "Add it"]),
    (INSTRUMENT.replace("aperture_m = 0.2794", 'aperture_m = "big"'), ["my.toml:6:14: ", "aperture_m is a string", "a number was expected"]),
    (INSTRUMENT.replace("aperture_m = 0.2794", "apertur_m = 1"), ["my.toml:6:1: ", '"apertur_m"', 'Did you mean "aperture_m"?'])])
def test_instruments(refused, text, words):
    refused({"my.toml": text}, ["instrument", "show", "my.toml"], words)


@pytest.mark.parametrize("text, words", [
    ("<VOTABLE>", ["b.csv:1: ", "is no XML", "fetch the file again"]), ("<html>404</html>", ["b.csv:1: ", "no <TABLE>"]),
    ('<!DOCTYPE a [<!ENTITY b "c">]><VOTABLE/>', ["b.csv:1: ", "document type", "remove it"]),
    ("# unit: nm\n# detector: photon\n500 0\n600 0\n", ["b.csv", "0 everywhere", "was expected"])])
def test_curves_of_bands(refused, scenario, text, words):
    name = scenario(('"paper_rgb"', '["file:b.csv"]'))
    refused({"b.csv": text}, ["signature", name, "--poses", "1", "--phase", "30"], [*words, "(named in scenario.toml:20:1)"])


POSES = "sun_x,sun_y,sun_z,obs_x,obs_y,obs_z"


@pytest.mark.parametrize("text, words", [
    (POSES + "\n1,0,nan,1,0,0\n", ["g.csv:2:5: ", "sun_z", "finite"]), (POSES + "\n", ["g.csv", "no rows below the header"]),
    ("", ["g.csv", "no header"]), (POSES + ",pose\n1,0,0,0,1,0,1\n0,1,0,1,0,0,1\n", ["g.csv:3: ", "two different directions"]),
    (POSES.replace(",", ";") + "\n", ["g.csv:1: ", SEMICOLONS, "sun_x"]), (POSES.replace(",", ";") + ";note, free\n", ["g.csv:1: ", SEMICOLONS, "sun_x"]), ("1,0,0,0,1,0\n", ["g.csv:1: ", "names of the columns were expected", "sun_x"])])
def test_tables_of_poses(refused, scenario, text, words):
    name = scenario()
    refused({"g.csv": text}, ["signature", name, "--geometry", "g.csv"], words)


@pytest.mark.parametrize("files, words", [
    ({}, ["lib: cannot read the folder", "umov library build"]), ({"lib/a.umovsig": b"x"}, ["lib/a.umovsig", "not a signature", "umov library build"]),
    ({"lib/a.umovsig": b""}, ["lib/a.umovsig", "not a signature"]), ({"lib/notes": b""}, ["lib: holds no signature", "umov library build"])])
def test_libraries(refused, scenario, files, words):
    name = scenario()
    refused({"obs.csv": HEAD + "2018-01-21T05:08:05Z,nm:550,1e-9,1e-11,.1,0,.01,.01\n", **files},
            ["identify", "obs.csv", "--scenario", name, "--library", "lib"], words)


@pytest.mark.parametrize("verb", ["run", "status", "merge", "verify", "repair"])
@pytest.mark.parametrize("text", ["hello", '{"umov": 99}', "[]", "[" * 5000, "\0" * 100])
def test_what_is_no_job_in_a_folder(refused, verb, text):
    done = refused({"d/job.json": text}, ["scale", verb, "d"], ["d/job.json: is no job of umov scale", "begin a job in a new folder"])
    assert "json.exception" not in done.err, done.err


@pytest.mark.parametrize("name, text, word", [
    ("manifest.json", "{}", "a manifest.json that umov did not write"), ("manifest.json", "{", "a manifest.json that umov did not write"),
    ("log.txt", "x", '"log.txt" and no manifest.json of umov'), ("frames/frame_1.fits", "x", '"frames" and no manifest.json of umov'), ("a.txt", "x", '"a.txt", which umov did not write')])
def test_folders_of_others_are_not_written_into(refused, scenario, name, text, word):
    refused({f"out/{name}": text}, ["run", scenario()], ["out: holds", word, "--force"], code=6)


@pytest.mark.parametrize("call, words", [
    (["signature", "scenario.toml", "--poses", "1", "--phase", "x"], ["--phase = x", "a number was expected"]),
    (["orbit", "show", "--orbit", "a.tle", "--norad", "1.5"], ["--norad = 1.5; a whole number was expected"]),
    (["orbit", "show", "--orbit", "a.tle", "--norad", "x"], ["--norad = x; a whole number was expected"]),
    (["signature", "scenario.toml", "--poses", "1", "--phase", "30", "--threads", "1e9"], ["--threads", "1e9", "0 to 1024"]),
    (["signature", "scenario.toml", "--poses", "1", "--phase", "30", "-o", "folder"], ["-o folder", ".csv, .ecsv, .fits, .json"]),
    (["mesh", "make", "sphere", "--radius", "nan", "-o", "a.obj"], ["--radius", "finite", "nan"])])
def test_options(refused, scenario, tmp_path, call, words):
    scenario()
    (tmp_path / "folder").mkdir()
    refused({}, call, words, code=2)


def test_as_many_threads_as_there_are(umov, scenario):
    assert umov("signature", scenario(), "--poses", "3", "--phase", "30", "--threads", "0").code == 0


def closed(*numbers):
    """Closes descriptors in the child, after Popen has made its own."""
    def close():
        for number in numbers:
            os.close(number)
    return close


@pytest.mark.parametrize("numbers", [(0,), (2,), (0, 1, 2), (1,)])
def test_descriptors_that_are_closed(scenario, tmp_path, numbers):
    """Descriptor 1 is then the first file that is opened: rows for the output must not go there by chance."""
    call = [UMOV, "signature", scenario(), "--poses", "3", "--phase", "30", "-q", "-o", "out.csv"]
    assert subprocess.run([*call[:-1], "want.csv"], cwd=tmp_path).returncode == 0
    done = subprocess.run(call, cwd=tmp_path, preexec_fn=closed(*numbers))
    assert done.returncode == 0
    rows = [[line for line in (tmp_path / name).read_text().splitlines() if not line.startswith("#")] for name in ("want.csv", "out.csv")]
    assert rows[0] == rows[1] and len(rows[0]) == 10  # names, three poses in three bands


@pytest.mark.parametrize("where", ["closed", "/dev/full"])
def test_rows_that_find_no_output(scenario, tmp_path, where):
    call = [UMOV, "signature", scenario(), "--poses", "3", "--phase", "30", "-q"]
    if where == "closed":
        done = subprocess.run(call, cwd=tmp_path, preexec_fn=closed(1), stderr=subprocess.PIPE, text=True)
    else:
        with open(where, "w") as full:
            done = subprocess.run(call, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 6 and "standard output cannot be written" in done.stderr and "-o" in done.stderr, done.stderr
