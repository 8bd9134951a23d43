"""Opens the studio as a page in Chromium: the land, changes, both languages, files in and out, no other host."""

import functools
import http.server
import json
import os
import shutil
import subprocess
import threading
from urllib.parse import urlsplit

import numpy
from orogen import NODE_BIN, ROOT, WORK, Checks, export
from PIL import Image

checks = Checks()
RECIPE = """orogen = 1

[parameters]
relief = { default = 0.5, range = [0, 1] }

[world]
seed = 3
size = 10240
cell = 20
sea_level = 0

[nodes.noise]
op = "ridged"
wavelength = 4000
octaves = 7

[nodes.land]
op = "expr"
expr = "noise * (200 + 600 * relief) + 150"

[outputs]
height = "land"
"""

# The page and a recipe on one host.
site = WORK / "site"
shutil.copytree(os.environ["OROGEN_WEB"], site / "studio")
(site / "recipes").mkdir()
(site / "recipes" / "land.toml").write_text(RECIPE)
(WORK / "other.toml").write_text(RECIPE.replace("seed = 3", "seed = 4"))


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Serves the folder without a log."""

    def log_message(self, *_):
        pass


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=site))
threading.Thread(target=server.serve_forever, daemon=True).start()
host = f"127.0.0.1:{server.server_address[1]}"
line = ["node", ROOT / "xtask/clients/drive_web.mjs", f"http://{host}/", WORK, NODE_BIN.parent]
said = json.loads(subprocess.run(line, check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout)
server.shutdown()


def picture(name):
    """A picture of the window."""
    return numpy.asarray(Image.open(WORK / f"{name}.png").convert("RGB")).astype(int)


def colors(name, top, bottom, left, right):
    """The number of different colors in a part of a picture."""
    return len(numpy.unique(picture(name)[top:bottom, left:right].reshape(-1, 3), axis=0))


# The one missing file is asked for on purpose.
errors = [error for error in said["errors"] if "404" not in error]
checks.that("no errors", not errors, errors)
hosts = {urlsplit(url).netloc for url in said["requests"] if not url.startswith(("data:", "blob:"))}
checks.equal("no other host", hosts, {host})
texts = said["texts"]
checks.that("a slider changes the recipe", "relief = { default = 0.5," not in texts.get("slider", "relief = { default = 0.5,"))
checks.that("a node is added", 'op = "terrace"' in texts.get("node", ""))
checks.that("the recipe is saved in the browser", 'op = "terrace"' in (texts.get("saved") or ""))
checks.equal("and there in another page", texts.get("kept"), texts.get("saved"))
checks.equal("a file of the computer", texts.get("other"), (WORK / "other.toml").read_text())
checks.that("a download is what was saved", (WORK / "mine.toml").is_file() and (WORK / "mine.toml").read_text() == texts.get("saved"))

# The bits of the page are those of the command line.
checks.that("an export is downloaded", (WORK / "mine.tif").is_file(), said["downloads"])
if (WORK / "mine.tif").is_file():
    native = export("mine.toml", "native.tif")
    checks.that("an export has the bytes of the command line", native.read_bytes() == (WORK / "mine.tif").read_bytes())

for name in ("english", "slider", "node", "chinese", "other"):
    checks.that(f"{name}: the land is drawn", colors(name, 180, 480, 250, 710) > 2000)
checks.that("the slider changes the land", numpy.abs(picture("english") - picture("slider"))[180:480, 250:710].mean() > 2)
checks.that("the menus are in two languages", numpy.abs(picture("english") - picture("chinese"))[:24].max() > 60)
# Boxes in place of characters have few shades and the same picture each.
checks.that("Chinese characters are drawn", colors("chinese", 0, 24, 0, 160) > 30)
checks.that("a wrong address is said in the window", numpy.abs(picture("wrong") - picture("chinese")).mean() > 2)
checks.end()
