"""Writes test files of heights as other programs do: one formula in every kind that orogen reads, and some that it must reject."""

import shutil
from pathlib import Path

import numpy
import rasterio
from rasterio.shutil import copy
from rasterio.transform import from_origin

WIDTH, HEIGHT = 37, 23
HOLE = (5, 3)  # column, row


def heights():
    """An asymmetric formula with values from 8 to 108, which fit into eight bits."""
    i, j = numpy.meshgrid(numpy.arange(WIDTH), numpy.arange(HEIGHT))
    return 30 + 2 * i - j + i * j % 7


def write(path, dtype, nodata=None, crs="EPSG:32632", transform=None, add=0.0, bands=1, point=False, **options):
    """Writes the formula plus `add`, with a hole if a nodata value is given."""
    data = (heights() + add).astype(dtype)
    if nodata is not None:
        data[HOLE[1], HOLE[0]] = nodata
    profile = {"driver": "GTiff", "width": WIDTH, "height": HEIGHT, "count": bands, "dtype": dtype, "nodata": nodata}
    transform = transform or from_origin(500000, 5200000, 30, 30)
    with rasterio.open(path, "w", crs=crs, transform=transform, **profile, **options) as file:
        for band in range(bands):
            file.write(data, band + 1)
        if point:
            file.update_tags(AREA_OR_POINT="Point")
    return path


def several_bands(path, dtype, **options):
    """Writes three bands: the formula, the formula plus 1000, and the formula flipped."""
    bands = [heights(), heights() + 1000, heights()[::-1, ::-1]]
    profile = {"driver": "GTiff", "width": WIDTH, "height": HEIGHT, "count": 3, "dtype": dtype, "crs": "EPSG:32632"}
    with rasterio.open(path, "w", transform=from_origin(500000, 5200000, 30, 30), **profile, **options) as file:
        for band, data in enumerate(bands):
            file.write(data.astype(dtype), band + 1)


TILES = {"tiled": True, "blockxsize": 16, "blockysize": 16}


def geotiffs(folder):
    """Writes every kind of GeoTIFF that is read; returns name, type and offset of the formula."""
    kinds = [
        ("f32-strips", "float32", 0.25, {}),
        ("f32-tiles-deflate-p3", "float32", 0.25, {**TILES, "compress": "deflate", "predictor": 3}),
        ("f32-tiles-lzw-p3-big-endian", "float32", 0.25, {**TILES, "compress": "lzw", "predictor": 3, "ENDIANNESS": "BIG"}),
        ("f32-strips-lzw-p2", "float32", 0.25, {"compress": "lzw", "predictor": 2, "blockysize": 5}),
        ("f64-tiles-deflate-p3", "float64", 0.125, {**TILES, "compress": "deflate", "predictor": 3}),
        ("f64-strips-big-endian", "float64", 0.125, {"ENDIANNESS": "BIG"}),
        ("f32-bigtiff-tiles-deflate", "float32", 0.25, {**TILES, "compress": "deflate", "BIGTIFF": "YES"}),
        ("f32-bigtiff-big-endian-lzw", "float32", 0.25, {"compress": "lzw", "BIGTIFF": "YES", "ENDIANNESS": "BIG"}),
        ("i16-tiles-lzw-p2", "int16", 0, {**TILES, "compress": "lzw", "predictor": 2}),
        ("i16-strips-deflate-p2-big-endian", "int16", 0, {"compress": "deflate", "predictor": 2, "ENDIANNESS": "BIG"}),
        ("u16-strips-lzw-p2", "uint16", 0, {"compress": "lzw", "predictor": 2, "blockysize": 7}),
        ("u8-strips-packbits", "uint8", 0, {"compress": "packbits"}),
        ("i8-tiles-deflate", "int8", 0, {**TILES, "compress": "deflate"}),
        ("u8-tiles-lzw-p2", "uint8", 0, {**TILES, "compress": "lzw", "predictor": 2}),
        ("i32-tiles-deflate-p2", "int32", 0, {**TILES, "compress": "deflate", "predictor": 2}),
        ("u32-strips-packbits-big-endian", "uint32", 0, {"compress": "packbits", "ENDIANNESS": "BIG"}),
        ("i64-strips", "int64", 0, {}),
        ("u64-tiles-deflate", "uint64", 0, {**TILES, "compress": "deflate"}),
        ("f32-tiles-zstd-p3", "float32", 0.25, {**TILES, "compress": "zstd", "predictor": 3}),
        ("i16-strips-zstd-p2-big-endian", "int16", 0, {"compress": "zstd", "predictor": 2, "ENDIANNESS": "BIG"}),
        ("f32-tiles-lzma", "float32", 0.25, {**TILES, "compress": "lzma"}),
        ("i16-strips-lzma-p2", "int16", 0, {"compress": "lzma", "predictor": 2}),
        ("f32-tiles-lerc", "float32", 0.25, {**TILES, "compress": "lerc", "MAX_Z_ERROR": 0}),
        ("f64-strips-lerc-deflate", "float64", 0.125, {"compress": "lerc_deflate", "MAX_Z_ERROR": 0}),
        ("i16-tiles-lerc-zstd", "int16", 0, {**TILES, "compress": "lerc_zstd", "MAX_Z_ERROR": 0}),
        ("u8-tiles-lerc", "uint8", 0, {**TILES, "compress": "lerc", "MAX_Z_ERROR": 0}),
        ("i32-strips-lerc", "int32", 0, {"compress": "lerc", "MAX_Z_ERROR": 0}),
        ("u16-strips-lerc-big-endian", "uint16", 0, {"compress": "lerc", "MAX_Z_ERROR": 0, "ENDIANNESS": "BIG"}),
    ]
    for name, dtype, add, options in kinds:
        unsigned = dtype.startswith("u")
        nodata = {"int8": -128, "uint8": 255}.get(dtype, 60000 if unsigned else -9999)
        yield write(folder / f"{name}.tif", dtype, nodata, add=add, **options), add


