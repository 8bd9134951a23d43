"""Layers that are derived from heights, of arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from orogen import _orogen
from orogen._arrays import F32, Samples, heights as _heights
from orogen._progress import Progress, listener


def _layer(
    heights: Samples, layer: str, cell: float, nodata: float | None, progress: Progress, options: Mapping[str, Any]
) -> F32:
    """A derived layer of the world of these heights; missing ones are interpolated for their neighbors."""
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        channels = _orogen.layer(data, layer, cell, dict(options), heard)
    made: F32 = channels[0] if len(channels) == 1 else np.stack(channels)
    return made
