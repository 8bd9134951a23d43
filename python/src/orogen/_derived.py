"""Layers that are derived from heights, of arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from orogen._arrays import F32, Samples, heights as _heights
from orogen._progress import Progress


def _layer(
    heights: Samples, layer: str, cell: float, nodata: float | None, progress: Progress, options: Mapping[str, Any]
) -> F32:
    """A derived layer of the world that consists of these heights."""
    import warnings

    import numpy as np

    from orogen._world import World

    data = _heights(heights, nodata)
    with warnings.catch_warnings():
        # Neighbors of missing samples see interpolated heights.
        warnings.simplefilter("ignore")
        world = World(data, cell=cell, cache=False)
    made: F32 = world.window(layer, window=(0, 0, data.shape[1], data.shape[0]), progress=progress, **options)
    made[..., np.isnan(data)] = np.nan
    return made
