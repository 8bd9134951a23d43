"""Writes and reads a network as the file that Orogen reads; `orogen_grid::learned` says what is in it."""

import hashlib

import numpy as np
import torch

from network import CHANNELS, LAYERS, Network

LICENCE = "MIT OR Apache-2.0"


def weights_of(network):
    """All weights in the order of the file: by layer, tap, input and output, then the offsets."""
    parts = []
    for layer in network.hidden:
        outputs, inputs, rows, columns = layer.weight.shape
        parts += [layer.weight.permute(2, 3, 1, 0).reshape(-1), layer.bias]
    parts += [network.phases.weight[:, :, 0, 0].T.reshape(-1), network.phases.bias]
    return np.concatenate([part.detach().numpy() for part in parts]).astype("<f4").tobytes()


def write_network(path, network, cells, lands):
    """Writes the file; `cells` are the smallest and the largest fine cell in metres, `lands` what it learned from."""
    weights = weights_of(network)
    lines = [
        "orogen network 1",
        f"channels {CHANNELS}",
        f"layers {LAYERS}",
        "cells {:g} {:g}".format(*cells),
        *(["rivers yes"] if network.rivers else []),
        f"licence {LICENCE}",
        *(f"land {land}" for land in lands),
        f"sha256 {hashlib.sha256(weights).hexdigest()}",
    ]
    path.write_bytes("\n".join(lines).encode() + b"\n\n" + weights)


def read_network(path):
    """The network of a file, and its smallest and largest fine cell in metres."""
    header, _, weights = path.read_bytes().partition(b"\n\n")
    fields = dict(line.split(" ", 1) for line in header.decode().splitlines())
    numbers = torch.from_numpy(np.frombuffer(weights, "<f4").copy())
    network = Network(int(fields["channels"]), int(fields["layers"]), "rivers" in fields)
    at = 0

    def take(*shape):
        nonlocal at
        part = numbers[at : at + int(np.prod(shape))].reshape(shape)
        at += part.numel()
        return part

    with torch.no_grad():
        for layer in network.hidden:
            outputs, inputs, rows, columns = layer.weight.shape
            layer.weight.copy_(take(rows, columns, inputs, outputs).permute(3, 2, 0, 1))
            layer.bias.copy_(take(outputs))
        network.phases.weight.copy_(take(network.phases.weight.shape[1], 4).T[:, :, None, None])
        network.phases.bias.copy_(take(4))
    return network, tuple(float(cell) for cell in fields["cells"].split())
