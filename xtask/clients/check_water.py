"""Checks water features with GDAL, SQLite and Shapely: equal in every format, valid areas without gaps, beds that never rise, joined reaches, and windows
of an unbounded world that continue each other."""

import json
import sqlite3
import subprocess

import numpy
import pyogrio
import rasterio
import rasterio.warp
import shapely
from orogen import BINARY, ROOT, WORK, Checks, export

checks = Checks()
LAYERS = ["rivers", "lakes", "watersheds", "summits", "coast", "contours"]
TYPES = {
    "rivers": "LineString Z",
    "lakes": "MultiPolygon",
    "watersheds": "MultiPolygon",
    "summits": "Point Z",
    "coast": "LineString",
    "contours": "LineString",
}


def read(path, layer=None):
    """Returns the columns of a layer, its geometries and its coordinate system."""
    meta, _, geometry, values = pyogrio.raw.read(path, layer=layer)
    return dict(zip(meta["fields"], values)), shapely.from_wkb(geometry), meta


def rivers_join(name, rivers, lines, lakes, areas, coasts):
    """Checks the invariants of every network."""
    ids = rivers["id"].astype(int)
    at = {number: k for k, number in enumerate(ids)}
    parts = [shapely.get_coordinates(line, include_z=True) for line in lines]
    heights = [part[:, 2] for part in parts]
    checks.that(f"{name}: beds never rise", all((numpy.diff(z) <= 0).all() for z in heights))
    checks.that(f"{name}: no reach crosses itself", lines.size == 0 or shapely.is_valid(lines).all())
    lake_at = {int(number): k for k, number in enumerate(lakes["id"])}
    shore = [shapely.boundary(area) for area in areas]
    coast = shapely.union_all(coasts)
    joined = falls = grows = shores = mouths = 0
    for k, part in enumerate(parts):
        down, mouth = rivers["downstream"][k], rivers["mouth"][k]
        follows = None if numpy.isnan(down) else at.get(int(down))
        if mouth == "reach":
            joined += follows is not None and (parts[follows][0] == part[-1]).all()
        elif mouth == "lake":
            k_lake = lake_at[int(rivers["mouth_lake"][k])]
            level = lakes["level"][k_lake]
            joined += shapely.distance(shore[k_lake], shapely.Point(part[-1])) < 1e-6 and abs(part[-1, 2] - level) < 1e-9
            joined += 0 if follows is None or rivers["source_lake"][follows] == rivers["mouth_lake"][k] else -1
            shores += 1
        elif mouth == "sea":
            joined += shapely.distance(coast, shapely.Point(part[-1])) < 1e-6
            shores += 1
        else:
            joined += mouth == "border"
        mouths += 1
        if rivers["source"][k] == "lake":
            k_lake = lake_at[int(rivers["source_lake"][k])]
            checks.that(f"{name}: reach {ids[k]} leaves its lake at the shore", shapely.distance(shore[k_lake], shapely.Point(part[0])) < 1e-6)
        if follows is not None:
            falls += part[-1, 2] < parts[follows][0, 2]
            # Unknown orders are NaN, which no comparison holds for.
            grows += rivers["drainage_area"][follows] < rivers["drainage_area"][k] or rivers["strahler"][follows] < rivers["strahler"][k]
    checks.equal(f"{name}: every reach ends in a reach, a lake, the sea or at the border, and shares that point", joined, mouths)
    checks.equal(f"{name}: nowhere is the next reach higher, or smaller", (falls, grows), (0, 0))
    checks.that(f"{name}: following the ids downstream ends", all(ends(k, rivers["downstream"], at) for k in range(len(parts))))
    return shores


def ends(k, downstream, at):
    """Checks that the path downstream of a reach ends."""
    for _ in range(len(downstream) + 1):
        if numpy.isnan(downstream[k]):
            return True
        k = at[int(downstream[k])]
    return False


def tiles(name, areas, frame, land):
    """Checks that areas cover the land and do not overlap."""
    checks.that(f"{name}: watersheds are valid", shapely.is_valid(areas).all(), shapely.is_valid_reason(areas[~shapely.is_valid(areas)])[:3])
    whole = shapely.union_all(areas)
    checks.near(f"{name}: watersheds do not overlap", shapely.area(areas).sum() / whole.area, 1.0, 1e-9)
    checks.near(f"{name}: watersheds cover the land", whole.area / land, 1.0, 0.01)
    parts = shapely.get_parts(whole)
    gaps = [ring for part in parts for ring in shapely.get_rings(part)[1:]]
    return whole, gaps


