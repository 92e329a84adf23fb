# %% [markdown]
# # A catalogue's night
# Every object of a file at every minute of an hour, and which of them stand above a site.

# %%
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import umov
from astropy import units as u
from astropy.time import Time

catalogue = Path(tempfile.mkdtemp()) / "catalogue.tle"
catalogue.write_text("".join(umov.example(name).read_text() for name in ("hst.tle", "agena733.tle")))

# %% [markdown]
# Arrays (object, time, 3), views of the library's memory; astropy's times go in as they are.

# %%
times = Time("2018-01-21T04:00:00") + np.arange(60) * u.min
states = umov.propagate(catalogue, list(times))
radius = np.linalg.norm(states.position_km, axis=-1)
for number, row in zip(states.norad_cat_id, radius):
    print(f"{number}: {row.min():.0f} to {row.max():.0f} km from the Earth's centre")

# %%
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.plot(times.datetime64, radius.T - 6378.137, label=[str(number) for number in states.norad_cat_id])
axes.set_ylabel("height above the equator's radius [km]")
axes.legend(title="catalogue number")
plt.show()

# %% [markdown]
# The night's passes of all of them, sunlit in a dark sky.

# %%
table = umov.passes(catalogue, "maui", times[0], "2018-01-21T16:00Z", visible_only=True)
print(table["norad_cat_id", "rise_utc", "culmination_alt", "visible"])
