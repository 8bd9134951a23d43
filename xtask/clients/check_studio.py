"""Opens the window of the studio on a display without a screen, in both languages, and looks at its picture."""

import json
import os
import subprocess
import time
from pathlib import Path

import numpy
from orogen import BINARY, WORK, Checks
from PIL import ImageGrab

checks = Checks()
STUDIO = Path(BINARY).parent.parent / "debug" / "orogen-studio"
SIZE = (1280, 800)


def display():
    """Starts a display; returns its name and its process."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"],
        pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as pipe:
        return f":{pipe.readline().strip()}", server


def look(name, language, arguments, seconds, recent=()):
    """Opens the window until its picture is there; returns the picture."""
    settings = WORK / name / "orogen"
    settings.mkdir(parents=True, exist_ok=True)
    remembered = {"language": language, "theme": "dark", "window": SIZE, "recent": recent}
    (settings / "studio.json").write_text(json.dumps(remembered))
    screen, server = display()
    environment = {**os.environ, "DISPLAY": screen, "XDG_CONFIG_HOME": str(WORK / name), "XDG_RUNTIME_DIR": str(WORK)}
    environment.pop("WAYLAND_DISPLAY", None)
    studio = subprocess.Popen([STUDIO, *arguments], env=environment, stdin=subprocess.DEVNULL)
    try:
        end = time.monotonic() + seconds
        colors = 0
        while time.monotonic() < end and colors < 2000:
            time.sleep(0.5)
            if studio.poll() is not None:
                break
            picture = numpy.array(ImageGrab.grab(xdisplay=screen).convert("RGB"))
            middle = picture[150:450, 200:800].reshape(-1, 3)
            colors = len(numpy.unique(middle, axis=0))
        checks.that(f"{name}: it runs", studio.poll() is None)
        # The finest picture may still be on its way.
        time.sleep(3)
        grabbed = ImageGrab.grab(xdisplay=screen)
        grabbed.save(WORK / f"{name}.png")
        checks.that(f"{name}: the land is drawn ({colors} colors)", colors >= 2000)
        return numpy.array(grabbed.convert("RGB"))
    finally:
        for process in studio, server:
            process.terminate()
            process.wait(20)


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
settings = WORK / "loss" / "orogen"
settings.mkdir(parents=True, exist_ok=True)
(settings / "studio.json").write_text('{"language": "en"}')
screen, server = display()
environment = {**os.environ, "DISPLAY": screen, "XDG_CONFIG_HOME": str(WORK / "loss"), "XDG_RUNTIME_DIR": str(WORK)}
environment.pop("WAYLAND_DISPLAY", None)
text = "orogen = 1\n\n[world]\ncell = 10\nsize = 2000\n\n[nodes.land]\nop = \"fbm\"\n\n[outputs]\nheight = \"land\"\n"
kept = settings / "unsaved" / "1.toml"
kept.parent.mkdir(exist_ok=True)
kept.write_text('# unsaved: {"title": "precious", "path": null, "folder": null}\n' + text)
studio = subprocess.Popen(
    [STUDIO, "classic", "--lose-device", "3"], env=environment, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
)
try:
    end = time.monotonic() + 300
    again = b""
    while time.monotonic() < end and studio.poll() is None and b"--after-loss" not in again:
        time.sleep(0.5)
        again = Path(f"/proc/{studio.pid}/cmdline").read_bytes()
    checks.that("a lost device: the studio starts again", b"--after-loss" in again and studio.poll() is None)
    time.sleep(4)
    checks.that("a lost device: the studio stays open", studio.poll() is None)
    checks.that("a lost device: the text is kept", text in kept.read_text())
finally:
    for process in studio, server:
        process.terminate()
        process.wait(20)

# The clipboard is that of the system, in both directions.
folder = WORK / "clipboard"
(folder / "orogen").mkdir(parents=True, exist_ok=True)
(folder / "orogen" / "studio.json").write_text(f'{{"language": "en", "window": [{SIZE[0]}, {SIZE[1]}]}}')
recipe = folder / "land.toml"
recipe.write_text(text)
screen, server = display()
environment = {**os.environ, "DISPLAY": screen, "XDG_CONFIG_HOME": str(folder), "XDG_RUNTIME_DIR": str(WORK)}
environment.pop("WAYLAND_DISPLAY", None)
studio = subprocess.Popen([STUDIO, recipe], env=environment, stdin=subprocess.DEVNULL)


def keys(*words):
    subprocess.run(["xdotool", *words], env=environment, check=True)
    time.sleep(0.5)


def until(holds, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end and not holds():
        time.sleep(0.5)
    return holds()


def clipboard():
    found = subprocess.run(
        ["xclip", "-out", "-selection", "clipboard"], env=environment, capture_output=True, text=True, timeout=20,
    )
    return found.stdout


try:
    found = ["xdotool", "search", "--onlyvisible", "--name", "Orogen"]
    until(lambda: subprocess.run(found, env=environment, capture_output=True).returncode == 0, 300)
    window = subprocess.run(found, env=environment, capture_output=True, text=True).stdout.split()[0]
    time.sleep(3)
    keys("windowfocus", window)
    # The text of the recipe is at the bottom.
    keys("mousemove", "--window", window, "640", "200", "key", "ctrl+4")
    keys("mousemove", "--window", window, "400", "640", "click", "1")
    keys("key", "ctrl+a", "key", "ctrl+c")
    checks.that("a copied text reaches other programs", until(lambda: clipboard() == text))
    other = text.replace("cell = 10", "cell = 20")
    subprocess.run(["xclip", "-in", "-selection", "clipboard"], env=environment, input=other, text=True, check=True)
    keys("key", "ctrl+a", "key", "ctrl+v")
    keys("key", "ctrl+s")
    checks.that("a text of another program is pasted", until(lambda: recipe.read_text() == other))
finally:
    ImageGrab.grab(xdisplay=screen).save(WORK / "clipboard.png")
    for process in studio, server:
        process.terminate()
        process.wait(20)

# Without a display it says what is missing.
without = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
failed = subprocess.run([STUDIO], env=without, capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
checks.that("without a display it fails", failed.returncode != 0)
checks.that("without a display it says what to do", b"cannot open a window" in failed.stderr)

checks.end()
