"""The 24 features of a window of heights.

All but the landforms are the same for heights multiplied by any factor; landforms know an angle of level ground.
"""

import numpy as np
from scipy import ndimage

from drainage import depressions, drainage_features, flood, lowest
from landforms import LANDFORMS, landform_shares

FEATURES = (
    "beta",
    "hurst",
    "hypso",
    "slope_cv",
    "slope_skew",
    "slope_het",
    "curv_skew1",
    "curv_skew4",
    "pit_peak",
    "log_fill",
    "fill_asym",
    "theta",
    "hack",
    "area_exp",
    *(f"g_{name}" for name in LANDFORMS),
)

# Features that are faults only if they are larger than in real land: real heights have pits by the noise of sensors and
# by lakes, so that noise would make well-drained land more real otherwise.
ONE_SIDED = ("pit_peak", "log_fill", "fill_asym")


def slopes(heights, cell):
    """Rise over run inside the window (Horn 1981)."""
    east = ndimage.sobel(heights, 1) / (8 * cell)
    south = ndimage.sobel(heights, 0) / (8 * cell)
    return np.hypot(east, south)[1:-1, 1:-1]


def mean_slope(heights, cell):
    """The mean slope in degrees."""
    return np.degrees(np.arctan(slopes(heights, cell))).mean()


def grid_bias(heights, cell):
    """How much slopes above one degree prefer directions that are multiples of 45 degrees, from 0 to 1."""
    south, east = np.gradient(heights, cell)
    is_steep = np.hypot(east, south) > np.tan(np.radians(1))
    if not is_steep.any():
        return 1.0
    return abs(np.exp(8j * np.arctan2(south, east)[is_steep]).mean())


def spectral_exponent(heights, shortest=4, longest=64):
    """The exponent of power by wave number between two wavelengths in samples: 0 is white noise."""
    side = min(heights.shape)
    heights = heights[:side, :side]
    y, x = np.mgrid[:side, :side]
    plane = np.c_[x.ravel(), y.ravel(), np.ones(side * side)]
    level = plane @ np.linalg.lstsq(plane, heights.ravel(), rcond=None)[0]
    taper = np.hanning(side)
    power = np.abs(np.fft.fft2((heights - level.reshape(side, side)) * taper[:, None] * taper)) ** 2
    frequencies = np.fft.fftfreq(side)
    numbers = np.hypot(frequencies[:, None], frequencies).ravel()
    classes = np.digitize(numbers, np.geomspace(1 / longest, 1 / shortest, 13))
    means = [(numbers[classes == each].mean(), power.ravel()[classes == each].mean()) for each in range(1, 13)]
    return -np.polyfit(*np.log(means).T, 1)[0]


def hurst_exponent(heights, lags=(2, 3, 4, 6, 8, 12, 16)):
    """Half the exponent of the variogram by distance: 0 is white noise, 1 is smooth."""
    halves = [
        (np.mean((heights[lag:] - heights[:-lag]) ** 2) + np.mean((heights[:, lag:] - heights[:, :-lag]) ** 2)) / 2
        for lag in lags
    ]
    return np.polyfit(np.log(lags), np.log(halves), 1)[0] / 2


def hypsometric_integral(heights):
    """The mean height between the lowest (0) and the highest (1), without the outermost thousandths."""
    low, high = np.quantile(heights, [0.001, 0.999])
    return (np.clip(heights, low, high).mean() - low) / (high - low)


def slope_features(steepness, block=32):
    """The spread and skewness of slopes, and the spread of their means over blocks of samples."""
    rows, columns = (side // block for side in steepness.shape)
    blocks = steepness[: rows * block, : columns * block].reshape(rows, block, columns, block).mean((1, 3))
    spread = steepness.std()
    return {
        "slope_cv": spread / steepness.mean(),
        "slope_skew": ((steepness - steepness.mean()) ** 3).mean() / (spread**3 + 1e-300),
        "slope_het": blocks.std() / blocks.mean(),
    }


def curvature_skewness(heights, scale):
    """The skewness of the Laplacian by quantiles: above 0 where valleys are sharper than crests."""
    edge = 3 * scale
    curvature = ndimage.gaussian_laplace(heights, scale)[edge:-edge, edge:-edge]
    low, middle, high = np.quantile(curvature, [0.02, 0.5, 0.98])
    return (high + low - 2 * middle) / (high - low + 1e-300)


def measure(heights, cell):
    """The features of a window of heights in metres, with its mean slope in degrees and its grid bias."""
    heights = np.ascontiguousarray(heights, float)
    smooth = ndimage.gaussian_filter(heights, 0.7)
    found = {
        "slope": mean_slope(heights, cell),
        "grid_bias": grid_bias(heights, cell),
        "beta": spectral_exponent(heights),
        "hurst": hurst_exponent(heights),
        "hypso": hypsometric_integral(heights),
        **slope_features(slopes(heights, cell)),
        "curv_skew1": curvature_skewness(heights, 1),
        "curv_skew4": curvature_skewness(heights, 4),
        "pit_peak": np.log10((lowest(smooth) + 1) / (lowest(-smooth) + 1)),
        **drainage_features(heights, cell),
    }
    # Depressions beside those of the same land upside down.
    depth = found.pop("fill_depth")
    _, turned = depressions(-heights, flood(-heights)[0])
    found["fill_asym"] = np.log10((depth + 1e-4) / (turned + 1e-4))
    found.update(zip((f"g_{name}" for name in LANDFORMS), landform_shares(heights, cell)))
    return {name: float(value) for name, value in found.items()}
