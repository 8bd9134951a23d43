"""Checks `orogen serve`: GDAL's drivers for WMTS and XYZ tiles, rasterio, NumPy, xarray, zarrita and others read what is exported."""

import io
import signal
import subprocess
import urllib.error
import urllib.request

import numpy
import rasterio
import serve_mesh
import serve_zarr
from orogen import BINARY, WORK, Checks, export
from rasterio.windows import Window

checks = Checks()
PLACE = ("--crs", "EPSG:32632", "--origin", "600000,5200000")

# A world at a place: the GeoTIFF of a preset.
place = export("hills", "place.tif", "--cell", 40, *PLACE)
with rasterio.open(place) as file:
    heights, bounds, crs = file.read(1), file.bounds, file.crs

server = subprocess.Popen(
    [BINARY, "serve", "place.tif", "hills", "endless", "--port", "0", "--quiet"], cwd=WORK, stdout=subprocess.PIPE, text=True
)
base = server.stdout.readline().split(" at ")[1].strip()


def get(path):
    """The bytes of an answer."""
    with urllib.request.urlopen(base + path) as answer:
        return answer.read()


# Windows: rasterio reads them over HTTP.
with rasterio.open(f"{base}place/window.tif") as file:
    checks.that("window.tif: the samples of the file", numpy.array_equal(file.read(1), heights))
    checks.equal("window.tif: the CRS", file.crs, crs)
    checks.equal("window.tif: the bounds", file.bounds, bounds)
west, north = bounds.left + 20 * 40, bounds.top - 10 * 40
part = f"bbox={west},{north - 50 * 40},{west + 60 * 40},{north}"
array = numpy.load(io.BytesIO(get(f"place/window.npy?{part}")))
checks.that("window.npy: the samples of the file", numpy.array_equal(array, heights[10:60, 20:80]))
with rasterio.open(io.BytesIO(get(f"place/window.png?{part}"))) as file:
    checks.equal("window.png: 16 bits", (file.dtypes[0], file.shape), ("uint16", (50, 60)))

# WMTS: the world's own matrix set is at the world's place.
for name, expected in [("world", 32632), ("web", 3857)]:
    with rasterio.open(f"WMTS:{base}place/wmts,layer=height,tilematrixset={name}") as file:
        checks.equal(f"WMTS {name}: the CRS", file.crs.to_epsg(), expected)
        checks.equal(f"WMTS {name}: red, green, blue and opacity", file.count, 4)
        if name == "world":
            checks.near("WMTS world: west", file.bounds.left, bounds.left, 40)
            checks.near("WMTS world: north", file.bounds.top, bounds.top, 40)
            picture = file.read(out_shape=(4, 128, 128))
            checks.that("WMTS world: a picture", picture[3].max() == 255 and picture[:3].std() > 5)

# Terrarium by WMTS: the heights of the file at the same coordinates, as coarse as the zoom.
with rasterio.open(f"WMTS:{base}place/wmts,layer=terrarium,tilematrixset=world") as file:
    row, column = file.index(bounds.left + 30.5 * 40, bounds.top - 40.5 * 40)
    pixel = file.read(window=Window(column, row, 1, 1))[:, 0, 0].astype(float)
    height = pixel[0] * 256 + pixel[1] + pixel[2] / 256 - 32768
    checks.near("terrarium: the height at a place", height, heights[40, 30], 20)

# XYZ tiles by GDAL's TMS driver.
zoom = 12
xyz = f"""<GDAL_WMS><Service name="TMS"><ServerUrl>{base}hills/terrarium/${{z}}/${{x}}/${{y}}.png</ServerUrl></Service>
<DataWindow><UpperLeftX>-20037508.34</UpperLeftX><UpperLeftY>20037508.34</UpperLeftY><LowerRightX>20037508.34</LowerRightX>
<LowerRightY>-20037508.34</LowerRightY><TileLevel>{zoom}</TileLevel><TileCountX>1</TileCountX><TileCountY>1</TileCountY>
<YOrigin>top</YOrigin></DataWindow><Projection>EPSG:3857</Projection><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY>
<BandsCount>3</BandsCount><ZeroBlockHttpCodes>404</ZeroBlockHttpCodes></GDAL_WMS>"""
cell = 2 * 20037508.342789244 / (256 << zoom)
built = export("hills", "built.npy", "--cell", repr(cell), "--window", "0,0,200,150")
with rasterio.open(xyz) as file:
    middle = 128 << zoom
    bands = file.read(window=Window(middle, middle, 200, 150)).astype(float)
decoded = bands[0] * 256 + bands[1] + bands[2] / 256 - 32768
difference = numpy.abs(decoded - numpy.load(built)).max()
checks.that("XYZ: the samples of an export", difference <= 0.5 / 256, difference)

serve_zarr.check(checks, base)
serve_mesh.check(checks, base)

# Errors are sentences.
try:
    get("place/window.tif?width=0")
    checks.that("a wrong width is refused", False)
except urllib.error.HTTPError as refused:
    checks.equal("a wrong width is refused", refused.code, 400)
    checks.that("and says why", b"whole number" in refused.read())

server.send_signal(signal.SIGINT)
checks.equal("it ends in peace", server.wait(60), 0)
checks.end()
