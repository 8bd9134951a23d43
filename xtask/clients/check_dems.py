"""Checks imports: orogen reads files written by rasterio (all kinds of GeoTIFF, other formats) bit for bit and keeps the position."""

import shutil
import subprocess
import warnings

import numcodecs
import numpy
import OpenEXR
import pyproj
import rasterio
import zarr
from dem_files import HEIGHT, HOLE, WIDTH, everything, heights, write
from orogen import BINARY, ROOT, WORK, Checks, export
from rasterio.shutil import copy
from rasterio.transform import from_origin

warnings.filterwarnings("ignore", category=rasterio.errors.NotGeoreferencedWarning)
checks = Checks()
folder = WORK / "dems"


def refused(path):
    """Returns the message of orogen for a file that it must reject."""
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

for name, said in [("bands.tif", "3 bands"), ("webp.tif:1", "WebP"), ("turned.tif", "rotated"), ("all-nodata.tif", "samples are nodata")]:
    said_really = refused(folder / name)
    checks.that(f"{name}: refused by name", said in said_really, said_really)

# One band of several, in every band layout.
for path in sorted(folder.glob("bands*.tif")):
    with rasterio.open(path) as file:
        for band in [1, 2, 3]:
            got = numpy.load(export(f"{path}:{band}", f"{path.stem}-{band}.npy", "-q"))
            checks.that(f"{path.name}: band {band}", numpy.array_equal(got, file.read(band).astype("f4")))
with rasterio.open(folder / "lossy-lerc.tif") as file:
    got = numpy.load(export(folder / "lossy-lerc.tif", "lossy.npy", "-q"))
    checks.that("lossy-lerc.tif: as GDAL unpacks it", numpy.array_equal(got, file.read(1)))
# LERC with a mask, large enough for every kind of block, and floats that do not compress.
rng = numpy.random.default_rng(1)
j, i = numpy.mgrid[:300, :260]
ground = (900 + 300 * numpy.sin(i / 40) * numpy.cos(j / 30) + rng.normal(0, 2, (300, 260))).astype("f4")
ground[40:60, 30:90] = numpy.nan
ground[100:200, 100:200] = 512
for name, data, options in [
    ("lerc-nan", ground, {"compress": "lerc", "MAX_Z_ERROR": 0}),
    ("lerc-lossy", ground, {"compress": "lerc_zstd", "MAX_Z_ERROR": 0.05}),
    ("lerc-f64", ground.astype("f8"), {"compress": "lerc_deflate", "MAX_Z_ERROR": 0.001}),
    ("lerc-i16", numpy.nan_to_num(ground).astype("i2"), {"compress": "lerc", "MAX_Z_ERROR": 0}),
    ("lerc-u8", (numpy.nan_to_num(ground) / 8).astype("u1"), {"compress": "lerc", "MAX_Z_ERROR": 0}),
    ("lerc-u32", numpy.nan_to_num(ground * 1000).astype("u4"), {"compress": "lerc", "MAX_Z_ERROR": 0}),
    ("zstd-22", ground, {"compress": "zstd", "ZSTD_LEVEL": 22, "predictor": 3}),
    ("lzma-9", ground, {"compress": "lzma", "LZMA_PRESET": 9, "predictor": 2}),
]:
    for tiled in [{}, {"tiled": True, "blockxsize": 128, "blockysize": 64}]:
        path = WORK / f"{name}.tif"
        with rasterio.open(path, "w", driver="GTiff", width=260, height=300, count=1, dtype=data.dtype, crs="EPSG:32632",
                           transform=from_origin(500000, 5200000, 30, 30), **tiled, **options) as file:
            file.write(data, 1)
        with rasterio.open(path) as file:
            want = file.read(1).astype("f4")
        got = numpy.load(export(path, name + ".npy", "-q"))
        known = ~numpy.isnan(want)
        checks.that(f"{name} {tiled}: samples", numpy.array_equal(got[known], want[known]), numpy.abs(got - want)[known].max())

# Mosaics of several files.
for name in ["tiles", "tiles.vrt"]:
    got = numpy.load(export(folder / name, name + ".npy", "-q"))
    want = (heights() + 0.25).astype("f4")
    checks.that(f"{name}: samples", numpy.array_equal(got[:12], want[:12]) and numpy.array_equal(got[:, :20], want[:, :20]))
    with rasterio.open(export(folder / name, name + "-out.tif", "-q")) as after:
        checks.equal(f"{name}: where it lies", (after.transform, after.crs), (from_origin(500000, 5200000, 30, 30), rasterio.CRS.from_epsg(32632)))

