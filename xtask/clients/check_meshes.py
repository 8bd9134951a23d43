"""Checks meshes with the Khronos validator, trimesh, meshio and admesh: the samples of the .npy, correct orientation, closed solids."""

import json
import re
import subprocess
import sys

import meshio
import numpy
import trimesh
from orogen import NODE_BIN, ROOT, WORK, Checks, export

checks = Checks()
BUMP = ROOT / "xtask/clients/bump.toml"
CELL = 10.0
ALPINE = ("--window", "200,300,180,140")
ADAPTIVE = ("--max-error", "4")


def validate(*paths):
    """Returns the validator's report of each .glb file."""
    line = ["node", ROOT / "xtask/clients/validate_glb.js", NODE_BIN.parent, *paths]
    done = subprocess.run(line, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"the validator ended with {done.returncode}:\n{done.stderr}")
    return json.loads(done.stdout)


def admesh(path):
    """Returns the number of repairs that admesh reports in its table."""
    # admesh prints the 80 bytes of the header without an end, so bytes of its memory may follow them.
    done = subprocess.run(["admesh", path], capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        return {"refused": done.returncode}
    counts = {}
    for name in ("Degenerate facets", "Edges fixed", "Facets removed", "Facets added", "Facets reversed",
                 "Backwards edges", "Normals fixed"):
        found = re.search(rf"{name}\s*:\s*(\d+)", done.stdout)
        counts[name] = int(found[1]) if found else None
    parts = re.search(r"Number of parts\s*:\s*(\d+)", done.stdout)
    counts["parts"] = int(parts[1]) if parts else None
    disconnected = re.search(r"Total disconnected facets\s*:\s*(\d+)\s+(\d+)", done.stdout)
    counts["disconnected"] = int(disconnected[1]) if disconnected else None
    return counts


def load(path):
    """Returns the only mesh of a file and its translation, as read by trimesh without merging vertices."""
    scene = trimesh.load_scene(path, process=False)
    checks.equal(f"{path.name}: one mesh is shown", len(scene.graph.nodes_geometry), 1)
    transform, name = scene.graph[scene.graph.nodes_geometry[0]]
    return scene.geometry[name], transform


def ground(places, kind):
    """Converts positions in the axes of a format to east, up, south."""
    x, y, z = places.T
    return numpy.stack([x, z, -y] if kind == "z up" else [x, y, z], axis=1)


def height_at(heights, east, south):
    """Returns the lower and the higher bound of the ground within cells, for both ways to split a square into triangles."""
    i = numpy.clip(numpy.floor(east).astype(int), 0, heights.shape[1] - 2)
    j = numpy.clip(numpy.floor(south).astype(int), 0, heights.shape[0] - 2)
    u, v = east - i, south - j
    nw, ne, sw, se = (heights[j + down, i + right].astype("f8") for down in (0, 1) for right in (0, 1))
    falling = numpy.where(u > v, nw + (ne - nw) * u + (se - ne) * v, nw + (se - sw) * u + (sw - nw) * v)
    rising = numpy.where(u + v < 1, nw + (ne - nw) * u + (sw - nw) * v, se + (sw - se) * (1 - u) + (ne - se) * (1 - v))
    return numpy.minimum(falling, rising), numpy.maximum(falling, rising)


def check_objects(path, table, heights, cell):
    """Checks that instances are the objects of a table, stand on the ground, and keep the distances of scatter.toml."""
    data = path.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    document, binary = json.loads(data[20:20 + length]), data[28 + length:]
    rows = [line.split(",") for line in table.read_text().splitlines()[1:]]
    for node in document["nodes"][1:]:
        kind = node["name"]
        attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]

        def read(name, parts):
            accessor = document["accessors"][attributes[name]]
            view = document["bufferViews"][accessor["bufferView"]]
            numbers = numpy.frombuffer(binary, "<f4", accessor["count"] * parts, view["byteOffset"])
            return numbers.reshape(-1, parts).astype("f8")

        place, turn, size = read("TRANSLATION", 3), read("ROTATION", 4), read("SCALE", 3)
        wanted = numpy.array([[float(row[k]) for k in (0, 1, 2, 4, 5)] for row in rows if row[3] == kind])
        # The mesh ends at the last samples, the table one cell further.
        ends = [(samples - 1) * cell for samples in heights.shape[::-1]]
        wanted = wanted[(wanted[:, 0] < ends[0]) & (-wanted[:, 1] < ends[1])]
        checks.equal(f"{path.name}: number of {kind}", len(place), len(wanted))
        found = numpy.stack([place[:, 0], -place[:, 2], place[:, 1], size[:, 0]], axis=1)
        off = float(numpy.abs(found - wanted[:, :4]).max())
        checks.that(f"{path.name}: each {kind} is that of the table", off < 2e-3, f"(off by {off})")
        angle = numpy.degrees(-2 * numpy.arctan2(turn[:, 1], turn[:, 3]))
        off = float(numpy.abs((angle - wanted[:, 4] + 180) % 360 - 180).max())
        checks.that(f"{path.name}: turns of {kind}", off < 0.01, f"(off by {off})")
        low, high = height_at(heights, place[:, 0] / cell, place[:, 2] / cell)
        off = float(numpy.maximum(low - place[:, 1], place[:, 1] - high).max())
        checks.that(f"{path.name}: each {kind} is on the ground", off < 1e-3, f"(off by {off})")
        apart = numpy.hypot(*(place[:, None, k] - place[None, :, k] for k in (0, 2)))
        numpy.fill_diagonal(apart, numpy.inf)
        spacing = {"house": 90.0, "tree": 9.0}[kind]
        checks.that(f"{path.name}: the spacing of {kind}", apart.min() >= spacing - 1e-3, f"({apart.min()})")


