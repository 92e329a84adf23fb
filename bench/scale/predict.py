#!/usr/bin/env python3
"""What umov scale plan says of unlike jobs, beside what they then take: CPU and bytes of the shards.

    .deps/venv/bin/python bench/scale/predict.py [NAME ...]

CPU is that of umov scale run with all its processes on a job that was locked before; the masks that the lock's trial traced are taken
away, so that the run traces them itself, as the plan has it. One thread, one worker.
"""
import json
import pathlib
import sys
import tempfile

from scenes import CATALOGUE, NIGHT, ROOT, SITES, Stopwatch, by_rays, catalogue, cubesat, load, lock, umov


def jobs(place):
    """Jobs of 5 to 60 CPU seconds, as unlike as they come."""
    scene = cubesat(place)
    hst = ROOT / "examples/hst_maui.toml"
    maui = ("-s", SITES["maui"], *NIGHT)
    long_night = ("--set", "time.stop=2018-01-23T16:00:00Z", "--set", "time.step_s=0.2")
    return {
        "cubesat by rays": by_rays(scene, 20_000),
        "cubesat by masks": ["signature", scene, "--poses", 1_000_000, "--phase", 60, "--visibility", "masks"],
        "HST by masks, short": ["signature", hst, "--poses", 200_000, "--phase", 60, "--visibility", "masks"],
        "HST by auto": ["signature", hst, "--poses", 20_000, "--phase", "60"],
        "passes of a catalogue": ["passes", "--orbit", CATALOGUE, *maui],
        "passes with magnitudes": ["passes", "--orbit", catalogue(place, 300), *maui, "--scene", scene],
        "light curves of HST": ["run", hst, *long_night],
        "exposures of HST": ["observe", ROOT / "examples/observe_hst.toml"],
    }


def main():
    wanted = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="umov-predict-") as place:
        for name, command in jobs(place).items():
            if wanted and not any(word in name for word in wanted):
                continue
            folder = pathlib.Path(place, name.replace(" ", "_"))
            with Stopwatch() as trial:
                predicted = lock(folder, command)["predicted"]
            plan = json.loads(umov("scale", "plan", "--json", "--cores", 1, folder).stdout)
            for one in (folder / "masks").glob("*"):  # what the trial has traced, the run shall trace itself
                one.unlink()
            with Stopwatch() as took:
                umov("scale", "run", "-q", "--threads", 1, folder)
            bytes_ = sum(file.stat().st_size for file in (folder / "shards").rglob("*.rows"))
            said = 3600 * plan["core_hours"]
            masks = predicted.get("once_cpu_s", 0)
            print(f"{name:24} said {said:6.1f} s ({masks:.1f} of it once), took {took.cpu:6.1f} s: {said / took.cpu:.2f}; "
                  f"{plan['gigabytes']:.4f} GB said, {bytes_ / 1e9:.4f} written: "
                  f"{1e9 * plan['gigabytes'] / bytes_:.3f}; {plan['shards']} shards; trial {trial.cpu:.1f} s; {load()}", flush=True)


if __name__ == "__main__":
    main()
