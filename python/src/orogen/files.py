"""Hydrology on files of heights that are larger than memory.

The functions read a file of heights (a DEM such as a GeoTIFF) window by window, keep what does not fit in memory on
disk, and write a file of the same samples at the same place. They return the path of the result.

Heights are those of `World(source)`: samples without a height are interpolated. Water leaves two samples beyond the
border of the file, where the land is as high as at the border: results are those of `orogen.hydrology` on
`np.pad(heights, 2, mode="edge")`, but for ties between directions. Work can be interrupted with Ctrl-C; `progress` is a
function that is called with the share that is done, or True for a bar of tqdm.

>>> from orogen import files
>>> files.fill("alps.tif", "filled.tif", memory="1GiB")
>>> files.accumulate("alps.tif", "area.tif", memory="1GiB")
"""

from __future__ import annotations

import os
from typing import Any

from orogen._progress import Progress
from orogen._world import PathLike, PathT, World

__all__ = ["accumulate", "fill"]


def fill(
    source: PathLike,
    path: PathT,
    *,
    memory: int | str | None = None,
    threads: int | None = None,
    overwrite: bool | None = None,
    progress: Progress = None,
) -> PathT:
    """Fills depressions to their spill level, as `orogen.hydrology.fill`.

    Parameters
    ----------
    source
        The file of heights.
    path
        The result, such as a GeoTIFF: float32 heights.
    memory
        Maximum memory, in bytes or as a text such as "1GiB". What does not fit is in the system's temporary folder: for
        `fill` three times the size of the heights, for `accumulate` six times. Method then: Barnes (2016).
    threads
        Number of threads; all cores by default. Each needs some memory.
    overwrite
        As in `World.export`.
    """
    node = {"op": "fill", "source": "land", "sea": False}
    return _solved(source, path, node, memory, threads, overwrite, progress)


def accumulate(
    source: PathLike,
    path: PathT,
    *,
    memory: int | str | None = None,
    threads: int | None = None,
    overwrite: bool | None = None,
    progress: Progress = None,
) -> PathT:
    """The area that drains through each cell, in square metres (D8), as `orogen.hydrology.accumulate`.

    The parameters are those of `fill`; the result is float32 square metres.
    """
    node = {"op": "drainage", "source": "land", "sea": False}
    return _solved(source, path, node, memory, threads, overwrite, progress)


def _solved(
    source: PathLike,
    path: PathT,
    node: dict[str, Any],
    memory: int | str | None,
    threads: int | None,
    overwrite: bool | None,
    progress: Progress,
) -> PathT:
    """Writes the first layer of a node that reads the heights of a file."""
    window = World(source, memory=memory, threads=threads, cache=False).view()
    given = os.fspath(source)
    recipe = {
        "orogen": 1,
        "world": {"size": [(window.width - 1) * window.cell, (window.height - 1) * window.cell], "cell": window.cell},
        "nodes": {"land": {"op": "dem", "path": given if "://" in given else os.path.abspath(given)}, "result": node},
        "outputs": {"height": "land", "result": "result"},
    }
    world = World(recipe, memory=memory, threads=threads, cache=False)
    return world.export(path, "result", window=window, overwrite=overwrite, progress=progress)
