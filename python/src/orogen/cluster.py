"""Builds by the workers of a Dask cluster, and checks of what they have made.

>>> from distributed import Client
>>> from orogen import cluster
>>> client = Client("tcp://scheduler:8786")
>>> cluster.build("continent", "/shared/land.zarr", client=client, cell=60)
>>> cluster.verify("continent", "/shared/land.zarr", client=client, sample=100)

All workers write into one folder that they share, or into an object store (`s3://bucket/land.zarr`). A part whose worker fails or dies is made again by another one, and a
build that was interrupted goes on with the same call. The result has the bits of `World.build` in one process.
"""

from __future__ import annotations

import os
import pickle
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import islice, starmap
from typing import Any, TypeAlias

import numpy as np

from orogen._progress import Progress, listener
from orogen._world import PathLike, PathT, Window, World, _restored
from orogen.errors import FileError, RequestError

__all__ = ["build", "verify"]

#: Parts for each thread of the cluster: workers that are faster do more of them.
PARTS_PER_THREAD = 8

#: Futures for each worker: while one runs, the next one waits at the worker.
FUTURES_PER_WORKER = 2

#: A chunk of a layer of a store: the layer, rows and columns.
Chunk: TypeAlias = "tuple[str, slice, slice]"


def build(
    world: World | PathLike,
    path: PathT,
    *,
    client: Any = None,
    layers: str | Sequence[str] = "height",
    parts: int | None = None,
    retries: int = 3,
    progress: Progress = None,
    **options: Any,
) -> PathT:
    """Builds a window of any size by the workers of a cluster. Returns the path.

    Parameters
    ----------
    world
        A world, the name of a preset, or a recipe. Workers open its files by their paths.
    path
        The result as in `World.build`: a URL of an object store, or in a folder that all workers share, under the same
        path.
    client
        A `distributed.Client`; by default the current one.
    layers
        Names of the layers.
    parts
        Number of parts; by default eight for each thread of the cluster. A build goes on with the same number.
    retries
        How often a part is tried again after an error. Parts of workers that died are always given to others.
    progress
        A function that is called with the share of the parts that are done, or True for a bar of tqdm.
    **options
        The keywords of `World.build`, such as `cell`, `bounds` and `tile`.

    Raises
    ------
    RequestError
        If there is no cluster, or the build is not possible.
    """
    client = _client(client)
    if "overwrite" in options:
        raise RequestError("a build in parts goes on with what is there; remove the result to build it anew")
    threads = sum(int(count) for count in client.nthreads().values())
    parts = PARTS_PER_THREAD * max(threads, 1) if parts is None else parts
    if parts < 1:
        raise RequestError("`parts` must be at least 1")
    whole = _whole(path)
    options["layers"] = layers if isinstance(layers, str) else ",".join(layers)
    arguments = _arguments(world)
    calls = ((arguments, whole, options, f"{number}/{parts}") for number in range(1, parts + 1))
    with listener(progress) as heard:
        for done, _ in enumerate(_in_waves(client, _part, calls, retries), 1):
            if heard is not None:
                heard(done / parts)
    if not _is_url(whole) and not os.path.exists(whole):
        raise FileError(f"{whole} is not there, although all parts were made; do all workers share its folder?")
    return path


def verify(
    world: World | PathLike,
    store: PathLike,
    *,
    client: Any = None,
    sample: int | None = 100,
    seed: int | None = None,
    retries: int = 3,
    progress: Progress = None,
) -> int:
    """Makes random chunks of a Zarr group again and compares them, bit for bit. Returns their number.

    Parameters
    ----------
    world
        The world that the group was built from.
    store
        The group, as `build` and `World.build` write it. It is read with zarr.
    client
        A `distributed.Client` whose workers do the work; by default this process does.
    sample
        Number of chunks, of all layers together; None for all.
    seed
        Chooses the chunks; by default they are others each time.

    Raises
    ------
    FileError
        If chunks differ; the message names them.
    """
    whole = _whole(store)
    group = _group(whole)
    chunks = [chunk for layer, array in sorted(group.arrays()) if array.ndim == 2 for chunk in _chunks(layer, array)]
    if not chunks:
        raise FileError(f"{whole} has no layers")
    if sample is not None and sample < len(chunks):
        chunks = random.Random(seed).sample(chunks, max(sample, 1))
    arguments = _arguments(world)
    calls = ((arguments, whole, chunk) for chunk in chunks)
    found = starmap(_difference, calls) if client is None else _in_waves(client, _difference, calls, retries)
    wrong = []
    with listener(progress) as heard:
        for done, difference in enumerate(found, 1):
            wrong += [difference] if difference else []
            if heard is not None:
                heard(done / len(chunks))
    if wrong:
        named = "; ".join(sorted(wrong)[:5])
        raise FileError(f"{whole} differs from the world in {len(wrong)} of {len(chunks)} chunks: {named}")
    return len(chunks)


