"""Trains the network: `python train.py windows.npz land.network`, or with `--rivers` the network that keeps the beds of
rivers; each takes about five minutes of one core.

The loss is a conditional energy score of two draws (Gneiting and Raftery 2007), a proper scoring rule: it is least if
the draws have the distribution of real land with the same coarse heights.
"""

import argparse
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

from network import NOISES, Network, Rivers
from network_file import write_network
from places import PLACES

STEPS = 6000
BATCH = 8
RATE = 3e-3
SEED = 0
# Coarse nodes along the side of a training window.
NODES = 44
# Coarse heights are samples of the fine ones after a filter [a, 1 - 2a, a]: points, or means of cells (0.25).
BLURS = (0.0, 0.1, 0.2, 0.25, 0.25)
# Binary logarithms of drainage areas, in samples, from which rivers are known: another one for each window.
LEAST_AREAS = (3.0, 4.0, 5.0, 6.0, 8.0)
# Fine cell, in metres, at which the octave is 0.
CELL = 75.0
# Weight of the error of heights without noise, so that these are the likeliest ones.
LIKELY = 0.5
# Sizes of the boxes over which differences are summed.
BOXES = (1, 3, 8)


def filtered(fine, share):
    padded = F.pad(fine, (1, 1, 1, 1), mode="reflect")
    rows = share * (padded[..., :-2] + padded[..., 2:]) + (1 - 2 * share) * padded[..., 1:-1]
    return share * (rows[..., :-2, :] + rows[..., 2:, :]) + (1 - 2 * share) * rows[..., 1:-1, :]


def noise_of(count, nodes):
    """No noise for the first third, then sums of four uniform numbers, with the variance 1, as `hash::normal` of the engine makes them."""
    draws = (torch.rand(4, 2 * count, NOISES, nodes, nodes).sum(0) - 2) * 3**0.5
    return torch.cat((torch.zeros(count, NOISES, nodes, nodes), draws))


class Windows:
    """Random windows with their coarse heights, both in coarse cells, and their rivers if asked."""

    def __init__(self, path, rivers=False):
        file = np.load(path)
        self.fine = torch.from_numpy(file["windows"])
        self.areas = torch.from_numpy(file["areas"].astype(np.float32)) if rivers else None
        # Cells of 88 m and 90 m are the same.
        self.cells = [float(10 * np.round(cell / 10)) for cell in (file["cells"].min(), file["cells"].max())]
        self.octaves = torch.from_numpy(0.5 * np.log2(file["cells"] / CELL))
        self.random = np.random.default_rng(SEED)

    def batch(self, count):
        random = self.random
        chosen = torch.from_numpy(random.integers(0, len(self.fine), count))
        # With rivers, each coarse node has all of its fine samples.
        side = 2 * NODES - (1 if self.areas is None else 0)
        row, column = random.integers(0, self.fine.shape[-1] - side + 1, 2)
        turn = random.integers(8)

        def window_of(planes):
            window = planes[chosen, row : row + side, column : column + side]
            if turn & 1:
                window = window.flip(1)
            if turn & 2:
                window = window.flip(2)
            return (window.transpose(1, 2) if turn & 4 else window)[:, None]

        fine = window_of(self.fine) * 0.5
        coarse = filtered(fine, float(random.choice(BLURS)))[..., ::2, ::2]
        octave = self.octaves[chosen][:, None, None, None]
        if self.areas is None:
            return fine, coarse, octave, None
        least = torch.from_numpy(random.choice(LEAST_AREAS, count).astype(np.float32))[:, None, None, None]
        return fine, coarse, octave, (fine, window_of(self.areas), least)


def repeated(planes):
    """For the likeliest land and two draws."""
    return planes.repeat(3, 1, 1, 1)


def length(difference, box):
    """Mean length of differences over boxes."""
    squares = difference * difference
    if box > 1:
        squares = F.avg_pool2d(squares, box, max(1, box // 2))
    return torch.sqrt(squares.sum(1) + 1e-5).mean()


def steps_of(x):
    return torch.cat((x[..., 1:, 1:] - x[..., 1:, :-1], x[..., 1:, 1:] - x[..., :-1, 1:]), 1)


def bends_of(x):
    return x[..., 1:-1, 2:] + x[..., 1:-1, :-2] + x[..., 2:, 1:-1] + x[..., :-2, 1:-1] - 4 * x[..., 1:-1, 1:-1]


def energy_score(first, second, real):
    """Distance of two draws to the real residual, less half of their distance to each other: of heights, slopes, bends."""
    sum = 0
    for measure, weight in ((lambda x: x, 1.0), (steps_of, 0.7), (bends_of, 0.35)):
        a, b, y = (weight * measure(x) for x in (first, second, real))
        for box in BOXES:
            sum = sum + 0.5 * (length(a - y, box) + length(b - y, box)) - 0.5 * length(a - b, box)
    return sum


def trained(windows, steps, report=print):
    torch.manual_seed(SEED)
    torch.set_num_threads(1)
    torch.use_deterministic_algorithms(True)
    network = Network(rivers=windows.areas is not None).to(memory_format=torch.channels_last)
    optimizer = torch.optim.Adam(network.parameters(), RATE, betas=(0.9, 0.99))
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, RATE, max(steps, 30), pct_start=0.1)
    mean = 0.0
    for step in range(1, steps + 1):
        fine, coarse, octave, known = windows.batch(BATCH)
        rivers = known and Rivers(*map(repeated, known))
        residual, scale, smooth = network(repeated(coarse), repeated(octave), noise_of(BATCH, NODES), rivers)
        first, rows, columns = 2 * network.halo, *residual.shape[-2:]
        real = (fine[..., first : first + rows, first : first + columns] - smooth[:BATCH]) * 2
        real = real / scale[:BATCH]
        likely, first, second = residual.split(BATCH)
        loss = energy_score(first, second, real) + LIKELY * sum(length(likely - real, box) for box in BOXES)
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimizer.step()
        schedule.step()
        mean += loss.item()
        if step % 200 == 0:
            report(f"step {step}: loss {mean / 200:.4f}")
            mean = 0.0
    return network


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("windows", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--rivers", action="store_true", help="the network that keeps the beds of rivers")
    parser.add_argument("--steps", type=int, default=STEPS)
    options = parser.parse_args()
    windows = Windows(options.windows, options.rivers)
    network = trained(windows, options.steps, lambda line: print(line, flush=True))
    write_network(options.out, network, windows.cells, [f"{place.land} (SRTM)" for place in PLACES])


if __name__ == "__main__":
    main()
