# %% [markdown]
# # Earthshine and the body's own heat
# Besides the Sun, the Earth lights a satellite, and a warm body shines by itself in the infrared. What does each bring?

# %%
import matplotlib.pyplot as plt
import numpy as np
import umov


# %% [markdown]
# A pass of HST over Maui with the light of a Lambert Earth (`render.earthshine`), which has columns of its own: `I` does
# not hold it.

# %%
curve = umov.run(umov.example("hst_maui.toml"), set={
    "render.earthshine.albedo": 0.3, "bands.set": ["nm:550"], "time.start": "2018-01-21T05:07:00Z",
    "time.stop": "2018-01-21T05:16:00Z", "time.step_s": 15, "time.only.sunlit": False})
sun, earth = curve.I[:, 0], curve["earth_I"][:, 0]
sunlit = sun > 0
share = earth[sunlit] / (sun + earth)[sunlit]
print(f"while the Sun shines the Earth brings {share.min():.1%} to {share.max():.1%} of the light")

# %% [markdown]
# The Earth lights faces that the Sun does not, so where the Sun's side is turned away it is most of what is seen. Its
# light has been to many places of the Earth's disk and is hardly polarized: p of the sum is smaller.

# %%
q, u = ((curve[name][sunlit, 0] * sun[sunlit] + curve[f"earth_{name}"][sunlit, 0] * earth[sunlit])
        / (sun + earth)[sunlit] for name in "qu")

# %% [markdown]
# Heat: a white sheet at 300 K, seen more and more obliquely, at wavelengths where its index is known. What it emits is
# polarized the other way round than what it reflects: a surface that reflects s takes p, and gives it back (Kirchhoff).

# %%
sheet = ([[-.5, -.5, 0], [.5, -.5, 0], [.5, .5, 0], [-.5, .5, 0]], [[0, 1, 2], [0, 2, 3]])
metal = umov.Material.from_dict("metal", {"index": {"n": 2.5, "k": 10.0}, "distribution": {"model": "ggx", "alpha": 0.1}})
plate = umov.Satellite(mesh=sheet, materials=metal, name="sheet")
angle = np.radians(np.arange(0, 86, 2.5))
observer = np.stack([np.zeros_like(angle), np.sin(angle), np.cos(angle)], axis=-1)
heat = {}
for micron in (5, 10):
    warm = umov.Engine(plate, bands=[f"nm:{1000 * micron}"], temperatures=["300"], set={"render.method": "rays"})
    heat[micron] = warm.evaluate([0, 0.01, 1], observer)[:, 0]
    print(f"{micron} um: {heat[micron][0, 0]:.3g} W/(sr nm) from in front")

# %%
figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
axes[0].semilogy(curve.phase_angle, sun, label="Sun")
axes[0].semilogy(curve.phase_angle, earth, label="Earth")
axes[0].set(xlabel="phase angle [°]", ylabel="I [W m⁻² nm⁻¹]")
axes[0].legend()
axes[1].plot(curve.phase_angle, 100 * curve.p[:, 0], label="Sun alone")
axes[1].plot(curve.phase_angle[sunlit], 100 * np.hypot(q, u), label="with the Earth")
axes[1].set(xlabel="phase angle [°]", ylabel="p [%]")
axes[1].legend()
for (micron, light), style in zip(heat.items(), ("-", "--")):
    axes[2].plot(np.degrees(angle), 100 * np.hypot(light[:, 1], light[:, 2]) / light[:, 0], style, label=f"{micron} µm")
axes[2].set(xlabel="seen at [°] from the normal", ylabel="p of the heat [%]")
axes[2].legend()
plt.show()