def odd_ones(folder):
    """Writes GeoTIFFs with other transforms, and some that must be rejected."""
    write(folder / "point.tif", "float32", point=True)
    write(folder / "degrees.tif", "float32", crs="EPSG:4326", transform=from_origin(7, 46, 1 / 1200, 1 / 1200))
    write(folder / "oblong.tif", "float32", transform=from_origin(500000, 5200000, 20, 30))
    write(folder / "south-up.tif", "float32", transform=rasterio.Affine(30, 0, 500000, 0, 30, 5200000))
    write(folder / "turned.tif", "float32", transform=rasterio.Affine(30, 5, 500000, 5, -30, 5200000))
    several_bands(folder / "bands.tif", "float32")
    several_bands(folder / "bands-pixels-p3.tif", "float32", interleave="pixel", compress="deflate", predictor=3, **TILES)
    several_bands(folder / "bands-pixels-p2.tif", "int16", interleave="pixel", compress="lzw", predictor=2)
    several_bands(folder / "bands-apart.tif", "int16", interleave="band", compress="zstd", predictor=2, **TILES)
    several_bands(folder / "bands-lerc.tif", "float32", interleave="pixel", compress="lerc", MAX_Z_ERROR=0)
    # Every sample is within half a metre; some do not compress.
    write(folder / "lossy-lerc.tif", "float32", add=0.25, compress="lerc", MAX_Z_ERROR=0.5, **TILES)
    write(folder / "webp.tif", "uint8", compress="webp", WEBP_LOSSLESS=True, bands=3)
    with rasterio.open(folder / "sparse.tif", "w", driver="GTiff", width=64, height=48, count=1, dtype="float32", nodata=-1,
                       transform=from_origin(0, 0, 30, 30), SPARSE_OK=True, **TILES) as file:
        file.write(numpy.full((16, 16), 7, "float32"), 1, window=rasterio.windows.Window(16, 16, 16, 16))
    with rasterio.open(folder / "all-nodata.tif", "w", driver="GTiff", width=WIDTH, height=HEIGHT, count=1,
                       dtype="int16", nodata=-9999, transform=from_origin(0, 0, 30, 30)) as file:
        file.write(numpy.full((HEIGHT, WIDTH), -9999, "int16"), 1)
    with rasterio.open(folder / "scaled.tif", "w", driver="GTiff", width=WIDTH, height=HEIGHT, count=1, dtype="int16",
                       transform=from_origin(0, 0, 30, 30)) as file:
        file.write(heights().astype("int16"), 1)
        file.scales, file.offsets = (0.5,), (100.0,)


