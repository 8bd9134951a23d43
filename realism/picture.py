#!/usr/bin/env python3
"""Hillshades of land side by side.

    picture.py FILES -o picture.jpg [--columns 4] [--slope 17.6]

Files are GeoTIFFs, or arrays of NumPy with cells of 60 m. Of each the first 256 x 256 samples are shown, with heights
multiplied such that the mean slope is the given one, as `score.py` does.
"""

import argparse
import warnings
from pathlib import Path

import numpy as np
import rasterio
import rasterio.errors
from scipy import ndimage

import rasters

# Pixels along a side, and between hillshades.
SIZE, GAP = 300, 4


def hillshade(heights, cell):
    """Light from the north-west, 45 degrees above the horizon."""
    south, east = np.gradient(heights, cell)
    return (1 + (east + south) * 0.5**0.5) / np.sqrt(2 * (1 + east**2 + south**2))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rasters", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--columns", type=int, default=4)
    parser.add_argument("--slope", type=float, default=17.6, help="mean slope in degrees")
    options = parser.parse_args()
    rows = -(-len(options.rasters) // options.columns)
    step = SIZE + GAP
    picture = np.full((rows * step - GAP, options.columns * step - GAP), 255, np.uint8)
    for index, path in enumerate(options.rasters):
        heights, cell = rasters.read(path, 60)
        window = rasters.with_slope(heights[: rasters.SIDE, : rasters.SIDE], cell, options.slope)
        shade = ndimage.zoom(hillshade(window, cell), SIZE / rasters.SIDE, order=1)
        y, x = (step * at for at in divmod(index, options.columns))
        picture[y : y + SIZE, x : x + SIZE] = np.clip(shade * 255, 0, 255)
    rows, columns = picture.shape
    # A picture has no place on Earth.
    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    form = {"driver": "JPEG", "count": 1, "dtype": "uint8", "quality": 75}
    with rasterio.open(options.out, "w", width=columns, height=rows, **form) as file:
        file.write(picture, 1)


if __name__ == "__main__":
    main()
