"""Checks built tiles with NumPy and Pillow: shared edges, one scale for all tiles, and Terrarium heights of worlds with a position."""

import json
import math

import numpy
from orogen import ROOT, WORK, Checks, build, export
from PIL import Image

checks = Checks()
CELL, SIDE = 30, 129
WINDOW = (31, 77, 300, 257)
PLANE = ROOT / "xtask/clients/plane.toml"


def numbers(path, kind, side):
    """Returns the values of a tile's file."""
    if kind == "png":
        with Image.open(path) as picture:
            checks.equal(f"{path.name}: 16 bits", picture.mode, "I;16")
            return numpy.array(picture)
    return numpy.fromfile(path, dtype={"r16": "<u2", "r32": "<f4"}[kind]).reshape(side, side)


def tiles(folder, kind):
    """Returns the manifest, and the metres and levels of each tile by column and row."""
    manifest = json.loads((folder / "manifest.json").read_text())
    [layer], side = manifest["layers"], manifest["tile"]["samples"]
    found = {}
    for tile in manifest["tiles"]:
        at = tile["column"], tile["row"]
        name = layer["files"].format(column=at[0], row=at[1])
        checks.equal(f"{folder.name} {at}: its name", tile["files"]["height"]["name"], name)
        raw = numbers(folder / name, kind, side)
        metres = raw if kind == "r32" else layer["low"] + raw.astype("f8") / 65535 * (layer["high"] - layer["low"])
        found[at] = tile, raw, metres
    return manifest, layer, found


def compare(folder, kind, heights, window):
    """Checks that all tiles contain the samples of an array, within half a step, at the positions of the manifest."""
    manifest, layer, found = tiles(folder, kind)
    x, y, width, height = window
    step = manifest["tile"]["step"]
    span = layer["highest"] - layer["lowest"]
    within = 0.0 if kind == "r32" else 0.5 / 65535 * span * (1 + 1e-3)
    covered = numpy.zeros(heights.shape, bool)
    worst = 0.0
    for (column, row), (tile, _, metres) in found.items():
        wide, tall = tile["inside"]
        left, top = tile["x"] - x, tile["y"] - y
        checks.equal(f"{folder.name} {column}, {row}: place", (left, top), (column * step, row * step))
        checks.near(f"{folder.name} {column}, {row}: east", tile["east"], tile["x"] * manifest["cell"], 0)
        worst = max(worst, float(numpy.abs(metres[:tall, :wide] - heights[top : top + tall, left : left + wide]).max()))
        covered[top : top + tall, left : left + wide] = True
        edge = metres[tall - 1 :, :wide] - metres[tall - 1, :wide]
        checks.that(f"{folder.name} {column}, {row}: beyond the window the edge is repeated", not edge.any())
    checks.that(f"{folder.name}: every sample is in a tile", bool(covered.all()))
    if kind != "r32":
        checks.near(f"{folder.name}: lowest", float(heights.min()), layer["low"], 0)
        checks.near(f"{folder.name}: highest", float(heights.max()), layer["high"], 0)
    return worst <= within, worst


