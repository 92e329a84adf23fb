"""A sphere on Hubble's orbit over Maui, for all that umov observe is asked."""
from conftest import ROOT

SCENE = """umov = 1
seed = {seed}
instrument = "{instrument}"
[observer]
name = "Maui"
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = {alt_m}
[time]
start = {start}
stop = {stop}
[[object]]
name = "ball"
orbit = {{ file = "{root}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "sphere.obj", unit = "m", up = "+Z" }}
materials = {{ default = "{material}" }}
[atmosphere]
{atmosphere}
{telescope}
[observation]
{observation}
[output]
dir = "out"
formats = ["ecsv"]
pol_frame = "{frame}"
"""


def write_scene(folder, observation, *, instrument="c11_imx250", atmosphere="seeing = { arcsec = 3 }", telescope="",
                material="paint_white", seed=0, frame="altaz", alt_m=3058, start="2018-01-21T05:11:00Z",
                stop="2018-01-21T05:11:05Z"):
    """Writes observe.toml beside sphere.obj; what is given are lines of the sections of its name."""
    path = folder / "observe.toml"
    path.write_text(SCENE.format(root=ROOT, observation=observation, instrument=instrument, atmosphere=atmosphere,
                                 telescope=telescope and "[telescope]\n" + telescope, material=material, seed=seed, frame=frame, alt_m=alt_m,
                                 start=start, stop=stop))
    return path


def make_sphere(umov, radius_m, facets=1000):
    """sphere.obj of so many facets."""
    assert umov("mesh", "make", "sphere", "--radius", radius_m, "--facets", facets, "-o", "sphere.obj").code == 0
