"""Compares terrain layers with those of GRASS, WhiteboxTools and gdaldem.

Files of heights on the command line replace the presets: at most the middle 400 x 400 samples of each are compared. The differences are
printed as a table.
"""

import json
import os
import shutil
import subprocess
import sys
import warnings

import numpy
import rasterio
import rasterio.features
import whitebox_workflows
from d8 import accumulated, below_border, downstream, flooded, receivers, to_border, torn
from orogen import CLIENT, WORK, Checks, export

warnings.filterwarnings("ignore")
checks = Checks()
GRASS = WORK / "grass"
DAY, LATITUDE = 172, 46
STREAM = 1e6
# Tolerance for equivalent algorithms: rounding to f32.
SAME = 1e-4


def read(path):
    with rasterio.open(path) as raster:
        data = raster.read(1).astype("f8")
        return numpy.where(data == raster.nodata, numpy.nan, data) if raster.nodata is not None else data


def inner(data, border):
    """Removes the border, where a neighborhood extends beyond the map and each program extrapolates in its own way."""
    return data[border:-border, border:-border]


class Place:
    """Heights, the layers of orogen and the layers of other programs."""

    def __init__(self, heights, crs, transform):
        self.z = heights.astype("f4").astype("f8")
        self.cell, self.transform = transform.a, transform
        self.options = [] if crs else ["--latitude", LATITUDE]
        # r.sun reads the latitude from the map.
        self.crs = crs or f"+proj=tmerc +lat_0={LATITUDE} +lon_0=0 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m"
        self.heights = self.write("heights.tif", self.z)

    def write(self, name, data):
        """Writes a plain GeoTIFF at the position, which every program reads."""
        rows, columns = data.shape
        profile = {"width": columns, "height": rows, "count": 1, "dtype": "float32", "crs": self.crs, "transform": self.transform}
        with rasterio.open(WORK / name, "w", driver="GTiff", nodata=-32768, **profile) as raster:
            raster.write(data.astype("f4"), 1)
        return WORK / name

    def ours(self, layer, *options):
        return read(export(self.heights, f"ours-{layer}.tif", "--layer", layer, "--no-cache", "-q", *options))

    def grass(self, script, *rasters):
        """Runs a script on the map `z` and returns its output rasters."""
        shutil.rmtree(GRASS, ignore_errors=True)
        lines = ["set -e", f"r.in.gdal -o input={self.heights} output=z --o --q", "g.region raster=z", script]
        lines += [f"r.out.gdal -f -c input={name} output={WORK}/grass-{name}.tif type=Float64 --o --q" for name in rasters]
        subprocess.run(["grass", "-c", self.heights, "-e", GRASS], check=True, capture_output=True)
        (WORK / "script.sh").write_text("\n".join(lines))
        done = subprocess.run(
            ["grass", GRASS / "PERMANENT", "--exec", "bash", WORK / "script.sh"], capture_output=True, text=True
        )
        if done.returncode:
            sys.exit(f"GRASS failed: {done.stderr[-2000:]}")
        return [read(WORK / f"grass-{name}.tif") for name in rasters]


def off(ours, theirs, where=None):
    """Returns the mean absolute difference relative to the mean absolute deviation of the other layer."""
    both = numpy.isfinite(ours) & numpy.isfinite(theirs) & (True if where is None else where)
    ours, theirs = ours[both], theirs[both]
    return numpy.abs(ours - theirs).mean() / numpy.abs(theirs - theirs.mean()).mean()


def unlike(ours, theirs, tolerance=0):
    """Returns the share of samples with a relative difference above the threshold."""
    both = numpy.isfinite(ours) & numpy.isfinite(theirs)
    ours, theirs = ours[both], theirs[both]
    return (numpy.abs(ours - theirs) > tolerance * numpy.abs(theirs)).mean()


