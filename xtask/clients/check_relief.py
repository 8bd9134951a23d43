"""Compares hillshade (within one grey level), slope and aspect (degrees) with gdaldem."""

import subprocess
import warnings

import numpy
import rasterio
from orogen import WORK, Checks, export

warnings.filterwarnings("ignore", category=rasterio.errors.NotGeoreferencedWarning)
checks = Checks()
WINDOW = ["--window", "200,300,500,400", "-q"]


def gdaldem(mode, source, *options):
    """Returns the output of gdaldem for a file without the border, where the extrapolation differs."""
    path = WORK / f"{mode}.tif"
    subprocess.run(["gdaldem", mode, source, path, *options], check=True, capture_output=True)
    with rasterio.open(path) as raster:
        return raster.read(1)[1:-1, 1:-1].astype("f8")


def ours(recipe, layer, *options):
    """Returns a layer of orogen without the same border."""
    return numpy.load(export(recipe, f"{recipe}-{layer}.npy", "--layer", layer, *options, *WINDOW))[1:-1, 1:-1].astype("f8")


for recipe in ["alpine", "canyon", "classic"]:
    heights = export(recipe, f"{recipe}.tif", *WINDOW)
    # Grays of gdaldem: 1 without light, 255 in full light.
    greys = 1 + 254 * ours(recipe, "hillshade")
    off = numpy.abs(greys - gdaldem("hillshade", heights))
    checks.that(f"{recipe}: hillshade within a grey level", off.max() <= 1, off.max())
    wrong = numpy.abs(greys - gdaldem("hillshade", heights, "-az", "135"))
    checks.that(f"{recipe}: light from the other side is told apart", wrong.max() > 20, wrong.max())

    for az, alt, z in [(135, 30, 1), (20, 60, 2.5), (250, 5, 0.5)]:
        greys = 1 + 254 * ours(recipe, "hillshade", "--azimuth", az, "--altitude", alt, "--z-factor", z)
        off = numpy.abs(greys - gdaldem("hillshade", heights, "-az", str(az), "-alt", str(alt), "-z", str(z)))
        checks.that(f"{recipe}: hillshade with light from {az} and {alt} degrees, heights times {z}", off.max() <= 1, off.max())

    slope = gdaldem("slope", heights)
    off = numpy.abs(ours(recipe, "slope") - slope)
    checks.that(f"{recipe}: slope in degrees", off.max() < 0.01, off.max())
    off = numpy.abs(ours(recipe, "aspect") - gdaldem("aspect", heights))
    # Flat ground has no aspect, and 0 degrees equal 360.
    off = numpy.minimum(off, 360 - off)[slope > 0.5]
    checks.that(f"{recipe}: aspect in degrees", off.max() < 0.05, off.max())

checks.end()
