#!/usr/bin/env python3
"""How much of real land comes back after it was averaged to a larger cell and refined.

    refined.py OROGEN PLACE.tif... [--factor 8]

OROGEN is the program. Each place is averaged to four times its cell, or as many as `--factor` says, refined by
`orogen refine` and by cubic interpolation, and compared with the original. Prints two tables in Markdown. Files with
fewer than 304 x 304 samples without gaps are left out. The name of a file is that of its region in real.json, which is
left out of the reference.
"""

import argparse
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rasterio
from rasterio.transform import from_origin
from scipy import ndimage

import rasters
import real
from drainage import drainage_areas, pits
from score import measured, standing_out

# Samples at the border of a place that are not compared.
BORDER = 24
# Drainage area of a river, in samples.
RIVER = 1100
# The position of the first sample of a place, in metres.
WEST, NORTH = 500_000.0, 5_000_000.0
# Types of land that the originals are like.
TYPES = ("mountains", "alpine", "rolling_hills", "volcanoes")

CUBIC = "cubic interpolation"
LEARNED = "`--detail learned`"
REFINED = {
    "`--detail rivers`": ["--detail", "rivers"],
    LEARNED: ["--detail", "learned"],
    "`--detail learned --noise 0`": ["--detail", "learned", "--noise", "0"],
}


@dataclass
class Place:
    name: str
    cell: float
    heights: np.ndarray
    factor: int


def without_gaps(heights):
    """The largest rectangle without missing heights."""
    best, corners = 0, None
    above = np.zeros(heights.shape[1], int)
    for row, known in enumerate(~np.isnan(heights)):
        above = np.where(known, above + 1, 0)
        # Columns whose runs of known heights have grown, with the first column that each run reaches.
        stack = []
        for column, height in enumerate([*above, 0]):
            first = column
            while stack and stack[-1][1] >= height:
                first, tall = stack.pop()
                if tall * (column - first) > best:
                    best = tall * (column - first)
                    corners = slice(row + 1 - tall, row + 1), slice(first, column)
            stack.append((first, height))
    return heights[corners] if corners else heights[:0, :0]