def neighborhoods(name, place):
    """Compares neighborhood layers with GRASS and gdaldem: differences by name, each with its tolerance."""
    found = {}
    cell, z = place.cell, place.z
    search = max(3, round(500 / cell))
    # Half a cell more, so that rounding does not decide whether the last cell is in range.
    reach = (search + 0.5) * cell
    disc = max(2, round(300 / cell))
    middle = [dimension // 2 for dimension in z.shape]
    observer = (place.transform * (middle[1] + 0.5, middle[0] + 0.5))
    tri = WORK / "gdal-TRI.tif"
    subprocess.run(["gdaldem", "TRI", "-alg", "Riley", place.heights, tri], check=True, capture_output=True)
    found["tri (gdaldem)"] = off(inner(place.ours("tri"), 1), inner(read(tri), 1)), SAME
    area = place.write("area.tif", place.ours("drainage-area"))
    script = f"""
r.neighbors -c input=z output=mean size={2 * disc + 1} method=average --q
r.geomorphon -m elevation=z forms=forms search={reach} flat=1 --q
r.in.gdal -o input={area} output=area --q
r.slope.aspect elevation=z slope=tangent format=percent -e --q
r.mapcalc "wet = log(area / {cell} / max(tangent / 100, 0.001))" --q
r.mapcalc "streams = if(area >= {STREAM}, 1, null())" --q
r.grow.distance input=streams distance=far --q
r.viewshed -b input=z output=seen coordinates={observer[0]},{observer[1]} observer_elevation=10 --q
r.slope.aspect elevation=z slope=slope aspect=aspect -e --q
r.sun elevation=z aspect=aspect slope=slope linke_value=3 albedo_value=0.2 day={DAY} step=0.1 glob_rad=sun nprocs={os.cpu_count()} --q
"""
    mean, forms, wet, far, seen, sun = place.grass(script, "mean", "forms", "wet", "far", "seen", "sun")
    border = disc + 1
    index = place.ours("tpi", "--disc", (disc + 0.01) * cell)
    found["tpi (r.neighbors)"] = off(inner(index, border), inner(z - mean, border)), SAME
    landforms = place.ours("landforms", "--reach", reach)
    found["landforms (r.geomorphon)"] = unlike(inner(landforms, search), inner(forms, search)), 0.01
    found["wetness (r.slope.aspect)"] = off(inner(place.ours("wetness"), 1), inner(wet, 1)), SAME
    # If the border is nearer than a stream, a stream outside may be nearer: orogen computes two samples beyond the border.
    known = far <= to_border(z.shape) * cell
    ours = place.ours("stream-distance")
    found["stream-distance (r.grow.distance)"] = off(ours, far, known), SAME
    # r.grow.distance passes the nearest stream from cell to cell and misses it in a few cells; it never finds a nearer one.
    checks.that(f"{name}: no stream is nearer than r.grow.distance finds", (ours[known] <= far[known] + 1e-5 * far.max()).all())
    visible = place.ours("viewshed", "--observer", f"{middle[1] * cell},{middle[0] * cell}", "--observer-height", 10)
    elsewhere = place.ours("viewshed", "--observer", f"{middle[1] * cell / 2},{middle[0] * cell / 2}", "--observer-height", 10)
    either = (elsewhere == 1) | (seen == 1)
    checks.that(f"{name}: another observer is told apart", (elsewhere != seen)[either].mean() > 0.3)
    found["viewshed (r.viewshed)"] = unlike(visible, seen), 0.01
    light = 1000 * place.ours("insolation", "--day", DAY, *place.options)
    other = place.ours("insolation", "--day", DAY - 60, *place.options)
    told = numpy.nanmean(inner(numpy.abs(1000 * other - sun) / sun, 1))
    checks.that(f"{name}: another day is told apart", told > 0.05, told)
    # r.sun samples shadows at the nearest cells of the ray, so the remaining difference does not vanish with its step: see docs/layers.md.
    found["insolation (r.sun)"] = numpy.nanmean(inner(numpy.abs(light - sun) / sun, 1)), 0.01
    return found


def beside(program, place, cells, to, length, above, known):
    """Compares the water layers of orogen with those of another program, where the map determines them."""
    cell = place.cell
    meets = known & (to >= 0)
    clean = ~below_border(place.ours("flow-direction").astype("int64"))
    area = cells * cell * cell
    checks.that(f"{program}: much of the map is compared", clean.mean() > 0.6 and meets.mean() > 0.3, f"{clean.mean()} {meets.mean()}")
    return {
        f"drainage-area ({program})": (unlike(place.ours("drainage-area")[clean], area[clean], SAME), 0),
        f"height-above-drainage ({program})": (off(place.ours("height-above-drainage"), above, meets), SAME),
        f"flow-distance ({program})": (off(place.ours("flow-distance"), length * cell, meets), SAME),
    }


def walked(place):
    """Compares water layers with traces along `flow-direction`; depressions are not filled."""
    codes = place.ours("flow-direction").astype("int64")
    cells = accumulated(codes)
    to, length, known = downstream(codes, cells * place.cell**2 >= STREAM)
    filled = flooded(place.z)
    found = beside("walked", place, cells, to, length, filled - filled.ravel()[to], known)
    ours, row, column = watershed(place)
    end, (to, _) = row * codes.shape[1] + column, receivers(codes)
    to[end] = end
    while not (to[to] == to).all():
        to = to[to]
    return found | {
        "filled (walked)": (unlike(place.ours("filled"), filled), 0),
        "watershed (walked)": (unlike(ours.astype("f8"), (to == end).reshape(codes.shape).astype("f8")), 0),
    }


def watershed(place):
    """Returns the watershed of a chosen outlet beside the stream that drains the most of the inner map, and the outlet's row and column."""
    area = place.ours("drainage-area")
    drained = numpy.where(to_border(area.shape) > 20, area, 0)
    row, column = numpy.unravel_index(drained.argmax(), area.shape)
    east, north = place.transform * (column + 0.5, row + 0.5)
    beside = f"{east + 1.2 * place.cell},{north - 0.7 * place.cell}"
    options = ("--layer", "watershed", "--outlet", beside, "--river-area", drained.max(), "--smooth", 0, "--no-cache", "-q")
    path = export(place.heights, "basin.geojson", *options)
    (feature,) = json.loads(path.read_text())["features"]
    # The nearest cell of the stream may be one further downstream.
    across, down = ~place.transform * [feature["properties"][name] for name in ("outlet_x", "outlet_y")]
    found = int(down), int(across)
    checks.that("the outlet is on the stream", area[found] >= drained.max() and numpy.hypot(found[0] - row, found[1] - column) < 3, found)
    ours = rasterio.features.rasterize([(feature["geometry"], 1)], out_shape=area.shape, transform=place.transform) == 1
    checks.that("the watershed has many cells", ours.sum() > 1000, ours.sum())
    return ours, *found


def whitebox(place):
    """Compares water layers with those of WhiteboxTools.

    Programs route water across level ground and out of depressions differently, so both get ground without them: filled, with each cell
    2 cm above the next, plus smaller noise so that no two neighbors are equally steep.
    """
    random = numpy.random.default_rng(1)
    falling = flooded(place.z - place.z.min() + 1, step=0.02)
    rough = random.uniform(0, 0.01, falling.shape)
    while (again := torn((falling + rough).astype("f4").astype("f8"))).any():
        rough[again] = random.uniform(0, 0.01, again.sum())
    place = Place(falling + rough, place.crs, place.transform)
    env = whitebox_workflows.WbEnvironment()
    env.verbose = False

    def get(raster, name):
        env.write_raster(raster, str(WORK / name))
        return read(WORK / name)

    dem = env.read_raster(str(place.heights))
    cells = get(env.hydrology.d8_flow_accum(input=dem, out_type="cells"), "wb-cells.tif")
    streams = cells * place.cell**2 >= STREAM
    drawn = env.read_raster(str(place.write("wb-streams.tif", streams)))
    above = get(env.hydrology.elevation_above_stream(dem=dem, streams=drawn), "wb-above.tif")
    length = get(env.hydrology.downslope_distance_to_stream(dem=dem, streams=drawn), "wb-length.tif") / place.cell
    pointers = env.hydrology.d8_pointer(dem=dem)
    pointer = get(pointers, "wb-pointer.tif")
    basin, row, column = watershed(place)
    outlet = numpy.zeros(place.z.shape)
    outlet[row, column] = 1
    outlet = env.read_raster(str(place.write("wb-outlet.tif", outlet)))
    theirs = get(env.hydrology.watershed_from_raster_pour_points(d8_pntr=pointers, pour_pts=outlet), "wb-basin.tif") == 1
    codes = place.ours("flow-direction").astype("int64")
    to, _, known = downstream(codes, streams)
    found = beside("WhiteboxTools", place, cells, to, length, above, known)
    # WhiteboxTools ends at the border; orogen continues beyond it.
    ours = place.ours("flow-direction", "--codes", "whitebox")
    return found | {
        "flow-direction (WhiteboxTools)": (unlike(inner(ours, 1), inner(pointer, 1)), 0),
        # Cells of the border lead out of the map there.
        "watershed (WhiteboxTools)": (unlike(inner(basin.astype("f8"), 1), inner(theirs.astype("f8"), 1)), 0),
    }


def middle(source):
    """Returns the middle of a file of heights, with holes filled in the same way as orogen."""
    with rasterio.open(source) as raster:
        rows, columns = (min(400, size) for size in raster.shape)
        left, top = (raster.width - columns) // 2, (raster.height - rows) // 2
        holes = (raster.read(1, window=((top, top + rows), (left, left + columns))) == raster.nodata).mean()
    return export(source, "middle.tif", "--window", f"{left},{top},{columns},{rows}", "-q"), f"{columns} x {rows}, {holes:.2%} holes"


if __name__ == "__main__":
    named = sys.argv[1:]
    for source in named or ["alpine", "canyon"]:
        if named:
            path, said = middle(source)
            source = source.rsplit("/")[-1]
            print(f"{source}: {said}")
        else:
            # GRASS needs a known coordinate system.
            map_options = ("--crs", "EPSG:32632", "--origin", "500000,5000000")
            path = export(source, "preset.tif", "--window", "400,440,320,300", *map_options, "-q")
        with rasterio.open(path) as raster:
            place = Place(raster.read(1), raster.crs, raster.transform)
        found = neighborhoods(source, place) if CLIENT == "grass" else walked(place) | whitebox(place)
        for layer, (value, most) in found.items():
            checks.that(f"{source}: {layer}", value <= most, f"{value:.7f}, at most {most}")
            if named:
                print(f"{source:32} {layer:40} {value:.7f}", flush=True)
    checks.end()
