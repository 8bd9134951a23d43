"""Checks of the Zarr stores that `orogen serve` answers: xarray, zarr-python and zarrita read the samples of exports."""

import json
import subprocess
import sys

import numpy
import xarray
import zarr
from orogen import NODE_BIN, ROOT, WORK, build, export


def check(checks, base):
    """Reads the world `place`, which is the file place.tif, and the preset `hills`."""
    store = f"{base}place/zarr"
    built = xarray.open_zarr(build("place.tif", "place.zarr"))
    with xarray.open_dataset(store, engine="zarr") as served:
        checks.that("zarr: the samples of a build", numpy.array_equal(served.height, built.height, equal_nan=True))
        for name in ("x", "y"):
            checks.that(f"zarr: {name} of a build", numpy.array_equal(served[name], built[name]))
            checks.equal(f"zarr: the attributes of {name}", served[name].attrs, built[name].attrs)
        checks.equal("zarr: the attributes of heights", served.height.attrs, built.height.attrs)
        checks.that("zarr: layers derived from the heights", {"slope", "drainage-area"} <= set(served.data_vars))
        slope = numpy.load(export("place.tif", "slope.npy", "--layer", "slope"))
        checks.that("zarr: the samples of a derived layer", numpy.array_equal(served.slope, slope, equal_nan=True))

    store = f"{base}hills/zarr"
    heights = numpy.load(export("hills", "hills.npy"))
    group = zarr.open_group(store, mode="r")
    checks.that("zarr-python: the samples of an export", group["height"][...].tobytes() == heights.tobytes())
    array = zarr.open_array(f"{store}/height", mode="r")
    checks.that("zarr-python: a part", numpy.array_equal(array[500:600, 700:], heights[500:600, 700:]))
    with xarray.open_dataset(store, engine="zarr") as served:
        part = served.height.sel(x=slice(3000, 3300), y=slice(-1500, -1800))
        checks.that("xarray: a part by its coordinates", numpy.array_equal(part, heights[100:121, 200:221]))
    tree = xarray.open_datatree(f"{store}/levels", engine="zarr")
    checks.equal("xarray: levels", [len(level.x) for level in tree.children.values()], [1024, 512])
    coarse = numpy.load(export("hills", "coarse.npy", "--cell", 30))
    checks.that("xarray: the samples of a level", numpy.array_equal(tree["1"]["height"], coarse))

    line = ["node", ROOT / "xtask/clients/read_zarr.mjs", NODE_BIN.parent, store, "height", "500", "480", "64"]
    found = json.loads(subprocess.run(line, capture_output=True, check=True, text=True).stdout)
    part = numpy.array(found["part"], numpy.float32).reshape(64, 64)
    checks.that("zarrita: the samples of an export", numpy.array_equal(part, heights[500:564, 480:544]))
    checks.equal("zarrita: the attributes", found["attributes"], {"long_name": "height", "units": "m"})

    # GDAL, in a process of its own: rasterio has another one.
    heights = numpy.load(export("place.tif", "expected.npy"))
    for name in (WORK / "place.zarr", f"/vsicurl/{base}place/zarr"):
        line = [sys.executable, ROOT / "xtask/clients/gdal_zarr.py", f'ZARR:"{name}":/height', WORK / "gdal.npy"]
        found = json.loads(subprocess.run(line, capture_output=True, check=True, text=True).stdout)
        checks.that(f"GDAL: the samples of {name}", numpy.load(WORK / "gdal.npy").tobytes() == heights.tobytes())
        checks.equal("GDAL: the place", found["geotransform"], [599980, 40, 0, 5200020, 0, -40])
        checks.that("GDAL: the coordinate system", "UTM zone 32N" in found["crs"], found["crs"])

    # An unbounded world is a square around its origin.
    with xarray.open_dataset(f"{base}endless/zarr", engine="zarr") as served:
        checks.equal("unbounded: the size", dict(served.sizes), {"y": 1 << 20, "x": 1 << 20})
        part = served.height.sel(x=slice(-2_000_000, -1_999_500), y=slice(3_000_000, 2_999_500))
        window = f"{round(-2_000_000 / served.attrs['cell'])},{round(-3_000_000 / served.attrs['cell'])}"
        rows, columns = part.shape
        expected = numpy.load(export("endless", "far.npy", "--window", f"{window},{columns},{rows}"))
        checks.that("unbounded: the samples of a window far away", numpy.array_equal(part, expected))