def place_of(path: Path, factor: int) -> Place | None:
    heights, cell = rasters.read(path, None)
    heights = without_gaps(heights)
    # The last coarse sample lies on the last fine one.
    rows, columns = (max(side - 1, 0) // factor * factor + 1 for side in heights.shape)
    if min(rows, columns) < rasters.SIDE + 2 * BORDER:
        print(f"{path.name} has too few samples without gaps: it is left out", file=sys.stderr)
        return None
    return Place(path.stem, cell, heights[:rows, :columns], factor)


def averaged(heights, factor):
    """Means over squares of `factor` samples around every such sample; samples at their border count by half."""
    weights = np.ones(factor + 1)
    weights[[0, -1]] = 0.5
    for axis in (0, 1):
        heights = ndimage.correlate1d(heights, weights / factor, axis, mode="mirror")
    return heights[::factor, ::factor]


def interpolated(coarse, place: Place):
    """Cubic splines through coarse samples."""
    rows, columns = place.heights.shape
    at = np.mgrid[:rows, :columns] / place.factor
    return ndimage.map_coordinates(coarse, at, order=3, mode="mirror")


def write(path: Path, heights, cell):
    rows, columns = heights.shape
    corner = from_origin(WEST - cell / 2, NORTH + cell / 2, cell, cell)
    options = {"driver": "GTiff", "count": 1, "dtype": "float32", "crs": "EPSG:32633", "transform": corner}
    with rasterio.open(path, "w", width=columns, height=rows, **options) as file:
        file.write(heights.astype("float32"), 1)


def read_at(path: Path, place: Place):
    """The heights of a file at the samples of a place, NaN where it has none."""
    with rasterio.open(path) as file:
        heights, corner = file.read(1).astype(float), file.transform
    column = round((corner.c + place.cell / 2 - WEST) / place.cell)
    row = round((NORTH - corner.f + place.cell / 2) / place.cell)
    whole = np.full(place.heights.shape, np.nan)
    ends = [min(start + size, most) for start, size, most in zip((row, column), heights.shape, whole.shape)]
    inside = tuple(slice(max(start, 0), end) for start, end in zip((row, column), ends))
    whole[inside] = heights[max(-row, 0) : ends[0] - row, max(-column, 0) : ends[1] - column]
    return whole


def refinements(program, place: Place, folder: Path):
    """The refined land by each way, and the share of pits of `--detail learned` before depressions are drained."""
    coarse, fine, recipe = folder / "coarse.tif", folder / "fine.tif", folder / "fine.toml"
    heights = averaged(place.heights, place.factor)
    write(coarse, heights, place.cell * place.factor)

    def orogen(*arguments):
        command = [program, *arguments, "--cell", str(place.cell), "--quiet", "--force"]
        subprocess.run([str(word) for word in command], check=True)

    made = {CUBIC: interpolated(heights, place)}
    for name, options in REFINED.items():
        orogen("refine", coarse, *options, "-o", fine)
        made[name] = read_at(fine, place)
    orogen("refine", coarse, *REFINED[LEARNED], "-o", recipe)
    text = recipe.read_text()
    before = text.replace('height = "drained"', 'height = "learned"')
    assert before != text, "the recipe of refined land has no node `drained`"
    recipe.write_text(before)
    orogen("export", recipe, "--no-cache", "-o", fine)
    return made, pits(compared(read_at(fine, place)))


def compared(heights, border=BORDER):
    return heights[border:-border, border:-border]


def rivers_found(place: Place, made):
    """The share of river samples of a place that have one of the refined land within a coarse cell."""
    # Land at the border, which the refined file may lack, drains as the original does.
    made = np.where(np.isnan(made), place.heights, made)
    away = ndimage.distance_transform_edt(drainage_areas(made) < RIVER)
    rivers = drainage_areas(place.heights) >= RIVER
    return (compared(away)[compared(rivers)] <= place.factor).mean()


def errors(place: Place, made):
    """The root of the mean square of errors of samples, and of means around coarse samples."""
    off = np.where(np.isnan(made), 0, made - place.heights)
    both = compared(off), compared(averaged(off, place.factor), BORDER // place.factor)
    return ", ".join(f"{np.sqrt(np.mean(each**2)):.1f}" for each in both) + " m"


def windows(place: Place, heights):
    """Windows of land where the original is hilly."""
    inner, original = compared(heights), compared(place.heights)
    for row in range(0, inner.shape[0] - rasters.SIDE + 1, rasters.SIDE):
        for column in range(0, inner.shape[1] - rasters.SIDE + 1, rasters.SIDE):
            at = slice(row, row + rasters.SIDE), slice(column, column + rasters.SIDE)
            if not np.isnan(inner[at]).any() and rasters.is_hilly(original[at], place.cell, rasters.MOUNTAINS):
                yield inner[at], place.cell


class Realism:
    """The windows of all places, each compared with real windows of other regions."""

    def __init__(self):
        known = real.load()
        self.all = real.Reference([window for kind in TYPES for window in real.of_type(known, kind)])
        self.scores, self.vectors = [], []

    def add(self, place: Place, heights):
        others = real.Reference([window for window in self.all.windows if window["region"] != place.name])
        vectors = [real.vector(window) for window in measured(others, list(windows(place, heights)))]
        self.scores += [others.score(vector) for vector in vectors]
        self.vectors += vectors

    def row(self):
        vectors = np.array(self.vectors)
        stand_out = ", ".join(standing_out(self.all, vectors)) or "0"
        median, most = np.quantile(self.scores, [0.5, 0.9])
        return f"{len(vectors)} | {median:.2f}, {most:.2f} | {self.all.energy(vectors):.2f} | {stand_out}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="OROGEN")
    parser.add_argument("places", nargs="+", type=Path, metavar="PLACE")
    parser.add_argument("--factor", type=int, choices=(2, 4, 8), default=4, help="coarse cell over fine cell")
    options = parser.parse_args()
    ways = [CUBIC, *REFINED]
    realism = {name: Realism() for name in ["the original", *ways]}
    print("| place, cells | " + " | ".join(f"{name}" for name in ways) + " | rivers | pits |")
    print("|---" * (len(ways) + 3) + "|")
    for place in filter(None, (place_of(path, options.factor) for path in options.places)):
        with tempfile.TemporaryDirectory() as folder:
            made, before = refinements(options.program, place, Path(folder))
        off = " | ".join(errors(place, made[name]) for name in ways)
        rivers = ", ".join(f"{100 * rivers_found(place, made[name]):.0f}" for name in ways)
        low = [pits(compared(place.heights)), before, pits(compared(made[LEARNED]))]
        low = ", ".join(f"{share:.2%}".replace("%", " %") for share in low)
        cells = f"{place.cell * place.factor:g} to {place.cell:g} m"
        print(f"| {place.name}, {cells} | {off} | {rivers} % | {low} |", flush=True)
        for name, land in {"the original": place.heights, **made}.items():
            realism[name].add(place, land)
    print("\n| | windows | realism: median, 90 % | energy | features that stand out |")
    print("|---|---|---|---|---|")
    for name, found in realism.items():
        print(f"| {name} | {found.row()} |")


if __name__ == "__main__":
    main()
