"""Checks the meshes of `orogen serve` in Cesium: Chromium shows them (drive_cesium.mjs), and heights are those of `/height`."""

import json
import math
import signal
import subprocess
import urllib.request

import numpy
from orogen import BINARY, NODE_BIN, ROOT, WORK, Checks
from PIL import Image

checks = Checks()
# Degrees, and metres of the world on the equator.
POINTS = [(0.013, -0.021), (0.07, -0.07), (0.1, -0.03), (0.12, -0.11), (0.031, -0.09)]
RADIUS = 6378137

server = subprocess.Popen(
    [BINARY, "serve", "hills", "--port", "0", "--quiet"], cwd=WORK, stdout=subprocess.PIPE, text=True
)
base = server.stdout.readline().split(" at ")[1].strip()


def get(path):
    """The JSON of an answer."""
    with urllib.request.urlopen(base + path) as answer:
        return json.load(answer)


points = ";".join(f"{east},{north}" for east, north in POINTS)
line = ["node", ROOT / "xtask/clients/drive_cesium.mjs", NODE_BIN.parent, base, WORK / "cesium.png", points]
driver = subprocess.run(line, capture_output=True, text=True, timeout=1500)
if driver.returncode != 0:
    print(driver.stdout, driver.stderr)
checks.equal("Cesium runs to the end", driver.returncode, 0)
found = json.loads(driver.stdout.splitlines()[-1])
checks.equal("nothing goes wrong, and no other host is asked", found["wrong"], [])
checks.that("the tiles have normals", found["normals"])
zoom = len(get("mesh/layer.json")["available"]) - 1
for (east, north), height in zip(POINTS, found["heights"], strict=True):
    x, y = (math.radians(degrees) * RADIUS for degrees in (east, north))
    checks.near(f"the height at {east}, {north}", height, get(f"height?x={x}&y={y}")["value"], 19267 / 2**zoom)
# Below the horizon there is shaded land instead of an even color.
shown = numpy.asarray(Image.open(WORK / "cesium.png").convert("L"), dtype=float)[220:480, 150:520]
checks.that("the picture has shaded land", shown.std() > 8 and shown.mean() > 60, (shown.mean(), shown.std()))

server.send_signal(signal.SIGINT)
checks.equal("the server ends in peace", server.wait(60), 0)
checks.end()
