#!/usr/bin/env python3
"""How true the time is that a running job says is left: on a terminal by umov scale run, and by umov.scale on two Dask workers.

    .deps/venv/bin/python bench/scale/progress.py [--seconds 40] [--shards 12] [--no-dask] [NAME ...]

Of each job the lines with a time left are read as they come. Told are the worst of "what has passed and what is left" over what it took
in the end, from the first line on, and the worst of "left" over what was left then, between a tenth and nine tenths of the job.
"""
import argparse
import os
import pathlib
import pty
import re
import subprocess
import sys
import tempfile
import time

from scenes import CATALOGUE, NIGHT, ROOT, SITES, UMOV, by_rays, cubesat, load, lock

LEFT = re.compile(r"(\d+) (s|min) left")


def jobs(place):
    """Even ones, ones that learn first, ones whose shards are unlike; how long one of each takes is found by a trial."""
    hst = ROOT / "examples/hst_maui.toml"
    return {"cubesat by rays": lambda n: by_rays(cubesat(place), n),
            "HST by masks": lambda n: ["signature", hst, "--poses", n, "--phase", 60, "--visibility", "masks"],
            "passes of a catalogue": lambda nights: ["passes", "--orbit", CATALOGUE, "-s", SITES["maui"], *NIGHT[:2], "--stop",
                                                     f"2018-01-{20 + nights}T16:00:00Z"]}


def told(command, env=None):
    """Seconds since the begin and seconds left of each line that has them; how long it took."""
    ours, theirs = pty.openpty()
    begin, out, text = time.monotonic(), [], ""
    process = subprocess.Popen([*map(str, command)], stdin=theirs, stdout=theirs, stderr=theirs, env={**os.environ, "TERM": "xterm", **(env or {})})
    os.close(theirs)
    while True:
        try:
            got = os.read(ours, 4096).decode(errors="replace")
        except OSError:  # its end
            break
        text = (text + got)[-4096:]
        for found in LEFT.finditer(text):
            seconds = float(found[1]) * (60 if found[2] == "min" else 1)
            out.append((time.monotonic() - begin, seconds))
        text = text[list(LEFT.finditer(text))[-1].end():] if LEFT.search(text) else text
    assert process.wait() == 0, text
    return out, time.monotonic() - begin


def describe(lines, took):
    if not lines:
        return "no line"
    whole = [(at + left) / took for at, left in lines]
    part = [left / (took - at) for at, left in lines if 0.1 < at / took < 0.9]
    worst = max(whole, key=lambda ratio: abs(ratio - 1))
    worst_left = max(part, key=lambda ratio: abs(ratio - 1), default=float("nan"))
    some = lines[:: max(1, len(lines) // 8)]
    return (f"took {took:.0f} s, {len(lines)} times: in all {worst:.2f}, left {worst_left:.2f} "
            f"({', '.join(f'{left:.0f} at {at:.0f}' for at, left in some)})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=40)
    parser.add_argument("--shards", type=int, default=12)
    parser.add_argument("--no-dask", action="store_true")
    parser.add_argument("names", nargs="*")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="umov-progress-") as place:
        for name, job in jobs(place).items():
            if given.names and not any(word in name for word in given.names):
                continue
            small = 1 if "passes" in name else 10_000  # nights, poses
            trial = lock(pathlib.Path(place, f"trial of {name}"), job(small))
            count = round(small * 2 * given.seconds / (trial["predicted"]["cpu_s"] * trial["total"]))  # two processes
            count = min(max(count, 1), 10_000_000)  # poses that umov signature takes at most
            ways = {"terminal": lambda folder: [UMOV, "scale", "run", "--workers", 2, "--threads", 1, folder]}
            if not given.no_dask:
                ways["Dask"] = lambda folder: [sys.executable, "-m", "umov.scale", "run", folder, "--cluster", "local:2"]
            for way, command in ways.items():
                folder = pathlib.Path(place, f"{name} {way}")
                total = trial["total"] if small == 1 else count
                lock(folder, job(count), "--per-shard", -(-total // given.shards))
                for one in (folder / "masks").glob("*"):  # as if the plan had been made elsewhere
                    one.unlink()
                print(f"{name:22} {way:9} {describe(*told(command(folder), {'PYTHONPATH': sys.path[0]}))}; {load()}", flush=True)


if __name__ == "__main__":
    main()
