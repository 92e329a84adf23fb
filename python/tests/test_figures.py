"""Figures of poses and of anybody's tables; what stands over those of one band."""
import matplotlib
import numpy as np
import pandas as pd
import pytest
from astropy import units as u

import umov
from conftest import EXAMPLES
from umov import plot

matplotlib.use("Agg")
T = np.arange(0, 120, 0.5)
MINE = {"mjd_utc": 60000 + T / 86400, "mag": 7 + 0.3 * np.sin(2 * np.pi * T / 8.2)}


@pytest.fixture(autouse=True)
def no_figure_stays():
    yield
    import matplotlib.pyplot as plt
    plt.close("all")


def _best(light, **more):
    """The period in the title [s]."""
    return float(plot.periodogram(light, **more).get_title().removesuffix(" s"))


@pytest.mark.parametrize("make", [lambda: MINE, lambda: pd.DataFrame(MINE), lambda: {**MINE, "band": ["V"] * len(T)}])
def test_a_table_has_a_periodogram_and_folds(make):
    """A sine of 8.2 s: its peak, and the magnitude of each part of a turn."""
    assert _best(make()) == pytest.approx(8.2, abs=0.01 * 8.2**2 / 120)  # a hundredth of the peak's width
    part, mag = plot.folded(make(), 8.2).collections[0].get_offsets().T
    np.testing.assert_allclose(mag, 7 + 0.3 * np.sin(2 * np.pi * part), atol=1e-3)  # of days with eleven decimals: 1 us of 8 s


def test_gaps_begin_lines_and_bands_are_chosen():
    two = {"mjd_utc": np.concatenate([MINE["mjd_utc"], MINE["mjd_utc"] + 0.1]), "mag": np.tile(MINE["mag"], 2)}
    assert len(plot.periodogram(two).lines) == 2
    assert len(plot.periodogram(two, gap_s=10000).lines) == 1
    both = {"mjd_utc": np.tile(MINE["mjd_utc"], 2), "mag": np.concatenate([MINE["mag"], 5 + 0 * T + 0.1 * np.sin(2 * np.pi * T / 20)]),
            "band": ["V"] * len(T) + ["R"] * len(T)}
    assert _best(both, band="R") == _best(both, band=0) == pytest.approx(20, abs=0.01 * 20**2 / 120)
    for band, told in ((7, "no band 7; there are R, V"), ("B", "it has R, V"), ("", 'band is ""')):
        with pytest.raises(umov.Error, match=told):
            plot.folded(both, 20, band=band)


def test_poses_are_a_cloud(glass):
    engine = umov.Engine(glass, bands="paper_rgb", method="rays")
    sun, observer = umov.random_poses(60, phase_deg=50)
    light = engine.light(sun, observer)
    axes = plot.q_rgb(light.stokes, bands=engine.bands, phase_deg=50)
    lit = light.stokes[..., 0].min(axis=1) > 0
    assert 0 < lit.sum() < 60  # a plate is dark in some
    x, _, z = axes.collections[0]._offsets3d
    np.testing.assert_allclose(np.sort(x), np.sort(100 * light.stokes[lit, 0, 1] / light.stokes[lit, 0, 0]))
    np.testing.assert_allclose(np.sort(z), np.sort(100 * light.stokes[lit, 2, 1] / light.stokes[lit, 2, 0]))
    assert axes.get_zlabel() == "650 nm [%]"
    plot.q_rgb(light, bands=engine.bands)
    for wrong in ({}, {"bands": engine.bands[:2]}, {"bands": engine.bands, "phase_deg": [1, 2, 3]}):
        with pytest.raises(umov.UsageError, match="bands=engine.bands|phase_deg has shape"):
            plot.q_rgb(light, **wrong)


def test_one_band_and_the_site_stand_over_the_figures():
    one = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60, "bands.set": ["Bessell.V"], "title": "my pass"})
    figure = one.plot()
    assert figure.get_suptitle() == "my pass from Maui"
    assert all(axes.get_title(loc="right") == "Bessell.V" for axes in figure.axes)
    assert plot.magnitude(one).get_title(loc="right") == "Bessell.V"
    several = umov.run(EXAMPLES / "hst_maui.toml", set={"time.step_s": 60})
    assert several.plot().get_suptitle() == "HST from Maui, polarized RGB"  # which names its site
    assert plot.magnitude(several).get_title(loc="right") == ""


def test_bands_of_poses_have_forms(hst):
    names = ["nm:450", "nm:550", "nm:650"]
    light = np.ones((5, 3, 4))
    for bands in (umov.Bands(names), np.array([450, 550, 650]) * u.nm, tuple(names)):
        assert plot.q_rgb(light, bands=bands).get_xlabel() == "450 nm [%]"
    for wrong, told in ((5, "bands is 5; names"), ([None, *names[1:]], "bands has None"), ({}, "bands is {}")):
        with pytest.raises(umov.UsageError, match=told):
            plot.q_rgb(light, bands=wrong)
    light[0, 0, 0] = np.nan
    with pytest.raises(umov.UsageError, match="not finite"):
        plot.q_rgb(light, bands=names)