DEM = WORK / "place.tif"
export("rolling", DEM.name, "--window", "100,150,260,220")
# The same terrain with a position on a map.
with rasterio.open(DEM) as source:
    heights = source.read(1)
UTM = WORK / "utm.tif"
profile = {"driver": "GTiff", "dtype": "float32", "count": 1, "height": heights.shape[0], "width": heights.shape[1]}
with rasterio.open(UTM, "w", crs="EPSG:32633", transform=rasterio.transform.from_origin(400_000, 5_200_000, 30, 30), **profile) as out:
    out.write(heights, 1)
DEGREES = WORK / "degrees.tif"
step = 30 / 111_195
with rasterio.open(DEGREES, "w", crs="EPSG:4326", transform=rasterio.transform.from_origin(11, 1, step, step), **profile) as out:
    out.write(heights, 1)



def halves(name, x, y, side, cell):
    """Checks that the water of two neighboring windows of `endless` is that of both together."""
    layers = ["rivers", "lakes", "coast", "watersheds"]

    def water(part, window):
        path = export("endless", f"{name}_{part}.gpkg", "--window", ",".join(map(str, window)), "--cell", str(cell), "--layer", ",".join(layers))
        return {layer: read(path, layer) for layer in layers}

    west, east = water("west", (x, y, side, side)), water("east", (x + side, y, side, side))
    whole = water("whole", (x, y, 2 * side, side))
    # The border is halfway between the last column and the first.
    border = (x + side - 0.5) * cell
    ends, areas = {}, {}
    for part in (west, east):
        rivers, lines, _ = part["rivers"]
        for k, line in enumerate(lines):
            points = shapely.get_coordinates(line, include_z=True)
            for at, kind in ((points[0], "source"), (points[-1], "mouth")):
                if at[0] == border:
                    checks.equal(f"{name}: reach {rivers['id'][k]} knows the border", rivers[kind][k], "border")
                    ends.setdefault(tuple(at), []).append(kind)
                    areas.setdefault(tuple(at), []).append(rivers["drainage_area"][k])
    checks.that(f"{name}: every reach at the border goes on at the same point", ends and all(sorted(kinds) == ["mouth", "source"] for kinds in ends.values()), ends)
    kept = [dict(zip(ends[at], found)) for at, found in areas.items() if len(found) == 2]
    checks.that(f"{name}: rivers bring their areas across the border", all(found["source"] >= 0.95 * found["mouth"] for found in kept), kept)
    both = {layer: [part[layer][1] for part in (west, east)] for layer in layers}
    for layer in ("rivers", "coast"):
        lengths = [sum(shapely.length(part).sum() for part in both[layer]), shapely.length(whole[layer][1]).sum()]
        checks.near(f"{name}: {layer} of both windows have the length of the whole", lengths[0], lengths[1], 1e-9 * max(lengths[1], 1))
        parts = shapely.union_all([shapely.union_all(part) for part in both[layer]])
        apart = shapely.hausdorff_distance(parts, shapely.union_all(whole[layer][1])) if lengths[1] > 0 else 0
        checks.near(f"{name}: {layer} of both windows are those of the whole", apart, 0, 2e-6 * cell)
    for layer in ("lakes", "watersheds"):
        valid = all(shapely.is_valid(part).all() for part in both[layer])
        checks.that(f"{name}: {layer} cut at the border are valid", valid)
        sums = [sum(shapely.area(part).sum() for part in both[layer]), shapely.area(shapely.union_all([shapely.union_all(part) for part in both[layer]]))]
        checks.near(f"{name}: {layer} of both windows do not overlap", sums[0], sums[1], 1e-9 * max(sums[0], 1))
    lakes = [shapely.union_all([shapely.union_all(part) for part in both["lakes"]]), shapely.union_all(whole["lakes"][1])]
    checks.near(f"{name}: lakes have no gap at the border", shapely.area(shapely.symmetric_difference(*lakes)), 0, 1e-9 * max(lakes[1].area, 1))
    unknown = whole["rivers"][0]["strahler"].astype(float)
    checks.that(f"{name}: orders are known where a river rises in the window only", numpy.isnan(unknown).any() and (unknown == 1).any())
    for part, found in (("west", west), ("east", east), ("whole", whole)):
        rivers_continue(f"{name} {part}", *found["rivers"][:2])
    print(f"{name}: {len(ends)} crossings, {len(whole['rivers'][1])} reaches, {len(whole['lakes'][1])} lakes, {len(whole['coast'][1])} coasts")


