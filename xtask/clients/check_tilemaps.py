"""Checks tilemaps with Tiled, PyTMX, ldtkpy and godot_parser: every layout opens, its picture is ours pixel for pixel, its wang sets stay, and tilesets of others are used."""

import base64
import csv
import json
import os
import struct
import subprocess

import numpy
import pytmx
from godot_parser import GDResource, GDScene
from ldtkpy import api as ldtk
from orogen import WORK, Checks, orogen
from PIL import Image

checks = Checks()
os.environ["QT_QPA_PLATFORM"] = "offscreen"

# The tiles of a class by layout, and the type of its wang set.
LAYOUTS = {"blob": (47, "mixed"), "edge": (16, "edge"), "corner": (15, "corner"), "dual": (15, "corner")}
MAPS = [("island", "fields-16", 64), ("alpine", "fields-32", 24), ("endless", "fields-16", 40)]
NAMES = ["water", "sand", "grass", "forest", "rock", "snow"]


def run(*command):
    """Runs a program; returns what it wrote to its outputs."""
    done = subprocess.run(list(map(str, command)), capture_output=True, stdin=subprocess.DEVNULL, timeout=120)
    checks.equal(f"{command[0]} {command[-1]}: ends well", done.returncode, 0)
    return done.stdout.decode() + done.stderr.decode()


def pixels(path):
    """Returns the colors of a picture."""
    with Image.open(path) as picture:
        return numpy.array(picture.convert("RGB"))


def classes_of(folder):
    """Returns the classes of the cells."""
    with open(folder / "classes.csv", newline="") as file:
        return numpy.array([[int(cell) for cell in row] for row in csv.reader(file)])


def check(preset, tileset, size, layout):
    """Makes a map and checks its files."""
    name = f"{preset}-{layout}"
    folder = WORK / name
    orogen("tilemap", preset, "--tileset", tileset, "--layout", layout, "--size", size, "-o", folder, "--quiet")
    summary = json.loads((folder / "tilemap.json").read_text())
    raster(name, folder)

    # Tiled's own copy has the same tiles and the same wang sets.
    run("tiled", "--export-map", "json", folder / "map.tmx", folder / "copy.json")
    run("tiled", "--export-tileset", "json", folder / "tiles.tsx", folder / "copy-tiles.json")
    made, copy = (json.loads((folder / file).read_text()) for file in ("map.tmj", "copy.json"))
    layers = [[(layer["name"], layer["data"]) for layer in file["layers"]] for file in (made, copy)]
    checks.equal(f"{name}: layers", layers[1], layers[0])
    tiles = json.loads((folder / "copy-tiles.json").read_text())
    count, kind = LAYOUTS[layout]
    sets = tiles["wangsets"]
    checks.equal(f"{name}: wang sets", [found["name"] for found in sets], NAMES)
    for found, own in zip(sets, made["tilesets"][0]["wangsets"]):
        checks.equal(f"{name}, {found['name']}: type", found["type"], kind)
        own = {tile["tileid"]: tile["wangid"] for tile in own["wangtiles"]}
        theirs = {tile["tileid"]: tile["wangid"] for tile in found["wangtiles"]}
        checks.equal(f"{name}, {found['name']}: wang ids", theirs, own)
        # A tile without any color is no part of a wang set, and water has no borders.
        different = 1 if found["name"] == "water" else count - (kind != "corner")
        checks.equal(f"{name}, {found['name']}: different tiles", len(set(map(tuple, own.values()))), different)

    # PyTMX reads the map; what is drawn on top in the middle of a class is that class.
    read = pytmx.TiledMap(str(folder / "map.tmx"))
    checks.equal(f"{name}: size", (read.width, read.height), (summary["width"], summary["height"]))
    checks.equal(f"{name}: no place is without a tile", summary["without_tile"], [])
    drawn = [list(layer.tiles()) for layer in read.layers]
    covered = {(x, y) for layer in drawn for x, y, _ in layer}
    checks.equal(f"{name}: places with a tile", len(covered), read.width * read.height)
    if layout == "blob":
        classes = classes_of(folder)
        names = [entry["name"] for entry in summary["classes"]]
        top = {}
        for layer in read.layers:
            for x, y, _ in layer.tiles():
                top[x, y] = layer.name
        wrong = [place for place, found in top.items() if names[classes[place[1], place[0]]] != found]
        checks.equal(f"{name}: the uppermost layer is the class", wrong[:3], [])
    engines(name, folder)


