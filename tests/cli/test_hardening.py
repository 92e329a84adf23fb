"""Places, names and machines that are not as one would like: nothing lost, nothing replaced unasked."""
import os
import resource
import stat
import subprocess

import pytest

from conftest import ROOT, UMOV

OEM = ROOT / "tests/data/ccsds/oem.kvn"
MESSAGES = [
    # text of a message, words of the refusal
    ("CCSDS_OEM_VERS = 2.0\nMETA_STOP\n2018-01-20T00:00:00 1 2 3 4 5 6\n", ["bad.oem:2", "META_START"]),
    ("CCSDS_AEM_VERS = 1.0\nDATA_START\n2018-01-20T00:00:00 1 0 0 0\n", ["bad.oem:2", "META_START"]),
    ("CCSDS_OEM_VERS = 2.0\nCOVARIANCE_START\nEPOCH = 2018-01-20T00:00:00\n1\nMETA_START\n", ["bad.oem:2"]),
    ('<tdm id="CCSDS_TDM_VERS" version="1.0"><header/><body><segment><metadata><TIME_SYSTEM>UTC</TIME_SYSTEM>'
     "<PARTICIPANT_1>A</PARTICIPANT_1></metadata>\n<data><observation><RANGE>1</RANGE></observation></data>"
     "</segment></body></tdm>", ["bad.oem:2", "no EPOCH"]),
]


@pytest.mark.parametrize("text, words", MESSAGES)
@pytest.mark.parametrize("verb", [["show"], ["convert", "--to", "kvn"], ["convert", "--to", "xml"]])
def test_messages_with_parts_out_of_place(umov, tmp_path, verb, text, words):
    (tmp_path / "bad.oem").write_text(text)
    done = umov("orbit", *verb, "--orbit", "bad.oem")
    assert done.code == 3, done.err
    for word in words:
        assert word in done.err, done.err


def test_standard_output_by_its_name_is_written_to(tmp_path):
    with open(tmp_path / "all.xml", "a") as out:
        out.write("first\n")
        out.flush()
        done = subprocess.run([UMOV, "orbit", "convert", "--orbit", OEM, "--to", "xml", "-o", "/dev/stdout"],
                              stdout=out, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "all.xml").read_text().startswith("first\n<?xml")
    through = subprocess.run([UMOV, "orbit", "convert", "--orbit", OEM, "--to", "xml", "-o", "/dev/stdout"],
                             capture_output=True, text=True)
    assert "first\n" + through.stdout == (tmp_path / "all.xml").read_text()
    assert os.path.islink("/dev/stdout")


def test_a_link_is_followed_and_a_private_file_stays_private(umov, tmp_path):
    (tmp_path / "real.csv").write_text("old")
    (tmp_path / "real.csv").chmod(0o600)
    (tmp_path / "link.csv").symlink_to("real.csv")
    done = umov("orbit", "show", "--orbit", OEM, "-o", "link.csv")
    assert done.code == 0, done.err
    assert (tmp_path / "link.csv").is_symlink()
    assert "oem" in (tmp_path / "real.csv").read_text().lower()
    assert stat.S_IMODE((tmp_path / "real.csv").stat().st_mode) == 0o600
    assert len(list(tmp_path.iterdir())) == 2


def test_a_name_that_is_not_utf8_does_not_cost_the_run(scenario, tmp_path):
    os.rename(tmp_path / scenario(), os.fsencode(tmp_path) + b"/caf\xe9.toml")
    done = subprocess.run([UMOV, "run", b"caf\xe9.toml"], cwd=tmp_path, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert "caf\ufffd.toml" in (tmp_path / "out/manifest.json").read_text()


def test_a_terminal_is_not_given_orders(umov, tmp_path):
    (tmp_path / "bad.oem").write_text("CCSDS_OEM_VERS = 2.0\n\x1b[2JFOO\n")
    done = umov("orbit", "show", "--orbit", "bad.oem")
    assert done.code == 3 and "\x1b" not in done.err and "?[2JFOO" not in done.out, done.err


def test_fewer_threads_than_asked_for_do_the_work(scenario, tmp_path):
    call = [UMOV, "signature", scenario(), "--poses", "3000", "--phase", "60"]
    limit = 3 << 30
    for threads, name in (("1", "one.csv"), ("1000", "many.csv")):
        done = subprocess.run([*call, "--threads", threads, "-o", name], cwd=tmp_path, capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        assert done.returncode == 0, done.stderr
    rows = [[line for line in (tmp_path / name).read_text().splitlines() if not line.startswith("#")]
            for name in ("one.csv", "many.csv")]
    assert len(rows[0]) > 3000 and rows[0] == rows[1]


def test_a_folder_elsewhere_is_replaced_only_if_the_user_names_it(umov, scenario, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    work = tmp_path / "work"
    work.mkdir()
    name = scenario(('dir = "out"', f'dir = "{elsewhere}"'))
    (work / name).write_text((tmp_path / name).read_text().replace("cube.obj", "../cube.obj"))

    def run(*more):
        return subprocess.run([UMOV, "run", name, "--accuracy", "0.5", *more], cwd=work, text=True,
                              capture_output=True)

    first = run()
    assert first.returncode == 0, first.stderr
    manifest = (elsewhere / "manifest.json").read_bytes()
    second = run()
    assert second.returncode == 3 and "name it yourself" in second.stderr, second.stderr
    assert (elsewhere / "manifest.json").read_bytes() == manifest
    counts = subprocess.run([UMOV, "observe", name], cwd=work, text=True, capture_output=True)
    assert counts.returncode == 3 and "name it yourself" in counts.stderr, counts.stderr
    assert run("-o", str(elsewhere)).returncode == 0
    assert (elsewhere / "manifest.json").read_bytes() != manifest