# Zarr versions 2 and 3, written by zarr-python.
place = {"x": 500015 + 30 * numpy.arange(WIDTH), "y": 5199985 - 30.0 * numpy.arange(HEIGHT)}
for version, codecs in [(2, [None, numcodecs.Zlib(), numcodecs.Zstd(), numcodecs.GZip(), numcodecs.LZ4(), numcodecs.Blosc("lz4"), numcodecs.Blosc("zstd", shuffle=0), numcodecs.Blosc("zlib")]),
                        (3, [None, zarr.codecs.GzipCodec(), zarr.codecs.ZstdCodec(), zarr.codecs.BloscCodec(cname="lz4"), zarr.codecs.BloscCodec(cname="zstd")])]:
    for n, codec in enumerate(codecs):
        path = WORK / f"heights-{version}-{n}.zarr"
        group = zarr.open_group(path, mode="w", zarr_format=version)
        for name, values in [("elevation", (heights() + 0.25).astype("f4")), *place.items()]:
            side = ["y", "x"] if values.ndim == 2 else [name]
            made = group.create_array(name, shape=values.shape, dtype=values.dtype, chunks=(8, 16) if values.ndim == 2 else (10,),
                                      compressors=codec if values.ndim == 2 else None, dimension_names=side if version == 3 else None)
            made[...] = values
            if version == 2:
                made.attrs["_ARRAY_DIMENSIONS"] = side
            if values.ndim == 2:
                made.attrs["crs"] = "EPSG:32632"
        got = numpy.load(export(path, path.stem + ".npy", "-q"))
        checks.that(f"{path.name} ({codec}): samples", numpy.array_equal(got, (heights() + 0.25).astype("f4")))
        with rasterio.open(export(path, path.stem + ".tif", "-q")) as after:
            checks.equal(f"{path.name}: where it lies", (after.transform, after.crs), (from_origin(500000, 5200000, 30, 30), rasterio.CRS.from_epsg(32632)))

# OpenEXR written by the OpenEXR library.
for name, sample in [("NO", "f4"), ("RLE", "f4"), ("ZIPS", "f4"), ("ZIP", "f4"), ("ZIP", "f2"), ("ZIP", "u4")]:
    path = WORK / f"library-{name}-{sample}.exr"
    data = heights().astype(sample)
    head = {"compression": getattr(OpenEXR, f"{name}_COMPRESSION"), "type": OpenEXR.scanlineimage}
    with OpenEXR.File(head, {"B": data + 1, "height": data, "A": data + 2}) as file:
        file.write(str(path))
    path.with_suffix(".toml").write_text("cell = 30\n")
    got = numpy.load(export(path, f"{path.stem}.npy", "-q"))
    checks.that(f"{path.name}: samples", numpy.array_equal(got, heights().astype("f4")))
    got = numpy.load(export(f"{path}:1", f"{path.stem}-1.npy", "-q"))
    checks.that(f"{path.name}: its first channel", numpy.array_equal(got, heights().astype("f4") + 2))

# Exports keep the position of the import, as read by GDAL and by orogen.
source = folder / "f32-strips.tif"
with rasterio.open(source) as before:
    for extension in ["asc", "png", "pgm"]:
        with rasterio.open(export(source, f"placed.{extension}", "-q")) as after:
            checks.equal(f".{extension}: where it lies", after.transform, before.transform)
            if extension != "pgm":
                checks.equal(f".{extension}: coordinate system", after.crs, before.crs)
    for extension in ["asc", "png", "pgm", "r16", "r32", "npy", "exr"]:
        for first_row in ["north", "south"]:
            if first_row == "south" and extension not in ["png", "pgm", "r16", "r32"]:
                continue
            options = ["--first-row", first_row] if first_row == "south" else []
            placed = export(source, f"again-{first_row}.{extension}", "-q", *options)
            if extension == "pgm":
                continue
            with rasterio.open(export(placed, f"again-{extension}.tif", "-q")) as after:
                checks.equal(f".{extension}, {first_row} first, and back: where it lies", after.transform, before.transform)
                checks.equal(f".{extension}, {first_row} first, and back: coordinate system", after.crs, before.crs)
                off = numpy.abs(after.read(1) - (heights() + 0.25))
                off[HOLE[1], HOLE[0]] = 0
                checks.that(f".{extension}, {first_row} first, and back: samples", off.max() < 0.01, off.max())
# Degrees have oblong pixels. With NAME.json the samples are restored exactly, without it approximately.
degrees = export(folder / "degrees.tif", "degrees.r32", "-q")
first, second = (numpy.load(export(path, name, "-q")) for path, name in [(folder / "degrees.tif", "a.npy"), (degrees, "b.npy")])
checks.that("degrees by .r32 and back", numpy.array_equal(first, second))

# The WKT of .prj files, in ESRI's dialect: a point of each system has the position of the EPSG registry.
codes = [4326, 4269, 4267, 4258, 32632, 32719, 26910, 26710, 25832, 6339, 28355, 7855, 31983, 3857, 3395, 3413, 3031, 32661, 2154, 3035, 5070, 3577, 27700,
         2193, 31467, 2056, 28992, 31370, 3006, 3347, 31287, 23700, 2927, 5514, 3112]
