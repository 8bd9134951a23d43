"""Windows of real land for training: `python prepare.py FOLDER windows.npz`.

FOLDER has the files of places.py. Sea is removed, land of 30 m is averaged to 60 m (the smallest cells of such heights
are noise of the radar), depressions are breached, and each place is used at its cell and at twice its cell. Drainage
areas are those of the whole place.
"""

import argparse
import heapq
from pathlib import Path

import numpy as np
import rasterio

from places import PLACES, path_of

# Samples along the side of a window.
SIDE = 95
# Windows of a place at its own cell; a third as many at twice the cell.
WINDOWS = 900
# Depressions up to this depth in metres are breached; others are kept.
DEEPEST = 60.0
# Heights up to this are sea, in metres.
SEA = 1.0
# Fall of a breached channel per sample, in metres.
FALL = 1e-3
# Passes that fill single voids.
GAP_PASSES = 3
SEED = 0


def without_gaps(heights):
    """Heights where a void whose neighbors are mostly known has their mean, so that single voids cost no windows."""
    rows, columns = heights.shape
    bordered = np.pad(heights, 1, constant_values=np.nan)
    shifts = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    around = np.stack([bordered[i : i + rows, j : j + columns] for i, j in shifts])
    known = np.isfinite(around)
    sum, count = np.where(known, around, 0).sum(0), known.sum(0)
    return np.where(np.isnan(heights) & (count >= 5), sum / np.maximum(count, 1), heights)


def heights_of(path):
    """Heights with NaN for sea and voids, and the cell in metres."""
    with rasterio.open(path) as file:
        heights = file.read(1).astype(np.float64)
        heights[heights == file.nodata] = np.nan
        for _ in range(GAP_PASSES):
            heights = without_gaps(heights)
        heights[heights <= SEA] = np.nan
        return heights, file.res[0]


def halved(heights):
    """Means of 2 x 2 samples."""
    rows, columns = (side // 2 * 2 for side in heights.shape)
    return heights[:rows, :columns].reshape(rows // 2, 2, columns // 2, 2).mean((1, 3))


def breached(heights):
    """Heights with channels through the rims of depressions (Lindsay 2016): a flood by priority from voids and borders,
    where each sample that lies lower than the flood cuts its way out along the samples that flooded it."""
    rows, columns = heights.shape
    width = columns + 2
    bordered = np.full((rows + 2, width), np.nan)
    bordered[1:-1, 1:-1] = heights
    z = bordered.ravel().tolist()
    is_done = np.isnan(bordered).ravel().tolist()
    flood = list(z)
    parent = [-1] * len(z)
    steps = (-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1)
    queue = []
    for at, done in enumerate(is_done):
        if not done and any(is_done[at + step] for step in steps):
            queue.append((z[at], at))
    for _, at in queue:
        is_done[at] = True
    heapq.heapify(queue)
    while queue:
        _, at = heapq.heappop(queue)
        for step in steps:
            near = at + step
            if is_done[near]:
                continue
            is_done[near], parent[near] = True, at
            if z[near] <= flood[at]:
                if flood[at] - z[near] <= DEEPEST:
                    limit, way = z[near], at
                    while way >= 0:
                        limit -= FALL
                        if z[way] <= limit:
                            break
                        z[way] = flood[way] = limit
                        way = parent[way]
                else:
                    flood[near] = flood[at]
            heapq.heappush(queue, (flood[near], near))
    return np.array(z).reshape(rows + 2, width)[1:-1, 1:-1]


def drainage_areas(heights):
    """Binary logarithms of drainage areas in samples, down the steepest slopes (O'Callaghan and Mark 1984)."""
    rows, columns = heights.shape
    bordered = np.full((rows + 2, columns + 2), np.nan)
    bordered[1:-1, 1:-1] = heights
    steepest = np.zeros((rows, columns))
    receiver = np.full((rows, columns), -1)
    index = np.arange(rows * columns).reshape(rows, columns)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            if (i, j) == (0, 0):
                continue
            near = bordered[1 + i : 1 + i + rows, 1 + j : 1 + j + columns]
            slope = (heights - near) / np.hypot(i, j)
            is_steeper = slope > steepest
            steepest = np.where(is_steeper, slope, steepest)
            receiver = np.where(is_steeper, index + i * columns + j, receiver)
    areas = [1.0] * heights.size
    receivers = receiver.ravel().tolist()
    for at in np.argsort(-heights, axis=None, kind="stable").tolist():
        if receivers[at] >= 0:
            areas[receivers[at]] += areas[at]
    return np.log2(areas).reshape(rows, columns)


def windows_of(heights, cell, count, random):
    """Rows and columns of up to `count` windows of hilly land without voids; steep land is chosen more often."""
    south, east = np.gradient(heights, cell)
    slope = np.hypot(east, south)
    found = []
    for _ in range(30 * count):
        if len(found) == count or min(heights.shape) <= SIDE:
            break
        row, column = random.integers(0, heights.shape[0] - SIDE), random.integers(0, heights.shape[1] - SIDE)
        here = np.s_[row : row + SIDE, column : column + SIDE]
        if not np.isfinite(slope[here]).all():
            continue
        mean = slope[here].mean()
        if mean < 0.05 or (slope[here] < 0.017).mean() > 0.35 or random.random() > mean / 0.25 + 0.15:
            continue
        found.append(here)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    options = parser.parse_args()
    random = np.random.default_rng(SEED)
    windows, areas, cells = [], [], []
    for place in PLACES:
        heights, cell = heights_of(path_of(place, options.folder))
        if cell < 45:
            heights, cell = halved(heights), 2 * cell
        for count in (WINDOWS, WINDOWS // 3):
            drained = breached(heights)
            area = drainage_areas(drained)
            found = windows_of(drained, cell, count, random)
            print(f"{place.file}, cells of {cell:g} m: {len(found)} windows", flush=True)
            # In cells, about 0.
            windows += [(drained[here] - drained[here].mean()) / cell for here in found]
            areas += [area[here].astype(np.float16) for here in found]
            cells += [cell] * len(found)
            heights, cell = halved(heights), 2 * cell
    arrays = {"windows": np.array(windows, np.float32), "areas": np.array(areas), "cells": np.array(cells, np.float32)}
    np.savez(options.out, **arrays)


if __name__ == "__main__":
    main()
