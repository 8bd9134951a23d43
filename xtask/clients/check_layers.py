"""GRASS and gdaldem make the layers that follow from heights: the same within a hundredth.

Named files of heights on the command line are measured instead of the presets, and a table of what was found is printed.
"""

import heapq
import os
import shutil
import subprocess
import sys
import warnings

import numpy
import rasterio
from orogen import WORK, Checks, export

warnings.filterwarnings("ignore")
checks = Checks()
GRASS = WORK / "grass"
DAY, LATITUDE = 172, 46


def read(path):
    with rasterio.open(path) as raster:
        data = raster.read(1).astype("f8")
        return numpy.where(data == raster.nodata, numpy.nan, data) if raster.nodata is not None else data


def inner(data, border):
    """Without the border that each program makes up in its own way."""
    return data[border:-border, border:-border]


class Place:
    """A file of heights, what orogen makes of it and what GRASS does."""

    def __init__(self, heights):
        self.heights = heights
        self.z = read(heights)
        with rasterio.open(heights) as raster:
            self.cell = raster.transform.a
            self.transform = raster.transform
            self.options = []
            profile = raster.profile
        if profile["crs"] is None:
            # r.sun asks the map for the latitude.
            self.options = ["--latitude", LATITUDE]
            profile.update(crs=f"+proj=tmerc +lat_0={LATITUDE} +lon_0=0 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m")
            self.heights = WORK / "placed.tif"
            with rasterio.open(self.heights, "w", **profile) as raster:
                raster.write(self.z.astype("f4"), 1)

    def ours(self, layer, *options):
        return read(export(self.heights, f"ours-{layer}.tif", "--layer", layer, "--no-cache", "-q", *options))

    def grass(self, script, *rasters):
        """Runs a script over the map `z`; returns rasters of it."""
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


def off(ours, theirs):
    """The mean absolute difference as a share of the mean absolute deviation of theirs."""
    both = numpy.isfinite(ours) & numpy.isfinite(theirs)
    ours, theirs = ours[both], theirs[both]
    return numpy.abs(ours - theirs).mean() / numpy.abs(theirs - theirs.mean()).mean()


def unlike(ours, theirs, tolerance=0):
    """The share of samples that differ by more than this share of theirs."""
    both = numpy.isfinite(ours) & numpy.isfinite(theirs)
    ours, theirs = ours[both], theirs[both]
    return (numpy.abs(ours - theirs) > tolerance * numpy.abs(theirs)).mean()


STEPS = {1: (0, 1), 2: (1, 1), 4: (1, 0), 8: (1, -1), 16: (0, -1), 32: (-1, -1), 64: (-1, 0), 128: (-1, 1)}


def receivers(codes):
    """The cell that each drains to by its ESRI direction, and how many cells away that is; itself at the border."""
    rows, columns = codes.shape
    index = numpy.arange(rows * columns).reshape(rows, columns)
    to, length = index.copy(), numpy.zeros(codes.shape)
    for code, (down, right) in STEPS.items():
        y, x = numpy.nonzero(codes == code)
        inside = (y + down >= 0) & (y + down < rows) & (x + right >= 0) & (x + right < columns)
        y, x = y[inside], x[inside]
        to[y, x] = index[y + down, x + right]
        length[y, x] = numpy.hypot(down, right)
    return to.ravel(), length.ravel()


def accumulated(codes):
    """How many cells drain through each."""
    to, _ = receivers(codes)
    waiting = numpy.bincount(to[to != numpy.arange(to.size)], minlength=to.size).tolist()
    to, count = to.tolist(), [1] * to.size
    ready = [cell for cell, waits in enumerate(waiting) if waits == 0]
    while ready:
        cell = ready.pop()
        if to[cell] != cell:
            count[to[cell]] += count[cell]
            waiting[to[cell]] -= 1
            if waiting[to[cell]] == 0:
                ready.append(to[cell])
    return numpy.array(count).reshape(codes.shape)


def downstream(codes, streams, cell):
    """The stream cell that each first meets, and the way there in metres; -1 where it meets none."""
    to, length = receivers(codes)
    streams = streams.ravel()
    to[streams] = numpy.flatnonzero(streams)
    length[streams] = 0
    # Twice as far each time.
    while not (to[to] == to).all():
        length, to = length + length[to], to[to]
    return numpy.where(streams[to], to, -1).reshape(codes.shape), cell * length.reshape(codes.shape)


def flooded(z):
    """The heights with depressions filled: Priority-Flood from the border and the sea."""
    rows, columns = z.shape
    heights, level = z.tolist(), [[None] * columns for _ in range(rows)]
    border = [(y, x) for y in range(rows) for x in range(columns) if y in (0, rows - 1) or x in (0, columns - 1) or z[y, x] <= 0]
    queue = [(heights[y][x], y, x) for y, x in border]
    for height, y, x in queue:
        level[y][x] = height
    heapq.heapify(queue)
    while queue:
        height, y, x = heapq.heappop(queue)
        for down, right in STEPS.values():
            j, i = y + down, x + right
            if 0 <= j < rows and 0 <= i < columns and level[j][i] is None:
                level[j][i] = max(height, heights[j][i])
                heapq.heappush(queue, (level[j][i], j, i))
    return numpy.array(level)


