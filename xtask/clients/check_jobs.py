"""Does eleven jobs in the window of the studio with mouse and keyboard, like a new user, in both languages."""

import re
import signal
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy
import rasterio
from accessible import FOCUSED, Bus
from orogen import WORK, Checks, orogen
from PIL import Image
from window import Display, Texts, Window, environment, until

checks = Checks()
LANGUAGES = {"en": "en_US.UTF-8", "zh-CN": "zh_CN.UTF-8"}
RECIPE = """orogen = 1

[world]
seed = 5
size = 6400
cell = 12.5

# Crests of noise.
[nodes.noise]
op = "ridged"
wavelength = 3200
octaves = 7

[nodes.land]
op = "remap"
source = "noise"
to = [-200, 900]

[outputs]
height = "land"
"""


class User:
    """A new user with a window in a language."""

    def __init__(self, language):
        self.language, self.text = language, Texts(language)
        # Pictures for the docs show no path of this machine.
        self.temporary = TemporaryDirectory(prefix="lands-")
        self.folder = Path(self.temporary.name)
        self.window = None
        self.display = Display()
        self.environment = environment(self.folder / "settings", self.display)
        self.environment["LC_ALL"] = LANGUAGES[language]
        self.bus = Bus(self.environment)
        self.recipe = self.folder / "land.toml"
        self.recipe.write_text(RECIPE)

    def start(self):
        self.window = Window(self.display, self.environment, bus=self.bus, folder=self.folder)
        self.window.focus()

    def end(self):
        for one in self.window, self.bus, self.display:
            if one:
                one.end()
        self.temporary.cleanup()

    def that(self, what, holds, found=""):
        checks.that(f"{self.language}: {what}", holds, found)

    def unsaved(self):
        """The text that is kept for a recovery; None if all is saved."""
        for file in sorted((self.folder / "settings/orogen/unsaved").glob("*.toml")):
            return file.read_text().split("\n", 1)[1]
        return None

    def text_with(self, what, holds):
        """Waits until a condition on the text holds that is not saved yet."""
        text = until(lambda: (text := self.unsaved()) is not None and holds(text) and text)
        self.that(what, bool(text), self.unsaved())
        return text or ""

    def has_title(self, title):
        self.that(f"the title is {title}", until(lambda: self.window.title() == title), self.window.title())

    def done(self):
        """Waits until the finest picture is there, and drawn."""
        made = re.escape(self.text("status.made")).replace(r"\{samples\}", r"(\d+)").replace(r"\{seconds\}", ".*")
        draft = self.text("analysis.draft")

        def is_done():
            labels = [control.name for control in self.window.controls() if control.role == "label"]
            return draft not in labels and any(
                (found := re.fullmatch(made, label)) and int(found[1]) >= 512 for label in labels
            )

        self.that("the finest picture", until(is_done))
        self.settled()

    def settled(self):
        """Waits until nothing is drawn any more: only pictures for readers need it."""
        pictures = [None] * 4

        def is_still():
            pictures[:] = [*pictures[1:], None if self.window.is_busy() else self.display.pixels()]
            return all(one is not None and (one == pictures[0]).all() for one in pictures)

        until(is_still, 20)

    def changes(self, what, place, act):
        """Does something that changes a part of the picture."""
        before = self.display.pixels(place)
        act()
        self.that(f"{what}: the picture changes", until(lambda: self.differs(place, before)))

    def differs(self, place, before):
        """Whether a part of the picture is another one."""
        return (self.display.pixels(place) != before).mean() > 0.01

    def keep(self, job):
        """Keeps the picture of a job, which `cargo xtask gallery studio` takes for the docs."""
        self.display.picture().save(WORK / f"{job}.{self.language}.webp", quality=80, method=6)

    # The jobs, in the order in which they are done.

    def open(self):
        """A preset by a click on the start page, then a file by its name."""
        window, text = self.window, self.text
        preset = window.control(text("spoken.preset", name=text.named("alpine")), "button")
        self.changes("a preset under the pointer", preset.place, lambda: window.point(preset.middle))
        self.settled()
        self.keep("open")
        window.press(preset.name, "button", seen=lambda: window.title().startswith("alpine"))
        self.has_title("alpine – Orogen")
        self.done()
        land = window.control(text("spoken.relief")).place
        colors = len(numpy.unique(self.display.pixels(land).reshape(-1, 3), axis=0))
        self.that(f"the preset is drawn ({colors} colors)", colors >= 2000)
        window.keys("ctrl+o")
        until(lambda: window.has_focus(text("spoken.file_name")))
        window.type(self.recipe)
        window.keys("Return")
        self.has_title("land – Orogen")
        self.done()

    def look(self):
        """The view from another side, nearer, without panels, and as a map."""
        window, text = self.window, self.text
        land = window.control(text("spoken.relief"))
        x, y = land.middle
        before = self.display.pixels(land.place)
        turned = window.drag((x, y), (x + 120, y - 30), until_seen=lambda: self.differs(land.place, before))
        self.that("a drag turns the view", turned)
        self.settled()
        self.changes("the wheel zooms", land.place, lambda: window.click((x, y), times=3, button=4))
        for key, name in ("F6", text("spoken.graph")), ("F7", text("command.next_seed")):
            window.keys(key)
            self.that(f"{key} hides {name}", until(lambda: not window.find(name)))
        wide = window.control(text("spoken.relief")).place
        self.that("the view is larger", wide[2] > land.place[2] + 200 and wide[3] > land.place[3] + 200, wide)
        self.done()
        self.keep("look")
        window.keys("ctrl+2")
        window.control(text("spoken.map"))
        window.keys("F11", "ctrl+1")
        window.control(text("spoken.graph"))
        window.control(text("command.next_seed"))

    def change(self):
        """A slider of the parameters, undone and redone."""
        window, text = self.window, self.text
        name = "noise." + text.named("wavelength")
        window.press(text("spoken.node", name="noise"), "button", seen=lambda: window.find(name))
        slider = window.control(name, "slider")
        left, top, width, height = slider.place
        land = window.control(text("spoken.relief")).place
        middle = top + height // 2
        before = self.display.pixels(land)
        is_wider = lambda own: nodes(own)["noise"]["wavelength"] > 3300
        ends = (left + width // 2, middle), (left + width * 11 // 20, middle)
        window.drag(*ends, until_seen=lambda: is_wider(self.unsaved() or RECIPE))
        self.text_with("the wavelength changes", is_wider)
        self.that("the picture changes", until(lambda: self.differs(land, before)))
        self.done()
        changed = self.unsaved()
        self.that("all else stays", re.sub("wavelength = .*", "wavelength = 3200", changed) == RECIPE, changed)
        self.keep("change")
        window.keys("ctrl+z")
        self.that("it is undone", until(lambda: self.unsaved() is None))
        self.has_title("land – Orogen")
        window.keys("ctrl+y")
        self.text_with("it is redone", lambda own: own == changed)

    def add(self):
        """A node from the search, after the end: it becomes the terrain."""
        window, text = self.window, self.text
        name = "land." + text.named("to")
        window.press(text("spoken.node", name="land"), "button", seen=lambda: window.find(name))
        window.keys("ctrl+space")
        is_field = lambda one: one.role == "text" and one.has(FOCUSED)
        self.that("the search has the keyboard", until(lambda: any(map(is_field, window.controls()))))
        window.type("stream")
        entry = text.named("stream-power")
        window.control(entry, "button")
        self.settled()
        self.keep("add")
        window.press(entry, "button", seen=lambda: len(nodes(self.unsaved())) == 3)
        added = self.text_with("the node is added", lambda own: len(nodes(own)) == 3)
        name, node = end(added)
        self.that("it is the terrain", node == {"op": "stream-power", "source": "land", **node}, added)
        self.done()

    def mend(self):
        """A broken text, its message, and the text mended."""
        window, text = self.window, self.text
        before = self.unsaved()
        window.keys("ctrl+4")
        left, top, _, height = window.control(text("spoken.recipe"), "text").place
        lines = before.split("\n")
        line = lines.index('op = "ridged"')
        # Behind the end of the line.
        behind = left + 300, top + height * (2 * line + 1) // (2 * len(lines))
        window.click_until(behind, lambda: window.has_focus(text("spoken.recipe")))
        window.keys("BackSpace", "BackSpace", "quotedbl")
        self.text_with("the text is broken", lambda own: 'op = "ridge"' in own)
        begin = f"{line + 1}: "
        is_message = lambda one: one.name.startswith(begin) and "ridged" in one.name
        message = until(lambda: [one.name for one in window.controls() if is_message(one)])
        self.that("the message names the line, and what was meant", message)
        window.control(text("status.invalid"), "label")
        self.settled()
        self.keep("mend")
        window.keys("BackSpace", "d", "quotedbl")
        self.text_with("the text is mended", lambda own: own == before)
        self.that("the message is gone", until(lambda: not window.find(text("status.invalid"))))
        self.done()

    def draw(self):
        """A line and an area on the map; the area raises the land."""
        window, text = self.window, self.text
        window.keys("ctrl+2", "ctrl+3")
        left, top, width, height = window.control(text("spoken.map")).place
        x, y = left + width // 2, top + height // 2
        window.press(text("tool.path"), "button", seen=lambda: window.find(text("tool.draw_help")))
        clicks = [(x - 120, y + 60), (x - 40, y - 40), (x + 60, y + 20), (x + 120, y - 60)]
        self.corners(clicks)
        window.press(text("drawing.alone"), "button", seen=lambda: ops(self.unsaved(), "path"))
        drawn = self.text_with("a line is drawn", lambda own: ops(own, "path"))
        points = numpy.array(ops(drawn, "path")[0]["points"], float)
        scales = numpy.diff(points, axis=0) / numpy.diff(numpy.array(clicks), axis=0)
        self.that("the line is where it was drawn", scales.min() > 0 and numpy.ptp(scales) < 0.5, points)
        window.press(text("tool.polygon"), "button", seen=lambda: window.find(text("tool.draw_help")))
        self.corners([(x - 60, y - 60), (x + 60, y - 80), (x + 80, y + 60), (x - 80, y + 70)])
        window.control(text("drawing.raise"), "button")
        self.settled()
        self.keep("draw")
        window.press(text("drawing.raise"), "button", seen=lambda: ops(self.unsaved(), "polygon"))
        area = self.text_with("an area is drawn", lambda own: ops(own, "polygon"))
        self.that("it has four points", len(ops(area, "polygon")[0]["points"]) == 4, area)
        name, node = end(area)
        self.that("it raises the land", node["op"] == "add" and node["b"] > 0 and node["mask"] in nodes(area), area)
        self.done()

    def corners(self, places):
        """Draws points, each once the one before is on the map."""
        # What is drawn later, such as the end of the drawing before, is no point.
        self.settled()
        for x, y in places:
            around = (x - 6, y - 6, 12, 12)
            before = self.display.pixels(around)
            is_seen = self.window.click_until((x, y), lambda: self.differs(around, before))
            self.that("a point of the drawing is seen", is_seen)
        self.window.keys("Return")

    def paint(self):
        """A stroke of a brush that raises the land."""
        window, text = self.window, self.text
        before = self.unsaved()
        left, top, width, height = window.control(text("spoken.map")).place
        x, y = left + width // 2, top + height // 2
        window.press(text("tool.raise"), "button", seen=lambda: window.find(text("tool.radius"), "slider"))
        stroke = (x - 100, y + 40), (x, y - 20), (x + 90, y + 40)
        window.drag(*stroke, until_seen=lambda: ops(self.unsaved(), "paint"))
        painted = self.text_with("a stroke is painted", lambda own: ops(own, "paint"))
        self.done()
        self.keep("paint")
        painted = self.unsaved()
        self.that("it is between the land and the output", end(painted)[1]["op"] == "paint", painted)
        rise = self.heights(painted, "after") - self.heights(before, "before")
        self.that("the stroke raises the land", rise.max() > 10 and rise.min() > -0.01, (rise.min(), rise.max()))
        self.that("the rest stays", 0.02 < (rise > 0.01).mean() < 0.6, (rise > 0.01).mean())

    def vary(self):
        """One of several seeds."""
        window, text = self.window, self.text
        before = tomllib.loads(self.unsaved())
        window.keys("ctrl+6", "ctrl+1")
        value = before["world"]["seed"] + 3
        variant = window.control(text("spoken.variant", value=value), "button")
        self.that("its picture", until(lambda: self.display.pixels(variant.place).std() > 10))
        self.done()
        self.keep("vary")
        before["world"]["seed"] = value
        is_taken = lambda own: tomllib.loads(own) == before
        window.press(variant.name, "button", seen=lambda: is_taken(self.unsaved()))
        self.text_with("the seed changes, and nothing else", is_taken)
        window.keys("ctrl+3")
        self.done()

    def export(self):
        """A GeoTIFF and a picture, which are those of the command line."""
        window, text = self.window, self.text
        recipe = self.folder / "exported.toml"
        recipe.write_text(self.unsaved())
        window.keys("ctrl+e")
        for name in "land.tif", "land.png":
            file = self.folder / name
            field = text("spoken.export_file")
            window.press(field, "text", seen=lambda: window.has_focus(field))
            window.keys("ctrl+a")
            # The window runs in this folder.
            window.type(name)
            done = text("export.done", file=name, what="")
            made = lambda: [one.name for one in window.controls() if one.name.startswith(done)]
            window.press(text("export.start"), "button", seen=made)
            self.that(f"{name}: it says what it made", made())
            own = self.folder / f"own-{name}"
            orogen("export", recipe, "-o", own)
            self.that(f"{name}: the bytes of the command line", file.read_bytes() == own.read_bytes())
        self.settled()
        self.keep("export")
        with rasterio.open(self.folder / "land.tif") as tif, Image.open(self.folder / "land.png") as png:
            heights = tif.read(1)
            self.that("rasterio and Pillow read as many samples", heights.shape == (png.height, png.width))
            gray = numpy.array(png, float)
            ends = numpy.array([heights.min(), heights.max()])
            low, high = gray.min(), gray.max()
            back = ends[0] + (gray - low) / (high - low) * (ends[1] - ends[0])
            self.that("both have the same heights", numpy.abs(back - heights).max() < 0.1, (low, high, ends))
        window.keys("Escape")
        until(lambda: not window.find(text("spoken.export_file")))

    def save(self):
        """Under the name of a file that exists, after a question."""
        window, text = self.window, self.text
        mine = self.folder / "mine.toml"
        mine.write_text("precious = true\n")
        own = self.unsaved()
        window.keys("ctrl+shift+s")
        until(lambda: window.has_focus(text("spoken.file_name")))
        window.keys("ctrl+a")
        window.type(mine)
        window.keys("Return")
        window.control(text("overwrite.replace"), "button")
        self.settled()
        self.keep("save")
        is_asked = lambda: window.find(text("overwrite.replace"), "button")
        window.press(text("overwrite.keep"), "button", seen=lambda: not is_asked())
        self.that("nothing is replaced before", mine.read_text() == "precious = true\n")
        window.press(text("file.choose"), "button", seen=is_asked)
        window.press(text("overwrite.replace"), "button", seen=lambda: mine.read_text() == own)
        self.that("it is saved", until(lambda: mine.read_text() == own), mine.read_text())
        self.has_title("mine – Orogen")
        self.that("nothing is left to recover", until(lambda: self.unsaved() is None))

    def recover(self):
        """What was not saved when the window was killed."""
        window, text = self.window, self.text
        mine = self.folder / "mine.toml"
        seed = tomllib.loads(mine.read_text())["world"]["seed"]
        window.keys("ctrl+r")
        own = self.text_with("a change", lambda own: tomllib.loads(own)["world"]["seed"] == seed + 1)
        self.done()
        window.process.send_signal(signal.SIGKILL)
        window.process.wait(20)
        self.start()
        window = self.window
        window.control(text("spoken.open", name="mine"), "button")
        self.settled()
        self.keep("recover")
        offer = text("spoken.open", name="mine")
        window.press(offer, "button", seen=lambda: window.title().startswith("*mine"))
        self.has_title("*mine – Orogen")
        self.that("the text is still kept", self.unsaved() == own)
        self.done()
        window.keys("ctrl+s")
        self.that("it is saved", until(lambda: mine.read_text() == own), mine.read_text())

    def heights(self, recipe, name):
        """The heights of a recipe, by the command line."""
        file = self.folder / f"{name}.toml"
        file.write_text(recipe)
        orogen("export", file, "-o", file.with_suffix(".npy"))
        return numpy.load(file.with_suffix(".npy"))


def nodes(recipe):
    return tomllib.loads(recipe)["nodes"]


def ops(recipe, op):
    """The nodes of an op."""
    return [node for node in nodes(recipe).values() if node["op"] == op]


def end(recipe):
    """The node that is the terrain, and its name."""
    name = tomllib.loads(recipe)["outputs"]["height"]
    return name, nodes(recipe)[name]


JOBS = ["open", "look", "change", "add", "mend", "draw", "paint", "vary", "export", "save", "recover"]


def use(language):
    """Does all jobs in a language."""
    user = User(language)
    job = "start"
    try:
        user.start()
        for job in JOBS:
            getattr(user, job)()
    except Exception as error:
        user.keep("failed")
        user.that(f"{job}: it goes on", False, f"{type(error).__name__}: {error}")
    finally:
        user.end()


with ThreadPoolExecutor() as pool:
    list(pool.map(use, LANGUAGES))
checks.end()
