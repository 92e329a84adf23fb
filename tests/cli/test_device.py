"""--device: cards by a driver without one (src/backend/cuda/tests), and what is said where there is none."""
import os

import pytest

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


def test_what_lacks_ends_with_6_or_a_line(signature, settings, tmp_path):
    settings(UMOV_FAKE_INIT=100)
    refused = signature("a.csv", "--device", "cuda")
    assert refused.code == 6 and "CUDA_ERROR_NO_DEVICE" in refused.err
    assert not (tmp_path / "a.csv").exists()
    told = signature("b.csv", "--device", "auto")
    assert told.code == 0 and "--device auto took the cpu: " in told.err
    assert sum(line.startswith("warning") for line in told.err.splitlines()) == 1


def test_what_cards_do_not_light_is_refused_by_name(signature, settings):
    settings()
    refused = signature("a.csv", "--device", "cuda", visibility="rays")
    assert refused.code == 2 and "rays are traced by the processor" in refused.err
    assert signature("a.csv", "--device", "gpu").code == 2


def test_a_lost_card_keeps_what_is_finished(signature, settings, tmp_path, monkeypatch):
    """The first block of 131,072 poses takes two batches, two launches each; then the same command goes on."""
    settings(UMOV_FAKE_LAUNCHES=4)
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
    assert done.code == 0 and "going on from" not in done.err, done.err
    assert umov("run", name, "-o", "cpu", *blocks).code == 0
    assert (tmp_path / "out/lightcurve.ecsv").read_text() == (tmp_path / "cpu/lightcurve.ecsv").read_text()


def test_a_run_on_cards_mends_by_rays(umov, scenario, settings, tmp_path):
    name = scenario()
    assert umov("mesh", "make", "cubesat", "--units", 3, "--panels", 2, "-o", "cube.obj").code == 0
    settings()
    assert umov("run", name, "-o", "cpu").code == 0
    done = umov("run", name, "-o", "card", "--device", "cuda")
    assert done.code == 0, done.err
    assert "Card of paper" in (tmp_path / "card/manifest.json").read_text()
