"""The stream power law of fastscapelib, from noise to a balance of uplift and erosion.

    stream_power_fastscapelib.py SEED OUT.npy

Needs numpy and fastscapelib. Writes 512 x 512 samples of 60 m, away from the border of the simulated land.
"""

import argparse

import fastscapelib
import numpy

SIDE, BORDER, CELL = 512, 64, 60.0
STEPS, STEP = 100, 100_000.0
# Heights are proportional to the uplift, in metres per year.
UPLIFT, ERODIBILITY, CREEP = 0.25e-3, 6e-6, 0.02

parser = argparse.ArgumentParser()
parser.add_argument("seed", type=int)
parser.add_argument("out")
options = parser.parse_args()

side = SIDE + 2 * BORDER
grid = fastscapelib.RasterGrid([side, side], [CELL, CELL], fastscapelib.NodeStatus.FIXED_VALUE)
graph = fastscapelib.FlowGraph(grid, [fastscapelib.SingleFlowRouter(), fastscapelib.MSTSinkResolver()])
rivers = fastscapelib.SPLEroder(graph, k_coef=ERODIBILITY, area_exp=0.45, slope_exp=1.0, tolerance=1e-3)
creep = fastscapelib.DiffusionADIEroder(grid, CREEP)

heights = numpy.random.default_rng(options.seed).uniform(0, 20, (side, side))
uplift = numpy.full((side, side), UPLIFT * STEP)
uplift[[0, -1]] = 0
uplift[:, [0, -1]] = 0
for _ in range(STEPS):
    heights += uplift
    graph.update_routes(heights)
    heights -= rivers.erode(heights, graph.accumulate(1.0), STEP)
    heights -= creep.erode(heights, STEP)
numpy.save(options.out, heights[BORDER:-BORDER, BORDER:-BORDER])