def rivers_continue(name, rivers, lines):
    """Checks that reaches join, fall and end."""
    at = {int(number): k for k, number in enumerate(rivers["id"])}
    parts = [shapely.get_coordinates(line, include_z=True) for line in lines]
    checks.that(f"{name}: beds never rise", all((numpy.diff(part[:, 2]) <= 0).all() for part in parts))
    joined = [(parts[at[int(next)]][0] == parts[k][-1]).all() for k, next in enumerate(rivers["downstream"]) if not numpy.isnan(next)]
    checks.that(f"{name}: reaches join", joined and all(joined))
    checks.that(f"{name}: following the ids downstream ends", all(ends(k, rivers["downstream"], at) for k in range(len(parts))))


# Mountains, a coast, the land around a large lake and large rivers.
for case in [("mountains", 0, 0, 200, 60), ("coast", -200, -200, 200, 960), ("lake", -1536, -1432, 240, 240), ("rivers", -150, -150, 150, 7680)]:
    halves(*case)

# The last column is the minimum share of banks above their river.
CASES = [
    # Beside the middle of a short reach near its mouth lies the deeper valley that it joins.
    ("alpine", "alpine", ["--cell", "120"], None, 0.93),
    ("alpine_part", "alpine", ["--window", "150,210,300,260"], None, 0.9),
    ("island", "island", [], None, 0.95),
    ("archipelago", "archipelago", ["--seed", "9"], None, 0.9),
    ("fjords", "fjords", ["--seed", "3"], None, 0.9),
    ("utm", UTM, ["--river-area", "300000"], "EPSG:32633", 0.9),
    ("degrees", DEGREES, ["--river-area", "300000"], "EPSG:4326", 0.9),
]

