"""device=: cards by a driver without one, as tests/cli/test_device.py has it for the command."""
import numpy as np
import pytest

import umov
from conftest import ROOT

FAKE = ROOT / "build/release/fake_cuda"


@pytest.fixture
def cards(monkeypatch):
    """cards(UMOV_FAKE_INIT=100): the driver without a card is found, and behaves so."""

    def of(**values):
        monkeypatch.setenv("UMOV_CUDA_PATH", str(FAKE))
        for name, value in values.items():
            monkeypatch.setenv(name, str(value))

    return of


def test_device_is_one_of_three(hst):
    with pytest.raises(umov.UsageError, match="device is 'gpu'; cpu, cuda or auto was expected"):
        umov.Engine(hst, bands=["nm:550"], device="gpu")


def test_an_engine_on_a_card(hst, cards, tmp_path):
    cards()
    poses = umov.random_poses(60, phase_deg=60, seed=1)
    ours = umov.Engine(hst, bands=["nm:550"], method="masks", cache=tmp_path)
    theirs = umov.Engine(hst, bands=["nm:550"], method="masks", cache=tmp_path, device="cuda")
    assert (ours.facts["device"], theirs.facts["device"]) == ("", "Card of paper")
    wanted, found = ours.light(*poses), theirs.light(*poses)
    floor = 0.1 * np.median(wanted.stokes[..., 0])  # docs/theory/device.md, "Checks": 2e-4 in the median, 1e-3 at worst
    error = np.abs(found.stokes[..., 0] - wanted.stokes[..., 0]) / np.maximum(wanted.stokes[..., 0], floor)
    assert np.median(error) < 2e-4 and error.max() < 1e-3
    assert (found.is_dark == wanted.is_dark).all()


def test_sums_on_a_card(hst, cards, tmp_path):
    cards()
    poses = umov.random_poses(20, phase_deg=60, seed=1)
    lights = [umov.Sums(hst, cache=tmp_path, device=device) for device in ("cpu", "cuda")]
    wanted, found = [sums.apply(sums.abundances(*poses), bands=["nm:550"]).stokes[..., 0] for sums in lights]
    assert np.allclose(found, wanted, rtol=1e-3, atol=1e-4 * np.median(wanted))


def test_what_lacks_is_raised_or_warned_of(hst, cards, tmp_path):
    cards(UMOV_FAKE_INIT=100)
    with pytest.raises(umov.DeviceError, match="CUDA_ERROR_NO_DEVICE"):
        umov.Engine(hst, bands=["nm:550"], method="masks", cache=tmp_path / "a", device="cuda")
    with pytest.warns(umov.UmovWarning, match='device="auto" took the cpu: '):
        engine = umov.Engine(hst, bands=["nm:550"], method="masks", cache=tmp_path / "b", device="auto")
    assert engine.facts["device"].startswith("cpu: ")


def test_a_library_and_an_inversion_take_a_card(cards, tmp_path):
    cards(UMOV_FAKE_INIT=100)
    scene = ROOT / "examples/agena_maui.toml"
    with pytest.raises(umov.DeviceError, match="CUDA_ERROR_NO_DEVICE"):
        umov.build_library([scene], tmp_path / "lib", cells=4, cache=tmp_path / "c", device="cuda")
    with pytest.warns(umov.UmovWarning, match='device="auto" took the cpu: '):
        umov.build_library([scene], tmp_path / "lib", cells=4, cache=tmp_path / "c", device="auto")
    curve = umov.run(scene, set={"time.step_s": 30, "bands.set": ["nm:550"]})
    with pytest.raises(umov.DeviceError, match="CUDA_ERROR_NO_DEVICE"):
        umov.invert_pose(curve, scene, set={"bands.set": ["nm:550"]}, fit=umov.Fit(grid=1000, method="masks"),
                         cache=tmp_path / "d", device="cuda")
