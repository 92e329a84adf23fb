# %% [markdown]
# # What does roughness do to polarization?
# The degree of linear polarization that a surface makes of sunlight depends on the phase angle, through the
# angle of incidence on its microfacets, and hardly on how rough it is: roughness spreads the same light.

# %%
import matplotlib.pyplot as plt
import numpy as np
import umov

theta = np.arange(5.0, 86.0, 5.0)

# %% [markdown]
# In the mirror direction, for a glass of several roughnesses, with and without light from below the surface.

# %%
figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained", sharey=True)
for body, axis in zip((None, {"reflectance": 0.2}), axes):
    for alpha, style in ((0.1, "-"), (0.3, "--"), (0.6, ":")):
        glass = umov.Material.from_dict("glass", {
            "index": {"n": 1.5, "k": 0.0}, "distribution": {"model": "ggx", "alpha": alpha}, "body": body})
        f = glass.brdf(550, theta_i_deg=theta, theta_o_deg=theta, phi_deg=180)
        axis.plot(theta, 100 * f[:, 1, 0] / f[:, 0, 0], style, label=f"alpha {alpha}")
    axis.set(title="with body light" if body else "surface alone", xlabel="incidence = reflection [°]")
axes[0].set_ylabel("Q/I [%]")
axes[0].legend()
plt.show()

# %% [markdown]
# Brewster's angle of n = 1.5 is 56.3 deg: there all of the reflected light is polarized.

# %%
smooth = umov.Material.from_dict("glass", {"index": {"n": 1.5, "k": 0.0}, "distribution": {"model": "ggx", "alpha": 0.1}})
brewster = np.degrees(np.arctan(1.5))
f = smooth.brdf(550, theta_i_deg=brewster, theta_o_deg=brewster, phi_deg=180)
print(f"Q/I at {brewster:.1f} deg: {f[1, 0] / f[0, 0]:.6f}")
assert abs(f[1, 0] / f[0, 0] - 1) < 1e-9
