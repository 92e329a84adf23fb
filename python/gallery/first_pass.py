# %% [markdown]
# # My first pass
# When does the Hubble Space Telescope pass over Maui, and what does a polarimeter see of it?

# %%
import matplotlib.pyplot as plt
import umov

hst = umov.Satellite(mesh=umov.example("hst.obj"), unit="m", up="+Z", normals="smooth", orbit=umov.example("hst.tle"),
                     attitude={"point": "+Z", "at": {"ra_deg": 83.8, "dec_deg": -5.4}, "then": "+X", "toward": "sun"},
                     materials={"array_front": "cell_silicon", "array_back": "mli_kapton", "antenna": "paint_white",
                                "light_shield": "film_aluminized", "baffle": "paint_black", "forward_shell": "film_aluminized",
                                "default": "aluminium_anodized"}, name="HST")

# %% [markdown]
# Passes come with the magnitudes of this very body: the columns of `umov passes`, as an astropy table.

# %%
table = umov.passes(hst, "maui", "2018-01-21T04:00Z", "2018-01-21T07:00Z")
table["rise_utc", "culmination_alt", "set_utc", "mag_min", "p_max"].pprint(max_width=-1)

# %% [markdown]
# The light of the first one, every five seconds, in the three bands of the paper.

# %%
curve = hst.light_curve("maui", table[0], step_s=5)
print(curve)
curve.plot()
plt.show()

# %% [markdown]
# The same pass as a cloud of Q/I in three bands, to be turned with the mouse: one material alone would lie on a line.

# %%
umov.turnable.q_rgb(curve)

# %% [markdown]
# And the mesh, a colour for each of its materials.

# %%
umov.turnable.mesh(hst)
