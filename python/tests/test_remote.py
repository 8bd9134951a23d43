"""Object stores: builds by a cluster, elevation models by URL."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import orogen
import pytest

boto3 = pytest.importorskip("boto3")
moto_server = pytest.importorskip("moto.server")


@pytest.fixture(scope="module")
def bucket() -> Iterator[str]:
    """A bucket of a store on loopback, whose account is in the environment."""
    server = moto_server.ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    host, port = server.get_host_and_port()
    settings = {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ALLOW_HTTP": "true",
        "AWS_REGION": "us-east-1",
        "AWS_ACCESS_KEY_ID": "somebody",
        "AWS_SECRET_ACCESS_KEY": "secret",
    }
    before = {name: os.environ.get(name) for name in settings}
    os.environ.update(settings)
    boto3.client("s3", region_name="us-east-1", endpoint_url=settings["AWS_ENDPOINT_URL"]).create_bucket(Bucket="land")
    yield "s3://land"
    for name, value in before.items():
        if value is None:
            del os.environ[name]
        else:
            os.environ[name] = value
    server.stop()


def objects(prefix: str) -> dict[str, bytes]:
    client = boto3.client("s3", region_name="us-east-1", endpoint_url=os.environ["AWS_ENDPOINT_URL"])
    names = [entry["Key"] for entry in client.list_objects_v2(Bucket="land", Prefix=prefix).get("Contents", [])]
    return {name[len(prefix) :]: client.get_object(Bucket="land", Key=name)["Body"].read() for name in names}


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_paths_are_urls(bucket: str, tmp_path: Path) -> None:
    world = orogen.World("hills", cache=False)
    assert world.export(f"{bucket}/a.tif", size=64) == f"{bucket}/a.tif"
    world.export(tmp_path / "a.tif", size=64)
    assert objects("a.tif") == {"": (tmp_path / "a.tif").read_bytes()}
    there = orogen.World(f"{bucket}/a.tif", cache=False)
    assert np.array_equal(there.window(), orogen.World(tmp_path / "a.tif", cache=False).window())
    with pytest.raises(orogen.errors.FileError, match="only read"):
        world.export("https://127.0.0.1/a.tif", size=64)
    with pytest.raises(orogen.errors.FileError, match="bucket does not exist"):
        world.build("s3://none/a.zarr", cell=240)


def test_a_cluster_builds_into_a_store(bucket: str, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("zarr")
    from orogen import cluster

    pytest.importorskip("obstore")
    options: dict[str, Any] = {"cell": 60, "tile": 64}
    world = orogen.World("hills", cache=False)
    world.build(tmp_path / "one.zarr", **options)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as workers,
        distributed.Client(workers) as client,
    ):
        victims = list(client.run(os.getpid).values())[:1]

        def kill(done: float) -> None:
            if victims and done > 0.2:
                os.kill(victims.pop(), signal.SIGKILL)

        made = cluster.build(world, f"{bucket}/many.zarr", client=client, parts=12, progress=kill, **options)
        assert not victims and made == f"{bucket}/many.zarr"
        assert objects("many.zarr/") == files(tmp_path / "one.zarr")
        cluster.verify(world, made, client=client, sample=4, seed=1)
