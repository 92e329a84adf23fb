"""A scenario around a body that `umov mesh make` makes, for the programs of this folder."""
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
UMOV = ROOT / "build/release/apps/cli/umov"
NADIR = 'attitude = { point = "-Z", at = "nadir", then = "+X", toward = "velocity" }'
SCENARIO = """umov = 1
seed = 1
[observer]
name = "Maui"
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T05:00:00Z
stop = 2018-01-21T05:20:00Z
step_s = 1.0
only = {{ alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true }}
[[object]]
name = "{name}"
orbit = {{ file = "{root}/data/tle/hst.tle", norad = 20580 }}
mesh = {{ file = "{mesh}", unit = "m", up = "+Z", normals = "{normals}" }}
{attitude}
[object.materials]
{materials}
{part}
[bands]
set = "paper_rgb"
"""


def scenario(folder, shape, material, normals="flat", attitude=NADIR, part="", umov=UMOV):
    """folder/NAME.toml of NAME = shape[0]; `shape`: words of `umov mesh make`; `material`: of a group's number and name, as they sort."""
    name = shape[0]
    mesh = folder / f"{name}.obj"
    if not mesh.exists():
        subprocess.run([umov, "mesh", "make", *shape, "-o", mesh, "-q"], check=True)
    groups = sorted({line.split()[1] for line in mesh.read_text().splitlines() if line.startswith("usemtl")})
    materials = "\n".join(f'{group} = "{material(k, group)}"' for k, group in enumerate(groups))
    file = folder / f"{name}.toml"
    file.write_text(SCENARIO.format(name=name, root=ROOT, mesh=mesh, normals=normals, attitude=attitude, materials=materials, part=part))
    return file
