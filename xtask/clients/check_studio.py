"""Opens the window of the studio on a display without a screen, in both languages, and looks at its picture."""

import json
import os
import subprocess
import time
from pathlib import Path

import numpy
from orogen import WORK, Checks
from window import SIZE, STUDIO, Display, Window, environment, until

checks = Checks()


def look(name, language, arguments, seconds, recent=()):
    """Opens the window until its picture is there; returns the picture."""
    display = Display()
    own = environment(WORK / name, display)
    remember(name, {"language": language, "theme": "dark", "window": SIZE, "recent": recent})
    window = Window(display, own, arguments)
    colors = lambda: len(numpy.unique(display.pixels((200, 150, 600, 300)).reshape(-1, 3), axis=0))
    try:
        until(lambda: not window.is_running() or colors() >= 2000, seconds, 0.5)
        checks.that(f"{name}: it runs", window.is_running())
        # The finest picture may still be on its way.
        time.sleep(3)
        found = colors()
        display.picture().save(WORK / f"{name}.png")
        checks.that(f"{name}: the land is drawn ({found} colors)", found >= 2000)
        return display.pixels()
    finally:
        window.end()
        display.end()


def remember(name, settings):
    """Writes the settings of a window."""
    folder = WORK / name / "orogen"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "studio.json").write_text(json.dumps(settings))
    return folder


english = look("english", "en", ["volcano"], 300)
chinese = look("chinese", "zh-CN", ["volcano"], 300)
# The labels differ, and the land between them does not.
bar = numpy.abs(english[:24].astype(int) - chinese[:24]).max()
checks.that("the menus are in two languages", bar > 60)
start = look("start", "en", [], 300)
checks.that("the start page has pictures", len(numpy.unique(start.reshape(-1, 3), axis=0)) > 5000)
# Letters that no font has are drawn as boxes; Chinese names of files are letters, also in the English interface.
names = [look(f"name-{n}", "en", [], 300, [f"/lands/{name}.toml"]) for n, name in enumerate(("山水", "\ue000\ue000"))]
checks.that("Chinese names are letters, not boxes", (names[0][100:150, :400] != names[1][100:150, :400]).any())

# A lost graphics device: the text that was not saved is in the window of the next run, in the same process.
settings = remember("loss", {"language": "en"})
display = Display()
text = "orogen = 1\n\n[world]\ncell = 10\nsize = 2000\n\n[nodes.land]\nop = \"fbm\"\n\n[outputs]\nheight = \"land\"\n"
kept = settings / "unsaved" / "1.toml"
kept.parent.mkdir(exist_ok=True)
kept.write_text('# unsaved: {"title": "precious", "path": null, "folder": null}\n' + text)
own = environment(WORK / "loss", display)
window = Window(display, own, ["classic", "--lose-device", "3"], errors=subprocess.DEVNULL)
try:
    line = lambda: Path(f"/proc/{window.process.pid}/cmdline").read_bytes()
    again = until(lambda: not window.is_running() or b"--after-loss" in line(), pause=0.5)
    checks.that("a lost device: the studio starts again", again and window.is_running())
    time.sleep(4)
    checks.that("a lost device: the studio stays open", window.is_running())
    checks.that("a lost device: the text is kept", text in kept.read_text())
finally:
    window.end()
    display.end()

# The clipboard is that of the system, in both directions.
folder = WORK / "clipboard"
remember("clipboard", {"language": "en", "window": SIZE})
recipe = folder / "land.toml"
recipe.write_text(text)
display = Display()
own = environment(folder, display)
window = Window(display, own, [recipe])


def clipboard():
    found = subprocess.run(
        ["xclip", "-out", "-selection", "clipboard"], env=own, capture_output=True, text=True, timeout=20,
    )
    return found.stdout


def keys(*keys):
    window.keys(*keys)
    time.sleep(0.5)


try:
    window.focus()
    time.sleep(3)
    # The text of the recipe is at the bottom.
    window.point((640, 200))
    keys("ctrl+4")
    # A slow window may not take a short press for a click, so it is done again.
    for _ in range(5):
        window.click((400, 640))
        time.sleep(0.5)
        keys("ctrl+a", "ctrl+c")
        if until(lambda: clipboard() == text, 10):
            break
    checks.that("a copied text reaches other programs", clipboard() == text)
    other = text.replace("cell = 10", "cell = 20")
    subprocess.run(["xclip", "-in", "-selection", "clipboard"], env=own, input=other, text=True, check=True)
    keys("ctrl+a", "ctrl+v")
    keys("ctrl+s")
    checks.that("a text of another program is pasted", until(lambda: recipe.read_text() == other, 60))
finally:
    display.picture().save(WORK / "clipboard.png")
    window.end()
    display.end()

# Without a display it says what is missing.
without = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
failed = subprocess.run([STUDIO], env=without, capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
checks.that("without a display it fails", failed.returncode != 0)
checks.that("without a display it says what to do", b"cannot open a window" in failed.stderr)

checks.end()
