"""Checks map sheets: Poppler and librsvg render PDF and SVG to the same picture as the .png of the sheet."""

import re
import subprocess

import numpy
from orogen import ROOT, WORK, Checks, orogen
from PIL import Image

checks = Checks()
DPI = 110


def pixels(path):
    """Returns a picture as an array of values from 0 to 255."""
    return numpy.asarray(Image.open(path).convert("RGB"), dtype=float)


def difference(a, b):
    """Returns the mean difference of two pictures of one size, and the largest mean of all squares of 16 pixels."""
    height, width = (min(a.shape[k], b.shape[k]) for k in (0, 1))
    apart = numpy.abs(a[:height, :width] - b[:height, :width]).mean(axis=2)
    squares = apart[: height // 16 * 16, : width // 16 * 16].reshape(height // 16, 16, width // 16, 16).mean(axis=(1, 3))
    return apart.mean(), squares.max()


for name, recipe, options in [
    ("alpine", "alpine", ("--cell", 120)),
    ("archipelago", "archipelago", ("--cell", 160, "--shade", "swiss", "--palette", "oleron")),
    ("bands", "island", ("--cell", 80, "--palette", "bands", "--landscape")),
]:
    paths = {kind: WORK / f"{name}.{kind}" for kind in ("png", "svg", "pdf")}
    for path in paths.values():
        orogen("map", recipe, "-o", path, "--paper", "a4", "--dpi", DPI, "--title", f"{name} & Höhen", "--quiet", *options)
    drawn = {"svg": WORK / f"{name}_svg.png", "pdf": WORK / f"{name}_pdf.png"}
    subprocess.run(["rsvg-convert", "-d", str(DPI), "-p", str(DPI), paths["svg"], "-o", drawn["svg"]], check=True)
    subprocess.run(["pdftoppm", "-r", str(DPI), "-png", "-singlefile", paths["pdf"], drawn["pdf"].with_suffix("")], check=True)
    ours = pixels(paths["png"])
    for kind, path in drawn.items():
        theirs = pixels(path)
        sizes = max(abs(a - b) for a, b in zip(ours.shape[:2], theirs.shape[:2]))
        checks.that(f"{name}: the .{kind} is as large as the .png", sizes <= 2, f"({ours.shape} and {theirs.shape})")
        mean, worst = difference(ours, theirs)
        print(f"{name}: the .{kind} differs from the .png by {mean:.2f} of 255 on average, {worst:.1f} in the worst square")
        checks.that(f"{name}: the .{kind} looks like the .png", mean < 2.5 and worst < 30.0)
        # The comparison must fail for a mirrored picture.
        checks.that(f"{name}: the mirrored .{kind} is another", difference(ours, theirs[:, ::-1])[0] > 8.0)
    info = subprocess.run(["pdfinfo", paths["pdf"]], capture_output=True, text=True)
    checks.that(f"{name}: pdfinfo finds nothing wrong", info.returncode == 0 and not info.stderr, info.stderr)
    checks.that(f"{name}: with its title", f"{name} & Höhen" in info.stdout)
    checks.that(f"{name}: on A4", "(A4)" in info.stdout)

# Print resolution: more than 10 MB, above the size limit of libxml2 for one element.
large = WORK / "large.svg"
orogen("map", "alpine", "-o", large, "--quiet")
text = large.read_text()
longest = max(map(len, re.findall(r'"([^"]*)"', text)))
print(f"large: {len(text) / 1e6:.1f} MB, longest attribute {longest / 1e6:.2f} MB")
checks.that("large: an SVG of more than 10 MB", len(text) > 10e6)
checks.that("large: no attribute is longer than 1 MiB", longest < 1 << 20, f"({longest})")
done = subprocess.run(["rsvg-convert", large, "-o", WORK / "large_svg.png"], capture_output=True, text=True)
checks.that("large: rsvg-convert draws it without --unlimited", done.returncode == 0, done.stderr)
orogen("map", "alpine", "-o", WORK / "large.png", "--dpi", 96, "--quiet")
mean, worst = difference(pixels(WORK / "large.png"), pixels(WORK / "large_svg.png"))
print(f"large: the .svg differs from the .png by {mean:.2f} of 255 on average, {worst:.1f} in the worst square")
checks.that("large: the .svg looks like the .png", mean < 4.0 and worst < 40.0)

damaged = WORK / "damaged.pdf"
damaged.write_bytes((WORK / "alpine.pdf").read_bytes()[:2000])
done = subprocess.run(["pdfinfo", damaged], capture_output=True, text=True)
checks.that("a PDF cut short is refused", done.returncode != 0)
damaged = WORK / "damaged.svg"
damaged.write_bytes((WORK / "alpine.svg").read_bytes()[:20000])
done = subprocess.run(["rsvg-convert", damaged, "-o", WORK / "damaged.png"], capture_output=True, text=True)
checks.that("an SVG cut short is refused", done.returncode != 0)

checks.end()
