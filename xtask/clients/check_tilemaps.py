"""Checks tilemaps with Tiled and PyTMX: every layout opens, its picture is ours pixel for pixel, and its wang sets stay."""

import csv
import json
import os
import subprocess

import numpy
import pytmx
from orogen import WORK, Checks, orogen
from PIL import Image

checks = Checks()
os.environ["QT_QPA_PLATFORM"] = "offscreen"

# The tiles of a class by layout, and the type of its wang set.
LAYOUTS = {"blob": (47, "mixed"), "edge": (16, "edge"), "corner": (15, "corner"), "dual": (15, "corner")}
MAPS = [("island", "fields-16", 64), ("alpine", "fields-32", 24), ("endless", "fields-16", 40)]


def run(*command):
    """Runs a program; returns what it wrote to its outputs."""
    done = subprocess.run(list(map(str, command)), capture_output=True, stdin=subprocess.DEVNULL, timeout=120)
    checks.equal(f"{command[0]} {command[-1]}: ends well", done.returncode, 0)
    return done.stdout.decode() + done.stderr.decode()


def pixels(path):
    """Returns the colours of a picture."""
    with Image.open(path) as picture:
        return numpy.array(picture.convert("RGB"))


def check(preset, tileset, size, layout):
    """Makes a map and checks its files."""
    name = f"{preset}-{layout}"
    folder = WORK / name
    orogen("tilemap", preset, "--tileset", tileset, "--layout", layout, "--size", size, "-o", folder, "--quiet")
    summary = json.loads((folder / "tilemap.json").read_text())
    ours = pixels(folder / "preview.png")
    for kind in "tmx", "tmj":
        picture = folder / f"{kind}.png"
        run("tmxrasterizer", folder / f"map.{kind}", picture)
        checks.that(f"{name}.{kind}: its picture is ours", numpy.array_equal(pixels(picture), ours))

    # Tiled's own copy has the same tiles and the same wang sets.
    run("tiled", "--export-map", "json", folder / "map.tmx", folder / "copy.json")
    run("tiled", "--export-tileset", "json", folder / "tiles.tsx", folder / "copy-tiles.json")
    made, copy = (json.loads((folder / file).read_text()) for file in ("map.tmj", "copy.json"))
    layers = [[(layer["name"], layer["data"]) for layer in file["layers"]] for file in (made, copy)]
    checks.equal(f"{name}: layers", layers[1], layers[0])
    tiles = json.loads((folder / "copy-tiles.json").read_text())
    count, kind = LAYOUTS[layout]
    sets = tiles["wangsets"]
    checks.equal(f"{name}: wang sets", [found["name"] for found in sets], ["sand", "grass", "forest", "rock", "snow"])
    for found, own in zip(sets, made["tilesets"][0]["wangsets"]):
        checks.equal(f"{name}, {found['name']}: type", found["type"], kind)
        # A tile without any colour is no part of a wang set.
        own = {tile["tileid"]: tile["wangid"] for tile in own["wangtiles"] if any(tile["wangid"])}
        theirs = {tile["tileid"]: tile["wangid"] for tile in found["wangtiles"]}
        checks.equal(f"{name}, {found['name']}: wang ids", theirs, own)
        empty = 0 if kind == "corner" else 1
        checks.equal(f"{name}, {found['name']}: different tiles", len(set(map(tuple, own.values()))), count - empty)

    # PyTMX reads the map; what is drawn on top in the middle of a class is that class.
    read = pytmx.TiledMap(str(folder / "map.tmx"))
    checks.equal(f"{name}: size", (read.width, read.height), (summary["width"], summary["height"]))
    checks.equal(f"{name}: no place is without a tile", summary["without_tile"], [])
    drawn = [list(layer.tiles()) for layer in read.layers]
    covered = {(x, y) for layer in drawn for x, y, _ in layer}
    checks.equal(f"{name}: places with a tile", len(covered), read.width * read.height)
    if layout == "blob":
        with open(folder / "classes.csv", newline="") as file:
            classes = numpy.array([[int(cell) for cell in row] for row in csv.reader(file)])
        names = [entry["name"] for entry in summary["classes"]]
        top = {}
        for layer in read.layers:
            for x, y, _ in layer.tiles():
                top[x, y] = layer.name
        wrong = [place for place, found in top.items() if names[classes[place[1], place[0]]] != found]
        checks.equal(f"{name}: the uppermost layer is the class", wrong[:3], [])


for preset, tileset, size in MAPS:
    for layout in LAYOUTS if preset == "island" else ["blob"]:
        check(preset, tileset, size, layout)

checks.end()
