"""What the checks share: asking orogen for files, and counting what was found."""

import json
import os
import subprocess
import sys
from pathlib import Path

BINARY = os.environ["OROGEN"]
ROOT = Path(os.environ["OROGEN_ROOT"])
WORK = Path(os.environ["OROGEN_WORK"])
NODE_BIN = Path(os.environ["OROGEN_NODE_BIN"])


def orogen(*arguments):
    """Runs the command and ends the check if it fails."""
    line = [BINARY, *map(str, arguments)]
    done = subprocess.run(line, cwd=WORK, capture_output=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"orogen {' '.join(line[1:])} ended with {done.returncode}:\n{done.stderr.decode()}")
    return done.stdout


def generate(recipe, *options):
    """Generates into a folder of its own; returns the folder and its summary."""
    folder = WORK / Path(recipe).stem
    orogen("generate", recipe, "-o", folder, "--quiet", *options)
    return folder, json.loads((folder / "summary.json").read_text())


def export(recipe, name, *options):
    """Exports one layer into a file of this name; returns its path."""
    path = WORK / name
    orogen("export", recipe, "-o", path, *options)
    return path


def build(recipe, name, *options):
    """Builds into a file or folder of this name; returns its path."""
    path = WORK / name
    orogen("build", recipe, "-o", path, "--quiet", *options)
    return path


class Checks:
    """Counts what holds; says what does not."""

    def __init__(self):
        self.passed = 0
        self.failed = 0

    def that(self, what, holds, found=""):
        """A statement that must hold."""
        if holds:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAILED: {what} {found}")

    def equal(self, what, got, expected):
        """Two values that must be equal."""
        self.that(what, got == expected, f"(got {got}, expected {expected})")

    def near(self, what, got, expected, tolerance):
        """Two numbers that may differ by no more than the tolerance."""
        self.that(what, abs(got - expected) <= tolerance, f"(got {got}, expected {expected} within {tolerance})")

    def end(self):
        """Prints the count and leaves with its verdict."""
        print(f"{self.passed} passed, {self.failed} failed")
        sys.exit(1 if self.failed or not self.passed else 0)
