#!/usr/bin/env python3
"""How far generated land is from real land.

    score.py FILES.tif                              beside mountains
    score.py FILES.tif --type rolling_hills         beside land of another type of real.json
    score.py FILES.npy --cell 60 --half first       beside every second region of the type

Files are GeoTIFFs with square cells of about 30 to 90 m and heights in metres, or arrays of NumPy.
All windows of 256 x 256 samples that are hilly enough are judged, after their heights were multiplied such that the
mean slope is the median of the real windows: steepness alone decides nothing.

    windows    how many were judged, and how many were too flat
    score      mean distance to the five nearest real windows; 1 is that of a typical real window to other regions
    energy     energy distance of the whole set to the real windows; 1 is that of a typical real region to the others
    stand out  features whose median is more than two spreads from the real median
    grid bias  preference of slopes for multiples of 45 degrees
    drainage   samples below all neighbors, and samples that filling of depressions raises

One window proves nothing: judge 16 seeds or more. README.md says what the features are.
"""

import argparse
import json
from pathlib import Path

import numpy as np

import rasters
import real
from drainage import depressions, flood, pits
from features import FEATURES, ONE_SIDED, measure


def drainage(windows):
    """Shares of pits and of samples raised by filling, at the original heights."""
    filled = [depressions(window, flood(np.ascontiguousarray(window))[0])[0] for window, _ in windows]
    return np.mean([pits(window) for window, _ in windows]), np.mean(filled)


def measured(reference: real.Reference, windows):
    """The features of windows, after their heights were multiplied to the slope of the real ones."""
    slope = reference.median("slope")
    found = [measure(rasters.with_slope(window, cell, slope), cell) for window, cell in windows]
    for name in ONE_SIDED:
        least = reference.median(name)
        for window in found:
            window[name] = max(window[name], least)
    return found


def standing_out(reference: real.Reference, vectors):
    """Features whose median is more than two spreads from the real median, with that offset."""
    medians = np.nanmedian(reference.offsets(vectors), 0)
    return {name: offset for name, offset in zip(FEATURES, medians) if not abs(offset) <= 2}


def judge(reference: real.Reference, windows):
    """The figures of windows beside real ones."""
    found = measured(reference, windows)
    vectors = np.array([real.vector(window) for window in found])
    scores = [reference.score(vector) for vector in vectors]
    bias = [window["grid_bias"] for window in found]
    own_bias = [window["grid_bias"] for window in reference.windows]
    energy = reference.energy(vectors)
    low, filled = drainage(windows)
    return {
        "windows": len(windows),
        "score": np.median(scores),
        "p90": np.quantile(scores, 0.9),
        "energy": None if np.isnan(energy) else energy,
        "stand_out": standing_out(reference, vectors),
        "bias": np.median(bias),
        "worst_bias": max(bias),
        "pits": low,
        "filled": filled,
        "real": {
            "windows": len(reference.windows),
            "p90": np.quantile(reference.own_scores, 0.9),
            "bias": np.median(own_bias),
            "worst_bias": max(own_bias),
            "filled": 10 ** reference.median("log_fill") - 1e-3,
        },
    }


def table(found, flat):
    def bias(figures):
        return f"median {figures['bias']:.3f}, worst {figures['worst_bias']:.3f}"

    own = found["real"]
    energy = "no unit: no region has five windows" if found["energy"] is None else f"{found['energy']:.2f}"
    stand_out = ", ".join(f"{name} {offset:+.1f}" for name, offset in found["stand_out"].items())
    return f"""\
windows    {found["windows"]}, too flat {flat}
score      median {found["score"]:.2f}, p90 {found["p90"]:.2f} (real: 1.00, {own["p90"]:.2f})
energy     {energy}
stand out  {len(found["stand_out"])}  {stand_out}
grid bias  {bias(found)} (real: {bias(own)})
drainage   pits {found["pits"]:.2%}, filled {found["filled"]:.2%} (real: filled {own["filled"]:.2%})"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rasters", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--type", default=real.MOUNTAINS, help="the type of land, as in real.json [default: mountains]")
    parser.add_argument("--half", choices=("first", "second"), help="beside every second region of the type, by name")
    parser.add_argument("--cell", type=float, help="cell in metres of files of NumPy")
    parser.add_argument("--real", type=Path, default=real.REAL, help="another file of real windows")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    reference = real.Reference(real.of_type(real.load(options.real), options.type, options.half))
    hilly = rasters.MOUNTAINS if options.type == real.MOUNTAINS else rasters.GENTLE
    windows = rasters.windows_of(options.rasters, options.cell, hilly)
    if not windows.kept:
        if options.json:
            print(json.dumps({"windows": 0, "flat": windows.flat}))
            return
        parser.exit(1, f"no window is judged: {windows.flat} are too flat, and the others have gaps\n")
    found = judge(reference, windows.kept)
    print(json.dumps({"flat": windows.flat, **found}) if options.json else table(found, windows.flat))


if __name__ == "__main__":
    main()
