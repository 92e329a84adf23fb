"""--device: cards by a driver without one (src/backend/cuda/tests), and what is said where there is none."""
import json
import os
import shutil
import subprocess

import numpy as np
import pytest
from astropy.table import Table

from conftest import ROOT, read_csv

FAKE = ROOT / "build/release/fake_cuda"


@pytest.fixture
def settings(monkeypatch):
    """settings(UMOV_FAKE_CARDS=0): the driver without a card is found, and behaves so."""

    def of(**values):
        monkeypatch.setenv("UMOV_CUDA_PATH", str(FAKE))
        for name, value in values.items():
            monkeypatch.setenv(name, str(value))

    return of


@pytest.fixture
def signature(umov, scenario):
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0

    def call(out, *more, visibility="masks", poses=300):
        return umov("signature", name, "--poses", poses, "--phase", "60", "--visibility", visibility, "-o", out, *more)

    return call


def test_signature_on_cards_is_that_of_the_processor(signature, settings, tmp_path):
    settings(UMOV_FAKE_CARDS=2)
    assert signature("cpu.csv").code == 0
    done = signature("card.csv", "--device", "cuda")
    assert done.code == 0, done.err
    for ours, theirs in zip(read_csv(tmp_path / "cpu.csv"), read_csv(tmp_path / "card.csv")):
        wanted = float(ours["intensity"])
        assert abs(float(theirs["intensity"]) - wanted) <= 1e-4 * wanted + 1e-6


def test_doctor_names_the_cards(umov, settings):
    assert "not used: no NVIDIA driver" in umov("doctor").out or os.path.exists("/proc/driver/nvidia")
    settings()
    assert "Card of paper (1 GB, compute 8.0)" in umov("doctor").out


def test_half_of_what_is_needed_is_told(umov, signature, tmp_path, monkeypatch):
    """A driver without a compiler, files that are something else, or are no library."""
    driver, compiler = FAKE / "libcuda.so.1", FAKE / "libnvrtc.so.13"
    cases = {"driver of another": ({"libcuda.so.1": compiler}, "is too old: it lacks cuInit"),
             "compiler of another": ({"libcuda.so.1": driver, "libnvrtc.so.13": driver}, "is too old: it lacks nvrtcVersion")}
    if shutil.which("ldconfig", path="/sbin:/usr/sbin") and "libnvrtc" not in subprocess.run(
            ["ldconfig", "-p"], text=True, capture_output=True, env={"PATH": "/sbin:/usr/sbin"}).stdout:
        cases["no compiler"] = {"libcuda.so.1": driver}, "pip install nvidia-cuda-nvrtc"
    for variable in ("VIRTUAL_ENV", "LD_LIBRARY_PATH"):
        monkeypatch.delenv(variable, raising=False)
    for name, (files, told) in cases.items():
        folder = tmp_path / name
        folder.mkdir()
        for link, target in files.items():
            (folder / link).symlink_to(target)
        monkeypatch.setenv("UMOV_CUDA_PATH", str(folder))
        assert told in umov("doctor").out, name
        refused = signature("a.csv", "--device", "cuda")
        assert refused.code == 6 and told in refused.err, name
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / "libcuda.so.1").write_text("no library")
    monkeypatch.setenv("UMOV_CUDA_PATH", str(broken))
    if not os.path.exists("/proc/driver/nvidia"):  # else the system's is taken
        refused = signature("a.csv", "--device", "cuda")
        assert refused.code == 6 and "broken/libcuda.so.1: file too short" in refused.err, refused.err


def test_what_lacks_ends_with_6_or_a_line(signature, settings, tmp_path):
    settings(UMOV_FAKE_INIT=100)
    refused = signature("a.csv", "--device", "cuda")
    assert refused.code == 6 and "CUDA_ERROR_NO_DEVICE" in refused.err
    assert not (tmp_path / "a.csv").exists()
    told = signature("b.csv", "--device", "auto")
    assert told.code == 0 and "--device auto took the cpu: " in told.err
    assert sum(line.startswith("warning") for line in told.err.splitlines()) == 1


