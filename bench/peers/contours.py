#!/usr/bin/env python3
"""CPU seconds of contourpy on the heights of a .npy file: contours.py FILE LEVEL,LEVEL,... REPETITIONS

Its default algorithm ("serial"), lines as arrays of points. Prints one line of JSON: seconds of this process, and the points
of all lines.
"""
import json
import sys
import time

import contourpy
import numpy as np


def main():
    heights = np.load(sys.argv[1])
    levels = [float(level) for level in sys.argv[2].split(",")]
    seconds = []
    for _ in range(int(sys.argv[3])):
        start = time.process_time()
        generator = contourpy.contour_generator(z=heights, name="serial", line_type=contourpy.LineType.Separate)
        lines = [generator.lines(level) for level in levels]
        seconds.append(time.process_time() - start)
    points = sum(len(line) for level in lines for line in level)
    print(json.dumps({"seconds": seconds, "points": points}))


main()
