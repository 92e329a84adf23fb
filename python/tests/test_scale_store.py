"""Jobs in parts into an object store: S3 as moto plays it on the loopback. Skipped, saying so, where it is not installed."""
import json
import os
import pathlib
import subprocess
import sys
import time
import urllib.request

import pytest
from test_scale import job_of, merged_bytes, plain_bytes, scene, wrapper  # noqa: F401  scene is a fixture

import umov

pytest.importorskip("s3fs", reason="s3fs is not installed: object stores are not tested")
fsspec = pytest.importorskip("fsspec")
pytest.importorskip("moto")


@pytest.fixture(scope="module")
def server():
    """Its address."""
    with subprocess.Popen([sys.executable, "-u", "-m", "moto.server", "-H", "127.0.0.1", "-p", "0"],
                          stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True) as process:
        for line in process.stderr:
            if "Running on" in line:
                break
        yield line.split("Running on ")[1].strip()
        process.kill()


@pytest.fixture
def store(server, monkeypatch):
    """An empty bucket, as fsspec's own configuration has it here and in the workers."""
    options = {"key": "none", "secret": "none", "client_kwargs": {"endpoint_url": server, "region_name": "us-west-2"}}
    monkeypatch.setenv("FSSPEC_S3", json.dumps(options))
    monkeypatch.setitem(fsspec.config.conf, "s3", options)
    urllib.request.urlopen(urllib.request.Request(f"{server}/moto-api/reset", method="POST"))
    fsspec.filesystem("s3").clear_instance_cache()
    fsspec.filesystem("s3").call_s3("create_bucket", Bucket="jobs", CreateBucketConfiguration={"LocationConstraint": "us-west-2"})
    return "s3://jobs/lib/sat"


def objects(store, folder):
    found = fsspec.filesystem("s3", use_listings_cache=False).find(f"{store[5:]}/{folder}")
    return [path.rsplit("/", 1)[-1] for path in found]


def test_a_store_gives_the_plain_bytes(scene, store, tmp_path):  # noqa: F811
    job = job_of(scene)
    result = umov.scale.run(job, store, cluster="local:2", per_shard=60)
    assert not result.missing and not result.failed
    assert result.status["is_complete"] and result.status["done"] == 7 and not result.status["is_held"]
    assert merged_bytes(result) == plain_bytes(job)
    here = result.fetch(tmp_path / "here")
    here.verify()
    assert merged_bytes(here) == plain_bytes(job) and len(result.rows()) == len(here.rows()) == 1200
    assert result.status["bytes"] == sum(file.stat().st_size for file in here.files)


@pytest.mark.slow
def test_what_is_missing_is_done_again(scene, store):  # noqa: F811
    job = job_of(scene)
    before = umov.scale.run(job, store, cluster="local:1", per_shard=60)
    whole = set(objects(store, "shards"))
    for name in sorted(whole)[1:4]:
        fsspec.filesystem("s3").rm_file(f"{store[5:]}/shards/{name}")
    assert before.missing == [1, 2, 3]
    after = umov.scale.run(None, store, cluster="local:1")
    assert not after.missing and set(objects(store, "shards")) == whole
    assert merged_bytes(after) == plain_bytes(job)


def test_a_damaged_object_is_named(scene, store):  # noqa: F811
    result = umov.scale.run(job_of(scene, 100), store, cluster="local:1", per_shard=60)
    name = sorted(objects(store, "shards"))[1]
    path = f"{store[5:]}/shards/{name}"
    content = bytearray(fsspec.filesystem("s3").cat_file(path))
    content[len(content) // 2] ^= 1
    fsspec.filesystem("s3").pipe_file(path, bytes(content))
    with pytest.raises(umov.InputError, match=name):
        result.merge("merged.csv")
    assert not pathlib.Path("merged.csv").exists()


@pytest.mark.slow
def test_what_cannot_be_done_is_told(scene, store, tmp_path):  # noqa: F811
    program = wrapper(tmp_path, "if index == 3: os.kill(os.getpid(), signal.SIGSEGV)")
    with pytest.raises(umov.InputError, match="1 shards could not be done; shard 3: its process was ended by signal 11"):
        umov.scale.run(job_of(scene), store, cluster="local:1", per_shard=60, program=program)
    result = umov.scale.Result(store)
    assert result.missing == [3] and [one["index"] for one in result.failed] == [3]
    again = umov.scale.run(None, store, cluster="local:1")
    assert not again.missing and not again.failed and not objects(store, "failed")


def test_another_job_and_another_umov_are_refused(scene, store):  # noqa: F811
    umov.scale.run(job_of(scene, 100), store, cluster="local:1", per_shard=60)
    with pytest.raises(umov.InputError, match="poses"):
        umov.scale.run(job_of(scene, 90), store, cluster="local:1", per_shard=60)
    fs = fsspec.filesystem("s3")
    fs.rm_file(f"{store[5:]}/shards/{objects(store, 'shards')[0]}")
    fs.pipe_file(f"{store[5:]}/lease.json", json.dumps({"host": "elsewhere", "pid": 7, "time": time.time()}).encode())
    with pytest.raises(umov.DeviceError, match="another umov is at work .*elsewhere"):
        umov.scale.run(None, store, cluster="local:1")
    assert not umov.scale.run(None, store, cluster="local:1", join=True).missing


@pytest.mark.parametrize("place", ["file:///tmp/job", "memory://job", "nonsense://job"])
def test_places_that_are_no_stores(scene, place):  # noqa: F811
    with pytest.raises(umov.UsageError):
        umov.scale.run(job_of(scene), place, cluster="local:1")


def test_a_store_takes_a_cluster_and_a_job(scene, store):  # noqa: F811
    with pytest.raises(umov.UsageError, match="takes a cluster"):
        umov.scale.run(job_of(scene), store)
    with pytest.raises(umov.InputError, match="holds no job"):
        umov.scale.Result(store)


def test_a_store_that_is_gone(scene, monkeypatch):  # noqa: F811
    monkeypatch.setitem(fsspec.config.conf, "s3", {"key": "none", "secret": "none", "max_paths": 1, "client_kwargs": {
        "endpoint_url": "http://127.0.0.1:9", "region_name": "us-west-2"}, "config_kwargs": {"retries": {"max_attempts": 0}}})
    with pytest.raises(umov.DeviceError, match="127.0.0.1:9"):
        umov.scale.Result("s3://jobs/gone")


def test_nothing_of_the_configuration_is_kept(scene, store):  # noqa: F811
    options = json.loads(os.environ["FSSPEC_S3"])
    umov.scale.run(job_of(scene, 20), store, cluster="local:1")
    fs = fsspec.filesystem("s3", use_listings_cache=False)
    for path in fs.find(store[5:]):
        assert options["client_kwargs"]["endpoint_url"].encode() not in fs.cat_file(path)
