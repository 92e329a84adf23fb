# %% [markdown]
# # My own photometry beside the model
# A night's table of magnitudes and polarization: which of two stories about the object fits, and what is left over?

# %%
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import umov
from astropy import units as u
from astropy.table import QTable
from astropy.time import Time
from numpy.typing import NDArray

SPAN = ("2018-01-21T05:08:00Z", "2018-01-21T05:15:00Z")


def telescope(shield: str) -> umov.Satellite:
    """HST with a story about its tube: foil or paint."""
    return umov.Satellite(mesh=umov.example("hst.obj"), unit="m", up="+Z", normals="smooth", orbit=umov.example("hst.tle"),
                          attitude={"point": "+Z", "at": {"ra_deg": 83.8, "dec_deg": -5.4}, "then": "+X", "toward": "sun"},
                          materials={"array_front": "cell_silicon", "array_back": "mli_kapton", "antenna": "paint_white",
                                     "baffle": "paint_black", "default": shield}, name="HST")


# %% [markdown]
# The table. Yours comes from a telescope; this one is made here, of a tube of anodized aluminium, brought to a telescope
# by 0.4 mag of air and glass, with noise: a file with a time, a magnitude and a degree of polarization, and their errors.

# %%
truth = telescope("aluminium_anodized").light_curve("maui", *SPAN, step_s=7, bands=["nm:550"])
rng = np.random.default_rng(7)
lit = np.isfinite(truth.p[:, 0])
table = QTable({"time": truth.time[lit].isot, "mag": truth.mag[lit, 0] + 0.4 + rng.normal(0, 0.04, lit.sum()),
                "p": truth.p[lit, 0] + rng.normal(0, 0.01, lit.sum())})
file = Path(tempfile.mkdtemp()) / "mine.ecsv"
table.write(file)

# %% [markdown]
# Read back as if nothing were known of it. The model is asked for a finer grid and taken between its epochs at the times
# of the measurements; the zero point is free, so the mean of the residuals is taken off.

# %%
mine = QTable.read(file)
times = Time(mine["time"])


def residuals(shield: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    model = telescope(shield).light_curve("maui", *SPAN, step_s=2, bands=["nm:550"])
    good = np.isfinite(model.p[:, 0])
    grid = (model.time[good] - times[0]).to_value(u.s)
    at = (times - times[0]).to_value(u.s)
    magnitude = np.asarray(mine["mag"]) - np.interp(at, grid, model.mag[good, 0])
    return magnitude - np.median(magnitude), np.asarray(mine["p"]) - np.interp(at, grid, model.p[good, 0])


# %% [markdown]
# Foil makes nearly the same polarization as aluminium, paint hardly any; magnitudes part foil from aluminium.

# %%
figure, axes = plt.subplots(2, 1, figsize=(7, 5), layout="constrained", sharex=True)
for shield, colour in (("aluminium_anodized", "#0072b2"), ("paint_white", "#d55e00"), ("film_silvered", "#009e73")):
    magnitude, p = residuals(shield)
    chi = np.mean((magnitude / 0.04) ** 2), np.mean((p / 0.01) ** 2)
    print(f"{shield:20} chi squared per point: magnitude {chi[0]:8.1f}, p {chi[1]:8.1f}")
    axes[0].plot(times.datetime64, magnitude, ".", color=colour, label=shield)
    axes[1].plot(times.datetime64, 100 * p, ".", color=colour)
axes[0].set(ylabel="magnitude, mine − model", ylim=(1.5, -1.5))
axes[1].set(ylabel="p, mine − model [%]")
axes[1].tick_params("x", rotation=30)
axes[0].legend(fontsize="small")
plt.show()