@pytest.mark.parametrize("verb", ["run", "observe"])
def test_a_run_and_an_observation_without_cards_end_with_6_or_a_line(umov, settings, tmp_path, verb):
    scene = ROOT / ("examples/observe_hst.toml" if verb == "observe" else "examples/agena_maui.toml")
    settings(UMOV_FAKE_INIT=100)
    more = "observation.cadence_s=3" if verb == "observe" else "time.step_s=30"
    command = (verb, scene, "--set", more)
    refused = umov(*command, "-o", "cuda", "--device", "cuda")
    assert refused.code == 6 and "CUDA_ERROR_NO_DEVICE" in refused.err, refused.err
    assert not (tmp_path / "cuda").exists()
    told = umov(*command, "-o", "auto", "--device", "auto")
    assert told.code == 0 and told.err.count("--device auto took the cpu: ") == 1, told.err
    light, = json.loads((tmp_path / "auto/manifest.json").read_text())["light"]
    assert light["device"].startswith("cpu: starting the driver") and light["method"] in ("auto", "masks"), light


def test_what_cards_do_not_light_is_refused_by_name(signature, settings):
    settings()
    refused = signature("a.csv", "--device", "cuda", visibility="rays")
    assert refused.code == 2 and "rays are traced by the processor" in refused.err
    assert signature("a.csv", "--device", "gpu").code == 2
    told = signature("b.csv", "--device", "auto", visibility="rays")
    assert told.code == 0 and "--device auto took the cpu: rays are traced by the processor" in told.err


def test_own_heat_is_the_processors(umov, scenario, settings):
    settings()
    name = scenario(('default = "paper_al"', 'default = "paint_white"'), ('"paper_rgb"', '"nm:10000"'))
    command = ("signature", name, "--poses", 20, "--phase", "60", "--source", "thermal", "--temperature", 300, "-o", "a.csv")
    refused = umov(*command, "--device", "cuda")
    assert refused.code == 2 and "own heat is lit by the processor" in refused.err, refused.err
    told = umov(*command, "--device", "auto")
    assert told.code == 0 and "--device auto took the cpu: own heat is lit by the processor" in told.err, told.err


@pytest.mark.slow
def test_a_lost_card_keeps_what_is_finished(signature, settings, tmp_path, monkeypatch):
    """The first block of 131,072 poses takes two batches, three launches each; then the same command goes on."""
    settings(UMOV_FAKE_LAUNCHES=6)
    lost = signature("a.csv", "--device", "cuda", poses=140_000)
    assert lost.code == 6 and "CUDA_ERROR_LAUNCH_FAILED" in lost.err
    assert "The same command goes on from there." in lost.err
    monkeypatch.delenv("UMOV_FAKE_LAUNCHES")
    done = signature("a.csv", "--device", "cuda", poses=140_000)
    assert done.code == 0 and "going on from" in done.err
    assert signature("b.csv", "--device", "cuda", poses=140_000).code == 0
    assert (tmp_path / "a.csv").read_text() == (tmp_path / "b.csv").read_text()


def test_rows_of_a_card_are_not_gone_on_with_by_the_processor(umov, scenario, settings, tmp_path, monkeypatch):
    """Finished blocks stay when the card is lost, for the card alone: the processor begins anew."""
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    settings()
    blocks = ("--set", "time.step_s=0.1", "--accuracy", "0.5")  # five of 512 epochs, two launches each
    monkeypatch.setenv("UMOV_FAKE_LAUNCHES", "4")
    lost = umov("run", name, "-o", "out", "--device", "cuda", *blocks)
    assert lost.code == 6 and "The same command goes on from there." in lost.err, lost.err
    monkeypatch.delenv("UMOV_FAKE_LAUNCHES")
    done = umov("run", name, "-o", "out", *blocks)
    assert done.code == 0 and "this one begins anew" in done.err, done.err
    assert umov("run", name, "-o", "cpu", *blocks).code == 0
    assert (tmp_path / "out/lightcurve.ecsv").read_text() == (tmp_path / "cpu/lightcurve.ecsv").read_text()


def test_a_job_is_the_same_by_any_number_of_cards_and_another_by_another_compiler(umov, scenario, settings, monkeypatch):
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    settings(UMOV_FAKE_CARDS=2)
    command = ("run", name, "-o", "out", "--device", "cuda", "--set", "time.step_s=0.1", "--accuracy", "0.5")

    def lost():
        monkeypatch.setenv("UMOV_FAKE_LAUNCHES", "4")
        done = umov(*command)
        monkeypatch.delenv("UMOV_FAKE_LAUNCHES")
        assert done.code == 6 and "The same command goes on from there." in done.err, done.err

    lost()
    settings(UMOV_FAKE_CARDS=1)
    done = umov(*command)
    assert done.code == 0 and "begins anew" not in done.err, done.err
    lost()
    settings(UMOV_FAKE_VERSION=12080)
    done = umov(*command)
    assert done.code == 0 and "this one begins anew" in done.err, done.err


