"""Helpers of the checks: run orogen, and count results."""

import json
import os
import subprocess
import sys
from pathlib import Path

BINARY = os.environ["OROGEN"]
# The client whose step runs the script.
CLIENT = os.environ["OROGEN_CLIENT"]
ROOT = Path(os.environ["OROGEN_ROOT"])
WORK = Path(os.environ["OROGEN_WORK"])
NODE_BIN = Path(os.environ["OROGEN_NODE_BIN"])


def orogen(*arguments):
    """Runs the command; ends the check if it fails."""
    line = [BINARY, *map(str, arguments)]
    done = subprocess.run(line, cwd=WORK, capture_output=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"orogen {' '.join(line[1:])} ended with {done.returncode}:\n{done.stderr.decode()}")
    return done.stdout


def generate(recipe, *options):
    """Runs `generate` into a new folder; returns the folder and its summary."""
    folder = WORK / Path(recipe).stem
    orogen("generate", recipe, "-o", folder, "--quiet", *options)
    return folder, json.loads((folder / "summary.json").read_text())


def export(recipe, name, *options):
    """Exports one layer to a file of this name; returns its path."""
    path = WORK / name
    orogen("export", recipe, "-o", path, *options)
    return path


def build(recipe, name, *options):
    """Builds into a file or folder of this name; returns its path."""
    path = WORK / name
    orogen("build", recipe, "-o", path, "--quiet", *options)
    return path


class Checks:
    """Counts passed checks and prints failed ones."""

    def __init__(self):
        self.passed = 0
        self.failed = 0

    def that(self, what, holds, found=""):
        """Checks that a statement is true."""
        if holds:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAILED: {what} {found}")

    def equal(self, what, got, expected):
        """Checks that two values are equal."""
        self.that(what, got == expected, f"(got {got}, expected {expected})")

    def near(self, what, got, expected, tolerance):
        """Checks that two numbers differ by at most the tolerance."""
        self.that(what, abs(got - expected) <= tolerance, f"(got {got}, expected {expected} within {tolerance})")

    def end(self):
        """Prints the count and exits with 0 if all checks passed."""
        print(f"{self.passed} passed, {self.failed} failed")
        sys.exit(1 if self.failed or not self.passed else 0)
