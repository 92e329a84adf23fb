#!/usr/bin/env python3
"""What rows cost to be written beside what they cost to be lit: CPU of a pose of HST in three bands by masks.

    .deps/venv/bin/python bench/scale/writing.py [--poses 200000] [FORM ...]

Light is that of a job that keeps the brightest pose alone (--reduce). All by one thread, as the difference of jobs of twice as many
poses and of so many: what comes before the first pose is in neither. Medians of three turns, as the machine may be busy.
"""
import argparse
import os
import pathlib
import statistics
import tempfile

from scenes import ROOT, Stopwatch, load, lock, umov


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=200_000)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("forms", nargs="*")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="umov-writing-") as place:
        os.environ["XDG_CACHE_HOME"] = place

        def job(poses):
            return ["signature", ROOT / "examples/hst_maui.toml", "--poses", poses, "--phase", 60, "--visibility", "masks"]

        def in_parts(poses, *more):
            folder = pathlib.Path(place, f"{len(more)}-{poses}-{len(os.listdir(place))}")
            lock(folder, job(poses), "--per-shard", 50_000, *more)
            for mask in (first / "masks").iterdir():
                (folder / "masks").mkdir(exist_ok=True)
                (folder / "masks" / mask.name).unlink(missing_ok=True)  # of the lock's trial: some directions
                os.link(mask, folder / "masks" / mask.name)
            with Stopwatch() as took:
                umov("scale", "run", "-q", "--threads", 1, folder)
            size = sum(file.stat().st_size for file in (folder / "shards").rglob("*.rows"))
            return took.cpu, size, folder

        def plain(poses, suffix):
            file = pathlib.Path(place, f"plain.{suffix}")
            with Stopwatch() as took:
                umov(*job(poses), "-q", "--threads", 1, "-o", file)
            return took.cpu, file.stat().st_size

        def parquet(poses):
            import resource

            import umov as package
            folder = in_parts(poses)[2]
            begin = resource.getrusage(resource.RUSAGE_SELF)
            package.scale.Result(folder).to_parquet(folder / "parquet")
            end = resource.getrusage(resource.RUSAGE_SELF)
            return (end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime,
                    sum(file.stat().st_size for file in (folder / "parquet").iterdir()))

        ways = {"light alone": lambda n: in_parts(n, "--reduce", "most:intensity:1"), "shards": in_parts,
                "fits": lambda n: plain(n, "fits"), "csv": lambda n: plain(n, "csv"), "ecsv": lambda n: plain(n, "ecsv"),
                "shards to parquet": parquet}
        first = pathlib.Path(place, "first")
        lock(first, job(2 * given.poses), "--per-shard", 50_000)
        umov("scale", "run", "-q", first)  # traces the masks
        plain(2 * given.poses, "fits")     # and for the plain command
        light = None
        for name, way in ways.items():
            if given.forms and name != "light alone" and not any(form in name for form in given.forms):
                continue
            took, bytes_ = [], 0
            for _ in range(given.turns):
                few, many = way(given.poses), way(2 * given.poses)
                took.append(1e6 * (many[0] - few[0]) / given.poses)
                bytes_ = (many[1] - few[1]) / given.poses
            us = statistics.median(took)
            light = light or us
            more = us if "to" in name else us - light
            print(f"{name:18} {us:6.2f} us a pose ({', '.join(f'{one:.1f}' for one in took)}); writing {more:.2f} us, {more / light:.2f} of the "
                  f"light; {bytes_:.0f} bytes a pose; {load()}", flush=True)


if __name__ == "__main__":
    main()
