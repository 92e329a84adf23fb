"""The pass of case_r.py before a chamfered box whose attitude is known: light of it with other materials, and tables of what an observer has of it."""
import json
import math
import re

import blind
import case_r
import chamfered_box

BANDS_NM = (425, 550, 650)


def index_of(name):
    """n and k of a shipped table at the three bands, between its rows on straight lines."""
    rows = [tuple(map(float, r)) for r in re.findall(r"^ +([\d.E+-]+) ([\d.E+-]+) ([\d.E+-]+)$", (blind.ROOT / f"data/nk/{name}.yml").read_text(), re.M)]
    out = []
    for nm in BANDS_NM:
        (a, *low), (b, *high) = next((r, s) for r, s in zip(rows, rows[1:]) if r[0] <= nm / 1000 <= s[0])
        part = (nm / 1000 - a) / (b - a)
        out.append([x + part * (y - x) for x, y in zip(low, high)])
    return out


class Box:
    """The box with some of its groups as one (`same`: old and new name). `materials`: of each group of the mesh; `more`: materials in TOML besides those of the box."""

    def __init__(self, o, work, materials, more, epochs, same=()):
        self.o, self.work, self.materials, self.more = o, work, materials, more
        self.step_s = 2 * case_r.HALF_S / (epochs - 1)
        self.text = case_r.scenario(blind.SCENARIO, work).replace('normals = "smooth"', 'normals = "flat"').replace('formats = ["csv"]', 'formats = ["csv"]\ncsv_digits = "all"')
        self.mesh = work / "box.obj"
        chamfered_box.write_mesh(self.mesh)
        mesh = self.mesh.read_text()
        for old, new in same:  # groups that become one
            mesh = re.sub(f"^usemtl {old}$", f"usemtl {new}", mesh, flags=re.M)
        self.mesh.write_text(mesh)

    def scenario(self, name, attitude, method, **other):
        """`other`: groups of another material than the box's."""
        materials = "\n".join(f'{g} = "{m}"' for g, m in {**self.materials, **other}.items())
        path = self.work / f"{name}.toml"
        path.write_text(self.text.format(seed=self.o.seed, name="box", root=blind.ROOT, mesh=self.mesh, law=blind.inertial(attitude), step=self.step_s, materials=materials,
                                         method=method, out=self.work / "truth", span=case_r.SPAN) + chamfered_box.materials_in_toml() + self.more)
        return path

    def light(self, attitude, **other):
        """Rows of a run, as numbers where they are numbers."""
        blind.run(self.o.umov, "run", self.scenario("true", attitude, "rays", **other), "-o", self.work / "truth", "--force", "-q")
        rows = blind.rows_of(self.work / "truth/lightcurve.csv")
        return [{k: row[k] if k in ("time_utc", "band") else float(row[k] or 0) for k in ("time_utc", "band", "I", "intensity", "q", "u")} for row in rows]

    def asked(self, *words):
        return json.loads(blind.run(self.o.umov, "invert", *words, "--json", *self.o.rest, ok=(0, 4)))


def write_observed(rows, typical, snr, rng, path, gain=None, instrument=(0, 0)):
    """A table as an observer has it: noise of photons, S/N that of an I of `typical`; a gain of each band and a constant polarization of the instrument, which nobody knows of."""
    unit = next(3.1 * r["I"] / r["intensity"] for r in rows if r["intensity"] > 0)
    out = ["# pol_frame: equatorial", "time_utc,band,flux,flux_err,q,u,q_err,u_err"]
    for r in rows:
        true = r["intensity"]
        scale = 3.1 * r["I"] / true if true > 0 else unit
        sd = blind.photon_sd(true, typical, snr)
        cells = [r["time_utc"], r["band"], f"{scale * ((gain or {}).get(r['band'], 1) * true + sd * rng.gauss(0, 1)):.6e}", f"{scale * sd:.6e}", "", "", "", ""]
        if true > 5 * sd:
            e = math.sqrt(2) * sd / true
            cells[4:] = [f"{r[k] + p + e * rng.gauss(0, 1):.6f}" for k, p in zip("qu", instrument)] + [f"{e:.6f}"] * 2
        out.append(",".join(cells))
    path.write_text("\n".join(out) + "\n")