def raster(name, folder):
    """Compares Tiled's pictures of a map with ours."""
    ours = pixels(folder / "preview.png")
    for kind in "tmx", "tmj":
        picture = folder / f"{kind}.png"
        run("tmxrasterizer", "--hide-layer", "objects", folder / f"map.{kind}", picture)
        checks.that(f"{name}.{kind}: its picture is ours", numpy.array_equal(pixels(picture), ours))


class Canvas:
    """Draws tiles as an engine does, from the picture of the tileset."""

    def __init__(self, folder, width, height, size):
        with Image.open(folder / "tiles.png") as picture:
            self.tiles = picture.convert("RGBA")
        self.size = size
        self.picture = Image.new("RGBA", (width * size, height * size))

    def draw(self, left, top, x, y, mirrored=False, upside_down=False, transposed=False):
        """Draws the tile at (left, top) of the picture at the pixel (x, y)."""
        tile = self.tiles.crop((left, top, left + self.size, top + self.size))
        turns = [(transposed, Image.Transpose.TRANSPOSE)]
        turns += [(mirrored, Image.Transpose.FLIP_LEFT_RIGHT), (upside_down, Image.Transpose.FLIP_TOP_BOTTOM)]
        for is_set, turn in turns:
            tile = tile.transpose(turn) if is_set else tile
        self.picture.alpha_composite(tile, (x, y))

    def is_like(self, folder):
        """Tells whether the picture is our preview."""
        return numpy.array_equal(numpy.array(self.picture.convert("RGB")), pixels(folder / "preview.png"))


def engines(name, folder, has_ldtk=True):
    """Reads the files for LDtk and Godot, draws them, and compares the pictures."""
    summary = json.loads((folder / "tilemap.json").read_text())
    width, height, size = summary["width"], summary["height"], summary["tile"]
    checks.equal(f"{name}: a project of LDtk", (folder / "map.ldtk").exists(), has_ldtk)
    objects = 0
    if has_ldtk:
        # Made from LDtk's schema: it fails where a key is missing or has another type.
        project = ldtk.ldtk_json_from_dict(json.loads((folder / "map.ldtk").read_text()))
        canvas = Canvas(folder, width, height, size)
        for layer in reversed(project.levels[0].layer_instances):
            for tile in layer.grid_tiles:
                canvas.draw(*tile.src, *tile.px, tile.f & 1 > 0, tile.f & 2 > 0)
            if layer.int_grid_csv:
                classes = classes_of(folder).ravel() + 1
                checks.that(f"{name}: classes of LDtk", numpy.array_equal(layer.int_grid_csv, classes))
            objects += len(layer.entity_instances)
        checks.that(f"{name}: the picture of LDtk is ours", canvas.is_like(folder))
        uids = [entry.uid for entry in project.defs.layers + project.defs.entities + project.defs.tilesets]
        checks.equal(f"{name}: numbers of LDtk are unique", len(set(uids)), len(uids))

    # The reader does not know comments.
    text = {file: (folder / file).read_text().replace("; made by", "\n; made by") for file in ("tiles.tres", "map.tscn")}
    text = {file: "".join(line for line in own.splitlines(True) if line[0] != ";") for file, own in text.items()}
    tiles = GDResource.parse(text["tiles.tres"])
    known = {key.split("/")[0] for section in tiles.get_sections("sub_resource") for key in section.properties}
    canvas = Canvas(folder, width, height, size)
    markers = 0
    for node in GDScene.parse(text["map.tscn"]).get_sections("node"):
        markers += node.header.attributes.get("type") == "Marker2D"
        if "tile_map_data" not in node.properties:
            continue
        data = base64.b64decode(node["tile_map_data"].args[0])
        checks.equal(f"{name}: version of the cells of Godot", data[:2], b"\0\0")
        for x, y, source, left, top, turns in struct.iter_unpack("<hhHHHH", data[2:]):
            assert source == 0 and f"{left}:{top}" in known, (left, top)
            turned = [turns & bit > 0 for bit in (1 << 12, 1 << 13, 1 << 14)]
            canvas.draw(left * size, top * size, x * size, y * size, *turned)
    checks.that(f"{name}: the picture of Godot is ours", canvas.is_like(folder))
    if has_ldtk:
        checks.equal(f"{name}: objects of LDtk and Godot", objects, markers)
    return markers


