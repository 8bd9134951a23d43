"""Rasters of heights, and their windows."""

import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from features import mean_slope, slopes

# Samples along a side of a window.
SIDE = 256


@dataclass(frozen=True)
class Hilly:
    """What a window must have to be judged, and whether heights below 0 count as 0."""

    slope: float
    relief: float
    flat: float
    sea: bool


MOUNTAINS = Hilly(slope=5, relief=250, flat=0.2, sea=False)
# Landscapes that are not mountains hold sea and plains; no floor of the sea is known in their real windows.
GENTLE = Hilly(slope=1, relief=50, flat=0.6, sea=True)


@dataclass
class Windows:
    """Windows of heights with their cells, and how many were too flat to be judged."""

    kept: list = field(default_factory=list)
    flat: int = 0


def read(path: Path, cell: float | None):
    """The heights of a raster, NaN where there are none, and its cell in metres."""
    if path.suffix == ".npy":
        if cell is None:
            sys.exit(f"{path}: a file of NumPy has no cell; give --cell METRES")
        return np.load(path).astype(float), cell
    import rasterio

    with rasterio.open(path) as file:
        heights = file.read(1).astype(float)
        if file.nodata is not None:
            heights[heights == file.nodata] = np.nan
        return heights, abs(file.res[0])


def windows_of(paths, cell, hilly: Hilly) -> Windows:
    """All windows of rasters, side by side from their first sample; those with gaps are left out."""
    found = Windows()
    for path in paths:
        heights, size = read(path, cell)
        if not 10 <= size <= 250:
            sys.exit(f"{path}: cells of {size:g} m; the measure holds for about 30 to 90 m")
        for row in range(0, heights.shape[0] - SIDE + 1, SIDE):
            for column in range(0, heights.shape[1] - SIDE + 1, SIDE):
                window = heights[row : row + SIDE, column : column + SIDE]
                if np.isnan(window).any():
                    continue
                window = np.maximum(window, 0) if hilly.sea else window
                if is_hilly(window, size, hilly):
                    found.kept.append((window, size))
                else:
                    found.flat += 1
    return found


def is_hilly(window, cell, hilly: Hilly) -> bool:
    flat = (slopes(window, cell) < np.tan(np.radians(1))).mean()
    return mean_slope(window, cell) > hilly.slope and np.ptp(window) > hilly.relief and flat < hilly.flat


def with_slope(window, cell, degrees):
    """The window with its heights multiplied such that its mean slope is `degrees`."""
    low, high = 1e-3, 1e3
    for _ in range(60):
        middle = (low * high) ** 0.5
        if mean_slope(window * middle, cell) < degrees:
            low = middle
        else:
            high = middle
    return window * low
