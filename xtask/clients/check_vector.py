"""Checks vector tiles and PMTiles: GDAL reads the features of exports from vector tiles, and pmtiles the heights of a tree of tiles."""

import io
import json
import signal
import subprocess
import urllib.request

import numpy
import pyogrio
import shapely
from orogen import BINARY, WORK, Checks, build, export
from PIL import Image
from pmtiles.reader import MmapSource, Reader, all_tiles
from pmtiles.tile import Compression, TileType

checks = Checks()
EQUATOR = 2 * 20037508.342789244
WORLD, ZOOM = "alpine", 10

server = subprocess.Popen(
    [BINARY, "serve", WORLD, "--port", "0", "--quiet"], cwd=WORK, stdout=subprocess.PIPE, text=True
)
base = server.stdout.readline().split(" at ")[1].strip()


def tile(path, zoom, column, row):
    """The file of a tile, at a path from which GDAL knows its place."""
    file = WORK / "vector" / str(zoom) / str(column) / f"{row}.mvt"
    file.parent.mkdir(parents=True, exist_ok=True)
    with urllib.request.urlopen(f"{base}vector/{zoom}/{column}/{row}.mvt{path}") as answer:
        file.write_bytes(answer.read())
    return file


def features(file, layer):
    """The geometries and the attributes of a layer, in metres of the map."""
    about, _, geometry, values = pyogrio.raw.read(file, layer=layer)
    return shapely.from_wkb(geometry), dict(zip(about["fields"].tolist(), values))


middle = 1 << (ZOOM - 1)
first = tile("", ZOOM, middle, middle)
names = sorted(pyogrio.list_layers(first)[:, 0].tolist())
checks.equal("layers", names, ["contours", "lakes", "rivers", "summits"])

# Contours: each vertex is between the heights of the samples around it.
cell = EQUATOR / (512 << ZOOM)
heights = numpy.load(export(WORLD, "heights.npy", "--cell", repr(cell), "--window", "0,0,520,520"))
lines, values = features(first, "contours")
worst, vertices = 0.0, 0
for line, height in zip(lines, values["elevation"]):
    places = shapely.get_coordinates(line)
    columns, rows = places[:, 0] / cell, -places[:, 1] / cell
    inside = (columns > 2) & (columns < 510) & (rows > 2) & (rows < 510)
    i, j = numpy.floor(columns[inside]).astype(int), numpy.floor(rows[inside]).astype(int)
    around = numpy.stack([heights[j + down, i + across] for down in (-1, 0, 1, 2) for across in (-1, 0, 1, 2)])
    worst = max(worst, float(numpy.maximum(around.min(0) - height, height - around.max(0)).max(initial=0.0)))
    vertices += len(i)
checks.equal("contours: vertices beyond the heights around them", worst, 0.0)
checks.that("contours: many vertices", vertices > 1000, vertices)
checks.that("contours: every fifth is an index contour", set(values["index"].tolist()) <= {0, 1, False, True})
steps = numpy.unique(numpy.diff(numpy.unique(values["elevation"])))
checks.that("contours: one interval", len(steps) == 1, steps)

# Tiles beside each other: their contours cross the line between them at the same places.
border = 512 * cell


def crossings(file):
    """The places at which contours cross the border, with their heights; the buffer of the tile is read, too."""
    _, _, geometry, (heights, *_) = pyogrio.raw.read(file, layer="contours", columns=["elevation"], CLIP="NO")
    found = set()
    for line, height in zip(shapely.from_wkb(geometry), heights):
        for part in shapely.get_parts(line):
            places = shapely.get_coordinates(part)
            side = numpy.sign(numpy.round(places[:, 0] - border, 3))
            for k in numpy.flatnonzero((side[1:-1] == 0) & (side[:-2] * side[2:] < 0)) + 1:
                if -border < places[k, 1] < 0:
                    found.add((float(height), round(float(places[k, 1]), 2)))
    return found


