"""Checks GeoTIFFs with rasterio: the samples of the .npy at their positions; rio-cogeo accepts them as Cloud Optimized GeoTIFFs."""

import logging
import subprocess
import sys
import warnings
from pathlib import Path

import numpy
import rasterio
from orogen import ROOT, WORK, Checks, build, export
from rasterio.errors import RasterioIOError
from rio_cogeo.cogeo import cog_validate

checks = Checks()
RIO = Path(sys.executable).with_name("rio")

# GDAL reports problems as log records, rasterio and PROJ as Python warnings: neither may occur.
grumbles = []
listener = logging.Handler(level=logging.WARNING)
listener.emit = lambda record: grumbles.append(record.getMessage())
logging.getLogger("rasterio").addHandler(listener)
warnings.simplefilter("error")


def same_bits(a, b):
    """Compares bit for bit, including zeros and NaNs."""
    return a.dtype == b.dtype and a.shape == b.shape and numpy.array_equal(a.view("u4"), b.view("u4"))


def both(recipe, name, cell, window):
    """Returns one window as GeoTIFF and as an array."""
    options = ("--cell", cell, "--window", ",".join(map(str, window)))
    return export(recipe, f"{name}.tif", *options), numpy.load(export(recipe, f"{name}.npy", *options))


def factors(width, height, tile):
    """The decimation factors of overviews: powers of two, sizes rounded up, down to one tile."""
    found, size = [], (width, height)
    while max(size) > tile:
        size = tuple((side + 1) // 2 for side in size)
        found.append(2 ** (len(found) + 1))
    return found


# Odd sizes, whole tiles, an overview of exactly one 512-wide tile, less than a tile, a single sample.
for name, recipe, cell, window, tile in [
    ("alpine", "alpine", 30, (31, 77, 1237, 899), 512),
    ("wide", "alpine", 30, (0, 0, 1536, 1024), 512),
    ("tall", "alpine", 30, (0, 0, 1024, 1536), 384),
    ("small", "hills", 20, (5, 6, 100, 70), 512),
    ("one", "hills", 20, (5, 6, 1, 1), 512),
]:
    path, heights = both(recipe, name, cell, window)
    x, y, width, height = window
    with rasterio.open(path) as tiff:
        checks.equal(f"{name}: one band of f32", tiff.dtypes, ("float32",))
        checks.equal(f"{name}: tiles", tiff.block_shapes, [(tile, tile)])
        checks.equal(f"{name}: overviews", tiff.overviews(1), factors(width, height, tile))
        checks.that(f"{name}: bit-equal to the .npy", same_bits(tiff.read(1), heights))
        checks.equal(f"{name}: points, not areas", tiff.tags().get("AREA_OR_POINT"), "Point")
        checks.equal(f"{name}: layout", tiff.tags(ns="IMAGE_STRUCTURE").get("LAYOUT"), "COG")
        checks.equal(f"{name}: only NaN stands for none", str(tiff.nodata), "nan")
        checks.equal(f"{name}: heights are in metres", tiff.units[0], "m")
        checks.that(f"{name}: a system of its own, in metres", "metre" in tiff.crs.to_wkt() and not tiff.crs.to_epsg())
        # The center of a pixel is the position of its sample: x east, y south of the origin.
        for row, column in [(0, 0), (height - 1, 0), (0, width - 1), (height // 2, width // 3)]:
            place = tuple(map(float, tiff.xy(row, column)))
            checks.equal(f"{name}: place of {column}, {row}", place, ((x + column) * cell, -(y + row) * cell))
    valid, errors, complaints = cog_validate(path, strict=True, quiet=True)
    checks.that(f"{name}: valid for rio-cogeo, strictly", valid and not errors and not complaints, (errors, complaints))

said = subprocess.run([RIO, "cogeo", "validate", "--strict", WORK / "alpine.tif"], capture_output=True, text=True)
checks.that("rio cogeo validate --strict", said.stdout.strip().endswith("is a valid cloud optimized GeoTIFF"), said)

# Generated worlds on a map: their position, and windows given by pixel edges as for gdal_translate -projwin.
for code, origin in [(32632, (600000, 5200000)), (2264, (1500000, 500000)), (2056, (2600000, 1200000)), (4326, (11, 47))]:
    place = ("--crs", f"EPSG:{code}", "--origin", ",".join(map(str, origin)))
    path = export("hills", f"placed-{code}.tif", "--cell", 20, "--window", "0,0,200,150", *place)
    with rasterio.open(path) as tiff:
        checks.equal(f"EPSG:{code}: the system", tiff.crs.to_epsg(), code)
        checks.equal(f"EPSG:{code}: the place", tuple(map(float, tiff.xy(0, 0))), tuple(map(float, origin)))
        (left, top), (right, bottom) = tiff.transform @ (31, 17), tiff.transform @ (131, 77)
        expected = tiff.read(1, window=((17, 77), (31, 131)))
    # Degrees are resampled to square metres on another grid.
    if code != 4326:
        part = numpy.load(export(path, f"placed-{code}.npy", "--projwin", left, top, right, bottom))
        checks.that(f"EPSG:{code}: the part that -projwin takes", same_bits(part, expected))

# A plane that rises 3 m per metre to the east and falls 2 m per metre to the south: 3 east + 2 north at every point. Mirrored,
# rotated or shifted by half a cell it would differ.
PLANE, CELL = ROOT / "xtask/clients/plane.toml", 0.05
for name, window in [("even", (24, 8, 1216, 896)), ("odd", (31, 15, 1203, 901))]:
    path, heights = both(PLANE, f"plane-{name}", CELL, window)
    with rasterio.open(path) as tiff:
        checks.that(f"plane {name}: bit-equal to the .npy", same_bits(tiff.read(1), heights))
        places = [(2.0, -1.0), (50.0, -1.0), (2.0, -40.0), (50.0, -40.0), (12.35, -33.3)]
        for (east, north), [height] in zip(places, tiff.sample(places)):
            checks.near(f"plane {name} at {east}, {north}", float(height), 3.0 * east + 2.0 * north, 1e-3)
        count = len(tiff.overviews(1))
    checks.equal(f"plane {name}: overviews", count, 2)
    for level in range(count):
        with rasterio.open(path, overview_level=level) as coarse:
            rows, columns = numpy.mgrid[0 : coarse.height, 0 : coarse.width]
            place = coarse.transform
            east, north = place.c + (columns + 0.5) * place.a, place.f + (rows + 0.5) * place.e
            worst = float(numpy.abs(coarse.read(1) - (3.0 * east + 2.0 * north)).max())
            # A quarter of a cell of the full raster, for odd sizes; plain decimation by two would be off by half a cell.
            most = 1e-3 if name == "even" else 0.25 * CELL
            checks.that(f"plane {name}, overview {level}: in its place", worst <= most, f"(off by {worst}, allowed {most})")

# `build` writes the same file tile by tile, and a file too large for `export` reads the same way.
for name, recipe, options in [
    ("built", "alpine", ("--cell", 30, "--window", "31,77,1237,899")),
    ("built-plane", PLANE, ("--cell", CELL, "--window", "31,15,1203,901")),
]:
    path = build(recipe, f"{name}.tif", *options)
    heights = numpy.load(export(recipe, f"{name}.npy", *options))
    with rasterio.open(path) as tiff:
        checks.that(f"{name}: bit-equal to the .npy", same_bits(tiff.read(1), heights))
    valid, errors, complaints = cog_validate(path, strict=True, quiet=True)
    checks.that(f"{name}: valid for rio-cogeo, strictly", valid and not errors and not complaints, (errors, complaints))
checks.equal("built: the file that export writes", (WORK / "built.tif").read_bytes(), (WORK / "alpine.tif").read_bytes())
with rasterio.open(WORK / "built-plane.tif") as tiff:
    for (east, north), [height] in zip(places, tiff.sample(places)):
        checks.near(f"built plane at {east}, {north}", float(height), 3.0 * east + 2.0 * north, 1e-3)

checks.equal("nothing was grumbled about", grumbles, [])

# The checks must fail: a flipped byte in a tile, half a file, and a layout that is not cloud-optimized.
path, heights = WORK / "alpine.tif", numpy.load(WORK / "alpine.npy")
whole = path.read_bytes()
flipped = bytearray(whole)
flipped[len(whole) - len(whole) // 4] ^= 0x10
for name, damaged in [("flipped", bytes(flipped)), ("half", whole[: len(whole) // 2])]:
    broken = WORK / f"{name}.tif"
    broken.write_bytes(damaged)
    try:
        with rasterio.open(broken) as tiff:
            found = same_bits(tiff.read(1), heights)
    except RasterioIOError:
        found = False
    checks.that(f"{name}: noticed", not found)

with rasterio.open(path) as tiff:
    profile = {key: tiff.profile[key] for key in ("driver", "dtype", "width", "height", "count", "crs", "transform")}
with rasterio.open(WORK / "plain.tif", "w", **profile) as plain:
    plain.write(heights, 1)
checks.that("a plain GeoTIFF is not valid", not cog_validate(WORK / "plain.tif", strict=True, quiet=True)[0])

checks.end()