def measure(name, place):
    """The differences of all layers, by name: each with the most that is allowed."""
    found = {}
    cell, z = place.cell, place.z
    search = max(3, round(500 / cell))
    disc = max(2, round(300 / cell))
    middle = [dimension // 2 for dimension in z.shape]
    observer = (place.transform * (middle[1] + 0.5, middle[0] + 0.5))
    tri, tpi = [WORK / f"gdal-{mode}.tif" for mode in ("TRI", "TPI")]
    subprocess.run(["gdaldem", "TRI", "-alg", "Riley", place.heights, tri], check=True, capture_output=True)
    found["tri (gdaldem)"] = off(inner(place.ours("tri"), 1), inner(read(tri), 1)), 0.001
    ours_area = place.ours("drainage-area")
    (WORK / "area.tif").unlink(missing_ok=True)
    shutil.copy(WORK / "ours-drainage-area.tif", WORK / "area.tif")
    suns = f"""
r.slope.aspect elevation=z slope=slope aspect=aspect -e --q
time r.sun elevation=z aspect=aspect slope=slope linke_value=3 albedo_value=0.2 day={DAY} step=0.25 glob_rad=sun nprocs={os.cpu_count()} --q
"""
    script = f"""
r.neighbors -c input=z output=mean size={2 * disc + 1} method=average --q
r.neighbors -c input=z output=spread size={2 * disc + 1} method=stddev --q
r.geomorphon elevation=z forms=forms search={search} flat=1 --q
r.in.gdal -o input={WORK}/area.tif output=area --q
r.slope.aspect elevation=z slope=tangent format=percent -e --q
r.mapcalc "wet = log(area / {cell} / max(tangent / 100, 0.001))" --q
r.mapcalc "streams = if(area >= 1000000, 1, null())" --q
r.grow.distance input=streams distance=far --q
r.viewshed -b input=z output=seen coordinates={observer[0]},{observer[1]} observer_elevation=10 --q
{suns}
"""
    mean, spread, forms, wet, far, seen, sun = place.grass(
        script, "mean", "spread", "forms", "wet", "far", "seen", "sun"
    )
    border = disc + 1
    found["tpi (r.neighbors)"] = off(inner(place.ours("tpi", "--disc", (disc + 0.01) * cell), border), inner(z - mean, border)), 0.01
    forms_ours = place.ours("landforms", "--reach", (search - 0.01) * cell)
    found["landforms (r.geomorphon)"] = unlike(inner(forms_ours, search), inner(forms, search)), 0.01
    found["wetness (r.slope.aspect)"] = off(inner(place.ours("wetness"), 1), inner(wet, 1)), 0.01
    # Orogen's world goes on for two samples beyond the file, and so do its streams.
    found["stream-distance (r.grow.distance)"] = off(inner(place.ours("stream-distance"), 40), inner(far, 40)), 0.01
    visible = place.ours("viewshed", "--observer", f"{middle[1] * cell},{middle[0] * cell}", "--observer-height", 10)
    elsewhere = place.ours("viewshed", "--observer", f"{middle[1] * cell / 2},{middle[0] * cell / 2}", "--observer-height", 10)
    either = (elsewhere == 1) | (seen == 1)
    checks.that(f"{name}: another observer is told apart", (elsewhere != seen)[either].mean() > 0.3)
    found["viewshed (r.viewshed)"] = unlike(visible, seen), 0.01
    light = 1000 * place.ours("insolation", "--day", DAY, *place.options)
    other = place.ours("insolation", "--day", DAY - 60, *place.options)
    told = numpy.nanmean(inner(numpy.abs(1000 * other - sun) / sun, 1))
    checks.that(f"{name}: another day is told apart", told > 0.05, told)
    found["insolation (r.sun)"] = numpy.nanmean(inner(numpy.abs(light - sun) / sun, 1)), 0.01

    codes = place.ours("flow-direction").astype("int64")
    cells = accumulated(codes)
    found["drainage-area (walked)"] = unlike(inner(ours_area, 2), inner(cells * cell * cell, 2), 0.01), 0.05
    streams = cells * cell * cell >= 1e6
    to, length = downstream(codes, streams, cell)
    meets = inner(to, 2) >= 0
    filled = flooded(z)
    above = filled - filled.ravel()[to]
    ours = place.ours("height-above-drainage")
    found["height-above-drainage (walked)"] = off(inner(ours, 2)[meets], inner(above, 2)[meets]), 0.01
    ours = place.ours("flow-distance")
    found["flow-distance (walked)"] = off(inner(ours, 2)[meets], inner(length, 2)[meets]), 0.01
    return found


if __name__ == "__main__":
    named = sys.argv[1:]
    sources = named or ["alpine", "canyon"]
    for source in sources:
        if named:
            path = WORK / "heights.tif"
            shutil.copy(source, path)
            path.chmod(0o644)
        else:
            # GRASS works in a coordinate system that it knows.
            map_options = ("--crs", "EPSG:32632", "--origin", "500000,5000000")
            path = export(source, "heights.tif", "--window", "200,300,320,300", *map_options, "-q")
        for layer, (value, most) in measure(source, Place(path)).items():
            checks.that(f"{source}: {layer}", value <= most, f"{value:.5f}, at most {most}")
            if named:
                print(f"{source.rsplit('/')[-1]:32} {layer:40} {value:.5f}", flush=True)
    checks.end()
