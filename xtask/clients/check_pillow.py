"""Checks pictures with Pillow: grey values match the heights of the summary, water covers heights below the sea, animations move."""

import numpy
from orogen import ROOT, WORK, Checks, export, generate, orogen
from PIL import Image

checks = Checks()
SIZE = 256


def pixels(path, mode, shape):
    """Returns the picture as an array if it has this mode and size."""
    with Image.open(path) as image:
        image.load()
        checks.equal(f"{path.name}: format", image.format, "PNG")
        checks.equal(f"{path.name}: mode", image.mode, mode)
        checks.equal(f"{path.name}: size", image.size, (shape[1], shape[0]))
        return numpy.asarray(image)


def check_greys(name, grey, top, heights, summary):
    """Grey 0 is height_min and the maximum grey is height_max; values in between are within half a step."""
    low, span = summary["height_min"], summary["height_max"] - summary["height_min"]
    step = span / top
    checks.equal(f"{name}: black and white are both there", (int(grey.min()), int(grey.max())), (0, top))
    off = float(numpy.abs(low + grey.astype("f8") * step - heights).max())
    # The tolerance is half a step plus the rounding of f32 heights of this magnitude.
    bound = 0.5 * step + 1e-6 * max(abs(low), abs(low + span))
    checks.that(f"{name}: heights within half a step", off <= bound, f"(off by {off}, allowed {bound})")


for preset in ("alpine", "island"):
    folder, summary = generate(preset, "--size", SIZE)
    shape = (summary["height"], summary["width"])
    window = f"0,0,{summary['width']},{summary['height']}"
    options = ("--cell", summary["cell"], "--window", window)
    heights = numpy.load(export(preset, f"{preset}.npy", *options)).astype("f8")

    fine = pixels(folder / "height.png", "I;16", shape)
    check_greys(f"{preset} height.png", fine, 65535, heights, summary)
    coarse = pixels(folder / "height8.png", "L", shape)
    check_greys(f"{preset} height8.png", coarse, 255, heights, summary)
    colors = pixels(folder / "map.png", "RGB", shape).astype("i4")

    # Water is where blue is above red. Up to 2 % of the pixels may differ at the shore.
    blue = colors[..., 2] > colors[..., 0]
    lakes = numpy.load(export(preset, f"{preset}-lakes.npy", "--layer", "lakes", *options)) > 0.0
    sea = float((blue & ~lakes).mean())
    checks.near(f"{preset} map.png: sea and land are told apart", 1.0 - sea, summary["land_share"], 0.02)
    checks.that(f"{preset} map.png: lakes are blue", bool(blue[lakes].all()))

    exported = pixels(export(preset, f"{preset}-export.png", *options), "I;16", shape).astype("f8")
    likeness = float(numpy.corrcoef(exported.ravel(), heights.ravel())[0, 1])
    checks.that(f"{preset}: an exported PNG shows the heights", likeness > 0.9999, f"(correlation {likeness})")

# A plane that rises to the east and falls to the south: the top right corner is the brightest, the bottom left the darkest.
folder, summary = generate(ROOT / "xtask/clients/plane.toml")
shape = (summary["height"], summary["width"])
for name, mode in (("height.png", "I;16"), ("height8.png", "L")):
    grey = pixels(folder / name, mode, shape)
    corners = [int(grey[0, -1]), int(grey[-1, 0])]
    checks.equal(f"plane {name}: corners", corners, [65535, 0] if mode == "I;16" else [255, 0])
    checks.that(f"plane {name}: rises east", bool((numpy.diff(grey.astype("i4"), axis=1) > 0).all()))
    checks.that(f"plane {name}: falls south", bool((numpy.diff(grey.astype("i4"), axis=0) < 0).all()))

def frames(path):
    """Returns every frame as an array, and its duration."""
    with Image.open(path) as image:
        pictures, delays = [], []
        for frame in range(image.n_frames):
            image.seek(frame)
            pictures.append(numpy.asarray(image.convert("RGB")).astype("i4"))
            delays.append(image.info.get("duration"))
        return pictures, delays


def refused(path):
    """Checks that Pillow rejects the file or reads other frames."""
    try:
        return len(frames(path)[0]) != FRAMES
    except (OSError, SyntaxError, EOFError, ValueError, IndexError):
        return True


# Animations: an APNG contains exactly the bytes of each frame; a GIF approximates them with 255 colors.
FRAMES, DELAY, WIDE, HIGH = 6, 80, 160, 90
turn = ("render", "island", "--cell", 160, "--size", f"{WIDE}x{HIGH}", "--turntable", FRAMES, "--delay", DELAY, "--quiet", "-o")
orogen(*turn, WORK / "turn-%02d.png")
orogen(*turn, WORK / "turn.png")
orogen(*turn, WORK / "turn.gif")
single = [pixels(WORK / f"turn-{frame:02d}.png", "RGB", (HIGH, WIDE)).astype("i4") for frame in range(FRAMES)]
for name in ("turn.png", "turn.gif"):
    pictures, delays = frames(WORK / name)
    checks.equal(f"{name}: frames", len(pictures), FRAMES)
    checks.equal(f"{name}: delays", {float(delay) for delay in delays}, {float(DELAY)})
    checks.equal(f"{name}: size", pictures[0].shape, (HIGH, WIDE, 3))
    off = max(float(numpy.abs(a - b).mean()) for a, b in zip(pictures, single))
    checks.that(f"{name}: frames as they are by themselves", off <= (0 if name.endswith("png") else 6), f"(off by {off})")
    checks.that(f"{name}: frames differ", all((a != b).any() for a, b in zip(pictures, pictures[1:])))
    # Damage must be detected.
    whole = (WORK / name).read_bytes()
    for what, damaged in (("cut short", whole[: len(whole) // 2]), ("of another kind", b"X" + whole[1:])):
        (WORK / f"damaged-{name}").write_bytes(damaged)
        checks.that(f"{name}: {what}, it is refused", refused(WORK / f"damaged-{name}"))
orogen("grow", "dla-peaks", "--size", 96, "--frames", 4, "--quiet", "-o", WORK / "grow.gif")
checks.equal("grow.gif: frames", len(frames(WORK / "grow.gif")[0]), 4)
orogen("noise", "perlin", "--size", 64, "--frames", 9, "--quiet", "-o", WORK / "noise.gif")
checks.equal("noise.gif: frames", len(frames(WORK / "noise.gif")[0]), 9)

checks.end()
