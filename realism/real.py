"""Windows of real land, and how far other windows are from them."""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.spatial.distance import cdist

from features import FEATURES

REAL = Path(__file__).with_name("real.json")

# The landscape whose windows are hilly by the rule of mountains.
MOUNTAINS = "mountains"

# Real windows whose distances are averaged.
NEAREST = 5

# The ten shares of landforms count as four features.
_WEIGHTS = np.array([0.4 if name.startswith("g_") else 1.0 for name in FEATURES])


def load(path: Path = REAL):
    """The windows of a file such as real.json, each a dictionary."""
    file = json.loads(path.read_text())
    return [dict(zip(file["columns"], row)) for row in file["windows"]]


def of_type(windows, name: str, half: str | None = None):
    """The windows of a type, or of one half of its regions: every second one by name."""
    found = [window for window in windows if window["type"] == name]
    if not found:
        sys.exit(f"there is no type '{name}'; there are: {', '.join(sorted({window['type'] for window in windows}))}")
    if half:
        regions = sorted({window["region"] for window in found})[half == "second" :: 2]
        found = [window for window in found if window["region"] in regions]
    return found


def vector(window):
    """The features of a window; those of landforms as roots, so that rare ones count."""
    return np.array([window[name] ** 0.5 if name.startswith("g_") else window[name] for name in FEATURES], float)


def energy(these, those):
    """The energy distance of two sets of points (Szekely and Rizzo 2013)."""
    return 2 * cdist(these, those).mean() - cdist(these, these).mean() - cdist(those, those).mean()


class Reference:
    """Real windows, in the space in which distances are measured.

    A feature counts in units of its spread, from the tenth to the ninetieth percentile of the real windows, and at most
    six of them.
    """

    def __init__(self, windows):
        self.windows = windows
        self.regions = np.array([window["region"] for window in windows])
        vectors = np.array([vector(window) for window in windows])
        self.middle = np.nanmedian(vectors, 0)
        low, high = np.nanquantile(vectors, [0.1, 0.9], 0)
        self.spread = np.maximum((high - low) / 2.563, 1e-3)
        self.points = self.point(vectors)
        if len(set(self.regions)) < 2:
            sys.exit(f"the real windows are all of {self.regions[0]}: a unit of distance needs two regions")
        own = np.array([self._distance(p, self.regions != r) for p, r in zip(self.points, self.regions)])
        # The unit of distance: that of a typical real window to those of other regions.
        self.unit = np.median(own)
        self.own_scores = own / self.unit
        large = [region for region in sorted(set(self.regions)) if (self.regions == region).sum() >= 5]
        apart = [energy(self.points[self.regions == region], self.points[self.regions != region]) for region in large]
        self.energy_unit = np.median(apart) if apart else np.nan

    def offsets(self, vectors):
        """Features as multiples of the real spread from the real median."""
        return (vectors - self.middle) / self.spread

    def point(self, vectors):
        offsets = np.nan_to_num(np.clip(self.offsets(vectors), -6, 6), nan=6.0)
        return offsets * np.sqrt(_WEIGHTS / _WEIGHTS.sum())

    def _distance(self, point, among):
        return np.sort(np.sqrt(((self.points[among] - point) ** 2).sum(1)))[:NEAREST].mean()

    def score(self, vector):
        """The mean distance to the nearest real windows; 1 is that of a typical real window to other regions."""
        return self._distance(self.point(vector), slice(None)) / self.unit

    def energy(self, vectors):
        """The energy distance of a set to the real windows; 1 is that of a typical real region to the others."""
        return energy(self.point(vectors), self.points) / self.energy_unit

    def median(self, name: str):
        return np.median([window[name] for window in self.windows])