def check_water(path, cell, expected, whole):
    """Checks that rivers are on the ground, lakes and the sea are level and above their bed, and all faces point up."""
    name = path.name
    scene = trimesh.load_scene(path, process=False)
    parts = {node: scene.geometry[scene.graph[node][1]] for node in scene.graph.nodes_geometry}
    checks.equal(f"{name}: its nodes", set(parts), {"terrain", *expected})
    terrain = parts["terrain"].vertices
    columns = int(numpy.rint(terrain[:, 0].max() / cell)) + 1
    heights = terrain[:, 1].reshape(-1, columns)
    for part in expected:
        mesh = parts[part]
        places, faces = mesh.vertices, mesh.faces
        a, b, c = (places[faces[:, k]] for k in range(3))
        normal = numpy.cross(b - a, c - a)
        checks.that(f"{name}: triangles of {part} face up", bool((normal[:, 1] > 0).all()), f"({(normal[:, 1] <= 0).sum()} do not)")
        used = numpy.unique(faces)
        length = numpy.linalg.norm(mesh.vertex_normals, axis=1)
        checks.that(f"{name}: normals of {part}", bool(numpy.abs(length - 1).max() < 1e-3 and (mesh.vertex_normals[used, 1] > 0).all()))
        checks.equal(f"{name}: {part} are translucent", mesh.visual.material.alphaMode, "BLEND")
        middle = places[faces].mean(axis=1)
        low, high = height_at(heights, middle[:, 0] / cell, middle[:, 2] / cell)
        if part == "rivers":
            low, high = height_at(heights, places[:, 0] / cell, places[:, 2] / cell)
            checks.that(f"{name}: corners of rivers lie on the ground", bool((places[:, 1] >= high - 1e-3).all()), f"({(places[:, 1] - high).min()})")
            under = (middle[:, 1] < height_at(heights, middle[:, 0] / cell, middle[:, 2] / cell)[0]).mean()
            checks.that(f"{name}: and between them", under < 1e-3, f"({under:.2%} are below)")
            left, right = places[0::3], places[2::3]
            width = numpy.hypot(*(left - right)[:, [0, 2]].T)
            checks.that(f"{name}: rivers are narrow streams to broad rivers", 0.1 < numpy.median(width) < 50, f"({numpy.median(width)} m)")
        else:
            checks.that(f"{name}: {part} are level", bool((numpy.ptp(places[faces][:, :, 1], axis=1) == 0).all()))
            lit = (places[faces][:, :, 1].max(axis=1) > low).mean()
            checks.that(f"{name}: {part} cover lower ground", lit > (0.9 if part == "sea" else 0.5), f"({lit:.2%})")
    if whole is not None:
        # All squares with every corner below the sea are covered, and none without such a corner.
        mesh = parts["sea"]
        covered = numpy.zeros((heights.shape[0] - 1, heights.shape[1] - 1), bool)
        box = numpy.rint(mesh.vertices.reshape(-1, 4, 3)[:, :, [0, 2]] / cell).astype(int)
        for (west, north), (east, south) in zip(box.min(axis=1), box.max(axis=1)):
            covered[north:south, west:east] = True
        wet = heights <= whole
        corners = wet[:-1, :-1].astype(int) + wet[1:, :-1] + wet[:-1, 1:] + wet[1:, 1:]
        checks.that(f"{name}: the sea covers the squares that it touches, and no others", bool((covered == (corners > 0)).all()))


