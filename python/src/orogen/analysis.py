"""Terrain analysis of 2-D arrays of heights: every layer that `orogen export --layer` derives from heights, and contours.

All functions take heights in metres as an array of shape (rows, columns), row 0 in the north, and `cell`, the distance
between samples in metres. Samples that are NaN, masked or equal to `nodata` are missing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from orogen import _layers, _orogen
from orogen._arrays import F64, Samples, heights as _heights
from orogen._layers import *  # noqa: F403

__all__ = ["Contour", "contours", *_layers.__all__]


class Contour(NamedTuple):
    """A contour line. Higher ground is to its left, with north up."""

    level: float
    """The height in metres."""
    closed: bool
    """Whether it is a ring; the first point is not repeated as the last."""
    points: F64
    """Positions of shape (n, 2): metres east and south of the first sample."""


def contours(
    heights: Samples,
    *,
    cell: float,
    interval: float | None = None,
    levels: Sequence[float] | None = None,
    nodata: float | None = None,
) -> list[Contour]:
    """Contour lines at `levels`, or at the multiples of `interval`; by default about ten.

    Lines cross the sides of the lattice where heights interpolated linearly have the level (marching squares).
    """
    data = _heights(heights, nodata)
    values = None if levels is None else [float(level) for level in levels]
    return [Contour(*line) for line in _orogen.contours(data, cell, values, interval)]
