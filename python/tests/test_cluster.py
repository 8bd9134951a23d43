"""Builds by the workers of a cluster on this machine."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import orogen
import pytest
from orogen import cluster

distributed = pytest.importorskip("distributed")
zarr = pytest.importorskip("zarr")

RECIPE = {
    "orogen": 1,
    "world": {"size": [4000, 3000], "cell": 20, "seed": 3},
    "nodes": {"a": {"op": "fbm", "wavelength": 900}, "b": {"op": "remap", "source": "a", "to": [0, 300]}},
    "outputs": {"height": "b", "rough": "a"},
}

# What Dask and zarr warn of is not about this package.
pytestmark = pytest.mark.filterwarnings("ignore")



@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    folder = str(tmp_path_factory.mktemp("dask"))
    options = {"processes": True, "n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(local_directory=folder, **options) as local, distributed.Client(local) as found:
        yield found


@pytest.fixture(scope="module")
def world() -> orogen.World:
    return orogen.World(RECIPE, cache=False)


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_cluster_makes_the_same_files(client: Any, world: orogen.World, tmp_path: Path) -> None:
    options: dict[str, Any] = {"layers": ["height", "rough"], "tile": 32}
    world.build(tmp_path / "one.zarr", layers="height,rough", tile=32)
    told: list[float] = []
    made = cluster.build(world, tmp_path / "many.zarr", client=client, parts=7, progress=told.append, **options)
    assert files(made) == files(tmp_path / "one.zarr")
    assert len(told) == 7 and told == sorted(told) and told[-1] == 1
    # Again, nothing is left to do.
    assert cluster.build(world, tmp_path / "many.zarr", client=client, parts=7, **options) == made


def test_parts_of_a_killed_worker_are_made_by_others(client: Any, world: orogen.World, tmp_path: Path) -> None:
    options: dict[str, Any] = {"tile": 16, "cell": 10.0}
    world.build(tmp_path / "one.zarr", **options)
    pids = list(client.run(os.getpid).values())
    killed: list[float] = []

    def kill(share: float) -> None:
        if not killed:
            os.kill(pids[0], signal.SIGKILL)
        killed.append(share)

    made = cluster.build(world, tmp_path / "many.zarr", client=client, parts=20, progress=kill, **options)
    assert len(killed) == 20 and files(made) == files(tmp_path / "one.zarr")
    assert pids[0] not in client.run(os.getpid).values()


def test_few_futures_exist_at_a_time(client: Any) -> None:
    drawn: list[int] = []

    def calls() -> Iterator[tuple[int]]:
        for number in range(30):
            drawn.append(number)
            yield (number,)

    done = 0
    for result in cluster._in_waves(client, _double, calls(), 0):
        done += 1
        assert result % 2 == 0 and len(drawn) <= done + 2 * 2 * cluster.FUTURES_PER_WORKER
    assert done == 30


def test_an_error_of_a_worker_ends_the_work(client: Any) -> None:
    with pytest.raises(ZeroDivisionError):
        list(cluster._in_waves(client, _divide, ((1 - number,) for number in range(20)), 1))


def _double(number: int) -> int:
    return 2 * number


def _divide(number: int) -> float:
    return 1 / number


def test_a_store_is_verified(client: Any, world: orogen.World, tmp_path: Path) -> None:
    store = tmp_path / "land.zarr"
    world.build(store, window=(30, 20, 100, 70), layers="height,rough", tile=32)
    assert cluster.verify(world, store, sample=None) == 2 * 4 * 3
    assert cluster.verify(world, store, sample=5, client=client) == 5
    with pytest.raises(orogen.errors.FileError, match="in 5 of 5 chunks: height"):
        cluster.verify(orogen.World(RECIPE, seed=4, cache=False), store, sample=5, seed=1)
    # One sample by its last bit.
    array = zarr.open_group(store)["height"]
    array[40, 50] = np.nextafter(array[40, 50], np.float32(np.inf))
    place = r"in 1 of 24 chunks: height, rows 32 to 64, columns 32 to 64: 1 of 1024 samples"
    with pytest.raises(orogen.errors.FileError, match=place):
        cluster.verify(world, store, sample=None)
    with pytest.raises(orogen.errors.FileError, match="not finished"):
        cluster.verify(world, tmp_path)


def test_mistakes_are_refused(client: Any, world: orogen.World, tmp_path: Path) -> None:
    with pytest.raises(orogen.errors.RequestError, match="parts"):
        cluster.build(world, tmp_path / "a.zarr", client=client, parts=0)
    with pytest.raises(orogen.errors.RequestError, match="layer"):
        cluster.build(world, tmp_path / "a.zarr", client=client, layers="nothing", retries=0)
    assert not any(tmp_path.iterdir())


def test_without_a_cluster_the_message_says_so(world: orogen.World) -> None:
    caught: list[Exception] = []

    def ask() -> None:
        try:
            cluster._client(None)
        except orogen.errors.RequestError as error:
            caught.append(error)

    # In a thread that has no client of its own.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distributed, "get_client", _none)
        thread = threading.Thread(target=ask)
        thread.start()
        thread.join()
    assert "client=" in str(caught[0])


def _none() -> None:
    raise ValueError("no client")