def check_places(name, places, heights, cell=CELL):
    """Checks that every vertex is a sample of the grid with the same height bit for bit; returns the samples that are used."""
    column = numpy.rint(places[:, 0] / cell).astype(int)
    row = numpy.rint(places[:, 2] / cell).astype(int)
    off = max(numpy.abs(places[:, 0] - column * cell).max(), numpy.abs(places[:, 2] - row * cell).max())
    checks.that(f"{name}: places are on the lattice", off < 1e-4 * cell, f"(off by {off})")
    inside = (column >= 0) & (row >= 0) & (column < heights.shape[1]) & (row < heights.shape[0])
    checks.that(f"{name}: all of them within it", bool(inside.all()))
    if inside.all():
        same = places[:, 1].astype("f4").view("u4") == heights[row, column].view("u4")
        checks.that(f"{name}: heights are equal to the last bit", bool(same.all()), f"({(~same).sum()} are not)")
    return column, row


def check_faces(name, places, faces, heights, cell=CELL):
    """Checks that triangles are counter-clockwise from above and cover the ground exactly once."""
    a, b, c = (places[faces[:, k]].astype("f8") for k in range(3))
    normal = numpy.cross(b - a, c - a)
    checks.that(f"{name}: all triangles face up", bool((normal[:, 1] > 0).all()))
    area = (heights.shape[0] - 1) * (heights.shape[1] - 1) * cell * cell
    checks.near(f"{name}: the ground they cover", float(normal[:, 1].sum()) / 2, area, 1e-5 * area)


def check_normals(name, normals, places, heights, cell):
    """Checks that normals are within a few degrees of the central differences of the samples."""
    south, east = numpy.gradient(heights.astype("f8"), cell)
    column, row = numpy.rint(places[:, 0] / cell).astype(int), numpy.rint(places[:, 2] / cell).astype(int)
    inner = (column > 0) & (row > 0) & (column < heights.shape[1] - 1) & (row < heights.shape[0] - 1)
    expected = numpy.stack([-east[row, column], numpy.ones(len(row)), -south[row, column]], axis=1)
    expected /= numpy.linalg.norm(expected, axis=1)[:, None]
    degrees = numpy.degrees(numpy.arccos(numpy.clip((expected * normals).sum(axis=1), -1, 1)))[inner]
    checks.that(f"{name}: normals lean as the land does", bool(numpy.median(degrees) < 3), f"({numpy.median(degrees)})")