for code in codes:
    system = pyproj.CRS.from_epsg(code)
    area = system.area_of_use
    there = pyproj.Transformer.from_crs(system.geodetic_crs, system, always_xy=True)
    middle = ((area.west + area.east) / 2, (area.south + area.north) / 2)
    if code in [32661, 3413, 3395, 3857]:
        middle = (20, 70)
    if code == 3031:
        middle = (20, -75)
    x, y = there.transform(*middle)
    step = 0.001 if system.is_geographic else 100
    path = write(WORK / f"epsg{code}.tif", "float32", crs=f"EPSG:{code}", transform=from_origin(x, y, step, step))
    export(path, f"epsg{code}.asc", "-q")
    read = pyproj.CRS.from_user_input((WORK / f"epsg{code}.prj").read_text())
    back = pyproj.Transformer.from_crs(read.geodetic_crs, read, always_xy=True).transform(*middle)
    checks.that(f"EPSG:{code}: its .prj", numpy.allclose(back, (x, y), rtol=0, atol=1e-3 if step > 1 else 1e-9), (back, (x, y)))
    checks.equal(f"EPSG:{code}: its ellipsoid", read.ellipsoid.semi_major_metre, system.ellipsoid.semi_major_metre)
    with rasterio.open(WORK / f"epsg{code}.asc") as file:
        checks.that(f"EPSG:{code}: GDAL understands it", file.crs is not None and file.crs.is_projected == system.is_projected, file.crs)
    with rasterio.open(export(WORK / f"epsg{code}.asc", f"epsg{code}-back.tif", "-q")) as file:
        checks.equal(f"EPSG:{code}: its .prj and back", file.crs.to_epsg() if file.crs else None, code)
# A coordinate system without a code is kept verbatim, also in a GeoTIFF.
own = pyproj.CRS.from_proj4("+proj=sinu +lon_0=10 +datum=WGS84").to_wkt("WKT1_ESRI")
shutil.copy(folder / "arc.asc", WORK / "own.asc")
(WORK / "own.prj").write_text(own)
with rasterio.open(export(WORK / "own.asc", "own.tif", "-q")) as file:
    checks.that("a system of its own", file.crs is not None and "Sinusoidal" in file.crs.to_wkt(), file.crs)
checks.equal("a system of its own, and back", (export(WORK / "own.tif", "own-back.asc", "-q").with_suffix(".prj")).read_text().strip(), own)

# An SRTM tile of GDAL's own driver, and a whole world written by orogen and compressed again by GDAL.
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
# A folder of SRTM tiles: two with a shared column, and a gap.
(WORK / "srtm").mkdir(exist_ok=True)
for name, data in [("N46E007", tile), ("N46E008", tile[:, ::-1]), ("N45E008", tile)]:
    data.astype(">i2").tofile(WORK / "srtm" / f"{name}.hgt")
with rasterio.open(export(WORK / "srtm", "srtm.tif", "-q")) as after:
    checks.equal("srtm: its corner and system", (round(after.bounds.left, 3), round(after.bounds.top, 3), after.crs.to_epsg()), (7.0, 47.0, 4326))
    got = after.read(1)
    want = numpy.concatenate([tile, tile[:, ::-1][:, 1:]], axis=1)
    checks.equal("srtm: columns", got.shape[1], 2401)
    checks.that("srtm: its first row", numpy.array_equal(got[0], want[0]))
world = export(ROOT / "crates/orogen-engine/recipes/hills.toml", "hills.tif", "-q", "--window", "3,5,301,203")
want = numpy.load(export(ROOT / "crates/orogen-engine/recipes/hills.toml", "hills.npy", "-q", "--window", "3,5,301,203"))
for k, options in enumerate([{"compress": "lzw", "predictor": 3, "tiled": True}, {"compress": "packbits"}, {"compress": "deflate", "predictor": 2}]):
    copy(world, WORK / f"packed{k}.tif", driver="GTiff", **options)
    got = numpy.load(export(WORK / f"packed{k}.tif", f"packed{k}.npy", "-q"))
    checks.that(f"packed anew by {options}", numpy.array_equal(got.view("u4"), want.view("u4")))
# The checks must fail if a byte of the samples is changed.
broken = bytearray((folder / "f32-strips.tif").read_bytes())
broken[2000] ^= 0x40
(WORK / "broken.tif").write_bytes(broken)
got = numpy.load(export(WORK / "broken.tif", "broken.npy", "-q"))
checks.that("a changed byte is a changed sample", not numpy.array_equal(got, (heights() + 0.25).astype("f4")))

checks.end()
