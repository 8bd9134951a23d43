"""Checks raster exports with OpenEXR, GDAL, rasterio, Pillow and Godot: the samples of the .npy, in the same orientation and position."""

import json
import subprocess
import warnings

import numpy
import OpenEXR
import rasterio
from orogen import ROOT, WORK, Checks, export
from PIL import Image
from rasterio.errors import NotGeoreferencedWarning, RasterioIOError

warnings.simplefilter("ignore", NotGeoreferencedWarning)
checks = Checks()
BUMP = ROOT / "xtask/clients/plane_bump.toml"
WINDOW = ("--window", "0,0,230,150")

heights = numpy.load(export(BUMP, "all.npy", *WINDOW))
checks.equal("size", heights.shape, (150, 230))
# An asymmetric test terrain: a bump around column 60, row 40, on a plane that rises to the east and falls to the south.
bump = heights - (numpy.arange(230) * 5 / 4 - numpy.arange(150)[:, None] * 5 / 32)
checks.equal("the bump is in the north-west", tuple(int(k) for k in numpy.unravel_index(bump.argmax(), bump.shape)), (40, 60))


def same_bits(a, b):
    """Compares bit for bit."""
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def exr(path):
    """Returns the channels of an EXR picture by name."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels.copy() for name, channel in file.channels().items()}


def noticed(what, damaged, read):
    """Checks that a damaged file is either rejected or read with other contents."""
    try:
        found = read(damaged)
    except (RuntimeError, OSError, RasterioIOError, ValueError, SyntaxError):
        found = False
    checks.that(f"a damaged {what} is noticed", not found)


def damage(path, change):
    """Writes a copy with changed bytes."""
    broken = path.with_name("broken-" + path.name)
    content = bytearray(path.read_bytes())
    broken.write_bytes(bytes(change(content)))
    return broken


def flipped(content):
    """Flips one bit at three quarters of the file."""
    content[3 * len(content) // 4] ^= 0x10
    return content


# OpenEXR: exact 32-bit floats, 16-bit floats rounded to nearest, three channels, normals of length 1.
path = export(BUMP, "float.exr", *WINDOW)
channels = exr(path)
checks.equal("exr: one channel", list(channels), ["Y"])
checks.that("exr: bit-equal to the .npy", same_bits(channels["Y"], heights))
with OpenEXR.File(str(path)) as file:
    header = file.header()
    checks.equal("exr: ZIP", header["compression"], OpenEXR.ZIP_COMPRESSION)
    checks.equal("exr: scan lines, increasing", header["lineOrder"], OpenEXR.INCREASING_Y)
noticed("EXR", damage(path, flipped), lambda path: same_bits(exr(path)["Y"], heights))
noticed("half of an EXR", damage(path, lambda content: content[: len(content) // 2]), lambda path: same_bits(exr(path)["Y"], heights))
channels = exr(export(BUMP, "half.exr", "--half", *WINDOW))
checks.that("exr: halves to nearest", same_bits(channels["Y"], heights.astype("f2")))
channels = exr(export(BUMP, "rgb.exr", "--rgb", *WINDOW))
checks.equal("exr: three channels", sorted(channels), ["B", "G", "R"])
checks.that("exr: the same in each", all(same_bits(channel, heights) for channel in channels.values()))
channels = exr(export(BUMP, "normal.exr", "--layer", "normal", *WINDOW))
length = numpy.sqrt(sum(channels[part].astype("f8") ** 2 for part in "XYZ"))
checks.that("exr: normals have length 1", float(numpy.abs(length - 1).max()) < 1e-6)
checks.that("exr: the plane faces west and a little south", -0.25 < channels["X"][120, 200] < -0.23 and -0.04 < channels["Y"][120, 200] < -0.02)

# ESRI ASCII grid: every number and its position.
path = export(BUMP, "grid.asc", *WINDOW)
with rasterio.open(path) as grid:
    checks.equal("asc: driver", grid.driver, "AAIGrid")
    checks.that("asc: bit-equal to the .npy", same_bits(grid.read(1), heights))
    for row, column in [(0, 0), (149, 0), (40, 60)]:
        checks.equal(f"asc: place of {column}, {row}", tuple(map(float, grid.xy(row, column))), (5.0 * column, -5.0 * row))


def read_grid(path):
    """Checks that rasterio reads the exact samples."""
    with rasterio.open(path) as grid:
        return same_bits(grid.read(1), heights)


noticed("ASCII grid", damage(path, lambda content: content.replace(b" 7", b" 8", 1)), read_grid)

# Integer levels: PGM and PNG with 16 and 8 bits, raw files as described by their sidecar.
low, high = numpy.float64(heights.min()), numpy.float64(heights.max())


def levels(most):
    """Returns the expected levels of heights."""
    return numpy.floor((heights.astype("f8") - low) / (high - low) * most + 0.5)


for name, most, options in [
    ("grey.pgm", 65535, ()),
    ("grey8.pgm", 255, ("--bits", 8)),
    ("grey.png", 65535, ()),
    ("grey8.png", 255, ("--bits", 8)),
]:
    path = export(BUMP, name, *WINDOW, *options)
    with rasterio.open(path) as grid:
        checks.equal(f"{name}: samples", grid.dtypes, ("uint16" if most > 255 else "uint8",))
        checks.that(f"{name}: the levels of the .npy", numpy.array_equal(grid.read(1), levels(most)))
    told = json.loads(subprocess.run(["gdalinfo", "-json", path], capture_output=True, check=True).stdout)
    checks.equal(f"{name}: GDAL's size", told["size"], [230, 150])
    asked = subprocess.run(["gdallocationinfo", "-valonly", path, "60", "40"], capture_output=True, check=True)
    checks.equal(f"{name}: GDAL at 60, 40", int(asked.stdout), int(levels(most)[40, 60]))


def read_levels(path):
    """Checks that rasterio reads the exact levels."""
    with rasterio.open(path) as grid:
        return numpy.array_equal(grid.read(1), levels(65535))


noticed("PNG", damage(WORK / "grey.png", flipped), read_levels)
noticed("PGM", damage(WORK / "grey.pgm", flipped), read_levels)

for name, options in [("raw.r16", ()), ("south.r16", ("--first-row", "south")), ("raw.r32", ())]:
    path = export(BUMP, name, *WINDOW, *options)
    told = json.loads(path.with_suffix(".json").read_text() if name != "raw.r32" else (WORK / "raw.r32.json").read_text())
    samples = numpy.fromfile(path, {"u16": "<u2", "f32": "<f4"}[told["sample"]]).reshape(told["height"], told["width"])
    samples = samples[::-1] if told["first_row"] == "south" else samples
    if told["sample"] == "u16":
        checks.that(f"{name}: levels", numpy.array_equal(samples, levels(65535)))
        checks.near(f"{name}: what 65535 is", told["high"], high, 1e-4)
    else:
        checks.that(f"{name}: bit-equal to the .npy", same_bits(numpy.ascontiguousarray(samples), heights))
    checks.equal(f"{name}: the cell", told["cell"], 5.0)

for name, scale in [("terrarium", (256.0, 1.0, 1 / 256.0, -32768.0)), ("terrain-rgb", (6553.6, 25.6, 0.1, -10000.0))]:
    with Image.open(export(BUMP, f"{name}.png", "--encoding", name, *WINDOW)) as picture:
        rgb = numpy.asarray(picture).astype("f8")
    found = rgb[..., 0] * scale[0] + rgb[..., 1] * scale[1] + rgb[..., 2] * scale[2] + scale[3]
    checks.that(f"{name}: to half a step", float(numpy.abs(found - heights).max()) <= 0.501 * scale[2])

# SRTM: whole metres, halves rounded away from zero, positioned by the corner in the file name.
square = ("--cell", 0.5, "--window", "0,0,1201,1201")
fine = numpy.load(export(BUMP, "square.npy", *square)).astype("f8")
path = export(BUMP, "N46E007.hgt", *square)
with rasterio.open(path) as grid:
    checks.equal("hgt: driver", grid.driver, "SRTMHGT")
    whole = numpy.sign(fine) * numpy.floor(numpy.abs(fine) + 0.5)
    checks.that("hgt: whole metres", numpy.array_equal(grid.read(1), whole))
    corner = grid.xy(1200, 0)
    checks.that("hgt: its south-west corner", abs(corner[0] - 7) < 1e-9 and abs(corner[1] - 46) < 1e-9, corner)
noticed("half of an .hgt", damage(path, lambda content: content[: len(content) // 2]), lambda path: rasterio.open(path).read(1).size)

# The weights of both pictures add up to 255.
export(BUMP, "splat.png", "--layer", "splat", *WINDOW)
total = sum(numpy.asarray(Image.open(WORK / name)).astype(int).sum(axis=2) for name in ("splat.png", "splat_2.png"))
checks.equal("splat: sums", (int(total.min()), int(total.max())), (255, 255))

# Unreal's and Unity's formulas with the numbers of the sidecar only.
told = json.loads(export(BUMP, "unreal.png", "--target", "unreal", "--size", 127, "--cell", 5).with_suffix(".json").read_text())
near = heights[:127, :127].astype("f8")
values = numpy.asarray(Image.open(WORK / "unreal.png")).astype("f8")
z_scale = -told["low"] / 256 * 100
checks.near("unreal: whole Z scale", z_scale, round(z_scale), 1e-4)
found = (values - 32768) / 128 * z_scale / 100
checks.that("unreal: heights by its formula", float(numpy.abs(found - near).max()) <= 0.51 * z_scale / 12800)
told = json.loads(export(BUMP, "unity.r16", "--target", "unity", "--size", 129, "--cell", 5).with_suffix(".json").read_text())
found = numpy.fromfile(WORK / "unity.r16", "<u2").reshape(129, 129)[::-1] / 65535.0 * (told["high"] - told["low"]) + told["low"]
checks.that("unity: heights, rows from the south", float(numpy.abs(found - heights[:129, :129]).max()) <= 0.51 * (high - low) / 65535)

# Godot 3 opens the files; it reads PNG as 8 bits and EXR as 16-bit floats.
(WORK / "project.godot").write_text("config_version=4\n")
(WORK / "look.gd").write_text(
    """extends SceneTree

