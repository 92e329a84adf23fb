#!/usr/bin/env python3
"""Makes data/filters/lsst2023-*.ecsv from those of package speclite 1.0.0, which have a point every
0.1 nm: every tenth point (1 nm), from the peak outwards as far as the response is above 1e-4 of it
(and one zero at either end). Usage: lsst_curves.py OUTPUT_FOLDER"""
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
    responses = [response for _, response in rows]
    first = last = responses.index(max(responses))
    least = 1e-4 * max(responses)
    while first > 0 and responses[first - 1] > least:
        first -= 1
    while last + 1 < len(rows) and responses[last + 1] > least:
        last += 1
    kept = rows[first : last + 1]
    body = [f"{kept[0][0] - 1:.1f} 0.0"]
    body += [f"{nm:.1f} {response:.7g}" for nm, response in kept]
    body.append(f"{kept[-1][0] + 1:.1f} 0.0")
    return "\n".join(head[:-1] + ["# thinned to 1 nm by umov (tools/oracles/lsst_curves.py)", head[-1]] + body) + "\n"


def main():
    source = importlib.resources.files("speclite") / "data" / "filters"
    for band in "ugrizy":
        name = f"lsst2023-{band}.ecsv"
        Path(sys.argv[1], name).write_text(thinned((source / name).read_text()))


if __name__ == "__main__":
    main()
