"""Checks .npy exports with NumPy: the numbers of the summary, the samples of the program's own windows."""

import hashlib
import io

import numpy
from orogen import ROOT, Checks, export, generate, orogen

checks = Checks()
SIZE = 256

for preset in ("alpine", "island"):
    _, summary = generate(preset, "--size", SIZE)
    width, height, cell = summary["width"], summary["height"], summary["cell"]
    window = f"0,0,{width},{height}"
    heights = numpy.load(export(preset, f"{preset}.npy", "--cell", cell, "--window", window), allow_pickle=False)

    checks.equal(f"{preset}: type", heights.dtype, numpy.dtype("<f4"))
    checks.equal(f"{preset}: shape is rows by columns", heights.shape, (height, width))
    checks.that(f"{preset}: C order", heights.flags["C_CONTIGUOUS"])
    checks.that(f"{preset}: finite", bool(numpy.isfinite(heights).all()))
    digest = hashlib.sha256(heights.astype("<f4").tobytes(order="C")).hexdigest()
    checks.equal(f"{preset}: sha256", digest, summary["sha256"])
    # The summary writes an f32 with the fewest digits that identify it.
    checks.equal(f"{preset}: lowest", heights.min(), numpy.float32(summary["height_min"]))
    checks.equal(f"{preset}: highest", heights.max(), numpy.float32(summary["height_max"]))
    span = summary["height_max"] - summary["height_min"]
    checks.near(f"{preset}: mean", float(heights.mean(dtype="f8")), summary["height_mean"], 1e-6 * span)

    # A window equals the same crop of the whole raster bit for bit; x counts columns, y counts rows.
    x, y, w, h = 31, 77, 90, 41
    part = numpy.load(export(preset, "part.npy", "--cell", cell, "--window", f"{x},{y},{w},{h}"), allow_pickle=False)
    checks.that(f"{preset}: a window is a crop", numpy.array_equal(part, heights[y : y + h, x : x + w]))
    piped = numpy.load(io.BytesIO(orogen("export", preset, "-o", "-", "--cell", cell, "--window", f"{x},{y},{w},{h}")))
    checks.that(f"{preset}: a pipe gets the same bytes", numpy.array_equal(piped, part))

# A plane that rises 3 m per metre to the east and falls 2 m per metre to the south: every mirror image and rotation differs.
plane = numpy.load(export(ROOT / "xtask/clients/plane.toml", "plane.npy", "--window", "0,0,40,30"), allow_pickle=False)
rows, columns = numpy.mgrid[0:30, 0:40]
checks.equal("plane: shape", plane.shape, (30, 40))
worst = float(numpy.abs(plane - (3.0 * columns - 2.0 * rows)).max())
checks.near("plane: x grows east along a row, y grows south down the rows", worst, 0.0, 1e-3)

checks.end()
