# %% [markdown]
# # The period of a tumbling stage
# An Agena upper stage turns end over end, and somebody measures its magnitude twice a second during a pass. How fast
# does it turn, and what does polarization add?

# %%
import matplotlib.pyplot as plt
import numpy as np
import umov
from astropy import units as u
from astropy.timeseries import LombScargle

PERIOD_S = 23.7

# %%
agena = umov.Satellite(mesh=umov.example("agena.obj"), unit="m", up="+Z", normals="smooth", orbit=umov.example("agena733.tle"),
                       attitude={"mode": "spin", "axis": "+X", "period_s": PERIOD_S}, name="Agena",
                       materials={"default": "aluminium"})
table = umov.passes(agena.orbit_file, "maui", "2018-01-20T00:00Z", "2018-01-24T00:00Z", visible_only=True, norad=733)
best = table[int(np.argmax(table["culmination_alt"].value))]
curve = agena.light_curve("maui", best, step_s=0.5, bands=["nm:550"], alt_min_deg=10)
print(curve)

# %% [markdown]
# What was measured: magnitudes with 0.05 of noise. The range changes slowly, so brings no period.

# %%
rng = np.random.default_rng(1)
lit = np.isfinite(curve.mag[:, 0])
seconds = (curve.time[lit] - curve.time[0]).to_value(u.s)
reduced = curve.mag[lit, 0] - 5 * np.log10(curve.range[lit] / 1000)
measured = reduced + rng.normal(0, 0.05, lit.sum())

# %% [markdown]
# Lomb-Scargle with four harmonics, as flashes are sharp. A cylinder shows itself twice a turn, so half the period fits
# nearly as well.

# %%
frequency = np.linspace(1 / 120, 1 / 4, 6000)
power = LombScargle(seconds, measured, nterms=4).power(frequency)
found = 1 / frequency[int(np.argmax(power))]
print(f"best period {found:.2f} s; it turns in {PERIOD_S} s: {PERIOD_S / found:.2f} times that")

# %% [markdown]
# Folded with the true period: both halves differ where the ends do. Polarization against the scattering plane follows
# the phase angle and not the turn: for one material it hardly tells the period, but says what the material is.

# %%
figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
axes[0].plot(1 / frequency, power, color="#0072b2")
axes[0].set(xlabel="period [s]", ylabel="power", xlim=(4, 60))
for period in (PERIOD_S, PERIOD_S / 2):
    axes[0].axvline(period, color="#d55e00", linestyle=":")
axes[1].plot(seconds % PERIOD_S / PERIOD_S, measured, ".", markersize=3, color="#0072b2")
axes[1].invert_yaxis()
axes[1].set(xlabel="turn", ylabel="magnitude at 1,000 km")
drawn = axes[2].scatter(curve.phase_angle[lit], 100 * curve.q_scat[lit, 0], c=seconds % PERIOD_S / PERIOD_S, s=5,
                        cmap="twilight")
axes[2].set(xlabel="phase angle [°]", ylabel="q_scat [%]")
figure.colorbar(drawn, ax=axes[2], label="turn")
plt.show()
