"""The stream power law of landlab, from noise to a balance of uplift and erosion.

    stream_power_landlab.py SEED OUT.npy

Needs numpy and landlab. Writes 512 x 512 samples of 60 m, away from the border of the simulated land.
"""

import argparse

import numpy
from landlab import RasterModelGrid
from landlab.components import FastscapeEroder, FlowAccumulator, LinearDiffuser

SIDE, BORDER, CELL = 512, 64, 60.0
STEPS, STEP = 100, 100_000.0
# Heights are proportional to the uplift, in metres per year.
UPLIFT, ERODIBILITY, CREEP = 0.25e-3, 6e-6, 0.02

parser = argparse.ArgumentParser()
parser.add_argument("seed", type=int)
parser.add_argument("out")
options = parser.parse_args()

side = SIDE + 2 * BORDER
grid = RasterModelGrid((side, side), xy_spacing=CELL)
noise = numpy.random.default_rng(options.seed).uniform(0, 20, side * side)
heights = grid.add_field("topographic__elevation", noise, at="node")
# Depressions of the noise rise until they drain.
flow = FlowAccumulator(grid, flow_director="FlowDirectorD8")
rivers = FastscapeEroder(grid, K_sp=ERODIBILITY, m_sp=0.45, n_sp=1.0)
creep = LinearDiffuser(grid, linear_diffusivity=CREEP)
for _ in range(STEPS):
    heights[grid.core_nodes] += UPLIFT * STEP
    flow.run_one_step()
    rivers.run_one_step(STEP)
    creep.run_one_step(STEP)
numpy.save(options.out, heights.reshape(side, side)[BORDER:-BORDER, BORDER:-BORDER])
