#!/usr/bin/env python3
"""Two workers of one thread beside one process of two: how much of the machine do they use? Wants a quiet machine of two cores.

    .deps/venv/bin/python bench/scale/efficiency.py [--turns 3] [--shard-s 2] [--shards 10] [--no-dask]

In turn: the plain command, umov scale run as it is (one process), with --workers 2 --threads 1, and two Dask workers that are up
already (what a user starts once). Poses by rays; a shard takes --shard-s seconds of one core. Medians.
"""
import argparse
import shutil
import statistics
import tempfile
import time

from scenes import by_rays, cubesat, load, lock, plain, umov


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--shard-s", type=float, default=2)
    parser.add_argument("--shards", type=int, default=10)
    parser.add_argument("--no-dask", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="umov-eff-") as place:
        scene = cubesat(place)
        rate = lock(f"{place}/trial", by_rays(scene, 100_000))["predicted"]["cpu_s"]
        per_shard = max(1, round(given.shard_s / rate))
        command = by_rays(scene, per_shard * given.shards)
        lock(f"{place}/first", command, "--per-shard", per_shard)
        cluster = None
        if not given.no_dask:
            import distributed

            import umov as package
            cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1",
                                               dashboard_address="127.0.0.1:0", silence_logs=50)

        def fresh():
            shutil.rmtree(f"{place}/job", ignore_errors=True)
            shutil.copytree(f"{place}/first", f"{place}/job")
            return f"{place}/job"

        ways = {"plain, 2 threads": lambda: plain([*command, "--threads", 2], f"{place}/plain.csv"),
                "scale run": lambda: umov("scale", "run", "-q", fresh()),
                "scale run, 2 workers": lambda: umov("scale", "run", "-q", "--workers", 2, "--threads", 1, fresh())}
        if cluster:
            ways["2 Dask workers"] = lambda: package.scale.run(None, fresh(), cluster=cluster)
        seconds = {name: [] for name in ways}
        for _ in range(given.turns):
            for name, way in ways.items():
                begin = time.monotonic()
                way()
                seconds[name].append(time.monotonic() - begin)
        one = statistics.median(seconds["plain, 2 threads"])
        print(f"{given.shards} shards of {per_shard} poses, {1e3 * rate:.2f} ms of CPU each; {load()}")
        for name, all_ in seconds.items():
            took = statistics.median(all_)
            print(f"{name:22} {took:7.2f} s  efficiency {one / took:.3f}  ({', '.join(f'{s:.2f}' for s in all_)})")
        if cluster:
            cluster.close()


if __name__ == "__main__":
    main()
