#!/usr/bin/env python3
"""CPU seconds of Python packages on the heights of a .npy file: python.py PACKAGE FILE CELL REPETITIONS

Prints one line of JSON: a list of seconds of this process for each part. Parts of noise are seconds a sample.
"""

import json
import sys
import tempfile
import time
import warnings

import numpy as np

# Samples along the side of noise: packages that loop in Python get fewer.
LARGE, SMALL = 1024, 128
OCTAVES = 6


def timed(repetitions, **parts):
    """The times of functions; a first call of each compiles and loads what it needs."""
    for function in parts.values():
        function()
    times = {name: [] for name in parts}
    for _ in range(repetitions):
        for name, function in parts.items():
            start = time.process_time()
            function()
            times[name].append(time.process_time() - start)
    return times


def a_sample(times, side):
    return {name: [seconds / side**2 for seconds in values] for name, values in times.items()}


def orogen(heights, cell, repetitions):
    from orogen import World, analysis, hydrology, noise

    y, x = np.ogrid[0:LARGE, 0:LARGE]
    times = timed(
        repetitions,
        fill=lambda: hydrology.fill(heights),
        accumulate=lambda: hydrology.accumulate(heights, cell=cell),
        slope=lambda: analysis.slope(heights, cell=cell),
        hillshade=lambda: analysis.hillshade(heights, cell=cell),
    )
    times |= a_sample(
        timed(
            repetitions,
            perlin=lambda: noise.perlin(x, y, wavelength=64, octaves=OCTAVES),
            simplex=lambda: noise.opensimplex2(x, y, wavelength=64),
        ),
        LARGE,
    )
    return times | timed(min(repetitions, 5), window=lambda: World("hills", cache=False).window(size=4096))


def richdem(heights, cell, repetitions):
    import richdem as rd

    def accumulated():
        dem = rd.rdarray(heights.copy(), no_data=-9999)
        rd.FillDepressions(dem, epsilon=False, in_place=True)
        rd.FlowAccumulation(rd.ResolveFlats(dem), method="D8")

    dem = rd.rdarray(heights, no_data=-9999)
    return timed(
        repetitions,
        fill=lambda: rd.FillDepressions(dem, epsilon=False),
        accumulate=accumulated,
        slope=lambda: rd.TerrainAttribute(dem, attrib="slope_degrees"),
    )


def fastscapelib(heights, cell, repetitions):
    import fastscapelib as fs

    heights = heights.astype(np.float64)
    grid = fs.RasterGrid(list(heights.shape), [cell, cell], fs.NodeStatus.FIXED_VALUE)
    flow = fs.FlowGraph(grid, [fs.SingleFlowRouter(), fs.MSTSinkResolver()])

    def accumulated():
        flow.update_routes(heights)
        flow.accumulate(1.0)

    return timed(repetitions, accumulate=accumulated)


def pysheds(heights, cell, repetitions):
    from affine import Affine
    from pysheds.grid import Grid
    from pysheds.view import Raster, ViewFinder

    # Version 0.5 calls what NumPy 2.4 has no more.
    np.in1d = np.isin
    shape = ViewFinder(affine=Affine(cell, 0, 0, 0, -cell, 0), shape=heights.shape, nodata=np.float64(-9999))
    dem = Raster(heights.astype(np.float64), viewfinder=shape)
    grid = Grid.from_raster(dem)

    def filled():
        return grid.fill_depressions(grid.fill_pits(dem))

    def accumulated():
        grid.accumulation(grid.flowdir(grid.resolve_flats(filled())))

    return timed(min(repetitions, 3), fill=filled, accumulate=accumulated)


def xrspatial(heights, cell, repetitions):
    import xarray as xr
    import xrspatial

    y, x = cell * np.arange(heights.shape[0])[::-1], cell * np.arange(heights.shape[1])
    dem = xr.DataArray(heights, {"y": y, "x": x}, ("y", "x"), attrs={"res": (cell, cell)})
    return timed(repetitions, slope=lambda: xrspatial.slope(dem), hillshade=lambda: xrspatial.hillshade(dem))


def whitebox_workflows(heights, cell, repetitions):
    import whitebox_workflows

    env = whitebox_workflows.WbEnvironment()
    env.verbose = False
    rows, columns = heights.shape
    header = f"ncols {columns}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize {cell}\nNODATA_value -9999"
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/heights.asc"
        np.savetxt(path, heights, "%.9g", header=header, comments="")
        dem = env.read_raster(path, "m")
    water, land = env.hydrology, env.terrain

    def filled():
        return water.fill_depressions(dem=dem)

    return timed(
        min(repetitions, 3),
        fill=filled,
        accumulate=lambda: water.d8_flow_accum(input=filled()),
        slope=lambda: land.slope(input=dem),
        hillshade=lambda: land.hillshade(input=dem),
    )


def noise(heights, cell, repetitions):
    from noise import pnoise2

    def perlin():
        return [[pnoise2(x / 64, y / 64, octaves=OCTAVES) for x in range(SMALL)] for y in range(SMALL)]

    return a_sample(timed(repetitions, perlin=perlin), SMALL)


def opensimplex(heights, cell, repetitions):
    import opensimplex as package

    package.seed(1)
    at = np.arange(SMALL) / 64
    return a_sample(timed(repetitions, simplex=lambda: package.noise2array(at, at)), SMALL)


def main():
    package, file, cell, repetitions = sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4])
    warnings.simplefilter("ignore")
    times = globals()[package](np.load(file), cell, repetitions)
    # Some packages print.
    print("\n" + json.dumps(times))


main()
