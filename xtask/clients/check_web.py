"""Opens the studio as a page in Chromium: the land, changes, both languages, files in and out, no other host; with one
thread and with several; with WebGL 2 and with WebGPU."""

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

HEAVY = RECIPE.replace(
    "[outputs]",
    """[nodes.range]
op = "stream-power"
source = "land"

[outputs]""",
).replace('height = "land"', 'height = "range"')

# The page and recipes on one host.
site = WORK / "site"
shutil.copytree(os.environ["OROGEN_WEB"], site / "studio")
(site / "recipes").mkdir()
(site / "recipes" / "land.toml").write_text(RECIPE)
(site / "recipes" / "heavy.toml").write_text(HEAVY)
(WORK / "other.toml").write_text(RECIPE.replace("seed = 3", "seed = 4"))


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Serves the folder without a log."""

    def log_message(self, *_):
        pass


class Isolating(Quiet):
    """Serves it with the headers that isolate its pages from those of other hosts."""

    def end_headers(self):
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        super().end_headers()


def serve(handler):
    """A server of the site, and its host."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(handler, directory=site))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server, f"127.0.0.1:{server.server_address[1]}"


(plain, plain_host), (isolated, isolated_host) = serve(Quiet), serve(Isolating)
addresses = [f"http://{host}/" for host in (plain_host, isolated_host)]
line = ["node", ROOT / "xtask/clients/drive_web.mjs", *addresses, WORK, NODE_BIN.parent]
said = json.loads(subprocess.run(line, check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout)
plain.shutdown()
isolated.shutdown()


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
checks.equal("no other host", hosts, {plain_host, isolated_host})
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

# With threads.
single, threads, web_gpu = (said["pages"].get(name, {}) for name in ("single", "threads", "webGpu"))
modules = {
    host: {url.path for url in map(urlsplit, said["requests"]) if url.netloc == host and url.path.endswith(".wasm.gz")}
    for host in (plain_host, isolated_host)
}
checks.equal("the module of a page", modules[plain_host], {"/studio/studio_bg.wasm.gz"})
checks.equal("the module of an isolated page", modules[isolated_host], {"/studio/threads/studio_bg.wasm.gz"})
checks.equal("isolated pages", [single.get("isIsolated"), threads.get("isIsolated")], [False, True])
# Two workers at most, each with its threads; the second may just be starting its own.
cores = threads.get("cores", 1)
each = 1 + (min(cores, 16) if cores > 1 else 0)
checks.that("workers without threads", single.get("workers") in (1, 2), single)
checks.that("workers with threads", each <= threads.get("workers", 0) <= 2 * each, threads)
changed = said["workers"].get("changed")
checks.that("changes replace no worker", changed in (each, 2 * each), changed)
checks.that("changes are made with threads", texts.get("heavy", "") not in ("", texts.get("heavyBefore")))
checks.that("an export with threads is downloaded", (WORK / "heavy.tif").is_file(), said["downloads"])
if (WORK / "heavy.tif").is_file():
    (WORK / "heavy.toml").write_text(texts["heavy"])
    native = export("heavy.toml", "heavy-native.tif")
    checks.that("it has the bytes of the command line", native.read_bytes() == (WORK / "heavy.tif").read_bytes())

# With WebGPU.
checks.equal("graphics", [single.get("isWebGpu"), threads.get("isWebGpu"), web_gpu.get("isWebGpu")], [False, False, True])
difference = numpy.abs(picture("english") - picture("webgpu"))
checks.that("WebGPU draws the window of WebGL", difference.mean() < 2, difference.mean())

for name in ("english", "slider", "node", "chinese", "other", "threads", "webgpu"):
    checks.that(f"{name}: the land is drawn", colors(name, 180, 480, 250, 710) > 2000)
checks.that("the slider changes the land", numpy.abs(picture("english") - picture("slider"))[180:480, 250:710].mean() > 2)
checks.that("the menus are in two languages", numpy.abs(picture("english") - picture("chinese"))[:24].max() > 60)
# Boxes in place of characters have few shades and the same picture each.
checks.that("Chinese characters are drawn", colors("chinese", 0, 24, 0, 160) > 30)
checks.that("a wrong address is said in the window", numpy.abs(picture("wrong") - picture("chinese")).mean() > 2)
checks.end()