def test_a_run_on_cards_mends_by_rays(umov, scenario, settings, tmp_path):
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    settings()
    assert umov("run", name, "-o", "cpu").code == 0
    done = umov("run", name, "-o", "card", "--device", "cuda")
    assert done.code == 0, done.err
    assert "Card of paper" in (tmp_path / "card/manifest.json").read_text()


def test_auto_takes_the_processor_where_masks_do_not_fit(signature, settings, tmp_path):
    """Facets fit, masks do not: one line, and the rows of the processor."""
    settings(UMOV_FAKE_MEMORY=400_000)
    refused = signature("a.csv", "--device", "cuda")
    assert refused.code == 6 and "the masks take" in refused.err
    told = signature("b.csv", "--device", "auto")
    assert told.code == 0, told.err
    assert sum(line.startswith("warning") for line in told.err.splitlines()) == 1
    assert "--device auto took the cpu: the masks take" in told.err
    assert "# device: cpu: the masks take" in (tmp_path / "b.csv").read_text()
    assert signature("c.csv").code == 0
    assert read_csv(tmp_path / "b.csv") == read_csv(tmp_path / "c.csv")


def test_files_name_who_lit_and_not_who_might_have(umov, scenario, settings, tmp_path):
    """Cards are there and light nothing: a manifest names the processor alone."""
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    settings(UMOV_FAKE_FULL=0)
    done = umov("run", name, "-o", "out", "--device", "auto")
    assert done.code == 0 and "--device auto took the cpu: computing on Card of paper" in done.err, done.err
    light, = json.loads((tmp_path / "out/manifest.json").read_text())["light"]
    assert light["device"].startswith("cpu: computing on Card of paper") and "Card" not in light["instruction_set"]


@pytest.mark.parametrize("suffix", ["csv", "fits", "ecsv"])
def test_a_table_says_that_its_later_rows_are_anothers(signature, settings, tmp_path, suffix):
    """The first block of 4,096 poses takes a batch of two launches; before the next the cards are full for good."""
    settings(UMOV_FAKE_FULL=2)
    done = signature(f"a.{suffix}", "--device", "auto", "--accuracy", "0.5", visibility="auto", poses=4200)
    assert done.code == 0 and "--device auto took the cpu in the end, at first Card of paper: " in done.err, done.err
    if suffix == "fits":
        from astropy.io import fits
        text = "".join(str(fits.getheader(tmp_path / "a.fits", 1)).replace("\n", "").split("COMMENT "))
    else:
        text = (tmp_path / f"a.{suffix}").read_text()
    assert "device" in text and "cpu in the end, at first Card of paper" in text

SHARDED = {"signature": ("signature", "{}", "--poses", 2000, "--phase", "60", "--visibility", "masks"),
           "run": ("run", "{}", "--set", "render.method=\"masks\"")}


@pytest.mark.parametrize("verb", SHARDED)
def test_a_lost_card_ends_a_job_in_shards_with_its_name(umov, scenario, settings, tmp_path, monkeypatch, verb):
    """The worker tells which shard it was and why; finished shards stay, and the same command goes on."""
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    command = [str(word).format(name) for word in SHARDED[verb]] + ["--device", "cuda"]
    settings()
    begun = umov("scale", "run", "job", "--per-shard", 1000, "--part", "1/2", *command)
    assert begun.code in (0, 5), begun.err  # 5: one pass alone, which is the other part's
    monkeypatch.setenv("UMOV_FAKE_LAUNCHES", "1")
    lost = umov("scale", "run", "job")
    assert lost.code == 6 and "CUDA_ERROR_LAUNCH_FAILED" in lost.err, lost.err
    monkeypatch.delenv("UMOV_FAKE_LAUNCHES")
    done = umov("scale", "run", "job")
    assert done.code == 0, done.err
    refused = umov("scale", "run", "other", *command[:-1], "auto")
    assert refused.code == 2 and "--device auto would light some shards" in refused.err


WHITE = ('default = "paper_al"', 'default = "paint_white"')  # light in every attitude, where metal has its lobe's tail


@pytest.fixture
def curve(umov, scenario, request):
    """A light curve of a cubesat in its own attitude, by the processor: (file, scenario)."""
    name = scenario(*getattr(request, "param", []))
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    assert umov("run", name, "-o", "seen", "-q").code == 0
    return "seen/lightcurve.ecsv", name


QUESTIONS = {"pose": ("--grid", 1000), "spin": ("--period", 100),
             "material": ("--group", "body_px", "--candidates", "paint_white,cell_gaas"),
             "health": ("--drift", "body_px=paint_white")}


