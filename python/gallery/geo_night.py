# %% [markdown]
# # A geostationary night, with panels that follow the Sun
# A box with two wings stays at one place of the sky all night; the Sun goes round it, and the wings with the Sun.

# %%
import tempfile
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import umov


# %% [markdown]
# A shape with named groups is a file: boxes from their middle and size. +Z looks at the Earth, the wings lie along +Y,
# which is south of the orbit or north.

# %%
corner = np.array([[x, y, z] for x in (-.5, .5) for y in (-.5, .5) for z in (-.5, .5)])
sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
lines: list[str] = []
for k, (name, middle, size) in enumerate((("body", (0, 0, 0), (2, 2, 3)), ("wing", (0, 6, 0), (.05, 9, 2.4)),
                                          ("wing", (0, -6, 0), (.05, 9, 2.4)))):
    lines += [f"v {x} {y} {z}" for x, y, z in np.array(middle) + corner * np.array(size)]
    lines += [f"usemtl {name}"] + ["f " + " ".join(str(8 * k + c + 1) for c in side) for side in sides]
mesh = Path(tempfile.mkdtemp()) / "geo.obj"
mesh.write_text("\n".join(lines) + "\n")

# %%
goes = umov.Satellite(mesh=mesh, unit="m", up="+Z", orbit=umov.example("goes15.tle"), name="GEO",
                      attitude={"point": "+Z", "at": "nadir", "then": "+Y", "toward": "orbit_normal"},
                      materials={"body": "mli_kapton", "wing": "cell_silicon"},
                      parts=[{"name": "wings", "groups": ["wing"], "axis": "+Y", "face": "+X", "toward": "sun"}])
held = umov.Satellite.from_dict({key: value for key, value in goes.to_dict().items() if key != "part"})

# %% [markdown]
# A night from Maui in January, every five minutes: with wings that follow the Sun, and with wings that stand still.

# %%
def night(of: umov.Satellite, date: str, hours: tuple[int, int] = (5, 16), step_s: float = 300) -> umov.LightCurve:
    return of.light_curve("maui", f"{date}T{hours[0]:02}:00Z", f"{date}T{hours[1]:02}:00Z", step_s=step_s,
                          bands=["nm:550"], allow_old_elements=True)


january = {name: night(one, "2018-01-21") for name, one in (("following", goes), ("held", held))}
for name, curve in january.items():
    best = int(np.nanargmin(curve.mag[:, 0]))
    print(f"{name}: mag {curve.mag[best, 0]:.1f} at phase {curve.phase_angle[best]:.0f} deg, "
          f"altitude {curve.alt[best]:.1f} deg")

# %% [markdown]
# Hardly a difference: the wings look at the Sun and mirror it past us, to the north. Their axis is that of the Earth, so
# they follow the Sun's right ascension but not its declination. The mirrored light stands as far north as the Sun stands
# south, and Maui is 3.5 degrees north as the satellite sees it: around the equinoxes it is met, unless the satellite
# stands in the Earth's shadow just then. (The elements are weeks old by then: a warning says so, and for a place on the
# ring it does not matter.)

# %%
warnings.simplefilter("ignore", umov.UmovWarning)
dates = [str(day) for day in np.arange("2018-02-13", "2018-03-23", 2, dtype="datetime64[D]")]
brightest = {name: [float(np.nanmin(night(one, date, (7, 11), 120).mag)) for date in dates]
             for name, one in (("following", goes), ("held", held))}
season = dates[int(np.argmin(brightest["following"]))]
print(f"brightest on {season}: mag {min(brightest['following']):.1f}")

# %%
figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for (name, values), colour in zip(brightest.items(), ("#0072b2", "#d55e00")):
    axes[0].plot(np.array(dates, dtype="datetime64[D]"), values, ".-", color=colour, label=name)
axes[0].invert_yaxis()
axes[0].set(ylabel="brightest AB magnitude of the night")
axes[0].tick_params("x", rotation=30)
axes[0].legend()
umov.plot.magnitude(night(goes, season, (7, 11), 60), axes[1])
axes[1].set_title(season, fontsize="medium")
plt.show()
