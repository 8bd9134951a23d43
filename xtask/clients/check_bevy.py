"""Checks the example for Bevy: a run without a window, with software Vulkan. Rays hit the colliders at the heights of an export, there are no gaps, the ball lies on the ground, and the picture shows ground and sky."""

import os
import subprocess
import sys

import numpy
from orogen import WORK, Checks, orogen
from PIL import Image

checks = Checks()
CELL, START, RADIUS = 2.0, (4000.0, 5000.0), 1.5
# Frames of a sixtieth of a second, in which the ball rolls over several chunks of 128 m.
FRAMES = 1500


def run():
    """Runs the example; returns the rays and the ball."""
    picture = WORK / "rolling.png"
    line = [os.environ["OROGEN_BEVY"], "hills", "--at", "4000,5000", "--cell", str(CELL), "--frames", str(FRAMES), "--screenshot", picture]
    done = subprocess.run(list(map(str, line)), capture_output=True, stdin=subprocess.DEVNULL, timeout=1800)
    told = done.stdout.decode()
    if done.returncode != 0:
        sys.exit(f"the example ended with {done.returncode}:\n{told[-3000:]}\n{done.stderr.decode()[-3000:]}")
    errors = [text for text in (told + done.stderr.decode()).splitlines() if " ERROR " in text]
    checks.equal("errors in the log", errors, [])
    rays = [text.split()[1:] for text in told.splitlines() if text.startswith("ray ")]
    (ball,) = [text.split()[1:] for text in told.splitlines() if text.startswith("ball ")]
    return rays, list(map(float, ball)), picture


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


rays, ball, picture = run()
checks.equal("rays", len(rays), 41 * 41)
checks.equal("rays that find no ground", [ray for ray in rays if ray[2] == "none"], [])
hits = numpy.array([list(map(float, ray)) for ray in rays if ray[2] != "none"])
expect = ground(hits[:, :2])
worst = numpy.abs(hits[:, 2] - expect).max()
checks.that("rays hit the triangles of the samples, to a centimetre", worst < 0.01, worst)
whole = (hits[:, :2] % CELL == 0).all(axis=1)
checks.that("some rays hit samples, and some the borders of chunks", whole.sum() > 100 and (hits[:, :2] % (64 * CELL) == 0).any(axis=1).sum() > 5, whole.sum())
checks.that("the land is not flat", numpy.ptp(expect) > 5, numpy.ptp(expect))
x, y, z = ball
clearance = y - ground(numpy.array([[x, z], [x, z]]))[0]
checks.that("the ball lies on the ground", 0.9 * RADIUS < clearance < 2 * RADIUS, clearance)
rolled = numpy.hypot(x - START[0], z - START[1])
checks.that("the ball has rolled over the borders of chunks", rolled > 130, rolled)
image = numpy.asarray(Image.open(picture).convert("RGB")).astype(int)
checks.equal("picture: size", image.shape, (540, 960, 3))
red, green, blue = image[..., 0], image[..., 1], image[..., 2]
sky = (blue > red + 15) & (blue > 120)
checks.that("picture: sky above", sky[:40].mean() > 0.9, sky[:40].mean())
checks.that("picture: ground below", sky[-200:].mean() < 0.02, sky[-200:].mean())
checks.that("picture: the ball", ((red > green + 60) & (red > blue + 60)).sum() > 200, ((red > green + 60) & (red > blue + 60)).sum())
checks.that("picture: light and shadow on the ground", image[-200:].std() > 5 and len(numpy.unique(image[-200:].reshape(-1, 3), axis=0)) > 500)
checks.end()
