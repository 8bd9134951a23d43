#!/usr/bin/env python3
"""CPU seconds that a peer takes, on the heights of a .npy file: erosion.py PEER FILE CELL REPETITIONS

PEER is `richdem` (depressions filled, flats resolved, D8, accumulation), `fastscapelib` (routing and one stream power step) or
`matplotlib` (hillshade).
Prints one line of JSON: a list for each part, in seconds of this process.
"""
import json
import sys
import time

import numpy as np


def richdem(heights, repetitions):
    import richdem as rd

    parts = {"fill": [], "flats": [], "accumulation": []}
    for _ in range(repetitions):
        dem = rd.rdarray(heights.copy(), no_data=-9999)
        times = [time.process_time()]
        rd.FillDepressions(dem, epsilon=False, in_place=True)
        times.append(time.process_time())
        drained = rd.ResolveFlats(dem)
        times.append(time.process_time())
        rd.FlowAccumulation(drained, method="D8")
        times.append(time.process_time())
        for name, start, end in zip(parts, times, times[1:]):
            parts[name].append(end - start)
    return parts


def fastscapelib(heights, cell, repetitions):
    import fastscapelib as fs

    heights = heights.astype(np.float64)
    grid = fs.RasterGrid(list(heights.shape), [cell, cell], fs.NodeStatus.FIXED_VALUE)
    flow = fs.FlowGraph(grid, [fs.SingleFlowRouter(), fs.MSTSinkResolver()])
    eroder = fs.SPLEroder(flow, 2e-5, 0.45, 1, 1e-5)
    parts = {"step": []}
    for _ in range(repetitions):
        start = time.process_time()
        flow.update_routes(heights)
        eroder.erode(heights, flow.accumulate(1.0), 3e4)
        parts["step"].append(time.process_time() - start)
    return parts


def matplotlib(heights, cell, repetitions):
    from matplotlib.colors import LightSource

    light = LightSource(azdeg=315, altdeg=45)
    parts = {"hillshade": []}
    for _ in range(repetitions):
        start = time.process_time()
        light.hillshade(heights, vert_exag=1, dx=cell, dy=cell)
        parts["hillshade"].append(time.process_time() - start)
    return parts


def main():
    peer, file, cell, repetitions = sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4])
    heights = np.load(file)
    if peer == "richdem":
        parts = richdem(heights, repetitions)
    elif peer == "fastscapelib":
        parts = fastscapelib(heights, cell, repetitions)
    else:
        parts = matplotlib(heights, cell, repetitions)
    # richdem draws bars on the same output.
    print("\n" + json.dumps(parts))


main()
