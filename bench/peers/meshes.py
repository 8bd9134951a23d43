#!/usr/bin/env python3
"""CPU seconds of pydelatin on the heights of a .npy file: meshes.py FILE MAX_ERROR REPETITIONS

Prints one line of JSON: seconds of this process, the triangles, and the greatest error, measured here over every sample.
"""
import json
import sys
import time

import numpy as np
from pydelatin import Delatin


def deviation(heights, vertices, triangles):
    """The greatest vertical distance of a sample from the triangle over it."""
    worst = 0.0
    # Its rows count from the bottom.
    column, row = vertices[:, 0].astype(int), heights.shape[0] - 1 - vertices[:, 1].astype(int)
    up = vertices[:, 2].astype("f8")
    for a, b, c in triangles:
        x0, y0 = column[a], row[a]
        x1, y1, x2, y2 = column[b] - x0, row[b] - y0, column[c] - x0, row[c] - y0
        xs = np.arange(min(0, x1, x2), max(0, x1, x2) + 1)[None, :]
        ys = np.arange(min(0, y1, y2), max(0, y1, y2) + 1)[:, None]
        area = x1 * y2 - y1 * x2
        v, w = (xs * y2 - ys * x2) / area, (x1 * ys - y1 * xs) / area
        off = np.abs(up[a] + v * (up[b] - up[a]) + w * (up[c] - up[a]) - heights[ys + y0, xs + x0])
        worst = max(worst, float(off[(v >= 0) & (w >= 0) & (v + w <= 1)].max()))
    return worst


def main():
    heights = np.load(sys.argv[1])
    seconds = []
    for _ in range(int(sys.argv[3])):
        start = time.process_time()
        tin = Delatin(heights, max_error=float(sys.argv[2]))
        seconds.append(time.process_time() - start)
    triangles = tin.triangles.reshape(-1, 3)
    error = deviation(heights, tin.vertices.reshape(-1, 3), triangles)
    print(json.dumps({"seconds": seconds, "triangles": len(triangles), "error": error}))


main()