for name, recipe, options, crs, banks in CASES:
    path = export(recipe, f"{name}.gpkg", "--layer", ",".join(LAYERS), *options)
    tiff = export(recipe, f"{name}_height.tif", *options[: 2 if "--river-area" not in options else 0])
    done = subprocess.run(["ogrinfo", "-al", "-so", path], capture_output=True, text=True)
    checks.that(f"{name}: ogrinfo opens it without a word", done.returncode == 0 and not done.stderr, done.stderr)
    base = sqlite3.connect(path)
    checks.equal(f"{name}: SQLite finds the file sound", base.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
    checks.equal(f"{name}: all keys are there", base.execute("PRAGMA foreign_key_check").fetchall(), [])
    for layer in LAYERS:
        found = base.execute(f"SELECT rtreecheck('rtree_{layer}_geom')").fetchone()
        checks.equal(f"{name}: the index of {layer} is sound", found, ("ok",))
        count = base.execute(f"SELECT count(*) FROM {layer}").fetchone()[0]
        checks.that(f"{name}: ogrinfo counts {layer}", f"Layer name: {layer}\n" in done.stdout and f"Feature Count: {count}\n" in done.stdout)
    base.close()
    data = {layer: read(path, layer) for layer in LAYERS}
    with rasterio.open(tiff) as source:
        box, cell, ground = source.bounds, source.res, source.read(1)
        raster_crs = source.crs
    slack = 1e-6 * cell[0]
    for layer, (_, geometries, meta) in data.items():
        checks.equal(f"{name}: type of {layer}", meta["geometry_type"], TYPES[layer])
        if crs:
            checks.that(f"{name}: {layer} lie on their map", meta["crs"] == crs and raster_crs.to_string() == crs, meta["crs"])
        if len(geometries):
            west, south, east, north = shapely.total_bounds(geometries)
            inside = west >= box.left - slack and east <= box.right + slack and south >= box.bottom - slack and north <= box.top + slack
            checks.that(f"{name}: {layer} lie where the GeoTIFF does", inside, f"({west, south, east, north} in {box})")
    rivers, lines, _ = data["rivers"]
    lakes, areas, _ = data["lakes"]
    checks.that(f"{name}: lakes are valid and closed", len(areas) == 0 or shapely.is_valid(areas).all(), shapely.is_valid_reason(areas))
    checks.that(f"{name}: lakes do not overlap", len(areas) == 0 or abs(shapely.area(areas).sum() / shapely.area(shapely.union_all(areas)) - 1) < 1e-9)
    if crs is None:
        checks.that(f"{name}: areas are those of the polygons", numpy.allclose(shapely.area(areas), lakes["area"], rtol=1e-9))
        checks.that(f"{name}: lengths are those of the lines", numpy.allclose(shapely.length(lines), rivers["length"], rtol=1e-9))
    shores = rivers_join(name, rivers, lines, lakes, areas, data["coast"][1])
    sea = (ground <= 0).sum() if len(data["coast"][1]) else 0
    land = (ground.size - sea) * cell[0] * cell[1]
    whole, gaps = tiles(name, data["watersheds"][1], box, land)
    if len(data["coast"][1]) == 0:
        checks.equal(f"{name}: watersheds fill the GeoTIFF's extent without a gap", (whole.geom_type, len(gaps), whole.bounds == tuple(shapely.box(*box).bounds)), ("Polygon", 0, True)) if crs is None else checks.equal(f"{name}: no gap", len(gaps), 0)
    # Summits are samples of the GeoTIFF, the highest of their neighborhood.
    summits, points, _ = data["summits"]
    for point, height in zip(points, summits["height"]):
        i, j = int((point.x - box.left) / cell[0]), int((box.top - point.y) / cell[1])
        beside = ground[max(j - 1, 0) : j + 2, max(i - 1, 0) : i + 2]
        checks.that(f"{name}: a summit stands at its height", ground[j, i] == height == beside.max() and point.z == height)
    # Lines are in valleys: the middle of most reaches is lower than the ground 3 cells to each side.
    lower = sides = 0
    for line in lines:
        part = shapely.get_coordinates(line)
        for k in range(4, len(part) - 4, 4):
            along = part[k + 1] - part[k - 1]
            normal = numpy.array([-along[1], along[0]]) / max(numpy.hypot(*along), 1e-12)
            at = [part[k] + side * 3 * cell[0] * normal for side in (0, -1, 1)]
            i = [int((x - box.left) / cell[0]) for x, _ in at]
            j = [int((box.top - y) / cell[1]) for _, y in at]
            if min(i) < 0 or min(j) < 0 or max(i) >= ground.shape[1] or max(j) >= ground.shape[0]:
                continue
            here, left, right = (ground[b, a] for a, b in zip(i, j))
            sides += 2
            lower += int(here <= left) + int(here <= right)
    checks.that(f"{name}: rivers lie in valleys", sides > 0 and lower / sides > banks, f"({lower} of {sides})")
    print(f"{name}: {', '.join(f'{len(data[layer][1])} {layer}' for layer in LAYERS)}; {shores} mouths at shores, {lower / max(sides, 1):.3f} of banks higher")

# All formats contain the same features.
for layer in LAYERS:
    columns, geometries, _ = read(WORK / "fjords.gpkg", layer)
    for ending in ["geojson", "fgb"]:
        path = export("fjords", f"fjords_{layer}.{ending}", "--layer", layer, "--seed", "3")
        others, shapes, meta = read(path)
        order = numpy.argsort(others["id"]) if "id" in others else None
        if order is None:
            key = lambda found: sorted(shapely.to_wkb(shapely.normalize(shapely.set_precision(found, 0.02))))
            checks.equal(f"{layer}.{ending}: as many", len(shapes), len(geometries))
            continue
        near = [shapely.equals_exact(a, b, 0.02) for a, b in zip(geometries, shapes[order])]
        checks.that(f"{layer}.{ending}: the same geometries", len(shapes) == len(geometries) and all(near))
        same = all(
            (a is None and b is None) or a == b or (isinstance(a, float) and (numpy.isnan(a) and numpy.isnan(b) or abs(a - b) < 1e-9 * abs(a)))
            for field in columns
            for a, b in zip(columns[field], others[field][order])
        )
        checks.that(f"{layer}.{ending}: the same attributes", list(columns) == [field for field in others] and same)
    # The spatial indexes return the same features as a full scan.
    box = tuple(shapely.total_bounds(geometries[: max(1, len(geometries) // 3)]))
    expect = int(shapely.intersects(shapely.box(*box), geometries).sum())
    for path in [WORK / "fjords.gpkg", WORK / f"fjords_{layer}.fgb"]:
        found = pyogrio.raw.read(path, layer=layer, bbox=box)[2]
        checks.that(f"{layer}: {path.suffix} finds what lies in a box", len(found) >= expect > 0, f"({len(found)}, {expect})")

# A coordinate system without an EPSG code is the same in every format: a point has the same longitude and latitude.
CUSTOM = rasterio.CRS.from_proj4("+proj=laea +lat_0=47.25 +lon_0=11.5 +x_0=1000 +y_0=2000 +datum=WGS84")
place = WORK / "custom.tif"
with rasterio.open(place, "w", crs=CUSTOM, transform=rasterio.transform.from_origin(4000, 9000, 30, 30), **profile) as out:
    out.write(heights, 1)
expect = rasterio.warp.transform(CUSTOM, "EPSG:4326", [4000], [9000])
for ending in ["gpkg", "fgb", "geojson", "tif"]:
    path = export(place, f"custom_out.{ending}", *(["--layer", "summits"] if ending != "tif" else []))
    crs = rasterio.open(path).crs if ending == "tif" else rasterio.CRS.from_user_input(read(path)[2]["crs"])
    found = rasterio.warp.transform(crs, "EPSG:4326", [4000], [9000])
    checks.near(f"a system without a code in .{ending}", max(abs(a[0] - b[0]) for a, b in zip(found, expect)), 0.0, 1e-9)

# Layers of a GeoPackage that GDAL wrote, with curves of many points, holes and islands, as drawings of a recipe.
turn = numpy.linspace(0, 60, 5000)
spiral = shapely.LineString(numpy.column_stack([900 + 14 * turn * numpy.cos(turn), -900 + 14 * turn * numpy.sin(turn), turn]))
ring = shapely.Point(900, -900).buffer(700, quad_segs=64)
shore = shapely.unary_union([ring - shapely.Point(1000, -800).buffer(300), shapely.Point(1000, -800).buffer(120)])
for layer, geometry, kind in [("roads", spiral, "LineString Z"), ("coast", shapely.multipolygons([*shore.geoms]), "MultiPolygon"), ("spare", ring.boundary, "LineString")]:
    shapes = numpy.array([shapely.to_wkb(geometry, flavor="iso")])
    pyogrio.raw.write(WORK / "drawn.gpkg", shapes, [numpy.array([7])], ["n"], layer=layer, driver="GPKG", geometry_type=kind, crs="EPSG:32632", append=layer != "roads")
recipe = WORK / "drawn.toml"
recipe.write_text(
    """orogen = 1
[world]
size = [1800, 1800]
cell = 20
[nodes.roads]
op = "path"
file = "drawn.gpkg|layername=roads"
[nodes.coast]
op = "polygon"
file = "drawn.gpkg"
[outputs]
height = "roads.distance"
to_shore = "coast.distance"
"""
)
for layer, expect in [("height", lambda points: shapely.distance(spiral, points)), ("to_shore", lambda points: shapely.distance(shore.boundary, points))]:
    with rasterio.open(export(recipe, f"drawn_{layer}.tif", "--layer", layer)) as raster:
        rows, columns = numpy.indices(raster.shape)
        points = shapely.points(numpy.column_stack(rasterio.transform.xy(raster.transform, rows.ravel(), columns.ravel())))
        found = numpy.abs(raster.read(1).ravel())
    checks.near(f"drawn.gpkg: distances in {layer}", float(numpy.abs(found - expect(points)).max()), 0.0, 2e-3)
recipe.write_text(recipe.read_text().replace("|layername=roads", ""))
several = subprocess.run([BINARY, "export", recipe, "-o", "none.tif"], cwd=WORK, capture_output=True)
checks.that("drawn.gpkg: a layer must be chosen", several.returncode == 1 and b"`roads`, `spare`" in several.stderr, several.stderr)

# A truncated file must be rejected, and a rising river must be detected.
whole = (WORK / "fjords.gpkg").read_bytes()
damaged = WORK / "damaged.gpkg"
damaged.write_bytes(whole[: len(whole) // 2])
checks.that("half a GeoPackage is refused", subprocess.run(["ogrinfo", "-al", "-so", damaged], capture_output=True).returncode != 0)
flat = json.loads((WORK / "fjords_rivers.geojson").read_text())
checks.that("GeoJSON lines have heights", all(len(point) == 3 for point in flat["features"][0]["geometry"]["coordinates"]))

checks.end()