def corner_tiles(folder, pairs, turns):
    """Makes a tileset of Tiled with corner tiles of pairs of terrains, each quarter in the color of its terrain."""
    colors = [(40, 90, 200), (220, 200, 120), (70, 160, 60), (120, 120, 120)]
    corners = []
    for low, high in pairs:
        for bits in range(16):
            tile = tuple(high if bits >> n & 1 else low for n in range(4))
            # Clockwise from the north-east; turned by a quarter they are rotated.
            rotated = {tile[n:] + tile[:n] for n in range(4)}
            if tile not in corners and not (turns and rotated & set(corners)):
                corners.append(tile)
    size, columns = 8, 8
    picture = Image.new("RGB", (columns * size, (len(corners) + columns - 1) // columns * size))
    for n, tile in enumerate(corners):
        for class_, (x, y) in zip(tile, [(4, 0), (4, 4), (0, 4), (0, 0)]):
            box = (n % columns * size + x, n // columns * size + y)
            picture.paste(colors[class_], (*box, box[0] + 4, box[1] + 4))
    picture.save(folder / "quarters.png")
    wang = "".join(
        f'<wangtile tileid="{n}" wangid="{",".join(f"0,{class_ + 1}" for class_ in tile)}"/>'
        for n, tile in enumerate(corners)
    )
    names = "".join(f'<wangcolor name="t{n}" color="#808080" tile="-1" probability="1"/>' for n in range(4))
    (folder / "quarters.tsx").write_text(
        f'<?xml version="1.0" encoding="UTF-8"?><tileset version="1.8" name="quarters" tilewidth="{size}" tileheight="{size}" '
        f'tilecount="{len(corners)}" columns="{columns}">'
        f'<transformations hflip="0" vflip="0" rotate="{int(turns)}" preferuntransformed="1"/>'
        f'<image source="quarters.png" width="{picture.width}" height="{picture.height}"/>'
        f'<wangsets><wangset name="all" type="corner" tile="-1">{names}{wang}</wangset></wangsets></tileset>'
    )
    return colors, len(corners)


LAND = """
orogen = 1
world = { seed = 3, cell = 10, size = [480, 320] }
outputs = { class = "class" }
nodes.land = { op = "fbm", wavelength = 90, octaves = 4 }
nodes.class = { op = "expr", expr = "min(3, max(0, floor(land * 5 + 2)))" }
"""


def check_given(name, pairs, turns):
    """Uses a tileset that was not made by us: each quarter of a tile has the color of the class at its corner."""
    folder = WORK / name
    folder.mkdir(exist_ok=True)
    colors, count = corner_tiles(folder, pairs, turns)
    (folder / "land.toml").write_text(LAND)
    out = folder / "map"
    orogen("tilemap", folder / "land.toml", "--cell", 10, "--tileset", folder / "quarters.tsx", "-o", out, "--quiet")
    raster(name, out)
    summary = json.loads((out / "tilemap.json").read_text())
    checks.equal(f"{name}: no place is without a tile", summary["without_tile"], [])
    checks.that(f"{name}: some cells were changed", summary["without_tile_before"] > 0 and summary["changed"] > 0)
    classes, ours = classes_of(out), pixels(out / "preview.png")
    expected = numpy.array(colors, dtype=numpy.uint8)[classes]
    for dy, dx in (0, 0), (0, 1), (1, 0), (1, 1):
        at = ours[4 * dy + 1 :: 8, 4 * dx + 1 :: 8]
        corner = expected[dy : dy + at.shape[0], dx : dx + at.shape[1]]
        checks.that(f"{name}: quarters {dx}, {dy} have the classes of their corners", numpy.array_equal(at, corner))
    used = json.loads((out / "map.tmj").read_text())["layers"][0]["data"]
    checks.equal(f"{name}: turned tiles", any(tile >> 29 for tile in used), turns)
    engines(name, out, has_ldtk=not turns)
    return count


for preset, tileset, size in MAPS:
    for layout in LAYOUTS if preset == "island" else ["blob"]:
        check(preset, tileset, size, layout)

CHAIN = [(0, 1), (1, 2), (2, 3)]
HUB = [(1, 0), (1, 2), (1, 3)]
checks.equal("chain: tiles", check_given("given-chain", CHAIN, False), 46)
checks.equal("hub: tiles", check_given("given-hub", HUB, False), 46)
checks.equal("turned: tiles", check_given("given-turned", CHAIN, True), 16)

# A tileset that was written is read again; it has no tile for single cells, which wang sets cannot have.
orogen("tilemap", "tile-island", "--size", "64", "--tileset", WORK / "island-blob" / "tiles.tsx", "-o", WORK / "again", "--quiet")
raster("again", WORK / "again")
again = json.loads((WORK / "again" / "tilemap.json").read_text())
checks.equal("again: no place is without a tile", again["without_tile"], [])

# An infinite map has its chunks at the positions of the world; its picture is that of all chunks.
far = WORK / "infinite"
orogen("tilemap", "endless", "--cell", 60, "--window", "2001,-453,50,30", "--infinite", "-o", far, "--quiet")
ours = pixels(far / "preview.png")
for kind in "tmx", "tmj":
    run("tmxrasterizer", far / f"map.{kind}", far / f"{kind}.png")
    theirs = pixels(far / f"{kind}.png")
    top, left = -453 % 16 * 16, 2001 % 16 * 16
    part = theirs[top : top + ours.shape[0], left : left + ours.shape[1]]
    checks.that(f"infinite.{kind}: its picture is ours", numpy.array_equal(part, ours))
run("tiled", "--export-map", "json", far / "map.tmx", far / "copy.json")
places = [
    sorted((chunk["x"], chunk["y"]) for layer in json.loads((far / file).read_text())["layers"] for chunk in layer["chunks"])
    for file in ("map.tmj", "copy.json")
]
checks.equal("infinite: chunks", places[1], places[0])

# Scattered objects are in all files.
(WORK / "objects.toml").write_text(
    LAND.replace('outputs = { class = "class" }', 'outputs = { class = "class", height = "land" }')
    + '[[scatter]]\nname = "pine"\nspacing = 14\n[[scatter]]\nname = "rock"\nspacing = 40\nclearance = 1\nsize = [0.5, 2]\n'
)
orogen("tilemap", WORK / "objects.toml", "--cell", 10, "-o", WORK / "objects", "--quiet")
raster("objects", WORK / "objects")
markers = engines("objects", WORK / "objects")
read = pytmx.TiledMap(str(WORK / "objects" / "map.tmx"))
checks.equal("objects: in Tiled and Godot", len(list(read.objects)), markers)
checks.that("objects: some of both", {found.type for found in read.objects} == {"pine", "rock"} and markers > 100)
sides = read.width * read.tilewidth, read.height * read.tileheight
checks.that("objects: on the map", all(0 <= found.x < sides[0] and 0 <= found.y < sides[1] for found in read.objects))

checks.end()
