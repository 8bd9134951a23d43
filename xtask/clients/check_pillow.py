"""Pillow reads the pictures: grey values stand for the heights the summary says, sea is where the heights are below it."""

import numpy
from orogen import ROOT, Checks, export, generate
from PIL import Image

checks = Checks()
SIZE = 256


def pixels(path, mode, shape):
    """The picture as an array, if it is of this kind and size."""
    with Image.open(path) as image:
        image.load()
        checks.equal(f"{path.name}: format", image.format, "PNG")
        checks.equal(f"{path.name}: mode", image.mode, mode)
        checks.equal(f"{path.name}: size", image.size, (shape[1], shape[0]))
        return numpy.asarray(image)


def check_greys(name, grey, top, heights, summary):
    """Grey 0 is height_min and the top grey is height_max; between them within half a step."""
    low, span = summary["height_min"], summary["height_max"] - summary["height_min"]
    step = span / top
    checks.equal(f"{name}: black and white are both there", (int(grey.min()), int(grey.max())), (0, top))
    off = float(numpy.abs(low + grey.astype("f8") * step - heights).max())
    # The bound is half a step and what f32 heights of this size are rounded by.
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
    colours = pixels(folder / "map.png", "RGB", shape).astype("i4")

    # Seen as blue: more blue than red. At the shore the two may touch, so one part in fifty is let pass.
    blue = colours[..., 2] > colours[..., 0]
    sea = float(blue.mean())
    checks.near(f"{preset} map.png: sea and land are told apart", 1.0 - sea, summary["land_share"], 0.02)

    exported = pixels(export(preset, f"{preset}-export.png", *options), "I;16", shape).astype("f8")
    likeness = float(numpy.corrcoef(exported.ravel(), heights.ravel())[0, 1])
    checks.that(f"{preset}: an exported PNG shows the heights", likeness > 0.9999, f"(correlation {likeness})")

# A plane that rises to the east and falls to the south: the brightest corner is the top right, the darkest the bottom left.
folder, summary = generate(ROOT / "xtask/clients/plane.toml")
shape = (summary["height"], summary["width"])
for name, mode in (("height.png", "I;16"), ("height8.png", "L")):
    grey = pixels(folder / name, mode, shape)
    corners = [int(grey[0, -1]), int(grey[-1, 0])]
    checks.equal(f"plane {name}: corners", corners, [65535, 0] if mode == "I;16" else [255, 0])
    checks.that(f"plane {name}: rises east", bool((numpy.diff(grey.astype("i4"), axis=1) > 0).all()))
    checks.that(f"plane {name}: falls south", bool((numpy.diff(grey.astype("i4"), axis=0) < 0).all()))

checks.end()
