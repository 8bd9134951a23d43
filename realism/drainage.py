"""Depressions and drainage of a window of heights.

All functions take heights of one window as a two-dimensional array; water leaves at its border.
"""

import heapq

import numpy as np

try:
    from numba import njit
except ImportError:

    def njit(*_args, **_options):
        return lambda function: function


# Steps to the eight neighbors, row by row.
ROWS = np.array([-1, -1, -1, 0, 0, 1, 1, 1])
COLUMNS = np.array([-1, 0, 1, -1, 1, -1, 0, 1])
LENGTHS = np.hypot(ROWS, COLUMNS)

# Cells from which on water runs in a channel.
CHANNEL = 64


@njit(cache=True)
def flood(heights):
    """Fills depressions by Priority-Flood (Barnes, Lehman and Mulla 2014).

    Returns the filled heights, the cells in the order in which they were flooded, and the cell from which each was
    flooded (-1 on the border).
    """
    rows, columns = heights.shape
    filled = heights.copy()
    order = np.empty(rows * columns, np.int64)
    parents = np.full(rows * columns, -1, np.int64)
    is_seen = np.zeros((rows, columns), np.bool_)
    queue = [(0.0, np.int64(0), np.int64(0))]
    queue.clear()
    # Equal heights leave the queue in the order in which they came.
    count = np.int64(0)
    for row in range(rows):
        for column in range(columns):
            if row == 0 or column == 0 or row == rows - 1 or column == columns - 1:
                is_seen[row, column] = True
                heapq.heappush(queue, (heights[row, column], count, np.int64(row * columns + column)))
                count += 1
    done = 0
    while len(queue) > 0:
        level, _, cell = heapq.heappop(queue)
        order[done] = cell
        done += 1
        for step in range(8):
            row = cell // columns + ROWS[step]
            column = cell % columns + COLUMNS[step]
            if row < 0 or column < 0 or row >= rows or column >= columns or is_seen[row, column]:
                continue
            is_seen[row, column] = True
            other = row * columns + column
            parents[other] = cell
            filled[row, column] = max(heights[row, column], level)
            heapq.heappush(queue, (filled[row, column], count, np.int64(other)))
            count += 1
    return filled, order, parents


@njit(cache=True)
def network(filled, order, parents):
    """Steepest descent over filled heights (D8); on level ground towards the cell from which it was flooded.

    Returns for each cell its receiver (-1 on the border), the length of the step to it in cells, the number of cells
    that drain through it, and the length of the longest path that ends in it.
    """
    rows, columns = filled.shape
    receivers = parents.copy()
    lengths = np.ones(rows * columns)
    for cell in range(rows * columns):
        if parents[cell] < 0:
            continue
        row = cell // columns
        column = cell % columns
        steepest = 0.0
        for step in range(8):
            to_row = row + ROWS[step]
            to_column = column + COLUMNS[step]
            # Cells inside the window have all neighbors.
            slope = (filled[row, column] - filled[to_row, to_column]) / LENGTHS[step]
            if slope > steepest:
                steepest = slope
                receivers[cell] = to_row * columns + to_column
        across = receivers[cell] // columns - row
        along = receivers[cell] % columns - column
        lengths[cell] = np.sqrt(float(across * across + along * along))
    areas = np.ones(rows * columns)
    longest = np.zeros(rows * columns)
    for index in range(len(order) - 1, -1, -1):
        cell = order[index]
        to = receivers[cell]
        if to >= 0:
            areas[to] += areas[cell]
            longest[to] = max(longest[to], longest[cell] + lengths[cell])
    return receivers, lengths, areas, longest


def drainage_areas(heights):
    """The number of cells that drain through each cell."""
    filled, order, parents = flood(np.ascontiguousarray(heights, float))
    return network(filled, order, parents)[2].reshape(heights.shape)


def pits(heights):
    """The share of samples that are lower than all eight neighbors."""
    return lowest(heights) / heights.size


def lowest(heights):
    """The number of samples inside the window that are lower than all eight neighbors."""
    rows, columns = heights.shape
    around = [heights[1 + r : rows - 1 + r, 1 + c : columns - 1 + c] for r, c in zip(ROWS, COLUMNS)]
    return int((heights[1:-1, 1:-1] < np.minimum.reduce(around)).sum())


def depressions(heights, filled):
    """The share of samples inside the window that filling raises, and its mean rise over the spread of heights."""
    rise = (filled - heights)[1:-1, 1:-1]
    return (rise > 1e-6 * np.ptp(heights)).mean(), rise.mean() / (heights.std() + 1e-12)


def line(xs, ys):
    """The slope of the line through points, or NaN for fewer than four."""
    return np.polyfit(xs, ys, 1)[0] if len(xs) >= 4 else np.nan


def drainage_features(heights, cell):
    """The exponents of the slopes, lengths and areas of the channels of a window, and its depressions."""
    filled, order, parents = flood(heights)
    receivers, lengths, areas, longest = network(filled, order, parents)
    share, depth = depressions(heights, filled)
    inside = receivers >= 0
    flat = filled.ravel()
    slopes = np.zeros(flat.size)
    slopes[inside] = (flat[inside] - flat[receivers[inside]]) / (lengths[inside] * cell)

    # Channels by classes of area.
    edges = np.geomspace(CHANNEL, areas.max() / 2, 12)
    classes = np.digitize(areas, edges)
    steepness, course = [], []
    for each in range(1, len(edges)):
        channel = inside & (areas >= CHANNEL) & (classes == each)
        if channel.sum() >= 20 and slopes[channel].mean() > 0:
            steepness.append((np.log(areas[channel].mean()), np.log(slopes[channel].mean())))
        if channel.sum() >= 5:
            course.append((np.log(np.median(areas[channel])), np.log(np.median(longest[channel]))))

    larger = np.geomspace(8, flat.size / 100, 14)
    shares = np.array([(areas > area).mean() for area in larger])
    found = shares > 0
    return {
        "log_fill": np.log10(share + 1e-3),
        "fill_depth": depth,
        "theta": -line(*zip(*steepness)) if steepness else np.nan,
        "hack": line(*zip(*course)) if course else np.nan,
        "area_exp": -np.polyfit(np.log(larger[found]), np.log(shares[found]), 1)[0],
    }
