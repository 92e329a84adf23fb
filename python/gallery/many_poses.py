# %% [markdown]
# # A million poses, and their cloud in Q
# A tumbling cube of two metals, lit 60 and 140 deg from the Sun: each pose is a point in the space of Q/I in
# three bands. Where they lie tells materials apart.

# %%
import time

import matplotlib.pyplot as plt
import numpy as np
import umov

corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
faces = np.array([[a, b, c] for s in sides for a, b, c in ((s[0], s[1], s[2]), (s[0], s[2], s[3]))])

# %%
figure = plt.figure(figsize=(9, 4.5), layout="constrained")
for k, phase in enumerate((60, 140)):
    axes = figure.add_subplot(1, 2, k + 1, projection="3d")
    sun, observer = umov.random_poses(250_000, phase_deg=phase, seed=1)
    for material, colour in (("paper_au", "#e69f00"), ("paper_asi", "#0072b2")):
        engine = umov.Engine(umov.Satellite(mesh=(corner, faces), materials=material, name="cube"))
        begin = time.perf_counter()
        light = engine.light(sun, observer)
        spent = time.perf_counter() - begin
        print(f"{material} at {phase} deg: {len(sun) / spent:,.0f} poses per second, {light.is_dark.mean():.0%} dark")
        bright = light.stokes[:, 1, 0] > np.quantile(light.stokes[:, 1, 0], 0.9)
        q = 100 * light.stokes[bright, :, 1] / light.stokes[bright, :, 0]
        axes.scatter(q[::100, 0], q[::100, 1], q[::100, 2], s=6, color=colour, label=material)
    axes.set(title=f"{phase} deg", xlabel="425 nm [%]", ylabel="550 nm [%]", zlabel="650 nm [%]")
    axes.legend()
plt.show()
