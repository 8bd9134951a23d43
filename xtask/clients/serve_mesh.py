"""Checks of the meshes that `orogen serve` answers: a decoder of quantized-mesh finds the samples of exports."""

import json
import subprocess
import urllib.request

import numpy
from orogen import NODE_BIN, ROOT, export

# Cells along a side of a tile.
CELLS = 256


def check(checks, base):
    """Reads tiles of the preset `hills`."""
    with urllib.request.urlopen(f"{base}hills/mesh/layer.json") as answer:
        layer = json.load(answer)
    zoom = 12
    ranges = layer["available"][zoom][0]
    west, north = ranges["startX"], ranges["endY"]
    checks.equal("layer.json: the north-west corner at 0 degrees", (west, north), (1 << zoom, (1 << zoom - 1) - 1))
    places = [(west, north), (west + 1, north), (west, north - 1)]
    paths = [layer["tiles"][0].format(z=zoom, x=column, y=row) for column, row in places]
    line = ["node", ROOT / "xtask/clients/read_mesh.mjs", NODE_BIN.parent, *paths]
    tiles = json.loads(subprocess.run(line, capture_output=True, check=True, text=True).stdout)

    cell = 2 * 20037508.342789244 / (2 << zoom) / CELLS
    heights = numpy.load(export("hills", "mesh.npy", "--cell", repr(cell), "--window", f"0,0,{CELLS + 1},{CELLS + 1}"))
    own, east, south = ({key: numpy.array(tile[key]) for key in ("u", "v", "heights")} for tile in tiles)
    column, row = (numpy.rint(own[key] * CELLS / 32767).astype(int) for key in ("u", "v"))
    difference = numpy.abs(own["heights"] - heights[CELLS - row, column]).max()
    checks.that("quantized-mesh: vertices are samples", difference <= 0.25, difference)
    count = len(column)
    checks.that("quantized-mesh: fewer vertices than samples", 100 < count < (CELLS + 1) ** 2 / 4, count)
    checks.equal("quantized-mesh: two bytes of normal a vertex", tiles[0]["normals"], 2 * count)

    # The area of all triangles is that of the tile, and all are counter-clockwise.
    corners = numpy.array(tiles[0]["triangles"]).reshape(-1, 3)
    x, y = (own[key][corners].astype(numpy.int64) for key in ("u", "v"))
    twice = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    checks.that("quantized-mesh: triangles cover the tile", twice.min() > 0 and twice.sum() == 2 * 32767**2, twice.sum())

    def edge(index, side):
        tile = {key: numpy.array(tiles[index][key])[tiles[index]["edges"][side]] for key in ("u", "v", "heights")}
        along = tile["v" if side % 2 == 0 else "u"]
        return sorted(zip(along.tolist(), tile["heights"].round(6).tolist(), strict=True))

    checks.equal("quantized-mesh: the edge with the eastern neighbor", edge(0, 2), edge(1, 0))
    checks.equal("quantized-mesh: the edge with the southern neighbor", edge(0, 1), edge(2, 3))
    checks.that("quantized-mesh: vertices along the edge", len(edge(0, 2)) > 10, len(edge(0, 2)))