@pytest.mark.parametrize("question", QUESTIONS)
def test_an_inversion_without_its_card_ends_with_6(umov, curve, settings, question):
    settings(UMOV_FAKE_INIT=100)
    refused = umov("invert", question, curve[0], "--scenario", curve[1], *QUESTIONS[question], "--visibility", "masks",
                   "--device", "cuda")
    assert refused.code == 6 and "CUDA_ERROR_NO_DEVICE" in refused.err, refused.err


@pytest.mark.parametrize("question", ["material", "health"])
def test_an_inversion_on_a_card_answers_as_the_processor_does(umov, curve, settings, tmp_path, question):
    settings()
    answers = {}
    for device in ("cpu", "cuda"):
        done = umov("invert", question, curve[0], "--scenario", curve[1], *QUESTIONS[question], "--visibility", "masks",
                    "--device", device, "-o", device)
        assert done.code == 0, done.err
        answers[device] = json.loads((tmp_path / device / "verdict.json").read_text())
        light = json.loads((tmp_path / device / "manifest.json").read_text())["light"]
        assert [one["device"] for one in light] == ["cpu" if device == "cpu" else "Card of paper"]
    assert answers["cpu"]["verdict"] == answers["cuda"]["verdict"]
    for ours, theirs in zip(answers["cpu"][question + "s" if question == "material" else question],
                            answers["cuda"][question + "s" if question == "material" else question]):
        key = "fraction" if question == "material" else "change"
        error = ours[key + "_err"]  # parity of light is a hundredth of the errors of a fit
        assert abs(ours[key] - theirs[key]) <= 0.05 * error + 1e-9


def ball(folder):
    """within(q): whether an attitude lies in the 95 % set of a folder."""
    table = Table.read(folder / "set95.ecsv")
    centres = np.column_stack([table[name] for name in ("qw", "qx", "qy", "qz")])

    def within(q):
        return bool(np.any(2 * np.degrees(np.arccos(np.minimum(1, np.abs(centres @ q)))) <= table["radius_deg"]))

    return within


@pytest.mark.long
@pytest.mark.parametrize("curve", [[WHITE]], indirect=True)
def test_an_attitude_by_the_light_of_a_card(umov, curve, settings, tmp_path):
    """The same evidence, and the best attitude of each in the other's set.

    Not the verdicts, nor where the heaviest mode is: many attitudes explain 13 epochs, and the last digits of the light
    decide which of two nearby ones the search keeps."""
    settings()
    # By a thousand attitudes, 25 deg apart, it misses peaks, others for other digits (ln evidence 1 to 3 below that of 8000).
    command = ("invert", "pose", curve[0], "--scenario", curve[1], "--grid", 8000, "--visibility", "masks")
    answers = {}
    for device in ("cpu", "cuda"):
        done = umov(*command, "--device", device, "-o", device)
        assert done.code == 0, done.err
        answers[device] = json.loads((tmp_path / device / "verdict.json").read_text())
    # A factor of e is "not worth more than a bare mention" (Kass, Raftery 1995, section 3.2); the sampling leaves some tenths.
    assert abs(answers["cpu"]["log_evidence"] - answers["cuda"]["log_evidence"]) < 1
    for ours, theirs in (("cpu", "cuda"), ("cuda", "cpu")):
        best = max(answers[ours]["modes"], key=lambda mode: mode["weight"])
        assert ball(tmp_path / theirs)(best["q"]), f"the best attitude of {ours} is outside the set of {theirs}"


def test_a_library_by_the_light_of_a_card(umov, scenario, settings, tmp_path, monkeypatch):
    names = [scenario(WHITE), scenario(WHITE, name="second.toml")]  # light that 325 poses can tell
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    command = ("library", "build", *names, "-o", "lib", "--cells", 4, "--json", "--device")

    def states(device):
        done = umov(*command, device)
        assert done.code == 0, done.err
        return [row["state"] for row in json.loads(done.out)]

    settings(UMOV_FAKE_LAUNCHES=7)  # sums and light of the first object take three each
    lost = umov(*command, "cuda")
    assert lost.code == 6 and "Finished objects stay, and the same command goes on" in lost.err, lost.err
    monkeypatch.delenv("UMOV_FAKE_LAUNCHES")
    assert states("cuda") == ["was there", "made"]
    assert states("cuda") == ["was there"] * 2
    assert states("cpu") == ["made"] * 2  # other digits: made anew
    settings(UMOV_FAKE_INIT=100)
    assert umov(*command, "cuda").code == 6
    told = umov(*(word if word != "lib" else "new" for word in command), "auto")
    assert told.code == 0 and told.err.count("--device auto took the cpu: ") == 1