heights = numpy.load(export(BUMP, "bump.npy"))
high = numpy.unravel_index(heights.argmax(), heights.shape)
checks.that("the bump is in the north-east", high[0] < 24 and high[1] > 32, f"(row and column {high})")
full = 2 * (heights.shape[0] - 1) * (heights.shape[1] - 1)

# The same terrain in the formats with absolute positions.
for kind, options in (("full", ()), ("adaptive", ADAPTIVE)):
    for extension, axes in (("glb", "y up"), ("obj", "y up"), ("ply", "z up")):
        path = export(BUMP, f"bump-{kind}.{extension}", *options)
        mesh, transform = load(path)
        checks.that(f"{path.name}: stands at the origin", bool((transform == numpy.eye(4)).all()))
        places = ground(mesh.vertices, axes)
        column, row = check_places(path.name, places, heights)
        check_faces(path.name, places, mesh.faces, heights)
        check_normals(path.name, ground(mesh.vertex_normals, axes), places, heights, CELL)
        count = len(mesh.faces)
        checks.that(f"{path.name}: triangles", count == full if kind == "full" else 2 < count < full / 3, f"({count})")
        top = places[places[:, 1].argmax()]
        checks.that(f"{path.name}: the bump is in the north-east", bool(top[0] > 320 and top[2] < 240), f"({top})")
        if extension != "glb":
            other = meshio.read(path)
            same = numpy.array_equal(other.points.astype("f4"), mesh.vertices.astype("f4"))
            checks.that(f"{path.name}: meshio reads the places that trimesh reads", same)
            checks.that(f"{path.name}: and the triangles", numpy.array_equal(other.cells_dict["triangle"], mesh.faces))
        if kind == "adaptive":
            # The surface at every sample, from the triangle that contains it.
            flat = numpy.stack([places[:, 0], places[:, 2]], axis=1)
            worst = 0.0
            for corners in mesh.faces:
                (x0, y0), (x1, y1), (x2, y2) = (flat[corners] / CELL).round().astype(int)
                xs = numpy.arange(min(x0, x1, x2), max(x0, x1, x2) + 1)[None, :]
                ys = numpy.arange(min(y0, y1, y2), max(y0, y1, y2) + 1)[:, None]
                area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
                v = ((xs - x0) * (y2 - y0) - (ys - y0) * (x2 - x0)) / area
                w = ((x1 - x0) * (ys - y0) - (y1 - y0) * (xs - x0)) / area
                up = places[corners, 1].astype("f8")
                surface = up[0] + v * (up[1] - up[0]) + w * (up[2] - up[0])
                within = (v >= 0) & (w >= 0) & (v + w <= 1)
                off = numpy.abs(surface - heights[ys, xs])[within]
                worst = max(worst, float(off.max()))
            checks.that(f"{path.name}: no sample is further than 4 m", worst <= 4 + 1e-6, f"({worst})")

# With a texture, the color at a vertex is that of its pixel.
picture = trimesh.load_scene(WORK / "bump-full.glb", process=False).geometry.values()
material = next(iter(picture)).visual.material
checks.equal("bump-full.glb: its picture has a pixel for each sample",
             material.baseColorTexture.size, (heights.shape[1], heights.shape[0]))
pixels = numpy.asarray(material.baseColorTexture)
mesh, _ = load(WORK / "bump-adaptive.ply")
column, row = (numpy.rint(numpy.abs(mesh.vertices[:, k]) / CELL).astype(int) for k in (0, 1))
same = (mesh.visual.vertex_colors[:, :3] == pixels[row, column, :3]).all(axis=1)
checks.that("bump-adaptive.ply: corners have the colors of that picture's pixels", bool(same.all()), f"({(~same).sum()} have not)")
mesh, _ = load(WORK / "bump-adaptive.obj")
place = numpy.stack([mesh.visual.uv[:, 0] * pixels.shape[1], (1 - mesh.visual.uv[:, 1]) * pixels.shape[0]], axis=1) - 0.5
off = float(numpy.abs(place - mesh.vertices[:, [0, 2]] / CELL).max())
checks.that("bump-adaptive.obj: texture coordinates are the middles of pixels", off < 1e-3, f"(off by {off})")

