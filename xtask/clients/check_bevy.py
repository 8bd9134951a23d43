"""Checks the example for Bevy: a run without a window, with software Vulkan. Rays hit the colliders at the heights of an export, there are no gaps at the borders of chunks, the ball stays on the ground while it rolls over them, and the picture shows ground, sky and ball."""

import os
import subprocess
import sys

import numpy
from orogen import WORK, Checks, orogen
from PIL import Image

checks = Checks()
CELL, SIDE, RADIUS = 2.0, 128.0, 1.5
# Near the corner of a chunk: the ball rolls to the north-east.
START = (2545.0, 11914.0)
# Frames of a sixtieth of a second, in which the ball rolls over several chunks.
FRAMES = 1000
# Metres on both sides of a border where rays fall too.
BESIDE = 0.01


def run():
    """Runs the example; returns its rays, the positions of the ball and the picture."""
    picture = WORK / "rolling.png"
    at = ",".join(map(str, START))
    line = [os.environ["OROGEN_BEVY"], "hills", "--at", at, "--cell", str(CELL), "--frames", str(FRAMES), "--screenshot", picture]
    done = subprocess.run(list(map(str, line)), capture_output=True, stdin=subprocess.DEVNULL, timeout=1800)
    told = done.stdout.decode()
    if done.returncode != 0:
        sys.exit(f"the example ended with {done.returncode}:\n{told[-3000:]}\n{done.stderr.decode()[-3000:]}")
    errors = [text for text in (told + done.stderr.decode()).splitlines() if "ERROR" in text]
    checks.equal("errors in the log", errors, [])
    rays, ball = ([text.split()[1:] for text in told.splitlines() if text.startswith(word)] for word in ("ray ", "ball "))
    return rays, numpy.array(ball, dtype=float), numpy.asarray(Image.open(picture).convert("RGB")).astype(int)


def ground(points):
    """The heights of an export at points, on the triangles of its samples: cells are cut from south-west to north-east."""
    low = numpy.floor(points.min(axis=0) / CELL).astype(int) - 1
    size = numpy.ceil(points.max(axis=0) / CELL).astype(int) + 2 - low
    orogen("export", "hills", "--cell", CELL, "--window", f"{low[0]},{low[1]},{size[0]},{size[1]}", "-o", "ground.npy", "--quiet")
    heights = numpy.load(WORK / "ground.npy").astype(float)
    at = points / CELL - low
    whole = numpy.floor(at).astype(int)
    x, z = (at - whole).T
    i, j = whole.T
    a, east, south, across = heights[j, i], heights[j, i + 1], heights[j + 1, i], heights[j + 1, i + 1]
    near = a + x * (east - a) + z * (south - a)
    far = across + (1 - x) * (south - across) + (1 - z) * (east - across)
    return numpy.where(x + z <= 1, near, far)


def from_border(positions):
    """The distances to the nearest borders of chunks."""
    return abs(positions - SIDE * numpy.round(positions / SIDE))


rays, ball, picture = run()
checks.equal("rays that find no ground", [ray for ray in rays if ray[2] == "none"], [])
hits = numpy.array([list(map(float, ray)) for ray in rays if ray[2] != "none"])
expect = ground(hits[:, :2])
worst = abs(hits[:, 2] - expect).max()
# Cells that are cut the other way are 1 mm off.
checks.that("rays hit the triangles of the samples, to 0.2 mm", worst < 0.0002, worst)
checks.that("the land is not flat", numpy.ptp(expect) > 5, numpy.ptp(expect))
on = from_border(hits[:, :2]) == 0
near = from_border(hits[:, :2]) < 2 * BESIDE
checks.that("rays: count", len(rays) > 4000, len(rays))
checks.that("rays: on borders both ways", on.sum(axis=0).min() >= 60, on.sum(axis=0))
checks.that("rays: on corners of chunks", on.all(axis=1).any())
checks.that("rays: closely on both sides of borders", (near & ~on).sum(axis=0).min() >= 120, (near & ~on).sum(axis=0))
samples = (hits[:, :2] % CELL == 0).all(axis=1)
checks.that("rays: on samples", samples.sum() > 400, samples.sum())

way = ball[:, [0, 2]]
chunks = numpy.floor(way / SIDE)
crossed = abs(numpy.diff(chunks, axis=0)).sum(axis=0)
checks.equal("ball: positions", len(ball), FRAMES // 10 + 1)
checks.that("ball: crosses borders of chunks both ways", crossed.min() >= 1 and crossed.sum() >= 3, crossed)
clearance = ball[:, 1] - ground(way)
checks.that("ball: never sinks into the ground", clearance.min() > 0.95 * RADIUS, clearance.min())
checks.that("ball: rolls, and does not fly", numpy.mean(clearance < 1.1 * RADIUS) > 0.8, numpy.sort(clearance))
checks.that("ball: lies on the ground at the end", clearance[-1] < 1.1 * RADIUS, clearance[-1])

checks.equal("picture: size", picture.shape, (540, 960, 3))
red, green, blue = numpy.moveaxis(picture, 2, 0)
sky = (blue > red + 15) & (blue > 120)
orb = (red > green + 60) & (red > blue + 40)
land = picture[-200:].astype(float)
checks.that("picture: sky above", sky[:40].mean() > 0.99, sky[:40].mean())
checks.that("picture: ground below", sky[-200:].mean() < 0.01, sky[-200:].mean())
checks.that("picture: the ball", 1000 < orb.sum() < 20000, orb.sum())
checks.that("picture: grass", (green[-200:] > blue[-200:] + 20).mean() > 0.8, (green[-200:] > blue[-200:] + 20).mean())
checks.that("picture: light and dark", land.std(axis=(0, 1)).max() > 5, land.std(axis=(0, 1)))
print(f"{len(rays)} rays, at most {1000 * worst:.2f} mm off; the ball crossed {crossed.sum():.0f} borders in {numpy.linalg.norm(way[-1] - way[0]):.0f} m, {clearance.min():.3f} to {clearance.max():.3f} m above the ground")
checks.end()
