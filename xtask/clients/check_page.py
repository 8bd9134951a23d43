"""Checks the map page of `orogen serve`: Chromium drives it (drive_page.mjs), and what it shows and downloads is compared."""

import json
import re
import signal
import subprocess

import numpy
import rasterio
import trimesh
from orogen import BINARY, NODE_BIN, ROOT, WORK, Checks, export
from PIL import Image

checks = Checks()
MODULES = NODE_BIN.parent
REFERENCES = ROOT / "xtask/clients/page"
# Where only the map is, in pixels of a screenshot.
MAP = (370, 60, 940, 560)

server = subprocess.Popen(
    [BINARY, "serve", "alpine", "--port", "0", "--quiet"], cwd=WORK, stdout=subprocess.PIPE, text=True
)
base = server.stdout.readline().split(" at ")[1].strip()
driver = subprocess.run(
    ["node", ROOT / "xtask/clients/drive_page.mjs", MODULES, base, WORK], capture_output=True, text=True, timeout=1500
)
if driver.returncode != 0:
    print(driver.stdout, driver.stderr)
checks.equal("the page is driven to the end", driver.returncode, 0)
found = json.loads(driver.stdout.splitlines()[-1])


def picture(name):
    """The part of a screenshot with the map, in numbers from 0 to 255."""
    return numpy.asarray(Image.open(WORK / f"{name}.png").convert("RGB").crop(MAP), dtype=float)


checks.equal("nothing goes wrong, and no other host is asked", found["wrong"], [])
checks.equal("the title", found["title"], "alpine")

# What the map shows is what it has shown before: means of 10 x 10 pixels, because software and drivers differ.
for name in ("start", "flat", "contours", "layer"):
    shown = Image.fromarray(picture(name).astype("uint8")).resize((57, 50), Image.BOX)
    kept = REFERENCES / f"{name}.png"
    if not kept.exists():
        REFERENCES.mkdir(exist_ok=True)
        shown.save(kept, optimize=True)
        checks.that(f"{name}: a reference is kept", False, f"(made now; look at {kept}, and commit it)")
        continue
    apart = numpy.abs(numpy.asarray(shown, dtype=float) - numpy.asarray(Image.open(kept).convert("RGB"), dtype=float))
    checks.that(f"{name}: the picture that is kept", apart.mean() < 4 and (apart > 40).mean() < 0.02, (apart.mean(), apart.max()))
flat, sun, grey = picture("flat"), picture("sun"), picture("palette")
checks.that("a sun from the other side shades other slopes", numpy.corrcoef(flat.ravel(), sun.ravel())[0, 1] < 0.9)
colored, plain = [numpy.abs(shown[..., 0] - shown[..., 2])[150:350, 150:400].mean() for shown in (flat, grey)]
checks.that("the palette is grey, but for water", plain < 0.8 * colored, (plain, colored))

# Heights, places and profiles are those of the server.
height = float(re.search(r"([\d,.]+) m$", found["here"]).group(1).replace(",", ""))
checks.that("the height under the pointer is one of the world", 500 < height < 5000, found["here"])
checks.equal("five summits are found", len(found["places"]), 5)
heights = [float(re.search(r"height ([\d,.]+) m", place).group(1).replace(",", "")) for place in found["places"]]
checks.that("the highest summit comes first", heights == sorted(heights, reverse=True), heights)
checks.that("a profile has its words", re.match(r"[\d.,]+ k?m, lowest [\d.,]+ m, highest [\d.,]+ m", found["profile"]), found["profile"])

# Downloads.
geotiff, mesh, array = found["files"]
with rasterio.open(geotiff) as file:
    samples = file.read(1)
checks.equal("a GeoTIFF of 256 samples", max(samples.shape), 256)
checks.that("an array has the same samples", numpy.array_equal(numpy.load(array), samples))
scene = trimesh.load(mesh)
checks.that("a mesh has the relief", 0.9 * numpy.ptp(samples) < scene.bounding_box.extents[1] < 1.2 * numpy.ptp(samples))
checks.that("the picture of the map is not empty", numpy.asarray(Image.open(WORK / "picture.png").convert("L"), dtype=float).std() > 10)

# Links, languages, keys, phones.
checks.equal("a link shows the same", found["again"], found["link"])
checks.that("the page is in Chinese", "地图" in found["chinese"] and "剖面" in found["chinese"], found["chinese"])
checks.that("keys read out the middle of the map", "地图中心" in found["spoken"], found["spoken"])
checks.equal("a key leads to the search", found["focus"], "question")
checks.that("the panel of a phone is closed at first", found["hidden"])
checks.equal("a phone in Chinese", found["language"], "zh-CN")

server.send_signal(signal.SIGTERM)
checks.equal("the server ends", server.wait(30), 0)
checks.end()
