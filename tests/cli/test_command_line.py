"""The command line told to shells and to man, what umov doctor says, one habit for every verb."""
import json
import os
import re
import shutil
import subprocess

import pytest

from conftest import ROOT, UMOV, read_csv

HST = ROOT / "data/tle/hst.tle"


def verbs(umov):
    """{"umov mesh make": its words} of every verb, as the bash script has them."""
    script = umov("completion", "bash").out
    return {path: words.split() for path, words in re.findall(r"^    '(umov[^|'\-]*)'\) words='([^']*)'",
                                                              script, re.M)}


def leaves(umov):
    found = verbs(umov)
    return {path: words for path, words in found.items()
            if not any(other.startswith(path + " ") for other in found)}


def test_the_scripts_know_every_option_of_the_help(umov):
    found = leaves(umov)
    assert {"umov run", "umov mesh make", "umov orbit convert", "umov completion"} <= set(found)
    scripts = {shell: umov("completion", shell).out for shell in ("zsh", "fish")}
    man = umov("man").out.replace("\\-", "-")
    for path, words in found.items():
        help_text = umov(*path.split()[1:], "--help").out
        options = set(re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", help_text, re.M))
        assert options and options <= set(words), path
        assert ".SS " + path + "\n" in man and f"'{path}'" in scripts["zsh"], path
        part = man.split(".SS " + path + "\n")[1].split("\n.S")[0]
        for option in options:
            assert f"\\fB{option}\\fR" in part, (path, option)
            assert f'= "{path}"\'' in scripts["fish"] and f"-l {option[2:]} " in scripts["fish"]


def complete(umov, tmp_path, *words):
    (tmp_path / "c.bash").write_text(umov("completion", "bash").out)
    line = " ".join(f"'{word}'" for word in words)
    done = subprocess.run(
        ["bash", "-c", f"source c.bash; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _umov; "
                       'echo "${COMPREPLY[@]}"'], cwd=tmp_path, text=True, capture_output=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout.split()


@pytest.mark.skipif(not shutil.which("bash"), reason="no bash")
def test_bash_completes(umov, tmp_path):
    assert {"run", "passes", "mesh"} <= set(complete(umov, tmp_path, "umov", ""))
    assert complete(umov, tmp_path, "umov", "mesh", "m") == ["make"]
    assert complete(umov, tmp_path, "umov", "render", "s.toml", "--shade", "p") == ["p", "pa"]
    assert complete(umov, tmp_path, "umov", "render", "--shade", "=", "c") == ["colour"]
    assert complete(umov, tmp_path, "umov", "passes", "--vis") == ["--visible"]
    assert complete(umov, tmp_path, "umov", "completion", "z") == ["zsh"]
    assert complete(umov, tmp_path, "umov", "run", "-o", "") == []  # files
    assert complete(umov, tmp_path, "umov", "passes", "-s", "mauna") == ["mauna-kea"]
    assert complete(umov, tmp_path, "umov", "brdf", "mli_kapton_") == ["mli_kapton_back"]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_shell_reads_its_script(umov, tmp_path, shell):
    if not shutil.which(shell):
        pytest.skip("not installed")
    assert umov("completion", shell, "-o", "script").code == 0
    done = subprocess.run([shell, "-n", "script"], cwd=tmp_path, text=True, capture_output=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert umov("completion", "tcsh").code == 2


@pytest.mark.skipif(not shutil.which("groff"), reason="no groff")
def test_groff_reads_the_manual_page(umov, tmp_path):
    assert umov("man", "-o", "umov.1").code == 0
    done = subprocess.run(["groff", "-man", "-ww", "-Tascii", "umov.1"], cwd=tmp_path, text=True,
                          capture_output=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    plain = re.sub("\x1b\\[\\d*m|.\b", "", done.stdout)  # bold is an escape or an overstrike
    assert "EXIT STATUS" in plain and "umov mesh make" in plain


def test_every_verb_has_the_same_habits(umov):
    found = leaves(umov)
    no_table = {"mesh make", "mesh convert", "material plot", "material import", "orbit convert",
                "render", "schema", "completion", "man", "instrument show"}
    # Jobs in parts: what they make is a folder, or the table of another verb.
    no_table |= {f"scale {verb}" for verb in ("run", "merge", "verify", "repair", "script", "worker", "hold")}
    assert {path[5:] for path, words in found.items() if "--json" not in words} == no_table
    only_prints = {f"scale {verb}" for verb in ("plan", "lock", "run", "status", "verify", "repair", "worker", "hold")}
    assert {path[5:] for path, words in found.items() if "--output" not in words} == only_prints
    for path, words in found.items():
        assert ("-o" in words) == ("--output" in words) and "--help" in words, path


def found_by_doctor(umov):
    return {line["what"]: line["found"] for line in json.loads(umov("doctor", "--json").out)}


def test_doctor_counts_what_the_verbs_list(umov):
    said = found_by_doctor(umov)
    for what, command in (("materials", ("material", "list")), ("index tables", ("material", "index")),
                          ("distributions", ("material", "list", "--models"))):
        assert int(said[what]) == len(json.loads(umov(*command, "--json").out)), what
    assert int(said["threads"]) == len(os.sched_getaffinity(0))
    for suffix in said["tables"].split(", "):
        assert umov("material", "list", "-o", "t" + suffix).code == 0, suffix
    assert umov("material", "list", "-o", "t.xyz").code == 2


def test_doctor_writes_its_table(umov, tmp_path):
    assert umov("doctor", "-o", "d.json").code == 0
    assert {line["what"]: line["found"] for line in json.loads((tmp_path / "d.json").read_text())} == found_by_doctor(umov)
    assert umov("doctor", "-o", "d.csv").code == 0
    assert {row["ok"] for row in read_csv(tmp_path / "d.csv")} == {"True"}
    assert umov("doctor", "-o", "d.txt").code == 2


def test_doctor_and_bench_name_the_same_machine(umov, tmp_path):
    said = found_by_doctor(umov)
    done = umov("bench", "--only", "flat panel, 2 ", "--geometries", 0, "--seconds", 0.01, "-o", "b.csv")
    assert done.code == 0, done.err
    assert [row["instruction_set"] for row in read_csv(tmp_path / "b.csv")] == [said["instruction set"]]
    assert "# machine: " + said["processor"] in (tmp_path / "b.csv").read_text()


def test_doctor_measures_the_cache_folder(umov, tmp_path):
    folder = tmp_path / "cache/umov/masks"
    folder.mkdir(parents=True)
    (folder / "a").write_bytes(bytes(1_500_000))
    (tmp_path / "cache/umov/b").write_bytes(bytes(100_000))
    done = subprocess.run([UMOV, "doctor", "--json"], text=True, capture_output=True,
                          env=dict(os.environ, XDG_CACHE_HOME=str(tmp_path / "cache")))
    said = {line["what"]: line["found"] for line in json.loads(done.stdout)}
    assert said["cache folder"] == f"{tmp_path}/cache/umov: 2 files, 1.6 MB"


def test_doctor_tells_a_cache_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "cache").write_text("a file\n")
    done = subprocess.run([UMOV, "doctor", "--json"], text=True, capture_output=True,
                          env=dict(os.environ, XDG_CACHE_HOME=str(tmp_path / "cache")))
    said = {line["what"]: line for line in json.loads(done.stdout)}["cache folder"]
    assert said["ok"] and f"none: {tmp_path}/cache/umov cannot be written" in said["found"], said  # costs time alone


def test_doctor_knows_how_far_the_tables_reach(umov):
    said = found_by_doctor(umov)
    first, last = said["Earth orientation"].split(", measured")[0].split(" to ")

    def warnings(time):
        return umov("passes", "--orbit", HST, "-s", "maui", "--start", time, "--stop", time,
                    "--allow-old-elements").err
    for day, is_inside in ((first + "T00:00:01Z", True), (last + "T00:00:00Z", True),
                           (last + "T00:00:01Z", False)):
        assert ("table of Earth orientation" not in warnings(day)) == is_inside, day
    expiry = said["leap seconds"].removeprefix("until ")
    assert "leap-second" not in warnings(expiry + "T00:00:00Z")
    assert "leap-second" in warnings(expiry + "T00:00:01Z")


def test_a_material_is_shown_as_a_table(umov, tmp_path):
    rows = json.loads(umov("material", "show", "paper_au", "--json").out)
    assert [row["band"] for row in rows] == ["nm:425", "nm:550", "nm:650"]
    # Normal reflectance by Fresnel, from n and k beside it.
    for row in rows:
        n, k = row["n"], row["k"]
        assert row["reflectance_0"] == pytest.approx(((n - 1)**2 + k**2) / ((n + 1)**2 + k**2), rel=1e-12)
    assert umov("material", "show", "paper_au", "-o", "m.csv").code == 0
    assert float(read_csv(tmp_path / "m.csv")[1]["n"]) == rows[1]["n"]


@pytest.mark.parametrize("arguments", [("orbit", "convert", HST), ("orbit", "ephemeris", HST, "-s", "maui"), ("passes", HST)])
def test_a_file_without_its_option_is_told_which_one(umov, arguments):
    done = umov(*arguments)
    assert done.code == 2 and f"Did you mean --orbit {HST}?" in done.err, done.err


@pytest.mark.parametrize("arguments, verb", [((), "passes"), (("orbit",), "convert"), (("invert",), "health")])
def test_who_gives_no_verb_is_told_which_there_are(umov, arguments, verb):
    done = umov(*arguments)
    assert done.code == 2 and re.search(rf"no verb was given; there are .*\b{verb}\b", done.err), done.err


def test_sizes_are_taken_with_commas_as_the_help_shows_them(umov, tmp_path):
    for shape, option, values in (("box-wing", "--bus", ("5", "5", "45")), ("cigar", "--semi-axes", ("0.5", "0.5", "2"))):
        assert umov("mesh", "make", shape, option, *values, "-o", "words.obj").code == 0
        done = umov("mesh", "make", shape, option, ",".join(values), "-o", "commas.obj")
        assert done.code == 0, done.err
        same = [(tmp_path / f"{name}.obj").read_text().replace("commas", "words") for name in ("words", "commas")]
        assert same[0] == same[1]
    done = umov("mesh", "make", "box-wing", "--bus", "5,5", "-o", "a.obj")
    assert done.code == 2 and "--bus" in done.err and "3" in done.err, done.err
