"""Opens the window of the studio on a display without a screen, in both languages, and looks at its picture."""

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


def look(name, language, arguments, seconds):
    """Opens the window until its picture is there; returns the picture."""
    settings = WORK / name / "orogen"
    settings.mkdir(parents=True, exist_ok=True)
    (settings / "studio.json").write_text(f'{{"language": "{language}", "theme": "dark", "window": [{SIZE[0]}, {SIZE[1]}]}}')
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

# A lost graphics device: the text that was not saved is in the window of the next run, in the same process.
settings = WORK / "loss" / "orogen"
settings.mkdir(parents=True, exist_ok=True)
(settings / "studio.json").write_text('{"language": "en"}')
screen, server = display()
environment = {**os.environ, "DISPLAY": screen, "XDG_CONFIG_HOME": str(WORK / "loss"), "XDG_RUNTIME_DIR": str(WORK)}
environment.pop("WAYLAND_DISPLAY", None)
text = "orogen = 1\n\n[world]\ncell = 10\nsize = 2000\n\n[nodes.land]\nop = \"fbm\"\n\n[outputs]\nheight = \"land\"\n"
(settings / "studio-unsaved.toml").write_text("# unsaved: precious\n" + text)
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
    checks.that("a lost device: the text is kept", text in (settings / "studio-unsaved.toml").read_text())
finally:
    for process in studio, server:
        process.terminate()
        process.wait(20)

# Without a display it says what is missing.
without = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
failed = subprocess.run([STUDIO], env=without, capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
checks.that("without a display it fails", failed.returncode != 0)
checks.that("without a display it says what to do", b"cannot open a window" in failed.stderr)

checks.end()
