"""Commands on a graphics card, on a card that is not there, and without any driver: the processor always stands in."""

import json
import os
import subprocess
from pathlib import Path

import numpy
from orogen import BINARY, WORK, Checks
from PIL import Image

checks = Checks()
# Built with graphics cards, which the release under test is not.
OROGEN = Path(BINARY).parent.parent / "debug" / "orogen"
WITHOUT_DRIVERS = {**os.environ, "VK_DRIVER_FILES": "/nonexistent", "VK_ICD_FILENAMES": "/nonexistent"}


def run(*arguments, program=OROGEN, env=None):
    """Runs the command; returns its output and its messages."""
    line = [program, *map(str, arguments)]
    done = subprocess.run(line, cwd=WORK, capture_output=True, stdin=subprocess.DEVNULL, env=env)
    checks.equal(f"{' '.join(line[1:])} ends well", done.returncode, 0)
    if done.returncode != 0:
        print(done.stderr.decode())
    # The loader of Vulkan may have messages of its own.
    messages = [line for line in done.stderr.decode().splitlines() if "XDG_RUNTIME_DIR" not in line]
    return done.stdout.decode(), messages


def heights(folder):
    """The heights in metres, and the summary."""
    summary = json.loads((WORK / folder / "summary.json").read_text())
    grey = numpy.asarray(Image.open(WORK / folder / "height.png"), dtype=numpy.float64) / 65535
    low, high = summary["height_min"], summary["height_max"]
    return low + grey * (high - low), summary


devices = json.loads(run("devices", "--json")[0])
checks.that("there is an adapter", len(devices) > 0)
checks.that("an adapter can be used", any(device["refused"] is None for device in devices), devices)
checks.that("its buffers have a size", all(device["buffer_bytes"] >= 128 << 20 for device in devices), devices)
checks.that("the list names it", devices[0]["name"] in run("devices")[0])

def similarity(a, b):
    """The structural similarity of two pictures (Wang et al. 2004), by windows of 8 x 8 pixels."""
    def windows(picture):
        grey = numpy.asarray(Image.open(picture).convert("L"), dtype=numpy.float64)
        height, width = (side // 8 * 8 for side in grey.shape)
        return grey[:height, :width].reshape(height // 8, 8, width // 8, 8).swapaxes(1, 2).reshape(-1, 64)

    x, y = windows(a), windows(b)
    mx, my = x.mean(1), y.mean(1)
    covariance = ((x - mx[:, None]) * (y - my[:, None])).mean(1)
    one, two = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    return float((((2 * mx * my + one) * (2 * covariance + two)) / ((mx**2 + my**2 + one) * (x.var(1) + y.var(1) + two))).mean())


# The land of each, as a share of its relief. Where levels decide by the last digits, single slopes differ by more: one
# sample in ten thousand. Where waves work, a cliff may be one sample further: one sample in a thousand.
LANDS = [("island", 2e-4, 0.999), ("mesa", 2e-4, 1), ("archipelago", 2e-4, 0.999), ("alpine", 5e-4, 0.9999)]
for recipe, share, samples in LANDS:
    arguments = ["generate", recipe, "--size", "256", "--quiet"]
    _, exact_messages = run(*arguments, "-o", f"{recipe}-cpu")
    _, messages = run(*arguments, "-o", f"{recipe}-gpu", "--device", "gpu")
    checks.equal(f"{recipe}: nothing stands in", messages, [])
    (exact, summary), (preview, _) = heights(f"{recipe}-cpu"), heights(f"{recipe}-gpu")
    relief = summary["height_max"] - summary["height_min"]
    apart = float(numpy.quantile(abs(preview - exact), samples))
    checks.that(f"{recipe}: the preview is close", apart < share * relief, apart)

    alike = similarity(WORK / f"{recipe}-cpu" / "map.png", WORK / f"{recipe}-gpu" / "map.png")
    checks.that(f"{recipe}: the maps look the same", alike >= 0.98, alike)

GROWING = """orogen = 1
[world]
size = [7680, 7680]
cell = 60
[nodes.hills]
op = "fbm"
wavelength = 6000
[nodes.land]
op = "remap"
source = "hills"
from = [-1, 1]
to = [0, 600]
[nodes.rivers]
op = "stream-power"
source = "land"
cell = 240
[nodes.valleys]
op = "amplify"
source = "rivers"
flow = "rivers.flow"
cell = 60
halvings = 2
[outputs]
height = "valleys"
"""
(WORK / "growing.toml").write_text(GROWING)
for device in ["cpu", "gpu"]:
    run("grow", "growing.toml", "--frames", "3", "--quiet", "-o", f"grow-{device}-%d.png", "--device", device)
for k in range(3):
    alike = similarity(WORK / f"grow-cpu-{k}.png", WORK / f"grow-gpu-{k}.png")
    checks.that(f"frame {k} of growth looks the same", alike >= 0.98, alike)

for device in ["cpu", "gpu"]:
    run("render", "mesa", "--size", "320x180", "--samples", "2", "--quiet", "-o", f"{device}.png", "--device", device)
alike = similarity(WORK / "cpu.png", WORK / "gpu.png")
checks.that("renders look the same", alike >= 0.98, alike)

_, messages = run("generate", "mesa", "--size", "512", "--quiet", "-o", "limited", "--device", "gpu", "--memory", "256MiB")
checks.equal("a card works within a memory limit", messages, [])

text, _ = run("generate", "island", "--size", "64", "-o", "told", "--device", "gpu")
checks.that("the summary names the card", "preview" in text and devices[0]["name"] in text, text)

for what, arguments, env in [
    ("no such card", ["--device", "gpu:no such card"], None),
    ("no driver", ["--device", "gpu"], WITHOUT_DRIVERS),
]:
    folder = what.replace(" ", "-")
    _, messages = run("generate", "island", "--size", "256", "--quiet", "-o", folder, *arguments, env=env)
    checks.equal(f"{what}: one line says so", [len(messages), messages[0].endswith("the processor computes instead")], [1, True])
    same = (WORK / folder / "height.png").read_bytes() == (WORK / "island-cpu" / "height.png").read_bytes()
    checks.that(f"{what}: the heights are those of the processor", same)
_, messages = run("generate", "island", "--size", "64", "--quiet", "-o", "auto", "--device", "auto", env=WITHOUT_DRIVERS)
checks.equal("auto says nothing without a card", messages, [])
checks.that("devices says that there is none", "no graphics card" in run("devices", env=WITHOUT_DRIVERS)[0])

# The release under test is built without graphics cards.
checks.that("it says so", "built without" in run("devices", program=BINARY)[0])
_, messages = run("generate", "island", "--size", "64", "--quiet", "-o", "without", "--device", "gpu", program=BINARY)
checks.that("the processor stands in for it", len(messages) == 1 and "--features gpu" in messages[0], messages)

checks.end()
