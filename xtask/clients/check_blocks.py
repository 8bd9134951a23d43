"""Checks worlds of blocks: nbtlib reads .schem, midvoxio .vox, trimesh and the Khronos validator .glb, and a Luanti server opens the world. All have the same blocks."""

import json
import os
import re
import shutil
import sqlite3
import subprocess
from collections import Counter

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


def make(name):
    """Makes the same part of the world in a format."""
    out = WORK / name
    orogen("blocks", "caves", "--window", WINDOW, "-o", out, "--quiet")
    return out


def schem():
    """Reads the schematic: block names in the order level, row from the north, column."""
    root = nbtlib.load(make("b.schem"))["Schematic"]
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


blocks = schem()
if CLIENT == "luanti":
    for game in "minetest_game", "bare":
        luanti(blocks, game)
else:
    vox(blocks)
    glb()
checks.end()