def others(folder):
    """Writes the other formats."""
    source = write(folder / "source.tif", "float32", -9999, add=0.25)
    copy(source, folder / "arc.asc", driver="AAIGrid", DECIMAL_PRECISION=3)
    numpy.save(folder / "array.npy", (heights() + 0.25).astype(">f8"))
    (folder / "array.json").write_text('{ "cell": 30 }\n')
    picture = ((heights() - 8) * 600).astype("uint16")
    with rasterio.open(folder / "grey.png", "w", driver="PNG", width=WIDTH, height=HEIGHT, count=1, dtype="uint16") as file:
        file.write(picture, 1)
    (folder / "grey.toml").write_text(f"cell = 30\nlow = 8\nhigh = {8 + 65535 / 600}\n")
    picture.astype("<u2").tofile(folder / "raw.r16")
    (folder / "raw.toml").write_text(f"width = {WIDTH}\nheight = {HEIGHT}\ncell = 30\nlow = 8\nhigh = {8 + 65535 / 600}\n")
    (heights() + 0.25).astype(">f4").tofile(folder / "floats.r32")
    (folder / "floats.toml").write_text(f"width = {WIDTH}\nheight = {HEIGHT}\ncell = 30\nbyte_order = 'big'\n")
    for beside in folder.glob("*.aux.xml"):
        beside.unlink()
    (folder / "arc.prj").rename(folder / "placed.prj")
    (folder / "placed.asc").write_bytes((folder / "arc.asc").read_bytes())
    # A picture with a world file and a coordinate system, and another with GDAL's .aux.xml.
    with rasterio.open(folder / "notes.png", "w", driver="PNG", width=WIDTH, height=HEIGHT, count=1, dtype="uint16",
                       crs="EPSG:32632", transform=from_origin(500000, 5200000, 30, 30)) as file:
        file.write(picture, 1)
    shutil.copy(folder / "notes.png", folder / "world.png")
    (folder / "world.pgw").write_text("30\n0\n0\n-30\n500015\n5199985\n")
    shutil.copy(folder / "placed.prj", folder / "world.prj")
    for name in ["notes", "world"]:
        (folder / f"{name}.toml").write_text(f"low = 8\nhigh = {8 + 65535 / 600}\n")
    source.unlink()


def mosaics(folder):
    """Writes the formula as overlapping tiles with one missing, as a folder and as a virtual raster."""
    tiles = folder / "tiles"
    tiles.mkdir(exist_ok=True)
    data = (heights() + 0.25).astype("float32")
    pieces = {"a": (0, 0, 20, 12), "b": (19, 0, 18, 12), "c": (0, 12, 20, 11)}
    for name, (x, y, w, h) in pieces.items():
        profile = {"driver": "GTiff", "width": w, "height": h, "count": 1, "dtype": "float32", "crs": "EPSG:32632"}
        place = from_origin(500000 + 30 * x, 5200000 - 30 * y, 30, 30)
        with rasterio.open(tiles / f"{name}.tif", "w", transform=place, compress="deflate", **profile) as file:
            file.write(data[y:y + h, x:x + w], 1)
    sources = "".join(
        f"""    <SimpleSource>
      <SourceFilename relativeToVRT="1">tiles/{name}.tif</SourceFilename>
      <SourceBand>1</SourceBand>
      <SrcRect xOff="0" yOff="0" xSize="{w}" ySize="{h}"/>
      <DstRect xOff="{x}" yOff="{y}" xSize="{w}" ySize="{h}"/>
    </SimpleSource>
""" for name, (x, y, w, h) in pieces.items())
    (folder / "tiles.vrt").write_text(f"""<VRTDataset rasterXSize="{WIDTH}" rasterYSize="{HEIGHT}">
  <SRS>{(folder / "placed.prj").read_text().strip().replace('"', "&quot;")}</SRS>
  <GeoTransform>500000, 30, 0, 5200000, 0, -30</GeoTransform>
  <VRTRasterBand dataType="Float32" band="1">
{sources}  </VRTRasterBand>
</VRTDataset>
""")


def everything(folder):
    """Writes all files into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    made = list(geotiffs(folder))
    odd_ones(folder)
    others(folder)
    mosaics(folder)
    return made


if __name__ == "__main__":
    import sys

    everything(Path(sys.argv[1]))
