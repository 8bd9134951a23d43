"""Checks builds, exports, the cache and elevation models in an object store: the bytes of local files."""

import signal
import subprocess
import time

import numpy
import rasterio
import stores
from orogen import BINARY, CLIENT, WORK, Checks, build, export, orogen

checks = Checks()
store = stores.Azure() if CLIENT == "azure" else stores.S3()


def objects(prefix):
    """The objects under a prefix, by the rest of their names."""
    return {name[len(prefix) :]: store.read(name) for name in store.names(prefix)}


def files(path):
    """The files of a result, by their paths within it."""
    if path.is_file():
        return {"": path.read_bytes()}
    return {f"/{file.relative_to(path)}": file.read_bytes() for file in path.rglob("*") if file.is_file()}


def same(name):
    """Checks the objects of a result against the files of the same name."""
    found = {key: value for key, value in objects(name).items() if not key.startswith(".build/")}
    checks.that(f"{name}: the bytes of the local result", found == files(WORK / name), sorted(found))
    left = [key for key in objects(f"{name}.build/") if key != "journal"]
    checks.equal(f"{name}: no temporary object is left", left, [])


# In one process, and in parts at the same time.
options = ("--window", "3,5,700,500", "--cell", 20)
for name, more in [
    ("one.zarr", ("--tile", 64)),
    ("one.tif", ()),
    ("tiles", ("--tiles", "r16", "--tile", 65)),
]:
    build("hills", name, *options, *more)
    orogen("build", "hills", "-o", f"{store.url}/{name}", "--quiet", *options, *more)
    same(name)
build("hills", "parts.zarr", *options, "--tile", 64)
line = [BINARY, "build", "hills", "-o", f"{store.url}/parts.zarr", "--quiet", *map(str, options), "--tile", "64", "--part"]
parts = [subprocess.Popen([*line, f"{number}/3"], cwd=WORK) for number in (1, 2, 3)]
checks.equal("parts: all succeed", [part.wait() for part in parts], [0, 0, 0])
same("parts.zarr")

# Killed in the middle, and resumed.
build("alpine", "killed.zarr", "--window", "0,0,1024,1024", "--cell", 60, "--tile", 64)
line = [BINARY, "build", "alpine", "-o", f"{store.url}/killed.zarr", "--quiet", "--threads", "1"]
line += ["--window", "0,0,1024,1024", "--cell", "60", "--tile", "64"]
running = subprocess.Popen(line, cwd=WORK)
while running.poll() is None and len(store.names("killed.zarr/")) < 20:
    time.sleep(0.02)
running.send_signal(signal.SIGKILL)
running.wait()
checks.that("killed: unfinished", "/zarr.json" not in objects("killed.zarr"))
orogen(*line[1:], "--resume")
same("killed.zarr")

# A solution that one process stores is read by another one.
heights = numpy.load(export("alpine", "alpine.npy", "--size", 128, "--cache", f"{store.url}/cache"))
stored = objects("cache/")
checks.that("cache: there are solutions", len(stored) > 0)
again = numpy.load(export("alpine", "again.npy", "--size", 128, "--cache", f"{store.url}/cache"))
checks.that("cache: the same heights", numpy.array_equal(heights, again))
checks.equal("cache: stored once", objects("cache/"), stored)

# A window of a large GeoTIFF, by rasterio and by us; exports into the store.
build("hills", "large.tif", "--window", "0,0,1500,1500", "--cell", 10)
store.write("large.tif", WORK / "large.tif")
part = numpy.load(export(f"{store.url}/large.tif", "part.npy", "--window", "700,300,200,150"))
with rasterio.open(WORK / "large.tif") as whole:
    expect = whole.read(1, window=rasterio.windows.Window(700, 300, 200, 150))
checks.that("large.tif: the samples of rasterio", numpy.array_equal(part, expect))
orogen("export", "hills", "--size", 100, "-o", f"{store.url}/out.tif")
export("hills", "out.tif", "--size", 100)
same("out.tif")

store.stop()
checks.end()
