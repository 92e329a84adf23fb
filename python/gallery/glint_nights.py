# %% [markdown]
# # Which nights will it glint?
# A flat part mirrors the Sun to the site for a second or so, if the attitude is held. The three antennas of the first
# Iridium satellites did: silvered plates of 0.9 m x 1.9 m that lean 40 degrees from the vertical (Maley & Pizzicaroli
# 2003). Such a body, on the orbit of HST, over Maui for a week.

# %%
import matplotlib.pyplot as plt
import numpy as np
import umov
from astropy.table import QTable
from astropy.time import Time



def antenna(azimuth_deg: float) -> list[list[float]]:
    """Corners of a plate whose normal points 40 degrees below the horizon, seen from outside."""
    azimuth, lean = np.radians([azimuth_deg, 40.0])
    out = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    along = np.array([-out[1], out[0], 0.0])
    down = np.array([0.0, 0.0, -1.0])
    slope = np.cos(lean) * down - np.sin(lean) * out
    middle = 0.8 * out
    return [(middle + x * 0.44 * along + y * 0.93 * slope).tolist() for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1))]


vertices = [corner for azimuth in (0, 120, 240) for corner in antenna(azimuth)]
faces = [[4 * k + a, 4 * k + b, 4 * k + c] for k in range(3) for a, b, c in ((0, 1, 2), (0, 2, 3))]

# %% [markdown]
# Long axis down; how the body is turned about it (yaw) nobody told us. So ask for every ten degrees: 120 bring the next
# antenna to the same place.

# %%
def passes_for(yaw_deg: float) -> tuple[umov.Satellite, QTable]:
    bird = umov.Satellite(mesh=(vertices, faces), orbit=umov.example("hst.tle"), name="antennas", materials="film_silvered",
                          attitude={"point": "-Z", "at": "nadir", "then": "+X", "toward": "velocity", "yaw_deg": yaw_deg})
    return bird, umov.passes(bird, "maui", "2018-01-20T00:00Z", "2018-01-27T00:00Z", visible_only=True, bands=["nm:550"])


yaws = np.arange(0, 120, 10)
asked = [passes_for(float(yaw)) for yaw in yaws]
for yaw, (_, table) in zip(yaws, asked):
    for row in table[table["glints"] != ""]:
        print(f"yaw {yaw:3d}: glint at {row['glints']}, {row['glint_widths']} s wide, mag {row['mag_min'].value:.1f}")

# %% [markdown]
# Passes by night and yaw: the brightest magnitude of each. Glints last seconds, and two degrees of yaw move them to
# another night; between them the antennas are near the mirror direction and the pass is bright all the same.

# %%
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
best = np.array([table["mag_min"].value for _, table in asked])
names = [str(when)[5:16] for when in asked[0][1]["culmination_utc"]]
drawn = axes.pcolormesh(np.arange(best.shape[1] + 1), np.append(yaws, 120), best, cmap="cividis_r")
axes.set_xticks(np.arange(len(names)) + 0.5, names, rotation=60, ha="right", fontsize="small")
axes.set_ylabel("yaw [°]")
figure.colorbar(drawn, ax=axes, label="brightest AB magnitude")
plt.show()

# %% [markdown]
# The brightest of all, second by second.

# %%
which, number = np.unravel_index(np.nanargmin(best), best.shape)
bird, table = asked[int(which)]
curve = bird.light_curve("maui", table[int(number)], step_s=0.5, bands=["nm:550"])
axes = umov.plot.magnitude(curve)
for mark in str(table["glints"][int(number)]).split():
    axes.axvline(Time(mark.rstrip("Z")).datetime64, color="#d55e00", linestyle=":")
axes.set_title(f"yaw {yaws[which]}°: dotted where the glint was foretold", fontsize="medium")
plt.show()
