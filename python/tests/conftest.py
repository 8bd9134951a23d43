"""Worlds and arrays for all tests."""

from __future__ import annotations

import numpy as np
import orogen
import pytest


@pytest.fixture(scope="session")
def hills() -> orogen.World:
    return orogen.World("hills", cache=False)


@pytest.fixture(scope="session")
def endless() -> orogen.World:
    return orogen.World("hills", seed=7, cache=False)


@pytest.fixture(scope="session")
def rough() -> np.ndarray:
    """Heights with many depressions."""
    random = np.random.default_rng(1)
    slope = np.add.outer(np.arange(60.0), np.arange(80.0))
    return (slope + 40 * random.random(slope.shape)).astype(np.float32)