for kind in ("png", "r16", "r32"):
    options = ("--cell", CELL, "--window", ",".join(map(str, WINDOW)))
    heights = numpy.load(export("alpine", "alpine.npy", *options)).astype("f8")
    folder = build("alpine", kind, "--tiles", kind, "--tile", SIDE, *options)
    equal, worst = compare(folder, kind, heights, WINDOW)
    checks.that(f"{kind}: the samples of the .npy", equal, f"(off by {worst})")
    manifest, layer, found = tiles(folder, kind)
    checks.equal(f"{kind}: so many tiles", (manifest["tile"]["columns"], manifest["tile"]["rows"]), (3, 2))
    for (column, row), (_, raw, _) in found.items():
        if (column + 1, row) in found:
            east = found[column + 1, row][1]
            checks.that(f"{kind} {column}, {row}: shares its east edge", numpy.array_equal(raw[:, -1], east[:, 0]))
        if (column, row + 1) in found:
            south = found[column, row + 1][1]
            checks.that(f"{kind} {column}, {row}: shares its south edge", numpy.array_equal(raw[-1], south[0]))

    # A plane: 3 east - 2 south.
    plane = build(PLANE, f"plane-{kind}", "--tiles", kind, "--tile", 17)
    _, layer, found = tiles(plane, kind)
    checks.equal(f"plane {kind}: to the far edge", len(found), 12)
    rows, columns = numpy.mgrid[0:17, 0:17]
    step = 0.5 / 65535 * (layer["highest"] - layer["lowest"]) if kind != "r32" else 0.0
    for tile, _, metres in found.values():
        expect = 3.0 * (tile["east"] + columns) - 2.0 * (tile["south"] + rows)
        worst = float(numpy.abs(metres - expect).max())
        checks.that(f"plane {kind} {tile['column']}, {tile['row']}", worst <= step + 1e-3, f"(off by {worst})")

    # The checks must fail for a changed tile.
    path = folder / f"height_x1_y0.{kind}"
    damaged = bytearray(path.read_bytes())
    damaged[len(damaged) // 2 + (3 if kind == "r32" else 1)] ^= 0x40
    path.write_bytes(damaged)
    try:
        noticed = not compare(folder, kind, heights, WINDOW)[0]
    except (OSError, SyntaxError):
        noticed = True
    checks.that(f"{kind}: a flipped bit is noticed", noticed)


def terrarium(path):
    """Returns the metres of a Terrarium tile."""
    with Image.open(path) as picture:
        checks.equal(f"{path.name}: colors", picture.mode, "RGB")
        red, green, blue = (numpy.array(picture).astype("f8")[..., k] for k in range(3))
    return red * 256 + green + blue / 256 - 32768


def mosaic(folder, zoom):
    """Returns all tiles of a zoom in one array, and its first pixel on the whole map."""
    there = sorted((int(p.parent.name), int(p.stem), p) for p in (folder / str(zoom)).glob("*/*.png"))
    columns, rows = [[entry[k] for entry in there] for k in (0, 1)]
    left, top = min(columns), min(rows)
    out = numpy.full(((max(rows) - top + 1) * 256, (max(columns) - left + 1) * 256), numpy.nan)
    for column, row, path in there:
        out[(row - top) * 256 : (row - top + 1) * 256, (column - left) * 256 : (column - left + 1) * 256] = terrarium(path)
    return out, left * 256, top * 256


def on_map(folder, heights, x, y):
    """Returns the largest difference between an array whose first sample is x, y and the tiles of the deepest zoom."""
    about = json.loads((folder / "tiles.json").read_text())
    pixels, left, top = mosaic(folder, about["maxzoom"])
    middle = 256 * 2 ** (about["maxzoom"] - 1)
    height, width = heights.shape
    row, column = y + middle - top, x + middle - left
    return float(numpy.abs(pixels[row : row + height, column : column + width] - heights).max())


# At the map's own cell size.
ZOOM = 13
PIXEL = 2 * math.pi * 6378137 / 256 / 2**ZOOM
window = (100, 200, 500, 300)
options = ("--cell", repr(PIXEL), "--window", ",".join(map(str, window)))
heights = numpy.load(export("hills", "hills.npy", *options)).astype("f8")
folder = build("hills", "map", "--tiles", "terrarium", *options)
about = json.loads((folder / "tiles.json").read_text())
checks.equal("map: zoom", about["maxzoom"], ZOOM)
checks.equal("map: encoding", about["encoding"], "terrarium")
checks.near("map: true to scale", about["map_metres_per_metre"], 1.0, 1e-12)
worst = on_map(folder, heights, *window[:2])
checks.that("map: within 1/256 m", worst <= 1 / 256, f"(off by {worst})")
# The bounds of TileJSON: the sample is at the center of its pixel, half a pixel from the border.
west, south, east, north = about["bounds"]
degrees = 360 / 2**ZOOM / 256
checks.near("map: west", west, window[0] * degrees, 1e-9)
checks.near("map: east", east, (window[0] + window[2]) * degrees, 1e-9)
checks.that("map: the world lies south and east of 0, 0", west > 0 and north < 0)
checks.near("map: metres to the south", -math.asinh(math.tan(math.radians(north))) * 6378137, window[1] * PIXEL, 1e-3)

# Every lower zoom is the mean of the next higher zoom, rounded once.
exact, left, top = mosaic(folder, ZOOM)
for zoom in range(ZOOM - 1, about["minzoom"] - 1, -1):
    coarse, coarse_left, coarse_top = mosaic(folder, zoom)
    exact = exact.reshape(exact.shape[0] // 2, 2, exact.shape[1] // 2, 2).mean(axis=(1, 3))
    left, top = left // 2, top // 2
    row, column = top - coarse_top, left - coarse_left
    part = coarse[row : row + exact.shape[0], column : column + exact.shape[1]]
    worst = float(numpy.abs(part - exact).max())
    checks.that(f"map, zoom {zoom}: means", worst <= 1 / 256, f"(off by {worst})")
    whole = numpy.pad(exact, ((row, coarse.shape[0] - row - exact.shape[0]), (column, coarse.shape[1] - column - exact.shape[1])), "edge")
    exact, left, top = whole, coarse_left, coarse_top
checks.equal("map: one tile in the end", exact.shape, (256, 256))

# The plane at its own cell size: 3 east - 2 south; no mirror image, rotation or shift.
folder = build(PLANE, "plane-map", "--tiles", "terrarium", "--cell", 0.125)
rows, columns = numpy.mgrid[0:384, 0:512]
plane = 3.0 * columns * 0.125 - 2.0 * rows * 0.125
worst = on_map(folder, plane, 0, 0)
checks.that("plane on a map", worst <= 1 / 256 + 1e-3, f"(off by {worst})")
checks.that("plane on a map: a shift would be noticed", on_map(folder, plane[:-1], 0, 1) > 0.1)

# The checks must fail for a changed tile.
[path, *_] = sorted((WORK / "map" / str(ZOOM)).glob("*/*.png"))
damaged = bytearray(path.read_bytes())
damaged[len(damaged) // 2] ^= 0x10
path.write_bytes(damaged)
try:
    noticed = on_map(WORK / "map", heights, *window[:2]) > 1 / 256
except (OSError, SyntaxError):
    noticed = True
checks.that("map: a flipped bit is noticed", noticed)

checks.end()
