#!/usr/bin/env python3
"""Makes data/filters/lsst2023-*.ecsv from those of package speclite 1.0.0, which have a point every
0.1 nm: every tenth point (1 nm), 0 where the response is below 1e-4 of the peak. That moves the Sun by
.00015 mag at most. Usage: lsst_curves.py OUTPUT_FOLDER"""
import importlib.resources
import sys
from pathlib import Path


def thinned(text):
    head, rows = [], []
    for line in text.splitlines():
        try:
            rows.append([float(word) for word in line.split()])
        except ValueError:
            head.append(line)
    rows = rows[::10]
    least = 1e-4 * max(response for _, response in rows)
    cut = [(nm, response if response > least else 0) for nm, response in rows]
    # Of zeros in a row the first and the last are enough.
    kept = [cut[k] for k in range(len(cut)) if any(r for _, r in cut[max(k - 1, 0) : k + 2])]
    body = [f"{nm:.1f} {response:.7g}" for nm, response in kept]
    return "\n".join(head[:-1] + ['# - {thinned: "to 1 nm by umov (tools/oracles/lsst_curves.py)"}', head[-1]] + body) + "\n"


def main():
    source = importlib.resources.files("speclite") / "data" / "filters"
    for band in "ugrizy":
        name = f"lsst2023-{band}.ecsv"
        Path(sys.argv[1], name).write_text(thinned((source / name).read_text()))


if __name__ == "__main__":
    main()