# Every kind of .glb passes the validator without errors and warnings.
kinds = {
    "texture": (), "vertex": ("--color", "vertex"), "none": ("--color", "none"), "lods": ("--lods", "4"),
    "adaptive-lods": ("--lods", "3", *ADAPTIVE), "surfaces": ("--surfaces", "--lods", "3"), "exaggerated": ("--exaggeration", "2.5", "--height-curve", "0:0,0.5:0.2,1:1"),
}
paths = [export("alpine", f"alpine-{kind}.glb", *ALPINE, *options) for kind, options in kinds.items()]
paths += [export(BUMP, "bump-normals.glb", "--surfaces", *ADAPTIVE), WORK / "bump-full.glb", WORK / "bump-adaptive.glb", export("alpine", "alpine-large.glb", "--window", "0,0,300,300")]
for report in validate(*paths):
    name = report["file"].rsplit("/")[-1]
    checks.equal(f"{name}: errors and warnings", (report["numErrors"], report["numWarnings"]), (0, 0))
    if report["numErrors"] or report["numWarnings"]:
        print(json.dumps(report["messages"], indent=1))
# Rivers, lakes and the sea are on the ground.
wet = {
    "alpine": (120.0, ["rivers", "lakes"], None, ("--size", "512")),
    "fjords": (60.0, ["rivers", "lakes", "sea"], 0.0, ()),
}
for recipe, (cell, expected, sea, options) in wet.items():
    check_water(export(recipe, f"{recipe}-water.glb", "--water", *options), cell, expected, sea)
watery = [WORK / f"{recipe}-water.glb" for recipe in wet]
bends = ("--exaggeration", "2.5", "--height-curve", "0:0,0.5:0.2,1:1")
watery += [export("alpine", f"alpine-water-{kind}.glb", "--water", *ALPINE, *options) for kind, options in
           {"adaptive": ADAPTIVE, "lods": ("--lods", "3"), "exaggerated": bends, "vertex": ("--color", "vertex")}.items()]
for report in validate(*watery):
    name = report["file"].rsplit("/")[-1]
    checks.equal(f"{name}: errors and warnings", (report["numErrors"], report["numWarnings"]), (0, 0))
    if report["numErrors"] or report["numWarnings"]:
        print(json.dumps(report["messages"], indent=1))
# Objects are instances on the ground.
SCATTER = ROOT / "xtask/clients/scatter.toml"
table, ground_of = export(SCATTER, "objects.csv", "--layer", "scatter"), export(SCATTER, "objects.npy")
objects = [export(SCATTER, "objects.glb", "--objects"), export(SCATTER, "objects-adaptive.glb", "--objects", "--water", *ADAPTIVE)]
check_objects(objects[0], table, numpy.load(ground_of), 10.0)
for report in validate(*objects):
    name = report["file"].rsplit("/")[-1]
    checks.equal(f"{name}: errors and warnings", (report["numErrors"], report["numWarnings"]), (0, 0))
    if report["numErrors"] or report["numWarnings"]:
        print(json.dumps(report["messages"], indent=1))
place = load(WORK / "alpine-vertex.glb")[1][:3, 3]
checks.equal("alpine: the node stands where the window begins", [float(x) for x in place], [200 * 60.0, 0.0, 300 * 60.0])

# The normal map of an adaptive mesh, read as a viewer does, gives the normals of the full grid.
few, all_of_it = (load(WORK / f"bump-{kind}.glb")[0] for kind in ("normals", "full"))
texels = numpy.asarray(few.visual.material.normalTexture).astype("f8") / 127.5 - 1.0
checks.equal("bump-normals.glb: its normal map has a pixel for each sample", texels.shape, (*heights.shape, 3))
corner_normals = few.vertex_normals.astype("f8")
true_normals = numpy.zeros((*heights.shape, 3))
at = numpy.rint(all_of_it.vertices[:, [2, 0]] / CELL).astype(int)
true_normals[at[:, 0], at[:, 1]] = all_of_it.vertex_normals


