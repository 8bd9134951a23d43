"""Hydrology on 2-D arrays of heights.

All functions take an array of heights of shape (rows, columns), row 0 in the north, of any number type and memory order;
masked samples, NaN and samples equal to `nodata` are outside the land. They return new arrays of the same shape. `cell`
is the distance between samples in metres. Water leaves at the border, beside samples without a height, and at and below
`sea_level`. Long work can be interrupted with Ctrl-C; `progress` is a function that is called with the share that is
done, or True for a bar of tqdm.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from orogen import _orogen
from orogen._arrays import F32, Samples, heights as _heights
from orogen._progress import Progress, listener

__all__ = [
    "AboveDrainage",
    "Lakes",
    "accumulate",
    "above_drainage",
    "breach",
    "fill",
    "flow_direction",
    "lakes",
    "stream_order",
    "watersheds",
]


class AboveDrainage(NamedTuple):
    """Result of `above_drainage`."""

    height: F32
    """Height above the nearest stream along the flow path (HAND), in the unit of the heights."""
    distance: F32
    """Length of the flow path to the stream, in metres."""


class Lakes(NamedTuple):
    """Result of `lakes`."""

    labels: npt.NDArray[np.uint32]
    """The lake of each cell, numbered from 1 in row order; 0 on land."""
    surface: F32
    """The water surface in lakes, and the ground elsewhere."""


def fill(
    heights: Samples, *, nodata: float | None = None, sea_level: float | None = None, progress: Progress = None
) -> F32:
    """Fills depressions to their spill level: every cell then has a path to an outlet that never rises.

    Returns float32 of the shape of `heights`. Method: Cordonnier, Bovy and Braun (2019).
    """
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        return _orogen.fill(data, sea_level, heard)


def breach(
    heights: Samples,
    *,
    max_depth: float = float("inf"),
    max_length: int = 1_000_000,
    nodata: float | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> F32:
    """Cuts channels through the rims of depressions along least-cost paths; fills what would need more.

    `max_depth` is the greatest depth of a cut in the unit of the heights, `max_length` the greatest length of a channel
    in cells. Method: Lindsay (2016), as `BreachDepressionsLeastCost` of WhiteboxTools.
    """
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        return _orogen.breach(data, max_depth, max_length, sea_level, heard)


def flow_direction(
    heights: Samples,
    *,
    convention: str = "esri",
    random: int | None = None,
    nodata: float | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> npt.NDArray[np.uint8]:
    """The D8 direction in which each cell drains. Depressions drain through their lowest pass.

    `convention` chooses the codes: "esri" (also pysheds and richdem), "grass", "taudem", "whitebox" or "pcraster". With
    a seed as `random`, diagonals get random lengths (Rho8, Fairfield and Leymarie 1991).
    """
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        return _orogen.flow_direction(data, convention, random, sea_level, heard)


def accumulate(
    heights: Samples,
    *,
    cell: float = 1.0,
    rain: Samples | None = None,
    nodata: float | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> F32:
    """The area that drains through each cell, the cell included, in square metres (D8).

    With `cell=1` these are numbers of cells. `rain` weights cells: an array of the shape of the heights, of factors
    from 0.01 to 100. Depressions drain through their lowest pass.
    """
    data = _heights(heights, nodata)
    weights = None if rain is None else _heights(rain, name="rain")
    with listener(progress) as heard:
        return _orogen.accumulate(data, cell, weights, sea_level, heard)


def watersheds(
    heights: Samples, *, nodata: float | None = None, sea_level: float | None = None, progress: Progress = None
) -> npt.NDArray[np.uint32]:
    """The watershed of each cell: the number of its outlet, from 1; 0 for outlets to which no other cell drains."""
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        return _orogen.watersheds(data, sea_level, heard)


def stream_order(
    heights: Samples,
    *,
    area: float,
    cell: float = 1.0,
    nodata: float | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> npt.NDArray[np.uint8]:
    """The Strahler order of each stream cell, 0 elsewhere. Streams drain at least `area` square metres."""
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        return _orogen.stream_order(data, cell, area, sea_level, heard)


def above_drainage(
    heights: Samples,
    *,
    area: float,
    cell: float = 1.0,
    nodata: float | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> AboveDrainage:
    """Height above the nearest drainage (HAND, Rennó and others 2008), and the length of the path to it.

    Streams drain at least `area` square metres.
    """
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        made: Any = _orogen.above_drainage(data, cell, area, sea_level, heard)
    return AboveDrainage(*made)


def lakes(
    heights: Samples,
    *,
    area: float,
    cell: float = 1.0,
    nodata: float | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> Lakes:
    """The depressions of at least `area` square metres as lakes; smaller ones are filled."""
    data = _heights(heights, nodata)
    with listener(progress) as heard:
        made: Any = _orogen.lakes(data, cell, area, sea_level, heard)
    return Lakes(*made)
