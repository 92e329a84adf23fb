# %% [markdown]
# # A BRDF as it was measured
# A laboratory gives a table of angles and Mueller matrices. Here it is the example that comes with umov; a real one
# has the same columns.

# %%
import matplotlib.pyplot as plt
import numpy as np
import umov

print("\n".join(umov.example("panel_brdf.csv").read_text().splitlines()[2:5]))

# %% [markdown]
# As a material: between the rows it is interpolated, beyond them refused.

# %%
panel = umov.Material(str(umov.example("measured_panel.toml")))
print(panel, panel.range_nm, panel.source, sep="\n")
try:
    panel.brdf(wavelength_nm=700)
except umov.Error as error:
    print(type(error).__name__, error)

# %% [markdown]
# Beside the model of the library that the table was made from: what 30 degrees between rows cost.

# %%
theta = np.linspace(0, 80, 81)
figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for material, style in ((panel, "-"), (umov.Material("paint_white"), "--")):
    f = material.brdf(550, theta_i_deg=40, theta_o_deg=theta, phi_deg=180)
    axes[0].plot(theta, f[:, 0, 0], style, label=material.name)
    axes[1].plot(theta, 100 * f[:, 1, 0] / f[:, 0, 0], style)
axes[0].set(xlabel="reflection [°]", ylabel="BRDF [1/sr]", title="light at 40°")
axes[1].set(xlabel="reflection [°]", ylabel="Q/I [%]")
axes[0].legend()
plt.show()

# %% [markdown]
# On an object: a sheet of one square metre, front as measured, back black.

# %%
sheet = ([[-.5, -.5, 0], [.5, -.5, 0], [.5, .5, 0], [-.5, .5, 0]], [[0, 1, 2], [0, 2, 3]])
plate = umov.Satellite(mesh=sheet, materials={"default": {"front": panel, "back": "paint_black"}}, name="sheet")
stokes = umov.Engine(plate, bands=["nm:550"]).evaluate([0, 0, 1], [[0, 1, 1], [0, 1, -1]])
print(f"front {stokes[0, 0, 0]:.4f} m2/sr, back {stokes[1, 0, 0]:.4f}: it is not lit from there")
