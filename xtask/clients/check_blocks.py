"""Checks worlds of blocks: nbtlib reads .schem, midvoxio .vox, trimesh and the Khronos validator .glb, anvil-parser2 and nbtlib the save of Minecraft, and a Luanti server opens the world. All have the same blocks."""

import io
import json
import os
import re
import shutil
import sqlite3
import subprocess
import zlib
from collections import Counter

import anvil
import nbtlib
import numpy
import trimesh
from midvoxio.voxio import get_vox
from orogen import CLIENT, NODE_BIN, ROOT, WORK, Checks, orogen

checks = Checks()
# Names of nodes in Minetest Game and of block states in Minecraft, where they are not those of our blocks.
MINETEST = {
    "water": "water_source", "snow": "snowblock", "grass": "dirt_with_grass", "log": "tree", "needles": "pine_needles",
    "coal_ore": "stone_with_coal", "iron_ore": "stone_with_iron", "gold_ore": "stone_with_gold",
    "dry_grass": "dry_dirt_with_dry_grass", "litter": "dirt_with_coniferous_litter",
}  # fmt: skip
STATES = {
    "packed_ice": "ice", "snow_block": "snow", "grass_block": "grass", "coarse_dirt": "dry_grass", "podzol": "litter",
    "oak_log": "log", "oak_leaves": "leaves", "spruce_leaves": "needles",
}  # fmt: skip
WINDOW = "40,60,300,120"


def make(name, *more):
    """Makes the same part of the world in a format."""
    out = WORK / name
    orogen("blocks", "caves", "--window", WINDOW, "-o", out, "--quiet", *more)
    return out


def schem(name="b.schem", *more):
    """Reads the schematic: block names in the order level, row from the north, column."""
    root = nbtlib.load(make(name, *more))["Schematic"]
    checks.equal("schem: version", (int(root["Version"]), int(root["DataVersion"])), (3, 3700))
    size = [int(root[side]) for side in ("Height", "Length", "Width")]
    checks.equal("schem: columns", size[1:], [120, 300])
    names = {}
    for state, number in root["Blocks"]["Palette"].items():
        plain = re.fullmatch(r"minecraft:(\w+)(\[.*\])?", state)[1]
        names[int(number)] = STATES.get(plain, plain)
    data = numpy.array(root["Blocks"]["Data"], dtype=numpy.uint8)
    checks.that("schem: numbers of one byte that are in the palette", data.max() < len(names) <= 128)
    return numpy.array([names[k] for k in range(len(names))])[data].reshape(size)


