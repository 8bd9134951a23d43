"""How well a small network tells made land from real land: `python critic.py REAL FOLDER...`, folders of GeoTIFFs.

The critic learns from every second file of each folder, and judges the others, so that it meets no place and no seed
again. The figure is the area under the curve (AUC), the share of pairs in which it finds the real patch: 0.5 if it
cannot tell them apart, 1 if it always can. Give a folder of other real places, too: places differ by themselves, and no
land can be expected to be closer than these.

Patches are drained, so that pits of sensors do not count, and divided by their slope, so that steepness does not.
"""

import argparse
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from prepare import breached, halved, heights_of
from torch import nn

SIDE = 64
STEPS = 250
BATCH = 32
# Patches of a file.
PATCHES = 300
# Least mean slope of a patch.
HILLY = 0.05
# Land with smaller cells is averaged to twice its cell.
LEAST_CELL = 45
TRIES = 3


def patches_of(path, random):
    """Random patches of hilly land without voids, in units of their slope, with their Laplacians."""
    heights, cell = heights_of(path)
    if cell < LEAST_CELL:
        heights, cell = halved(heights), 2 * cell
    heights = breached(heights)
    found = []
    for _ in range(20 * PATCHES):
        if len(found) == PATCHES or min(heights.shape) < SIDE + 2:
            break
        row, column = (random.integers(0, side - SIDE - 1) for side in heights.shape)
        z = heights[row : row + SIDE + 2, column : column + SIDE + 2] / cell
        if not np.isfinite(z).all():
            continue
        south, east = np.gradient(z)
        slope = np.sqrt((east * east + south * south).mean())
        if slope < HILLY:
            continue
        bend = z[1:-1, 2:] + z[1:-1, :-2] + z[2:, 1:-1] + z[:-2, 1:-1] - 4 * z[1:-1, 1:-1]
        here = z[1:-1, 1:-1]
        found.append(np.stack(((here - here.mean()) / slope / 8, bend / slope)))
    return np.array(found, np.float32).reshape(-1, 2, SIDE, SIDE)


def critic():
    widths = (2, 16, 32, 48, 48)
    layers = []
    for inputs, outputs in zip(widths, widths[1:]):
        layers += [nn.Conv2d(inputs, outputs, 3, stride=2 if inputs > 2 else 1), nn.LeakyReLU(0.2)]
    return nn.Sequential(*layers, nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.Linear(widths[-1], 1))


def turned(patches, random):
    turn = random.integers(8)
    if turn & 1:
        patches = patches.flip(2)
    if turn & 2:
        patches = patches.flip(3)
    return patches.transpose(2, 3) if turn & 4 else patches


def area_under_curve(higher, lower):
    """Share of pairs in which the first is greater."""
    return float((higher[:, None] > lower[None]).float().mean())


def told_apart(real, made, seed):
    """The AUC on the second of each pair of patches, after training on the first."""
    torch.manual_seed(seed)
    random = np.random.default_rng(seed)
    network = critic()
    optimizer = torch.optim.Adam(network.parameters(), 2e-3)
    for _ in range(STEPS):
        halves = [patches[random.integers(0, len(patches), BATCH // 2)] for patches in (real[0], made[0])]
        batch = turned(torch.cat([torch.from_numpy(half) for half in halves]), random)
        wanted = torch.cat((torch.ones(BATCH // 2), torch.zeros(BATCH // 2)))
        loss = F.binary_cross_entropy_with_logits(network(batch)[:, 0], wanted)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    with torch.no_grad():
        scores = [network(torch.from_numpy(patches))[:, 0] for patches in (real[1], made[1])]
    return area_under_curve(*scores)


def halves_of(folder, random):
    """The patches of every second file of a folder, and of the others."""
    files = sorted(folder.glob("*.tif"))
    if len(files) < 2:
        raise SystemExit(f"{folder} has {len(files)} .tif; the critic learns from one and judges another")
    parts = [np.concatenate([patches_of(path, random) for path in files[first::2]]) for first in (0, 1)]
    if min(len(part) for part in parts) == 0:
        raise SystemExit(f"{folder}: there is no hilly land in half of its files")
    return parts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("folders", type=Path, nargs="+")
    options = parser.parse_args()
    torch.set_num_threads(1)
    random = np.random.default_rng(0)
    real = halves_of(options.real, random)
    for folder in options.folders:
        other = halves_of(folder, random)
        figures = [told_apart(real, other, seed) for seed in range(TRIES)]
        print(f"{folder.name}: AUC {np.mean(figures):.2f} ({min(figures):.2f} to {max(figures):.2f})", flush=True)


if __name__ == "__main__":
    main()
