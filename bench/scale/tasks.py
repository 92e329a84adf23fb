#!/usr/bin/env python3
"""What a shard costs the Dask scheduler, whose driver keeps a window of tasks: CPU of scheduler and client, memory between two numbers.

    .deps/venv/bin/python bench/scale/tasks.py [10000 50000]

The driver is that of umov.scale, over a folder locked for so many shards; what a worker does is nothing but a record. The scheduler
and its two workers are processes of their own, behind the loopback.
"""
import os
import subprocess
import sys
import tempfile
import time

import psutil
from scenes import by_rays, cubesat, load, lock

SCHEDULER = "import sys; from distributed.cli.dask_scheduler import main; main()"
WORKER = "import sys; from distributed.cli.dask_worker import main; main()"


def done_at_once(index, *_):
    """As a worker's record of a shard that is there."""
    return {"index": index, "status": "done", "code": 0, "message": "", "file": f"{index:08d}-" + "0" * 54, "sha256": "0" * 64,
            "rows": 4096, "bytes": 737280, "seconds": 10.0, "cpu_s": 10.0}


def cluster(place):
    """The scheduler and its workers."""
    file = f"{place}/scheduler.json"
    common = ["--host", "127.0.0.1", "--no-dashboard"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    first = subprocess.Popen([sys.executable, "-c", SCHEDULER, *common, "--port", "0", "--scheduler-file", file], **quiet)
    while not os.path.exists(file):
        time.sleep(0.1)
    workers = [subprocess.Popen([sys.executable, "-c", WORKER, *common, "--nthreads", "1", "--scheduler-file", file,
                                 "--local-directory", place], **quiet) for _ in range(2)]
    return file, first, workers


def main():
    import json

    import umov
    from umov._scale_driver import Cluster, Driver
    counts = [int(word) for word in sys.argv[1:]] or [10_000, 50_000]
    with tempfile.TemporaryDirectory(prefix="umov-tasks-") as place:
        scene = cubesat(place)
        file, first, workers = cluster(place)
        try:
            with open(file) as text:
                dask = Cluster(json.load(text)["address"], True)
            dask.client.wait_for_workers(2)
            scheduler, me = psutil.Process(first.pid), psutil.Process()
            for count in [1000, *counts]:
                lock(f"{place}/{count}", by_rays(scene, count), "--per-shard", 1)
                driver = Driver(umov.scale.Result(f"{place}/{count}"), dask, 1, None, True)
                driver.do = done_at_once
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
