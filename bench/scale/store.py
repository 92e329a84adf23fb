#!/usr/bin/env python3
"""A hundred million rows opened, streamed and picked from, as Python reads them.

    .deps/venv/bin/python bench/scale/store.py [--rows 100000000] [--per-shard 1000000] [--columns intensity]

A job of one short shard is run, and its file is the pattern of sparse ones: the same columns and block lengths, the numbers holes of
the disk (zeros), the rest written after the description of the form in docs/scale.md. Memory is what this process had at most.
"""
import argparse
import json
import pathlib
import random
import resource
import struct
import tempfile
import time

from scenes import by_rays, cubesat, load, lock, umov

WIDTH = {"float64": 8, "int64": 8, "text": 4, "bool": 1}


def about(file):
    content = file.read_bytes()
    begin, length = struct.unpack("<QQ", content[-24:-8])
    return content, json.loads(content[begin:begin + length])


def sparse(target, pattern, index, per_shard, rows_in_block):
    """A file of that many rows whose numbers are not written."""
    content, head = pattern
    table = head["tables"][0]
    with target.open("wb") as out:
        out.write(b"UMOVROW1")
        blocks = []
        for begin in range(0, per_shard, rows_in_block):
            rows, columns = min(rows_in_block, per_shard - begin), []
            for column, first in zip(table["columns"], table["blocks"][0]["columns"]):
                at = (out.tell() + 63) // 64 * 64
                out.seek(at + rows * WIDTH[column["type"]])
                place = {"at": at}
                if column["type"] == "text":  # the words are those of the pattern
                    ends_at = (out.tell() + 63) // 64 * 64
                    count = first["texts"]
                    ends = content[first["ends"]:first["ends"] + 8 * count]
                    words = content[first["words"]:first["words"] + struct.unpack("<Q", ends[-8:])[0]]
                    out.seek(ends_at)
                    out.write(ends)
                    words_at = (out.tell() + 63) // 64 * 64
                    out.seek(words_at)
                    out.write(words)
                    place.update(ends=ends_at, texts=count, words=words_at)
                columns.append(place)
            blocks.append({"rows": rows, "columns": columns})
        text = json.dumps({**head, "index": index, "tables": [{**table, "rows": per_shard, "blocks": blocks}]}).encode()
        at = (out.tell() + 63) // 64 * 64
        out.seek(at)
        out.write(text + struct.pack("<QQ", at, len(text)) + b"UMOVROW1")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=10**8)
    parser.add_argument("--per-shard", type=int, default=10**6)
    parser.add_argument("--block", type=int, default=12_288, help="rows of a block; as a signature of three bands has it")
    given = parser.parse_args()
    import umov as package
    with tempfile.TemporaryDirectory(prefix="umov-store-") as place:
        command = by_rays(cubesat(place), 50)
        folder = pathlib.Path(place, "job")
        key = lock(folder, command)["key"]
        umov("scale", "run", "-q", folder)
        first = next((folder / "shards").iterdir())
        pattern = about(first)
        first.unlink()
        files = []
        for index in range(given.rows // given.per_shard):
            files.append(folder / "shards" / f"{index:08d}-{key}-{index:032x}.rows")
            sparse(files[-1], pattern, index, given.per_shard, given.block)
        begin = time.monotonic()
        result = package.scale.Result(folder)
        rows = result.rows()
        opened = time.monotonic() - begin
        begin = time.monotonic()
        count = len(rows)
        counted = time.monotonic() - begin
        rng = random.Random(1)
        begin = time.monotonic()
        rows.row(count - 1)
        first_row = time.monotonic() - begin
        times = []
        for _ in range(200):
            begin = time.monotonic()
            rows.row(rng.randrange(count))
            times.append(time.monotonic() - begin)
        times.sort()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        begin, cpu, total = time.monotonic(), time.process_time(), 0.0
        for block in rows.blocks(["intensity", "stokes_q"]):
            total += float(block["intensity"].sum() + block["stokes_q"].sum())
        streamed, cpu = time.monotonic() - begin, time.process_time() - cpu
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        begin = time.monotonic()
        array = result.dask_array(["intensity", "stokes_q"])
        lazy = time.monotonic() - begin
        print(f"{count} rows in {len(files)} files, {len(rows.lengths)} blocks, {sum(f.stat().st_size for f in files) / 1e9:.1f} GB: "
              f"opened in {opened:.3f} s, counted in {counted:.2f} s; first row {1e3 * first_row:.0f} ms, "
              f"then median {1e3 * times[100]:.2f} ms, worst of 200 {1e3 * times[-1]:.1f} ms")
        print(f"two columns streamed in {streamed:.1f} s, {cpu:.1f} s of CPU (sum {total}); memory at most {peak:.0f} MB, "
              f"{before:.0f} before; dask array of shape {array.shape} made in {lazy:.2f} s; {load()}")


if __name__ == "__main__":
    main()
