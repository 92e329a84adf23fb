#!/usr/bin/env python3
"""What a shard costs the Dask scheduler, whose driver keeps a window of tasks: CPU of scheduler and client, memory between two numbers.

    .deps/venv/bin/python bench/scale/tasks.py [--together] [10000 50000]

The driver is that of umov.scale, over a folder locked for so many shards; what a worker does is nothing but a record. A shard is a task
of its own, as those of a second or longer are; --together: shards that are predicted to be short share tasks of a second, as always.
The scheduler and its two workers are processes of their own, behind the loopback.
"""
import json
import sys
import tempfile
import time

import dask_here
import psutil
from scenes import by_rays, cubesat, load, lock


def done_at_once(indices, **_):
    """As a worker's records of shards that took ten milliseconds."""
    return [{"index": index, "status": "done", "code": 0, "message": "", "file": f"{index:08d}-" + "0" * 54, "sha256": "0" * 64,
             "rows": 4096, "bytes": 737280, "seconds": 0.01, "cpu_s": 0.01} for index in json.loads(indices)]


def main():
    import umov
    from umov._scale_driver import Cluster, Driver
    is_together = "--together" in sys.argv
    counts = [int(word) for word in sys.argv[1:] if word != "--together"] or [10_000, 50_000]
    with tempfile.TemporaryDirectory(prefix="umov-tasks-") as place:
        scene = cubesat(place)
        first, file = dask_here.scheduler(place)
        workers = [dask_here.worker(place, file) for _ in range(2)]
        try:
            with open(file) as text:
                dask = Cluster(json.load(text)["address"], True)
            dask.client.wait_for_workers(2)
            scheduler, me = psutil.Process(first.pid), psutil.Process()
            for count in [1000, *counts]:
                lock(f"{place}/{count}", by_rays(scene, count), "--per-shard", 1)
                driver = Driver(umov.scale.Result(f"{place}/{count}"), dask, 1, None, True)
                driver.do = done_at_once
                if not is_together:
                    driver.task_s = 0.0
                cpu = [sum(p.cpu_times()[:2]) for p in (scheduler, me)]
                begin = time.monotonic()
                driver.run()
                took = time.monotonic() - begin
                cpu = [1e3 * (sum(p.cpu_times()[:2]) - before) / count for p, before in zip((scheduler, me), cpu)]
                assert driver.done == count
                print(f"{count:7} shards: {1e3 * took / count:.2f} ms each; CPU of the scheduler {cpu[0]:.2f} ms, of the driver "
                      f"{cpu[1]:.2f} ms; memory {scheduler.memory_info().rss / 1e6:.0f} MB and {me.memory_info().rss / 1e6:.0f} MB; "
                      f"{load()}", flush=True)
            dask.close()
        finally:
            for process in [*workers, first]:
                process.terminate()


if __name__ == "__main__":
    main()