west, east = crossings(first), crossings(tile("?layers=contours", ZOOM, middle + 1, middle))
checks.that("contours of adjacent tiles meet", west == east and len(west) > 10, (len(west), west ^ east))

# Lakes and rivers are those of an export.
whole = shapely.box(0, -border, border, 0)
exported = json.loads(export(WORLD, "lakes.geojson", "--layer", "lakes").read_text())["features"]
shapes = [shapely.from_geojson(json.dumps(lake["geometry"])) for lake in exported]
large = [lake for lake in shapes if lake.area >= 16 * cell * cell]
expected = shapely.area(shapely.intersection(large, whole)).sum()
found = shapely.area(features(first, "lakes")[0]).sum()
checks.near("lakes: their area", found / expected, 1, 0.02)
exported = json.loads(export(WORLD, "rivers.geojson", "--layer", "rivers").read_text())["features"]
shapes = [
    shapely.force_2d(shapely.from_geojson(json.dumps(river["geometry"])))
    for river in exported
    if river["properties"]["drainage_area"] >= 400 * cell * cell
]
expected = shapely.length(shapely.intersection(shapes, whole)).sum()
rivers, values = features(first, "rivers")
checks.near("rivers: their length", shapely.length(rivers).sum() / expected, 1, 0.03)
checks.that("rivers: discharges", (values["discharge"] > 0).all() and (values["strahler"] >= 1).all())
server.send_signal(signal.SIGINT)
checks.equal("it ends in peace", server.wait(60), 0)

# PMTiles: the heights of a tree of tiles, rounded by the zoom.
tree = build("hills", "tree", "--tiles", "terrarium", "--cell", 40)
described = json.loads((tree / "tiles.json").read_text())
with open(build("hills", "hills.pmtiles", "--cell", 40), "rb") as file:
    source = MmapSource(file)
    reader = Reader(source)
    header, metadata = reader.header(), reader.metadata()
    checks.equal("pmtiles: PNG", (header["tile_type"], header["tile_compression"]), (TileType.PNG, Compression.NONE))
    checks.that("pmtiles: clustered", header["clustered"])
    zooms = (header["min_zoom"], header["max_zoom"])
    checks.equal("pmtiles: zooms", zooms, (described["minzoom"], described["maxzoom"]))
    bounds = [header[f"{name}_e7"] / 1e7 for name in ("min_lon", "min_lat", "max_lon", "max_lat")]
    checks.that("pmtiles: bounds", numpy.allclose(bounds, described["bounds"], atol=1e-6), bounds)
    checks.equal("pmtiles: the encoding", metadata["encoding"], "terrarium")

    def decoded(bytes_):
        rgb = numpy.asarray(Image.open(io.BytesIO(bytes_)).convert("RGB")).astype(float)
        return rgb[..., 0] * 256 + rgb[..., 1] + rgb[..., 2] / 256 - 32768

    count, size = 0, 0
    for (zoom, column, row), content in all_tiles(source):
        exact = (tree / str(zoom) / str(column) / f"{row}.png").read_bytes()
        step = metadata["height_steps"][str(zoom)]
        rounded = decoded(content)
        difference = numpy.abs(rounded - decoded(exact)).max()
        checks.that(f"pmtiles {zoom}/{column}/{row}: half a step", difference <= step / 2 + 0.5 / 256, difference)
        checks.that(f"pmtiles {zoom}/{column}/{row}: steps", (rounded / step == numpy.round(rounded / step)).all())
        checks.that(f"pmtiles {zoom}/{column}/{row}: by its number", reader.get(zoom, column, row) == content)
        count, size = count + 1, size + len(exact)
    checks.equal("pmtiles: every tile", count, len(list(tree.glob("*/*/*.png"))))
    checks.equal("pmtiles: every tile is counted", header["addressed_tiles_count"], count)
    checks.that("pmtiles: smaller than the tree", header["tile_data_length"] < size, header["tile_data_length"] / size)
checks.end()
