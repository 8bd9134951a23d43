"""Checks Zarr groups with xarray and zarr-python: the samples of the .npy at their positions."""

import warnings

import numpy
import xarray
import zarr
from orogen import ROOT, WORK, Checks, build, export

checks = Checks()
warnings.simplefilter("error")


def same_bits(a, b):
    """Compares bit for bit, including zeros and NaNs."""
    a, b = numpy.ascontiguousarray(a), numpy.ascontiguousarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and numpy.array_equal(a.view("u4"), b.view("u4"))


# Odd sizes, whole chunks, less than a chunk, a single sample.
for name, recipe, cell, window, tile in [
    ("alpine", "alpine", 30, (31, 77, 1237, 899), 512),
    ("whole", "alpine", 30, (0, 0, 512, 256), 128),
    ("small", "hills", 20, (5, 6, 100, 70), 512),
    ("one", "hills", 20, (5, 6, 1, 1), 512),
]:
    options = ("--cell", cell, "--window", ",".join(map(str, window)))
    heights = numpy.load(export(recipe, f"{name}.npy", *options))
    path = build(recipe, f"{name}.zarr", "--tile", tile, *options)
    x, y, width, height = window
    with xarray.open_zarr(path) as group:
        layer = group["height"]
        checks.equal(f"{name}: sides", layer.dims, ("y", "x"))
        checks.that(f"{name}: bit-equal to the .npy", same_bits(layer.values, heights))
        checks.equal(f"{name}: unit", layer.attrs.get("units"), "m")
        checks.that(f"{name}: eastings", numpy.array_equal(group["x"].values, (x + numpy.arange(width)) * float(cell)))
        checks.that(f"{name}: northings", numpy.array_equal(group["y"].values, -(y + numpy.arange(height)) * float(cell)))
        checks.that(f"{name}: coordinates know their axes", group["x"].attrs["axis"] == "X" and group["y"].attrs["axis"] == "Y")
    array = zarr.open_array(path / "height", mode="r")
    checks.equal(f"{name}: format", array.metadata.zarr_format, 3)
    checks.equal(f"{name}: chunks", array.chunks, (tile, tile))
    checks.that(f"{name}: every chunk is there", array.nchunks_initialized == array.nchunks)
    with xarray.open_zarr(path, consolidated=False) as group:
        checks.that(f"{name}: without the copy of the metadata too", same_bits(group["height"].values, heights))

# Several layers in one group.
options = ("--cell", 60, "--window", "0,0,200,150")
path = build("alpine", "layers.zarr", "--layers", "height,terrain", "--tile", 64, *options)
with xarray.open_zarr(path) as group:
    checks.equal("layers: all are there", sorted(group.data_vars), ["height", "terrain"])
    heights = numpy.load(export("alpine", "layers.npy", *options))
    checks.that("layers: bit-equal", same_bits(group["height"].values, heights))

# A plane that rises 3 m per metre to the east and falls 2 m per metre to the south: 3 east + 2 north at every point.
path = build(ROOT / "xtask/clients/plane.toml", "plane.zarr", "--tile", 16)
with xarray.open_zarr(path) as group:
    for east, north in [(0.0, 0.0), (50.0, -1.0), (2.0, -40.0), (63.0, -47.0)]:
        value = float(group["height"].sel(x=east, y=north))
        checks.near(f"plane at {east}, {north}", value, 3.0 * east + 2.0 * north, 1e-3)

# The checks must fail: a flipped byte in a chunk, half a chunk, a missing chunk.
chunk = WORK / "alpine.zarr/height/c/0/1"
heights, whole = numpy.load(WORK / "alpine.npy"), chunk.read_bytes()
flipped = bytearray(whole)
flipped[len(whole) // 2] ^= 0x10
for name, damaged in [("flipped", bytes(flipped)), ("half", whole[: len(whole) // 2]), ("gone", None)]:
    chunk.unlink()
    if damaged is not None:
        chunk.write_bytes(damaged)
    try:
        with xarray.open_zarr(WORK / "alpine.zarr") as group:
            found = same_bits(group["height"].values, heights)
    except Exception as error:  # Whatever the codec calls it.
        found = False
    checks.that(f"{name}: noticed", not found)

# The repaired group is read again.
window = ("--cell", 30, "--window", "31,77,1237,899", "--tile", 512)
build("alpine", "alpine.zarr", *window, "--resume")
with xarray.open_zarr(WORK / "alpine.zarr") as group:
    checks.that("mended: bit-equal again", same_bits(group["height"].values, heights))

checks.end()
