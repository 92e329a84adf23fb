#!/usr/bin/env python3
"""examples/panel_brdf.csv: a "measured" Mueller BRDF made from the library's white paint.

usage: make_example_brdf.py build/release/apps/cli/umov > examples/panel_brdf.csv
"""
import csv
import io
import subprocess
import sys
import tempfile

THETA = (0, 15, 30, 45, 60, 75, 85)
PHI = (0, 30, 60, 90, 120, 150, 180)
with tempfile.TemporaryDirectory() as folder:
    with open(f"{folder}/in.csv", "w") as file:
        print("wavelength_nm,theta_i_deg,theta_o_deg,phi_deg", file=file)
        for i in THETA:
            for o in THETA:
                for phi in PHI:
                    print(f"550,{i},{o},{phi}", file=file)
    subprocess.run([sys.argv[1], "brdf", "paint_white", "--batch", f"{folder}/in.csv", "-o",
                    f"{folder}/out.csv"], check=True)
    text = open(f"{folder}/out.csv").read()
rows = list(csv.reader(io.StringIO("\n".join(l for l in text.splitlines() if not l.startswith("#")))))
print("# Mueller BRDF of umov's paint_white at 550 nm (tools/make_example_brdf.py), scattering plane [1/sr]")
print("# unit: nm,deg,deg,deg," + ",".join(["1 / sr"] * 16))
print(",".join(rows[0]))
for row in rows[1:]:
    print(",".join(f"{float(cell):.9g}" for cell in row))