func _init():
    for name in ["grey.png", "float.exr", "half.exr", "rgb.exr", "broken-float.exr"]:
        var image = Image.new()
        var fault = image.load("%s/" + name)
        if fault == OK:
            image.lock()
            print("%s ", name, " ", image.get_width(), " ", image.get_height(), " ", image.get_pixel(60, 40).r, " ", image.get_pixel(160, 40).r)
        else:
            print("%s ", name, " fault")
    quit()
"""
    % (WORK, "LOOK", "LOOK")
)
damage(WORK / "float.exr", lambda content: content[:100])
said = subprocess.run(
    ["godot3-server", "--path", WORK, "-s", "look.gd"], capture_output=True, text=True, timeout=120, env={"HOME": str(WORK), "PATH": "/usr/bin:/bin:/usr/games"}
)
seen = {words[1]: words[2:] for words in (line.split() for line in said.stdout.splitlines()) if words[:1] == ["LOOK"]}
for name, expect, tolerance in [
    ("grey.png", [levels(255)[40, 60] / 255, levels(255)[40, 160] / 255], 0.01),
    ("float.exr", [heights[40, 60], heights[40, 160]], 0.25),
    ("half.exr", [heights[40, 60], heights[40, 160]], 0.25),
    ("rgb.exr", [heights[40, 60], heights[40, 160]], 0.25),
]:
    found = seen.get(name, [])
    checks.equal(f"Godot, {name}: size", found[:2], ["230", "150"])
    if len(found) == 4:
        for k in range(2):
            checks.near(f"Godot, {name}: sample {k}", float(found[2 + k]), float(expect[k]), tolerance)
checks.that("Godot: a damaged EXR is noticed", seen.get("broken-float.exr", ["?"])[0] == "fault", seen.get("broken-float.exr"))

checks.end()
