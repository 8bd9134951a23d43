#!/usr/bin/env python3
"""Measures windows of real land, as rows of real.json.

    measure.py PLACE.tif... --type rolling_hills

The name of a file is that of its region. Of each region at most eight windows are taken, at random, so that none counts
more than others. Add the rows to the list "windows", and the regions to "regions" with their sources.
"""

import argparse
import json
from pathlib import Path

import numpy as np

import rasters
import real
from features import FEATURES, measure

COLUMNS = ("type", "region", "cell", "slope", "grid_bias", *FEATURES)
MOST = 8


def row_of(window) -> str:
    """A row of real.json, on one line."""
    values = [window[name] for name in COLUMNS]
    return json.dumps([float(f"{value:.6g}") if isinstance(value, float) else value for value in values])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rasters", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--type", required=True, help="the type of land: one of real.json, or a new one")
    parser.add_argument("--cell", type=float, help="cell in metres of files of NumPy")
    options = parser.parse_args()
    hilly = rasters.MOUNTAINS if options.type == real.MOUNTAINS else rasters.GENTLE
    random = np.random.default_rng(1)
    for path in options.rasters:
        kept = rasters.windows_of([path], options.cell, hilly).kept
        for index in sorted(random.permutation(len(kept))[:MOST]):
            window, cell = kept[index]
            found = {"type": options.type, "region": path.stem, "cell": float(cell), **measure(window, cell)}
            print(row_of(found) + ",")


if __name__ == "__main__":
    main()