def unit(vectors):
    return vectors / numpy.linalg.norm(vectors, axis=-1, keepdims=True)


tangents = unit(numpy.stack([corner_normals[:, 1], -corner_normals[:, 0], 0 * corner_normals[:, 0]], axis=1))
worst = plain = 1.0
for corners in few.faces:
    (x0, y0), (x1, y1), (x2, y2) = numpy.rint(few.vertices[corners][:, [0, 2]] / CELL).astype(int)
    xs, ys = (axis.ravel() for axis in numpy.meshgrid(numpy.arange(min(x0, x1, x2), max(x0, x1, x2) + 1),
                                                      numpy.arange(min(y0, y1, y2), max(y0, y1, y2) + 1)))
    area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
    v = ((xs - x0) * (y2 - y0) - (ys - y0) * (x2 - x0)) / area
    w = ((x1 - x0) * (ys - y0) - (y1 - y0) * (xs - x0)) / area
    within = (v >= 0) & (w >= 0) & (v + w <= 1)
    xs, ys, shares = xs[within], ys[within], numpy.stack([1 - v - w, v, w], axis=1)[within]
    n, t = corner_normals[corners], tangents[corners]
    frame = [unit(shares @ axis) for axis in (t, numpy.cross(n, t), n)]
    shown = unit(sum(texels[ys, xs, k, None] * frame[k] for k in range(3)))
    worst = min(worst, float((shown * true_normals[ys, xs]).sum(axis=1).min()))
    plain = min(plain, float((frame[2] * true_normals[ys, xs]).sum(axis=1).min()))
checks.that("bump-normals.glb: normals as a viewer makes them are those of all samples", worst > 0.9995, f"(cosine {worst})")
checks.that("bump-normals.glb: without its normal map they are not", plain < 0.999, f"(cosine {plain})")

# The validator must reject an index out of range and a truncated file.
whole = (WORK / "bump-full.glb").read_bytes()
json_length = int.from_bytes(whole[12:16], "little")
document = json.loads(whole[20:20 + json_length])
view = document["bufferViews"][1]
at = 28 + json_length + view["byteOffset"]
(WORK / "broken-index.glb").write_bytes(whole[:at] + b"\xfe\xff" + whole[at + 2:])
(WORK / "broken-short.glb").write_bytes(whole[:-100])
for report in validate(WORK / "broken-index.glb", WORK / "broken-short.glb"):
    checks.that(f"{report['file']}: the validator finds the damage", report["numErrors"] > 0)
bent = heights.copy()
bent[3, 5] += 1
mesh, _ = load(WORK / "bump-full.glb")
column, row = (numpy.rint(mesh.vertices[:, k] / CELL).astype(int) for k in (0, 2))
different = mesh.vertices[:, 1].astype("f4").view("u4") != bent[row, column].view("u4")
checks.equal("a height that differs is noticed", int(different.sum()), 1)

# Solids are closed, face outwards, and need no repair.
nothing = {"Degenerate facets": 0, "Edges fixed": 0, "Facets removed": 0, "Facets added": 0, "Facets reversed": 0,
           "Backwards edges": 0, "Normals fixed": 0, "parts": 1, "disconnected": 0}
