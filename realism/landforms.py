"""Geomorphons (Jasiewicz and Stepinski 2013): which of ten landforms each sample belongs to."""

import numpy as np

from drainage import COLUMNS, LENGTHS, ROWS

LANDFORMS = ("flat", "peak", "ridge", "shoulder", "spur", "slope", "hollow", "footslope", "valley", "pit")

# The landform by the number of directions that look down (rows) and up (columns).
_BY_COUNTS = (
    "flat flat flat footslope footslope valley valley valley pit",
    "flat flat footslope footslope footslope valley valley valley",
    "flat shoulder slope slope hollow hollow valley",
    "shoulder shoulder slope slope slope hollow",
    "shoulder shoulder spur slope slope",
    "ridge ridge spur spur",
    "ridge ridge ridge",
    "ridge ridge",
    "peak",
)
_TABLE = np.zeros((9, 9), int)
for _row, _names in enumerate(_BY_COUNTS):
    for _column, _name in enumerate(_names.split()):
        _TABLE[_row, _column] = LANDFORMS.index(_name)


def landform_shares(heights, cell, reach=10, flat=1.0):
    """The share of each landform.

    `reach` is the length of sight in samples, `flat` the angle of level ground in degrees. Samples nearer than `reach`
    to the border have no landform.
    """
    rows, columns = heights.shape
    center = heights[reach : rows - reach, reach : columns - reach]
    up = np.zeros(center.shape, int)
    down = np.zeros(center.shape, int)
    for row, column, length in zip(ROWS, COLUMNS, LENGTHS):
        highest = np.full(center.shape, -np.inf)
        lowest = np.full(center.shape, np.inf)
        for step in range(1, reach + 1):
            y, x = reach + step * row, reach + step * column
            seen = (heights[y : y + center.shape[0], x : x + center.shape[1]] - center) / (step * length * cell)
            np.maximum(highest, seen, out=highest)
            np.minimum(lowest, seen, out=lowest)
        angle = np.degrees(np.arctan(highest) + np.arctan(lowest))
        up += angle > flat
        down += angle < -flat
    return np.bincount(_TABLE[down, up].ravel(), minlength=len(LANDFORMS)) / center.size
