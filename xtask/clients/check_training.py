"""Checks training: the scripts run with PyTorch, and the networks that they write make the same land in orogen."""

import os
import subprocess
import sys

from orogen import ROOT, WORK, Checks, orogen

TRAINING = ROOT / "training"

# PyTorch is large, so it has an environment of its own, in which this script runs again.
if "torch" not in os.environ.get("OROGEN_INSIDE", ""):
    home = WORK.parent.parent / "training"
    python = home / "bin/python"
    if not python.is_file():
        subprocess.run([sys.executable, "-m", "venv", home], check=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", TRAINING / "requirements.txt"], check=True)
    sys.exit(subprocess.run([python, __file__], env=os.environ | {"OROGEN_INSIDE": "torch"}).returncode)

sys.path.insert(0, str(TRAINING))
sys.dont_write_bytecode = True

import draw  # noqa: E402
import numpy  # noqa: E402
import prepare  # noqa: E402
import rasterio  # noqa: E402
import train  # noqa: E402
from network_file import read_network, write_network  # noqa: E402
from rasterio.transform import from_origin  # noqa: E402

checks = Checks()
WORK.mkdir(parents=True, exist_ok=True)
RECIPE = """orogen = 1
[world]
seed = 3
size = [13500, 10800]
cell = 45
[nodes.place]
op = "dem"
path = "land.tif"
[nodes.fine]
op = "learned"
source = "place"
cell = 45
halvings = 1
seed = 2
noise = {noise}
weights = "{weights}"
[outputs]
height = "fine"
"""

HILLSLOPES = """orogen = 1
[world]
seed = 3
size = [{columns}, {rows}]
cell = 90
[nodes.place]
op = "dem"
path = "drained.tif"
[nodes.water]
op = "drainage"
source = "place"
[nodes.slopes]
op = "hillslopes"
source = "place"
flow = "water.flow"
receiver = "water.receiver"
rivers = {rivers}
seed = 2
weights = "{weights}"
[outputs]
height = "slopes"
flow = "water.flow"
"""

# Land of orogen with depressions, in place of real land.
orogen("export", "alpine", "--cell", "90", "--window", "0,0,260,240", "-o", WORK / "alpine.npy", "-q", "--force")
land = numpy.load(WORK / "alpine.npy").astype(numpy.float64)
land += 15 * numpy.random.default_rng(1).standard_normal(land.shape)
drained = prepare.breached(land)


def pits(heights):
    rows, columns = heights.shape
    around = [heights[i : rows - 2 + i, j : columns - 2 + j] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    return int((numpy.minimum.reduce(around) > heights[1:-1, 1:-1]).sum())


checks.that("breaching leaves no depression", pits(drained) == 0 < pits(land), (pits(land), pits(drained)))
windows = prepare.windows_of(drained, 90.0, 40, numpy.random.default_rng(0))
checks.that("windows of the land", len(windows) == 40 and drained[windows[0]].shape == (prepare.SIDE, prepare.SIDE), len(windows))
areas = prepare.drainage_areas(drained)
arrays = {
    "windows": numpy.array([(drained[here] - drained[here].mean()) / 90 for here in windows], numpy.float32),
    "areas": numpy.array([areas[here] for here in windows], numpy.float16),
    "cells": numpy.full(len(windows), 90, numpy.float32),
}
numpy.savez(WORK / "windows.npz", **arrays)

lines = []
prepared = train.Windows(WORK / "windows.npz")
network = train.trained(prepared, 10, lines.append)
write_network(WORK / "trained.network", network, prepared.cells, ["land of orogen"])
again, _ = read_network(WORK / "trained.network")
checks.that("a network is read as it was written", all((a == b).all() for a, b in zip(network.parameters(), again.parameters())))

heights = drained[:120, :150].astype(numpy.float32)
with rasterio.open(
    WORK / "land.tif", "w", driver="GTiff", width=150, height=120, count=1, dtype="float32", crs="EPSG:32632", transform=from_origin(0, 0, 90, 90)
) as file:
    file.write(heights, 1)
built_in = ROOT / "crates/orogen-grid/src/learned/land.network"
for weights in (WORK / "trained.network", built_in):
    network, cells = read_network(weights)
    for noise in (0.0, 1.0):
        recipe = WORK / "fine.toml"
        recipe.write_text(RECIPE.format(noise=noise, weights=weights))
        halo = network.halo
        window = f"{2 * halo},{2 * halo},{2 * (150 - 2 * halo)},{2 * (120 - 2 * halo)}"
        orogen("export", recipe, "--window", window, "-o", WORK / "fine.npy", "-q", "--no-cache", "--force")
        made = numpy.load(WORK / "fine.npy")
        want = draw.finer(network, cells, heights.astype(numpy.float64), 90.0, noise, draw.seed_of(3, 2))
        off = numpy.abs(made - want).max()
        checks.that(f"{weights.name}, noise {noise}: PyTorch makes the same heights", made.shape == want.shape and off < 0.02, off)
        smooth = numpy.abs(made[::2, ::2] - heights[halo:-halo, halo:-halo]).mean()
        checks.that(f"{weights.name}, noise {noise}: detail is added", smooth > 0.01, smooth)

# Between rivers: the same land, with the drainage of orogen.
rows, columns = (side // 2 * 2 for side in drained.shape)
land = drained[:rows, :columns].astype(numpy.float32)
with rasterio.open(
    WORK / "drained.tif", "w", driver="GTiff", width=columns, height=rows, count=1, dtype="float32", crs="EPSG:32632",
    transform=from_origin(0, 0, 90, 90),
) as file:
    file.write(land, 1)
network = train.trained(train.Windows(WORK / "windows.npz", rivers=True), 10, lines.append)
write_network(WORK / "rivers.network", network, prepared.cells, ["land of orogen"])
LEAST = 32
for weights in (WORK / "rivers.network", ROOT / "crates/orogen-grid/src/learned/rivers.network"):
    network, cells = read_network(weights)
    recipe = WORK / "hillslopes.toml"
    recipe.write_text(HILLSLOPES.format(columns=90 * columns, rows=90 * rows, rivers=LEAST, weights=weights))
    layers = {}
    for layer in ("height", "flow"):
        orogen("export", recipe, "--layer", layer, "-o", WORK / "layer.npy", "-q", "--no-cache", "--force")
        layers[layer] = numpy.load(WORK / "layer.npy").astype(numpy.float64)
    want, kept = draw.hillslopes(network, cells, land.astype(numpy.float64), layers["flow"] / 8100, LEAST, 90.0, 1.0, draw.seed_of(3, 2))
    border = 2 * network.halo
    made = layers["height"][border : border + want.shape[0], border : border + want.shape[1]]
    beds = land[border : border + want.shape[0], border : border + want.shape[1]]
    checks.that(f"{weights.name}: beds are kept", (made[kept] == beds[kept]).all() and kept.mean() > 0.02, kept.mean())
    off = (made - want)[~kept]
    same = (numpy.abs(off) < 0.02).mean()
    checks.that(f"{weights.name}: PyTorch makes the same slopes, except those that are raised", same > 0.9 and off.min() > -0.02, (same, off.min()))
checks.end()
