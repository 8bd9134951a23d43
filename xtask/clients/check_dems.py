"""orogen reads what rasterio writes: every kind of GeoTIFF and the other formats, to the last bit, and keeps where it lies."""

import subprocess
import warnings

import numpy
import rasterio
from dem_files import HEIGHT, HOLE, WIDTH, everything, heights
from orogen import BINARY, ROOT, WORK, Checks, export
from rasterio.shutil import copy
from rasterio.transform import from_origin

warnings.filterwarnings("ignore", category=rasterio.errors.NotGeoreferencedWarning)
checks = Checks()
folder = WORK / "dems"


def refused(path):
    """What orogen says of a file that it must not read."""
    done = subprocess.run([BINARY, "export", path, "-o", WORK / "no.npy"], capture_output=True, stdin=subprocess.DEVNULL)
    checks.equal(f"{path.name}: exit code", done.returncode, 1)
    return done.stderr.decode()


for path, add in everything(folder):
    got = numpy.load(export(path, path.stem + ".npy", "-q"))
    expected = (heights() + add).astype("f4")
    known = numpy.ones((HEIGHT, WIDTH), bool)
    known[HOLE[1], HOLE[0]] = False
    checks.equal(f"{path.name}: size", got.shape, (HEIGHT, WIDTH))
    checks.that(f"{path.name}: samples", numpy.array_equal(got[known], expected[known]))
    hole = got[HOLE[1], HOLE[0]]
    checks.that(f"{path.name}: the hole is filled from around it", abs(hole - expected[HOLE[1], HOLE[0]]) < 12, hole)
    with rasterio.open(path) as before, rasterio.open(export(path, path.stem + "-out.tif", "-q")) as after:
        checks.equal(f"{path.name}: where it lies", after.transform, before.transform)
        checks.equal(f"{path.name}: coordinate system", after.crs, before.crs)

for name, tolerance, add in [("arc.asc", 0, 0.25), ("array.npy", 0, 0.25), ("floats.r32", 0, 0.25), ("grey.png", 1e-3, 0), ("raw.r16", 1e-3, 0)]:
    got = numpy.load(export(folder / name, name + ".npy", "-q"))
    off = numpy.abs(got - (heights() + add))
    off[HOLE[1], HOLE[0]] = 0
    checks.that(f"{name}: samples", off.max() <= tolerance, off.max())

for name in ["point.tif", "oblong.tif", "degrees.tif"]:
    with rasterio.open(folder / name) as before, rasterio.open(export(folder / name, name + "-out.tif", "-q")) as after:
        checks.equal(f"{name}: coordinate system", after.crs, before.crs)
        for column, row in [(0, 0), (20, 11)]:
            x, y = before.xy(row, column)
            r, c = after.index(x, y)
            want, got = before.read(1)[row, column], after.read(1)[r, c]
            checks.that(f"{name}: the height at ({column}, {row})", abs(want - got) < 5, (want, got))
south = numpy.load(export(folder / "south-up.tif", "south-up.npy", "-q"))
checks.that("south-up.tif: north is up", numpy.array_equal(south, heights()[::-1].astype("f4")))

for name, said in [("two-bands.tif", "2 bands"), ("zstd.tif", "Zstandard"), ("turned.tif", "turned"), ("all-nodata.tif", "missing")]:
    said_really = refused(folder / name)
    checks.that(f"{name}: refused by name", said in said_really, said_really)

# An SRTM tile of GDAL's own driver, and a whole world written by orogen and packed anew by GDAL.
with rasterio.open(WORK / "tile.tif", "w", driver="GTiff", width=1201, height=1201, count=1, dtype="int16", nodata=-32768, crs="EPSG:4326",
                   transform=from_origin(7 - 0.5 / 1200, 47 + 0.5 / 1200, 1 / 1200, 1 / 1200)) as file:
    j, i = numpy.mgrid[:1201, :1201]
    tile = (100 + i // 3 + 2 * j % 50).astype("int16")
    file.write(tile, 1)
copy(WORK / "tile.tif", WORK / "N46E007.hgt", driver="SRTMHGT")
with rasterio.open(export(WORK / "N46E007.hgt", "hgt-out.tif", "-q")) as after:
    got = after.read(1)
    checks.equal("N46E007.hgt: its western and northern edge", (round(after.bounds.left, 3), round(after.bounds.top, 3)), (7.0, 47.0))
    checks.that("N46E007.hgt: its first column", abs(float(got[0, 0]) - tile[0, 0]) < 1 and got.shape[1] == 1201, got.shape)
world = export(ROOT / "recipes/hills.toml", "hills.tif", "-q", "--window", "3,5,301,203")
want = numpy.load(export(ROOT / "recipes/hills.toml", "hills.npy", "-q", "--window", "3,5,301,203"))
for k, options in enumerate([{"compress": "lzw", "predictor": 3, "tiled": True}, {"compress": "packbits"}, {"compress": "deflate", "predictor": 2}]):
    copy(world, WORK / f"packed{k}.tif", driver="GTiff", **options)
    got = numpy.load(export(WORK / f"packed{k}.tif", f"packed{k}.npy", "-q"))
    checks.that(f"packed anew by {options}", numpy.array_equal(got.view("u4"), want.view("u4")))
# That these checks can fail: a byte changed within the samples.
broken = bytearray((folder / "f32-strips.tif").read_bytes())
broken[2000] ^= 0x40
(WORK / "broken.tif").write_bytes(broken)
got = numpy.load(export(WORK / "broken.tif", "broken.npy", "-q"))
checks.that("a changed byte is a changed sample", not numpy.array_equal(got, (heights() + 0.25).astype("f4")))

checks.end()