def vox(blocks):
    """Reads the MagicaVoxel scene: where voxels are, and one color for each kind of block."""
    scene = get_vox(str(make("b.vox")))
    size = blocks.shape
    found = numpy.zeros(size, dtype=int)
    places = [frame["_t"] for node in scene.ntrns for frame in node.frames if "_t" in frame]
    checks.equal("vox: models", (len(scene.voxels), len(places)), (2, 2))
    for box, voxels, place in zip(scene.sizes, scene.voxels, places):
        checks.that("vox: at most 256 blocks along a side", max(box) <= 256)
        middle = [int(part) for part in place.split()]
        start = [at - side // 2 for at, side in zip(middle, box)]
        for x, y, z, color in voxels:
            column, north, level = (start[0] + x + size[2] // 2, start[1] + y + size[1] // 2, start[2] + z)
            found[level, size[1] - 1 - north, column] = color
    checks.that("vox: voxels are where the schematic has blocks", ((found > 0) == (blocks != "air")).all())
    kinds = Counter(zip(blocks.ravel().tolist(), found.ravel().tolist()))
    checks.equal("vox: a color for each kind", len(kinds), len(set(blocks.ravel().tolist())))


PROBE = """
minetest.after(0, function()
    local from, to = {x = %d, y = %d, z = %d}, {x = %d, y = %d, z = %d}
    minetest.emerge_area(from, to, function(place, action, left)
        if left > 0 then return end
        local counts = {}
        for x = from.x, to.x do
            for z = from.z, to.z do
                for y = from.y, to.y do
                    local name = minetest.get_node({x = x, y = y, z = z}).name
                    counts[name] = (counts[name] or 0) + 1
                end
            end
        end
        for name, count in pairs(counts) do print("NODE " .. name .. " " .. count) end
        for _, place in ipairs({%s}) do print("AT " .. minetest.get_node(place).name) end
        print("LIGHT " .. minetest.get_node_light({x = 0, y = to.y, z = 0}, 0.5))
        minetest.request_shutdown()
    end)
end)
"""


def luanti(blocks, game):
    """A server opens the world in a game, emerges it and counts its nodes."""
    name = f"luanti, {game}"
    world = WORK / f"world-{game}"
    orogen("blocks", "caves", "--window", WINDOW, "-o", world, "--quiet")
    settings = world / "world.mt"
    settings.write_text(settings.read_text().replace("gameid = minetest_game", f"gameid = {game}"))
    with sqlite3.connect(world / "map.sqlite") as database:
        checks.equal(f"{name}: SQLite", database.execute("PRAGMA integrity_check").fetchone(), ("ok",))
        rows = database.execute("SELECT count(*), min(pos), max(pos) FROM blocks").fetchone()
    count, length, width = blocks.shape
    west, south = -(width // 2), length - 1 - length // 2 - (length - 1)
    # The sea ends below y = 0: the highest water.
    bottom = -1 - int(numpy.argwhere(blocks == "water")[:, 0].max())
    low = [west, bottom, south]
    high = [west + width - 1, bottom + count - 1, south + length - 1]
    blocks_of = [(b // 16) - (a // 16) + 1 for a, b in zip(low, high)]
    checks.equal(f"{name}: map blocks", rows[0], int(numpy.prod(blocks_of)))
    places = numpy.random.default_rng(1).integers([0, 0, 0], blocks.shape, (200, 3))
    nodes = ", ".join(f"{{x={west + c}, y={bottom + y}, z={south + length - 1 - r}}}" for y, r, c in places.tolist())
    probe = world / "worldmods" / "probe"
    probe.mkdir()
    (probe / "mod.conf").write_text("name = probe\n")
    (probe / "init.lua").write_text(PROBE % (*low, *high, nodes))
    home = WORK / "home"
    (home / "games" / "bare").mkdir(parents=True, exist_ok=True)
    (home / "games" / "bare" / "game.conf").write_text("title = bare\n")
    (home / "games" / "bare" / "mods").mkdir(exist_ok=True)
    environment = {**os.environ, "HOME": str(home), "MINETEST_SUBGAME_PATH": str(home / "games")}
    settings = WORK / "minetest.conf"
    settings.write_text("server_announce = false\nbind_address = 127.0.0.1\n")
    server = shutil.which("minetestserver", path=f"{os.environ['PATH']}:/usr/games") or "minetestserver"
    command = [server, "--world", world, "--gameid", game, "--config", settings, "--port", "30917", "--logfile", WORK / "log.txt"]
    done = subprocess.run(list(map(str, command)), env=environment, capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
    told = done.stdout.decode() + done.stderr.decode()
    checks.equal(f"{name}: ends well", done.returncode, 0)
    checks.equal(f"{name}: errors", [line for line in told.splitlines() if "ERROR" in line], [])
    names = Counter(blocks.ravel().tolist())
    title = (lambda kind: "default:" + MINETEST.get(kind, kind)) if game == "minetest_game" else (lambda kind: "orogen_blocks:" + kind)
    expect = {kind if kind == "air" else title(kind): number for kind, number in names.items()}
    found = {node: int(number) for node, number in re.findall(r"^NODE (\S+) (\d+)", told, re.M)}
    checks.equal(f"{name}: nodes", found, expect)
    there = re.findall(r"^AT (\S+)", told, re.M)
    own = [blocks[place] if blocks[place] == "air" else title(blocks[place]) for place in map(tuple, places.tolist())]
    checks.that(f"{name}: nodes at their places", there == [str(node) for node in own])
    checks.equal(f"{name}: light in the open", re.findall(r"^LIGHT (\d+)", told, re.M), ["15"])


def open_edges(mesh):
    """Counts the edges with one triangle, except where the surface ends: in the outermost cubes, and at the bottom."""
    kinds, counts = numpy.unique(numpy.sort(mesh.edges, axis=1), axis=0, return_counts=True)
    middle = mesh.vertices[kinds].mean(axis=1)[counts == 1]
    is_outside = (middle[:, [0, 2]] < 1) | (middle[:, [0, 2]] > numpy.array([298, 118]))
    return int((~is_outside.any(axis=1) & (middle[:, 1] > mesh.bounds[0][1] + 1.5)).sum())


def glb():
    """Reads the mesh: no cracks inside, the right size, one outside."""
    path = make("b.glb")
    line = ["node", ROOT / "xtask/clients/validate_glb.js", NODE_BIN.parent, path]
    report = json.loads(subprocess.run(line, capture_output=True, check=True, stdin=subprocess.DEVNULL).stdout)[0]
    checks.equal("glb: errors and warnings of the validator", (report["numErrors"], report["numWarnings"]), (0, 0))
    scene = trimesh.load(path, process=False)
    parts = [mesh for name, mesh in scene.geometry.items() if name.startswith("blocks")]
    checks.equal("glb: parts", len(parts), 10)
    whole = trimesh.util.concatenate(parts)
    whole.merge_vertices(merge_norm=True, merge_tex=True, digits_vertex=9)
    low, high = whole.bounds
    checks.that("glb: as wide as the window", low[0] < 0 and 298 < high[0] < 300 and 118 < high[2] < 120)
    checks.equal("glb: edges inside with one triangle", open_edges(whole), 0)
    checks.that("glb: a missing triangle is found", open_edges(trimesh.Trimesh(whole.vertices, whole.faces[len(whole.faces) // 2 :], process=False)) > 0)
    checks.that("glb: neighboring triangles turn the same way", whole.is_winding_consistent)
    checks.that("glb: a color for each vertex", all(len(part.visual.vertex_attributes["color"]) == len(part.vertices) for part in parts))
    normals = numpy.concatenate([part.vertex_normals for part in parts])
    checks.that("glb: unit normals", bool(numpy.allclose(numpy.linalg.norm(normals, axis=1), 1, atol=1e-4)))


# The lowest y, and that of the uppermost water.
BOTTOM, SEA = -64, 62
OPEN = ("air", "water")


def unpacked(longs, bits, count):
    """Numbers of some bits in longs, none of which spans two of them."""
    longs = numpy.array(longs, dtype=numpy.int64).view(numpy.uint64)
    each = 64 // bits
    shifts = numpy.arange(each, dtype=numpy.uint64) * numpy.uint64(bits)
    return ((longs[:, None] >> shifts) & numpy.uint64((1 << bits) - 1)).ravel()[:count].astype(int)


def plain(name):
    """The name of our block for that of Minecraft's."""
    name = name.removeprefix("minecraft:")
    return STATES.get(name, name)


def section_blocks(section):
    """The names of the blocks of a section: 16 layers, rows and columns."""
    states = section["block_states"]
    names = numpy.array([plain(str(state["Name"])) for state in states["palette"]])
    if len(names) == 1:
        return numpy.full((16, 16, 16), names[0], dtype=object)
    return names[unpacked(states["data"], max(4, (len(names) - 1).bit_length()), 4096)].astype(object).reshape(16, 16, 16)


def read_region(path):
    """The chunks of a region file by their positions in it, read by hand as the format describes them."""
    data = path.read_bytes()
    checks.equal(f"minecraft: {path.name}: whole sectors, times of 0", (len(data) % 4096, data[4096:8192]), (0, bytes(4096)))
    chunks = {}
    used = numpy.zeros(len(data) // 4096, dtype=int)
    used[:2] += 1
    for at in range(1024):
        start, count = int.from_bytes(data[4 * at : 4 * at + 3], "big"), data[4 * at + 3]
        if count:
            used[start : start + count] += 1
            head = 4096 * start
            size = int.from_bytes(data[head : head + 4], "big")
            checks.that("minecraft: a chunk of zlib in its sectors", data[head + 4] == 2 and size + 4 <= 4096 * count)
            chunks[at % 32, at // 32] = nbtlib.File.parse(io.BytesIO(zlib.decompress(data[head + 5 : head + 4 + size])))
    checks.that(f"minecraft: {path.name}: each sector is used once", (used == 1).all())
    return chunks


def check_chunk(at, chunk, stored):
    """One chunk against the blocks of the world: its sections, height maps and biomes."""
    x, z = at
    name = f"minecraft: chunk {x}, {z}"
    checks.equal(f"{name}: place and status", (int(chunk["xPos"]), int(chunk["zPos"]), int(chunk["yPos"]), str(chunk["Status"]), int(chunk["DataVersion"])), (x, z, -4, "minecraft:full", 3700))
    sections = sorted(chunk["sections"], key=lambda section: int(section["Y"]))
    checks.equal(f"{name}: sections", [int(section["Y"]) for section in sections], list(range(-4, 20)))
    found = numpy.concatenate([section_blocks(section) for section in sections])
    checks.that(f"{name}: blocks", (found[1:] == stored[1:]).all())
    checks.that(f"{name}: bedrock below", (found[0] == numpy.where(stored[0] == "air", "air", "bedrock")).all())
    leaves = numpy.isin(found, ["leaves", "needles"])
    counted = {
        "WORLD_SURFACE": found != "air", "MOTION_BLOCKING": found != "air",
        "OCEAN_FLOOR": ~numpy.isin(found, OPEN), "MOTION_BLOCKING_NO_LEAVES": (found != "air") & ~leaves,
    }  # fmt: skip
    for kind, solid in counted.items():
        tops = numpy.where(solid.any(axis=0), solid.shape[0] - numpy.argmax(solid[::-1], axis=0), 0)
        checks.that(f"{name}: {kind}", (unpacked(chunk["Heightmaps"][kind], 9, 256).reshape(16, 16) == tops).all())
    biomes = set()
    for section in sections:
        palette = [str(entry) for entry in section["biomes"]["palette"]]
        if len(palette) > 1:
            cells = unpacked(section["biomes"]["data"], (len(palette) - 1).bit_length(), 64)
            checks.that(f"{name}: biomes", set(cells.tolist()) == set(range(len(palette))))
        biomes |= set(palette)
    return biomes


def minecraft():
    """Reads the save by two readers: every block of the window, height maps, biomes and settings."""
    save = make("save", "--format", "minecraft")
    left, top, width, length = map(int, WINDOW.split(","))
    # The same levels from a schematic that goes down further: the highest water ends at y = 62.
    blocks = schem("deep.schem", "--below", "150")
    blocks = blocks[int(numpy.argwhere(blocks == "water")[:, 0].max()) - SEA + BOTTOM :]
    columns = numpy.full((384, length, width), "air", dtype=object)
    columns[: blocks.shape[0]] = blocks
    checks.equal("minecraft: files", sorted(path.name for path in save.rglob("*") if path.is_file()), ["level.dat", "r.0.0.mca"])
    region = save / "region" / "r.0.0.mca"
    chunks = read_region(region)
    places = {(x, z) for x in range(left // 16, (left + width - 1) // 16 + 1) for z in range(top // 16, (top + length - 1) // 16 + 1)}
    checks.equal("minecraft: chunks", set(chunks), places)
    biomes = set()
    for (x, z), chunk in sorted(chunks.items()):
        stored = numpy.full((384, 16, 16), "air", dtype=object)
        x0, z0, x1, z1 = max(16 * x, left), max(16 * z, top), min(16 * x + 16, left + width), min(16 * z + 16, top + length)
        stored[:, z0 - 16 * z : z1 - 16 * z, x0 - 16 * x : x1 - 16 * x] = columns[:, z0 - top : z1 - top, x0 - left : x1 - left]
        biomes |= check_chunk((x, z), chunk, stored)
    checks.that("minecraft: biomes", {"minecraft:ocean", "minecraft:forest", "minecraft:plains"} <= biomes)
    by_anvil(region, columns, (left, top))
    level(nbtlib.load(save / "level.dat")["Data"], columns, (left, top))


def by_anvil(region, columns, corner):
    """The other reader: blocks at random places, also their properties."""
    file = anvil.Region.from_file(str(region))
    random = numpy.random.default_rng(2)
    for x, z in ((5, 6), (12, 9), (20, 10)):
        chunk = anvil.Chunk.from_region(file, x, z)
        for column, row, level in random.integers([0, 0, 1], [16, 16, 384], (700, 3)).tolist():
            block = chunk.get_block(column, level + BOTTOM, row)
            own = columns[level, 16 * z + row - corner[1], 16 * x + column - corner[0]]
            checks.equal(f"anvil-parser2: chunk {x}, {z}: {column}, {level}, {row}", plain(block.id), own)
            if own in ("leaves", "needles"):
                checks.equal("anvil-parser2: leaves stay", str(block.properties["persistent"]), "true")


def level(data, columns, corner):
    """The settings: the start is on the ground, and nothing is around the land."""
    checks.equal("level.dat: versions", (int(data["version"]), int(data["DataVersion"]), str(data["Version"]["Name"])), (19133, 3700, "1.20.4"))
    checks.equal("level.dat: name and mode", (str(data["LevelName"]), int(data["GameType"])), ("save", 1))
    x, y, z = (int(data[f"Spawn{axis}"]) for axis in "XYZ")
    column = columns[:, z - corner[1], x - corner[0]]
    ground = y - BOTTOM
    checks.that("level.dat: starts above dry ground", (column[ground:] == "air").all() and column[ground - 1] not in OPEN)
    generator = data["WorldGenSettings"]["dimensions"]["minecraft:overworld"]["generator"]
    layers = [(str(layer["block"]), int(layer["height"])) for layer in generator["settings"]["layers"]]
    checks.equal("level.dat: around the land", (str(generator["type"]), str(generator["settings"]["biome"]), layers), ("minecraft:flat", "minecraft:the_void", [("minecraft:air", 1)]))
    checks.equal("level.dat: seed", int(data["WorldGenSettings"]["seed"]), 3)


blocks = schem()
if CLIENT == "luanti":
    for game in "minetest_game", "bare":
        luanti(blocks, game)
else:
    vox(blocks)
    glb()
    minecraft()
checks.end()
