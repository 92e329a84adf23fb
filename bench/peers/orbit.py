#!/usr/bin/env python3
"""umov's SGP4 over a catalogue beside the Python package sgp4 (its C++ core), in one run.

    bench/peers/run orbit --orbit CATALOGUE.tle [--umov PATH]

One core, one day in 1,440 steps for every object; states per second, best of five.
"""

import argparse
import json
import subprocess
import sys
import time

import numpy as np
from sgp4.api import Satrec, SatrecArray

parser = argparse.ArgumentParser()
parser.add_argument("--orbit", required=True, help="catalogue of element sets, TLE or 3LE")
parser.add_argument("--umov", default="build/release/apps/cli/umov")
arguments = parser.parse_args()

lines = [line.rstrip() for line in open(arguments.orbit)]
pairs = [(a, b) for a, b in zip(lines, lines[1:]) if a.startswith("1 ") and b.startswith("2 ")]
objects = SatrecArray([Satrec.twoline2rv(a, b) for a, b in pairs])
first = np.array([Satrec.twoline2rv(*pair).jdsatepoch for pair in pairs]).max()
minutes = np.arange(1440)
best = np.inf
for _ in range(5):
    begin = time.perf_counter()
    objects.sgp4(np.full(1440, np.floor(first)), minutes / 1440)
    best = min(best, time.perf_counter() - begin)
peer = len(pairs) * 1440 / best

done = subprocess.run([arguments.umov, "bench", "--orbit", arguments.orbit, "--json", "-q"],
                      capture_output=True, text=True)
if done.returncode:
    sys.exit(f"umov bench failed: {done.stderr.strip()}")
print(f"sgp4 package, one core: {peer / 1e6:.2f} M states/s ({len(pairs)} objects x 1440)")
for row in json.loads(done.stdout):
    rate = row["states_per_s"]
    print(f"umov, {row['case']}, {row['instruction_set']}: {rate / 1e6:.2f} M states/s, "
          f"{rate / peer:.1f} times; differs from one by one by {row['difference']:g} km")
