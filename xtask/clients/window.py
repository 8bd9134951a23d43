"""Helpers of the checks of the studio: its window on a display without a screen, the mouse, keys, and pictures."""

import os
import subprocess
import time
import tomllib
from pathlib import Path

import numpy
from accessible import ENABLED, FOCUSED, Control
from orogen import BINARY, ROOT, WORK
from PIL import ImageGrab

STUDIO = Path(BINARY).parent.parent / "debug" / "orogen-studio"
SIZE = (1280, 800)
# A limit for what a busy machine may need; nothing waits longer than until its condition holds.
PATIENCE = 300
TRIES = 15


def until(holds, seconds=PATIENCE, pause=0.1):
    """Waits until a condition holds; returns its last value."""
    end = time.monotonic() + seconds
    while not (found := holds()) and time.monotonic() < end:
        time.sleep(pause)
    return found


class Texts:
    """The texts of the interface in a language, by key."""

    def __init__(self, language):
        locales = ROOT / "crates/orogen-studio/locales"
        self.tables = tomllib.loads((locales / f"{language}.toml").read_text())
        # The English of what other crates declare is its own key.
        declared = locales / f"declared.{language}.toml"
        self.declared = tomllib.loads(declared.read_text()) if declared.is_file() else {}

    def __call__(self, key, **values):
        section, name = key.split(".")
        text = self.tables[section][name]
        for value, shown in values.items():
            text = text.replace(f"{{{value}}}", str(shown))
        return text

    def named(self, name):
        """The name of a declared op, parameter, preset or palette."""
        return self.declared.get("names", {}).get(name, name)


class Display:
    """A display without a screen."""

    def __init__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            # Without -noreset it starts again when its last client leaves, and refuses the next one meanwhile.
            ["Xvfb", "-noreset", "-displayfd", str(write), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"],
            pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = f":{pipe.readline().strip()}"

    def picture(self):
        """What it shows."""
        return ImageGrab.grab(xdisplay=self.name).convert("RGB")

    def pixels(self, place=None):
        """What it shows, or a part of it: left, top, width, height."""
        pixels = numpy.array(self.picture())
        if place is None:
            return pixels
        left, top, width, height = place
        return pixels[top:top + height, left:left + width]

    def end(self):
        self.server.terminate()
        self.server.wait(20)


def environment(folder, display):
    """The environment of a window whose settings are in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    settings = folder / "orogen" / "studio.json"
    if not settings.exists():
        # A desktop portal, where there is one, would show its own dialogs.
        settings.parent.mkdir(exist_ok=True)
        settings.write_text('{"has_system_dialogs": false}')
    own = {**os.environ, "DISPLAY": display.name, "XDG_CONFIG_HOME": str(folder), "XDG_RUNTIME_DIR": str(folder)}
    own.pop("WAYLAND_DISPLAY", None)
    return own


class Window:
    """The studio, used by the mouse and the keyboard."""

    def __init__(self, display, own, arguments=(), bus=None, folder=WORK, errors=None):
        self.display, self.environment, self.bus = display, own, bus
        self.process = subprocess.Popen(
            [STUDIO, *arguments], env=own, cwd=folder, stdin=subprocess.DEVNULL, stderr=errors,
        )
        self.id = None

    def is_running(self):
        return self.process.poll() is None

    def is_busy(self):
        """Whether one of its threads runs."""
        states = []
        for thread in Path(f"/proc/{self.process.pid}/task").glob("*/stat"):
            try:
                states.append(thread.read_text().rpartition(")")[2].split()[0])
            except FileNotFoundError:
                # It has ended.
                continue
        return any(state in "RD" for state in states)

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)

    def focus(self):
        """Waits for the window, and gives it the keyboard: no window manager does."""
        search = ["xdotool", "search", "--onlyvisible", "--pid", str(self.process.pid), "--name", "Orogen"]
        find = lambda: subprocess.run(search, env=self.environment, capture_output=True, text=True).stdout.split()
        found = until(lambda: not self.is_running() or find())
        if not isinstance(found, list):
            raise LookupError("there is no window")
        self.id = found[0]
        self.xdotool("windowfocus", "--sync", self.id)

    def title(self):
        return subprocess.run(
            ["xdotool", "getwindowname", self.id], env=self.environment, capture_output=True, text=True,
        ).stdout.strip()

    def keys(self, *keys):
        """Presses keys, one combination after the other."""
        self.xdotool("key", "--delay", 40, *keys)

    def type(self, text):
        self.xdotool("type", "--delay", 15, text)

    def point(self, place):
        self.xdotool("mousemove", *place)

    def click(self, place, times=1, button=1):
        self.xdotool("mousemove", *place, "sleep", 0.05, "click", "--repeat", times, "--delay", 60, button)

    def drag(self, *places, until_seen=None, button=1):
        """Moves the mouse from place to place with a pressed button, which is released once the effect is seen: a slow
        window may get all of the movement at once."""
        words = ["mousemove", *places[0], "sleep", 0.1, "mousedown", button]
        for (x, y), (to_x, to_y) in zip(places, places[1:]):
            for step in range(1, 9):
                words += ["sleep", 0.03, "mousemove", x + (to_x - x) * step // 8, y + (to_y - y) * step // 8]
        self.xdotool(*words)
        seen = until(until_seen) if until_seen else None
        self.xdotool("mouseup", button)
        return seen

    def controls(self):
        """All controls, as a screen reader finds them."""
        window = self.bus.window(self.process.pid)
        return list(window.all()) if window else []

    def find(self, name, role=None, where=None):
        """The first usable control with a name, and a role; None if there is none."""
        for control in self.controls():
            if control.name == name and control.place and control.has(ENABLED) and role in (None, control.role):
                if where is None or where(control):
                    return control
        return None

    def control(self, name, role=None, where=None):
        """Waits for a control."""
        found = until(lambda: not self.is_running() or self.find(name, role, where))
        if not isinstance(found, Control):
            raise LookupError(f"there is no {role or 'control'} {name!r}")
        return found

    def press(self, name, role=None, where=None, seen=None):
        """Clicks a control where it stands still: dialogs are placed when their size is known. Clicks again, where it
        is then, if no effect is seen for long: where a picture takes a second, a press and its release are no click,
        and a dialog may get another size late."""
        for _ in range(TRIES):
            control = self.control(name, role, where)
            while (again := self.control(name, role, where)).place != control.place:
                control = again
            self.click(control.middle)
            if seen is None or until(seen, PATIENCE / TRIES):
                return True
        return False

    def click_until(self, place, seen=None):
        """Clicks a place until an effect is seen."""
        for _ in range(TRIES):
            self.click(place)
            if seen is None or until(seen, PATIENCE / TRIES):
                return True
        return False

    def has_focus(self, name):
        """Whether a field has the keyboard."""
        return self.find(name, "text", lambda field: field.has(FOCUSED))

    def end(self):
        if self.is_running():
            self.process.terminate()
        self.process.wait(20)