def test_a_library_of_the_processor_is_none_of_a_card(umov, scenario, settings, tmp_path, monkeypatch):
    """Cards that auto finds and cannot use light nothing; auto takes what is there from whoever made it."""
    name = scenario(('default = "paper_al"', 'default = "paint_white"'))
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0

    def state(device):
        done = umov("library", "build", name, "-o", "lib", "--cells", 4, "--json", "--device", device)
        assert done.code == 0, done.err
        return json.loads(done.out)[0]["state"]

    settings(UMOV_FAKE_FULL=0)
    assert state("auto") == "made"
    assert b"Card of paper" not in (tmp_path / "lib/scenario.umovsig").read_bytes()
    monkeypatch.delenv("UMOV_FAKE_FULL")
    assert state("cpu") == "was there"
    assert state("auto") == "was there"
    assert state("cuda") == "made"
    assert b"Card of paper" in (tmp_path / "lib/scenario.umovsig").read_bytes()
    assert state("auto") == "was there"
    settings(UMOV_FAKE_CARDS=2)
    assert state("cuda") == "was there"
    settings(UMOV_FAKE_CARDS=0)
    assert state("auto") == "was there"
    assert state("cpu") == "made"


@pytest.mark.long
def test_a_library_of_cards_is_searched_by_the_processor_without_a_warning(umov, curve, settings, monkeypatch):
    settings()
    observed, name = curve
    assert umov("library", "build", name, "-o", "lib", "--cells", 4, "--device", "cuda", "-q").code == 0
    monkeypatch.delenv("UMOV_CUDA_PATH")
    done = umov("identify", observed, "--library", "lib", "--scenario", name, "--objects", name)
    assert done.code in (0, 4), done.err
    assert "is not what its signature was made from" not in done.err, done.err


def test_a_library_that_tells_nothing_is_read_and_told(umov, scenario, tmp_path):
    """A mirror of the paper's aluminium in 4 cells: its glints lie between the nodes."""
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    for state in ("made", "was there"):
        done = umov("library", "build", name, "-o", "lib", "--cells", 4, "--json")
        assert done.code == 0, done.err
        row, = json.loads(done.out)
        assert row["state"] == state and row["error"] > 1e6, row
        assert ("scenario: between its nodes the light is off by" in done.err) == (state == "made"), done.err


@pytest.mark.slow
def test_bench_puts_cards_beside_cores(umov, settings, tmp_path):
    settings()
    assert umov("mesh", "make", "box-wing", "--facets", 200, "-o", "box.obj").code == 0
    command = ("bench", "--mesh", "box.obj", "--seconds", 0.01, "--geometries", 0, "-q")
    done = umov(*command, "--device", "cuda", "--batches", "1,300", "-c", "all", "-o", "b.csv")
    assert done.code == 0, done.err
    table = read_csv(tmp_path / "b.csv")
    assert [row["bands"] for row in table] == ["1"] * 4 + ["3"] * 4 + ["16"] * 4
    assert [row["batch"] for row in table[2:4]] == ["1", "300"]
    assert [row["instruction_set"] == "Card of paper" for row in table[:4]] == [False, False, True, True]
    assert all(float(row["poses_per_s"]) > 0 for row in table)
    assert umov(*command, "--batches", "5").code == 2
    settings(UMOV_FAKE_INIT=100)
    assert umov(*command, "--device", "cuda").code == 6
    told = umov("bench", "--only", "flat panel, 2 ", "--seconds", 0.01, "--geometries", 0, "--device", "auto", "-o", "c.csv")
    assert told.code == 0 and "--device auto took the cpu: " in told.err


def test_parity_looks_into_all_folders_that_are_named(tmp_path):
    """tools/gpu_check hands UMOV_CUDA_PATH to the tests of cards as it is."""
    done = subprocess.run([ROOT / "build/release/src/light/umov_cards_tests", "--gtest_filter=Cards.AbundancesAreThoseOfTheProcessor"],
                          env={**os.environ, "UMOV_TEST_CUDA": f"/nowhere:{FAKE}", "TEST_TMPDIR": str(tmp_path)}, text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stdout


def test_gpu_check_without_a_card(settings):
    settings(UMOV_FAKE_INIT=100)
    done = subprocess.run([ROOT / "tools/gpu_check"], text=True, capture_output=True, timeout=60)
    assert done.returncode == 6 and "there is no card to check" in done.stderr, done.stderr
