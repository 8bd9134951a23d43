"""The network: one step from coarse heights to heights at half the cell, with or without rivers that are known.

`inference` in Rust (crates/orogen-grid/src/learned) computes the same; its tests compare both.
"""

import torch
import torch.nn.functional as F
from torch import nn

CHANNELS = 32
LAYERS = 4
NOISES = 4
# Passes of the binomial filter that makes the scale of slopes and the smooth heights.
PASSES = 4
# Coarse nodes that an output reads on each side: one for slopes, the passes, and one for each layer.
HALO = 1 + PASSES + LAYERS
LEAK = 0.1
# Fine samples of a coarse cell.
PHASES = 4
# Binary logarithm of the largest drainage area that the network tells from larger ones.
LARGEST = 10
# Square of the slope below which ground counts as level.
LEVEL = 4e-4


def binomial(x, passes=PASSES):
    """`x` filtered with [1 2 1] / 4 along columns and rows, `passes` times; each pass takes one node from each side."""
    for _ in range(passes):
        x = (x[..., :-2] + 2 * x[..., 1:-1] + x[..., 2:]) * 0.25
        x = (x[..., :-2, :] + 2 * x[..., 1:-1, :] + x[..., 2:, :]) * 0.25
    return x


def inner(x, border):
    """`x` without `border` nodes on each side."""
    return x[..., border : x.shape[-2] - border, border : x.shape[-1] - border]


def interleaved(even, odd, dim):
    return torch.stack((even, odd), dim + 1).flatten(dim, dim + 1)


def cubic(z):
    """Interpolating cubic at half the cell: n nodes to 2 (n - 3) samples, the first at node 1."""
    for dim in (2, 3):
        n = z.shape[dim] - 3
        a, b, c, d = (z.narrow(dim, first, n) for first in range(4))
        z = interleaved(b, (9 * (b + c) - a - d) * 0.0625, dim)
    return z


def linear(x):
    """Linear interpolation at half the cell: n nodes to 2 (n - 1) samples, the first at node 0."""
    for dim in (2, 3):
        n = x.shape[dim] - 1
        a, b = x.narrow(dim, 0, n), x.narrow(dim, 1, n)
        x = interleaved(a, (a + b) * 0.5, dim)
    return x


class Rivers:
    """What is known of rivers: `heights` at the fine samples in coarse cells, the first at the first coarse node; `areas`,
    binary logarithms of drainage areas in samples; and the logarithm from which there is a river."""

    def __init__(self, heights, areas, least):
        self.heights, self.areas = heights, areas
        self.is_known = areas >= least

    def features(self, smooth, scale):
        """For each coarse node that has a scale, its fine samples: the beds above the interpolated heights `smooth`, in
        units of the scale, and the areas; 0 and the least area where there is no river."""
        border = 2 * (1 + PASSES)
        nearest = F.interpolate(scale, scale_factor=2, mode="nearest")
        above = inner(self.heights - F.pad(smooth, (2, 4, 2, 4)), border) * 2 / nearest
        is_known = inner(self.is_known, border)
        areas = torch.where(is_known, inner(self.areas, border).clamp(max=LARGEST), torch.zeros(())) / 5 - 0.5
        beds = torch.where(is_known, above, torch.zeros(()))
        return torch.cat((F.pixel_unshuffle(beds, 2), F.pixel_unshuffle(areas, 2)), 1)


class Network(nn.Module):
    def __init__(self, channels=CHANNELS, layers=LAYERS, rivers=False):
        super().__init__()
        self.layers = layers
        self.rivers = rivers
        self.halo = 1 + PASSES + layers
        widths = [6 + NOISES + (2 * PHASES if rivers else 0)] + [channels] * (layers - 1)
        self.hidden = nn.ModuleList([nn.Conv2d(width, channels, 3) for width in widths])
        self.phases = nn.Conv2d(channels, 4, 1)
        nn.init.normal_(self.phases.weight, std=0.02)
        nn.init.zeros_(self.phases.bias)

    @staticmethod
    def features(z, octave):
        """Features of heights `z` in coarse cells, and the scale of slopes."""
        east = (z[..., 1:-1, 2:] - z[..., 1:-1, :-2]) * 0.5
        south = (z[..., 2:, 1:-1] - z[..., :-2, 1:-1]) * 0.5
        scale = torch.sqrt(binomial(east * east + south * south) + LEVEL)
        around = z[..., 1:-1, 2:] + z[..., 1:-1, :-2] + z[..., 2:, 1:-1] + z[..., :-2, 1:-1]
        bend = around * 0.25 - z[..., 1:-1, 1:-1]
        above = inner(z, PASSES) - binomial(z)
        planes = (
            inner(east, PASSES) / scale,
            inner(south, PASSES) / scale,
            inner(bend, PASSES) / scale * 3,
            inner(above, 1) / scale,
            torch.log(scale) + 1,
            octave.expand_as(scale),
        )
        return torch.cat(planes, 1), scale

    def forward(self, z, octave, noise, rivers=None):
        """The residual in units of the scale, the scale, and the interpolated heights, over the fine samples from coarse
        node `HALO`. `z` and `noise` are over coarse nodes, `octave` is 0.5 log2(fine cell / 75 m). Where there is a
        river, the residual is that of its bed."""
        features, scale = self.features(z, octave)
        smooth = cubic(z)
        x = torch.cat((features, inner(noise, 1 + PASSES)), 1)
        if rivers:
            x = torch.cat((x, rivers.features(smooth, scale)), 1)
        for index, layer in enumerate(self.hidden):
            y = F.leaky_relu(layer(x), LEAK)
            x = y if index == 0 else y + inner(x, 1)
        residual = F.pixel_shuffle(self.phases(x), 2)
        rows, columns = residual.shape[-2:]

        def crop(plane, first):
            return plane[..., first : first + rows, first : first + columns]

        scale, smooth = crop(linear(scale), 2 * self.layers), crop(smooth, 2 * (self.halo - 1))
        if rivers:
            beds = (crop(rivers.heights, 2 * self.halo) - smooth) * 2 / scale
            residual = torch.where(crop(rivers.is_known, 2 * self.halo), beds, residual)
        return residual, scale, smooth