def _client(client: Any) -> Any:
    if client is not None:
        return client
    try:
        from distributed import get_client

        return get_client()
    except (ImportError, ValueError):
        raise RequestError("there is no Dask cluster; set `client=distributed.Client(...)`") from None


def _is_url(path: str) -> bool:
    return "://" in path


def _whole(path: PathLike) -> str:
    """A path for other processes, whose current folder may be another one."""
    given = os.fspath(path)
    return given if _is_url(given) else os.path.abspath(given)


def _arguments(world: World | PathLike) -> bytes:
    """What makes a world in another process, whose current folder may be another one."""
    found = dict((world if isinstance(world, World) else World(world))._arguments)
    recipe = found["recipe"]
    if isinstance(recipe, (str, os.PathLike)) and "\n" not in str(recipe) and os.path.exists(recipe):
        found["recipe"] = os.path.abspath(recipe)
    return pickle.dumps(found)


@lru_cache(maxsize=1)
def _opened(arguments: bytes) -> World:
    """A world that takes the threads of its worker, not those of all cores. The next call may need its solutions."""
    found: dict[str, Any] = pickle.loads(arguments)
    if found.get("threads") is None:
        try:
            from distributed import get_worker

            found["threads"] = get_worker().state.nthreads
        except (ImportError, ValueError):
            pass
    return _restored(found)


def _part(arguments: bytes, path: str, options: dict[str, Any], part: str) -> None:
    """Makes a part of a build."""
    _opened(arguments).build(path, **options | {"part": part})


def _in_waves(
    client: Any, function: Callable[..., Any], calls: Iterable[tuple[Any, ...]], retries: int
) -> Iterator[Any]:
    """The results of calls by workers, as they come. Only a few futures exist at a time, however many calls."""
    import distributed

    as_completed: Any = distributed.as_completed
    waiting = iter(calls)
    limit = FUTURES_PER_WORKER * max(len(client.nthreads()), 1)
    running = {client.submit(function, *call, retries=retries, pure=False) for call in islice(waiting, limit)}
    completed = as_completed(running)
    try:
        for future in completed:
            running.discard(future)
            yield future.result()
            for call in islice(waiting, 1):
                following = client.submit(function, *call, retries=retries, pure=False)
                running.add(following)
                completed.add(following)
    finally:
        client.cancel(list(running))


def _group(path: str) -> Any:
    try:
        import zarr
    except ImportError:
        raise RequestError("a store is read with zarr: `pip install zarr`") from None
    store: Any = path
    if _is_url(path):
        try:
            from obstore.store import from_url
            from zarr.storage import ObjectStore
        except ImportError:
            raise RequestError("a store of objects is read with obstore: `pip install obstore`") from None
        store = ObjectStore(from_url(path), read_only=True)
    try:
        return zarr.open_group(store, mode="r")
    except FileNotFoundError:
        raise FileError(f"{path} is no Zarr group, or its build was not finished") from None


def _chunks(layer: str, array: Any) -> Iterator[Chunk]:
    """The chunks of an array; of shards, since they are what is written at once."""
    rows, columns = getattr(array, "shards", None) or array.chunks
    for top in range(0, array.shape[0], rows):
        for left in range(0, array.shape[1], columns):
            yield layer, slice(top, min(top + rows, array.shape[0])), slice(left, min(left + columns, array.shape[1]))


def _difference(arguments: bytes, path: str, chunk: Chunk) -> str:
    """How a chunk differs from the world, or nothing."""
    layer, rows, columns = chunk
    group = _group(path)
    cell = float(group.attrs["cell"])
    # Coordinates are metres east and north.
    left, top = round(float(group["x"][columns.start]) / cell), round(-float(group["y"][rows.start]) / cell)
    window = Window(left, top, columns.stop - columns.start, rows.stop - rows.start, cell)
    expect = _opened(arguments).window(layer, window=window)
    stored = np.asarray(group[layer][rows, columns])
    wrong = int((expect.view(np.uint32) != stored.view(np.uint32))[~(np.isnan(expect) & np.isnan(stored))].sum())
    place = f"{layer}, rows {rows.start} to {rows.stop}, columns {columns.start} to {columns.stop}"
    return f"{place}: {wrong} of {expect.size} samples" if wrong else ""