for kind, options in (("full.stl", ()), ("adaptive.stl", ADAPTIVE), ("full.3mf", ()), ("adaptive.3mf", ADAPTIVE)):
    path = export(BUMP, f"bump-{kind}", "--print-size", "120", "--base", "2", *options)
    solid = trimesh.load_mesh(path)
    checks.that(f"{path.name}: watertight", bool(solid.is_watertight))
    checks.that(f"{path.name}: wound the same way", bool(solid.is_winding_consistent))
    scale = 120 / (CELL * (heights.shape[1] - 1))
    sides = [120.0, CELL * (heights.shape[0] - 1) * scale, 2 + float(numpy.ptp(heights)) * scale]
    # In an adaptive mesh both the highest and the lowest sample may be off by the allowed error.
    off = numpy.abs(solid.bounds - [[0, 0, 0], sides])
    most = [1e-3, 1e-3, 1e-3 if not options else 8 * scale]
    checks.that(f"{path.name}: its size", bool((off <= most).all()), f"({solid.bounds})")
    mean = float(heights.astype("f8").mean() - heights.min())
    checks.near(f"{path.name}: its volume", float(solid.volume), sides[0] * sides[1] * (2 + mean * scale), 0.03 * solid.volume)
    top = solid.vertices[solid.vertices[:, 2].argmax()]
    checks.that(f"{path.name}: the bump is in the north-east", bool(top[0] > 60 and top[1] > sides[1] / 2), f"({top})")
    if path.suffix == ".3mf":
        checks.equal(f"{path.name}: its unit", solid.units, "millimeter")
        stl = trimesh.load_mesh(path.with_suffix(".stl"))
        checks.near(f"{path.name}: the volume of the .stl", float(solid.volume), float(stl.volume), 1e-6 * float(stl.volume))
        continue
    checks.equal(f"{path.name}: what admesh would mend", admesh(path), nothing)
    checks.equal(f"{path.name}: meshio reads as many triangles", len(meshio.read(path).cells_dict["triangle"]), len(solid.faces))
middle = f"{(heights.min() + heights.max()) / 2:.2f}"
for kind, base, options in (("cut", "2", ("--cut", middle)), ("hollow", "2", ("--hollow", "1.2")), ("text", "8", ("--text", "Bump & 8")),
                            ("all", "8", ("--hollow", "1.2", "--text", "öß%", *ADAPTIVE)),
                            ("shells", "2", ("--cut", middle, "--hollow", "0.8")),
                            ("engraved", "8", ("--text", "Bump & 8", "--text-style", "engraved")),
                            ("plate", "8", ("--hollow", "1.2", "--text", "öß%", "--text-style", "engraved", *ADAPTIVE))):
    path, other = (export(BUMP, f"bump-{kind}.{suffix}", "--print-size", "120", "--base", base, *options) for suffix in ("stl", "3mf"))
    solid, same = trimesh.load_mesh(path), trimesh.load_mesh(other)
    checks.that(f"{path.name}: watertight, as {other.name}", bool(solid.is_watertight and same.is_watertight))
    checks.that(f"{path.name}: wound the same way", bool(solid.is_winding_consistent and same.is_winding_consistent))
    checks.near(f"{other.name}: the volume of {path.name}", float(same.volume), float(solid.volume), 1e-3 * float(solid.volume))
    found = admesh(path)
    bodies = trimesh.graph.connected_components(solid.face_adjacency, nodes=numpy.arange(len(solid.faces)), engine="networkx")
    checks.equal(f"{path.name}: its parts", found.pop("parts"), len(bodies))
    checks.equal(f"{path.name}: what admesh would mend", found, {name: count for name, count in nothing.items() if name != "parts"})
    if base == "2":
        share = solid.volume / trimesh.load_mesh(WORK / "bump-full.stl").volume
        checks.that(f"{path.name}: less volume than the full solid", 0.01 < share < 0.9, f"({share})")
path = WORK / "bump-adaptive.stl"
data = bytearray(path.read_bytes())
data[80:84] = (int.from_bytes(data[80:84], "little") - 1).to_bytes(4, "little")
broken = WORK / "broken.stl"
broken.write_bytes(data[:-50])
checks.that("a solid without one triangle: trimesh sees it", not trimesh.load_mesh(broken).is_watertight)
checks.that("a solid without one triangle: admesh sees it", admesh(broken) != nothing)

checks.end()
