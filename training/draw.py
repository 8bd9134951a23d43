"""Heights at half the cell, as `orogen` makes them: for tests of both, and for looking at a network."""

import numpy as np
import torch

from network import NOISES, Rivers
from train import CELL, filtered

MASK = (1 << 64) - 1
STEP = 0x9E3779B97F4A7C15


def mixed(z):
    """The finaliser of splitmix64, of arrays of 64-bit numbers."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


def one_mixed(z):
    with np.errstate(over="ignore"):
        return int(mixed(np.array([z & MASK], np.uint64))[0])


def seed_of(world, node):
    """The seed that a node with a seed of its own has in a world."""
    return one_mixed(one_mixed(world + STEP) ^ (node * 0xD1B54A32D192ED03 & MASK))


def noise_at(seed, level, column, row, columns, rows):
    """Sums of four uniform numbers for each node from this column and row."""
    x = np.arange(column, column + columns, dtype=np.int64).astype(np.uint64)[None]
    y = np.arange(row, row + rows, dtype=np.int64).astype(np.uint64)[:, None]
    planes = []
    with np.errstate(over="ignore"):
        for plane in range(NOISES):
            start = np.uint64((seed + (level << 8 | plane) * STEP) & MASK)
            bits = mixed(mixed(start ^ x * np.uint64(0xD6E8FEB86659FD93)) + y * np.uint64(0xA0761D6478BD642F))
            parts = sum((bits >> np.uint64(16 * part)) & np.uint64(0xFFFF) for part in range(4))
            planes.append((parts.astype(np.float32) / 65536 - 2) * np.float32(1.7320508))
    return torch.from_numpy(np.stack(planes).astype(np.float32))[None]


def finer(network, cells, heights, cell, noise, seed, level=1, at=(0, 0)):
    """The fine heights from coarse node `halo` of `heights`, whose first node is at column and row `at`."""
    fine = min(max(cell / 2, cells[0]), cells[1])
    octave = torch.full((1, 1, 1, 1), 0.5 * float(np.log2(fine / CELL)))
    rows, columns = heights.shape
    draw = noise * noise_at(seed, level, *at, columns, rows)
    mean = heights.mean()
    z = torch.from_numpy(((heights - mean) / cell).astype(np.float32))[None, None]
    with torch.no_grad():
        residual, scale, smooth = network(z, octave, draw)
    return (smooth + residual * scale * 0.5)[0, 0].numpy().astype(np.float64) * cell + mean


def hillslopes(network, cells, heights, areas, least, cell, noise, seed):
    """The land between rivers from the samples of coarse node `halo`, and where beds are kept. `areas` are drainage areas
    in samples, and beds are kept from `least` on; the first sample is at an even column and row. Samples that are lower
    than their receiver are as the network makes them."""
    mean = heights.mean()
    fine = torch.from_numpy(((heights - mean) / (2 * cell)).astype(np.float32))[None, None]
    coarse = filtered(fine, 0.25)[..., ::2, ::2]
    octave = torch.full((1, 1, 1, 1), 0.5 * float(np.log2(min(max(cell, cells[0]), cells[1]) / CELL)))
    logarithms = torch.from_numpy(np.log2(areas).astype(np.float32))[None, None]
    rivers = Rivers(fine, logarithms, float(np.log2(least)))
    draw = noise * noise_at(seed, 1, 0, 0, coarse.shape[-1], coarse.shape[-2])
    with torch.no_grad():
        residual, scale, smooth = network(coarse, octave, draw, rivers)
    made = (smooth + residual * scale * 0.5)[0, 0].numpy().astype(np.float64) * 2 * cell + mean
    border = 2 * network.halo
    kept = rivers.is_known[0, 0, border : border + made.shape[0], border : border + made.shape[1]].numpy()
    return made, kept
