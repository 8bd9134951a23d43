"""Arrays of every kind in; noise, hydrology, erosion and analysis out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import orogen
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from orogen import analysis, erosion, hydrology, noise

BASES = [name for name in noise.__all__]


@pytest.mark.parametrize("name", BASES)
def test_a_grid_of_noise_has_the_bits_of_points(name: str) -> None:
    function = getattr(noise, name)
    y, x = np.ogrid[0:40, 0:30]
    grid = function(x, y, wavelength=7.3, octaves=3, seed=5)
    assert grid.shape == (40, 30) and grid.dtype == np.float32
    assert np.array_equal(grid, function(*np.broadcast_arrays(x, y), wavelength=7.3, octaves=3, seed=5))
    assert np.abs(grid).max() <= 1 and np.ptp(grid) > 0
    assert function(3.5, 4.5, wavelength=7.3).shape == ()
    assert function(x, y, 2.0).shape == function(x, y, 2.0, 3.0).shape == (40, 30)


def test_noise_has_slopes_and_fractals() -> None:
    y, x = (axis / 1000 for axis in np.ogrid[0:20, 0:20])
    value, dx, dy = noise.perlin(x, y, gradient=True)
    step = 1e-3
    assert np.allclose((noise.perlin(x + step, y) - value) / step, dx, atol=2e-2)
    assert dy.shape == value.shape
    assert len(noise.simplex(x, y, 1.0, 2.0, gradient=True)) == 5
    ridged = noise.perlin(x * 50, y * 50, fractal="ridged", octaves=4)
    assert not np.array_equal(ridged, noise.perlin(x * 50, y * 50, octaves=4))
    noise.perlin(x, y, fractal="weighted", k=2.0, falloff="exponential", octaves=3)
    with pytest.raises(orogen.errors.RequestError, match="applies to"):
        noise.perlin(x, y, k=2.0)
    with pytest.raises(orogen.errors.RequestError, match="broadcast"):
        noise.perlin(np.zeros(3), np.zeros(4))
    with pytest.raises(TypeError, match="numbers"):
        noise.perlin("a", 1.0)
    with pytest.raises(orogen.errors.RequestError, match="gradient"):
        noise.white(x, y, gradient=True)


def kinds(heights: np.ndarray) -> list[Any]:
    """The same heights in other types and memory orders."""
    whole = np.round(heights)
    wide = np.zeros((heights.shape[0] * 2, heights.shape[1] * 3), np.float32)
    wide[::2, ::3] = whole
    read_only = whole.copy()
    read_only.flags.writeable = False
    return [
        whole,
        whole.astype(np.float64),
        whole.astype(np.int16),
        whole.astype(np.uint64),
        np.asfortranarray(whole),
        whole[::-1, ::-1].copy()[::-1, ::-1],
        wide[::2, ::3],
        whole.astype(">f4"),
        read_only,
        whole.tolist(),
        np.ma.masked_array(whole),
    ]


FUNCTIONS: list[Callable[..., Any]] = [
    hydrology.fill,
    hydrology.breach,
    hydrology.flow_direction,
    hydrology.accumulate,
    hydrology.watersheds,
    lambda heights: hydrology.stream_order(heights, area=20),
    lambda heights: hydrology.above_drainage(heights, area=20).height,
    lambda heights: hydrology.lakes(heights, area=3).surface,
    lambda heights: erosion.thermal(heights, cell=10, passes=3),
    lambda heights: erosion.stream_power(heights, cell=100, years=1e4, steps=2),
    lambda heights: erosion.pipes(heights, cell=10, iterations=5).ground,
    lambda heights: erosion.droplets(heights, cell=30, density=500),
    lambda heights: analysis.hillshade(heights, cell=10),
    lambda heights: analysis.slope(heights, cell=10),
]


@pytest.mark.parametrize("function", FUNCTIONS)
def test_every_kind_of_array_gives_the_same(function: Callable[..., Any], rough: np.ndarray) -> None:
    first, *others = kinds(rough)
    before = first.copy()
    expect = function(first)
    assert expect.shape == rough.shape and np.array_equal(first, before)
    for other in others:
        assert np.array_equal(function(other), expect, equal_nan=True)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_what_is_no_array_of_heights_is_refused(function: Callable[..., Any]) -> None:
    for wrong in (np.zeros(5), np.zeros((2, 2, 2)), np.float32(1), np.zeros((0, 5)), np.zeros((5, 0))):
        with pytest.raises(orogen.errors.RequestError):
            function(wrong)
    for wrong in (np.array([["a"]]), np.array([[None]]), np.zeros((3, 3), complex)):
        with pytest.raises(TypeError):
            function(wrong)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_missing_samples_and_small_arrays_are_fine(function: Callable[..., Any], rough: np.ndarray) -> None:
    for shape in ((1, 1), (1, 7), (7, 1), (2, 2), (3, 3)):
        assert function(np.arange(shape[0] * shape[1], dtype=float).reshape(shape)).shape == shape
    holes = rough.copy()
    holes[20:25, 30:40] = np.nan
    assert function(holes).shape == rough.shape


def test_masks_and_nodata_are_missing(rough: np.ndarray) -> None:
    holes = rough.copy()
    holes[20:25, 30:40] = np.nan
    marked = np.where(np.isnan(holes), -9999, holes).astype(np.float64)
    masked = np.ma.masked_equal(marked, -9999)
    expect = hydrology.fill(holes)
    assert np.isnan(expect[22, 35])
    assert np.array_equal(hydrology.fill(marked, nodata=-9999), expect, equal_nan=True)
    assert np.array_equal(hydrology.fill(masked), expect, equal_nan=True)


def test_filled_ground_drains_and_water_is_conserved(rough: np.ndarray) -> None:
    filled = hydrology.fill(rough)
    assert (filled >= rough).all() and (filled > rough).any()
    assert np.array_equal(hydrology.fill(filled), filled)
    area = hydrology.accumulate(rough, cell=60)
    assert area.min() == 3600
    directions = hydrology.flow_direction(rough)
    assert area[directions == 0].sum() == 3600 * rough.size
    cut = hydrology.breach(rough)
    assert (cut <= rough + 1e-3).mean() > 0.9
    assert hydrology.watersheds(rough)[1:-1, 1:-1].min() >= 1
    double = hydrology.accumulate(rough, cell=60, rain=np.full(rough.shape, 2.0))
    assert np.allclose(double, 2 * area)
    with pytest.raises(orogen.errors.RequestError, match="shape"):
        hydrology.accumulate(rough, rain=np.zeros((2, 2)))


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 30), st.integers(1, 30))
def test_filling_is_what_a_flood_does(seed: int, rows: int, columns: int) -> None:
    """The reference: Planchon and Darboux."""
    heights = np.random.default_rng(seed).integers(0, 6, (rows, columns)).astype(np.float32)
    water = np.full((rows + 2, columns + 2), np.inf, np.float32)
    inner = water[1:-1, 1:-1]
    inner[0], inner[-1], inner[:, 0], inner[:, -1] = heights[0], heights[-1], heights[:, 0], heights[:, -1]
    while True:
        lowest = np.min(
            [water[1 + j : rows + 1 + j, 1 + i : columns + 1 + i] for j in (-1, 0, 1) for i in (-1, 0, 1)], axis=0
        )
        sunk = np.minimum(inner, np.maximum(heights, lowest))
        if np.array_equal(sunk, inner):
            break
        inner[:] = sunk
    assert np.array_equal(hydrology.fill(heights), inner)


def test_contours_follow_heights() -> None:
    cone = 100 - np.hypot(*np.mgrid[-20:21, -20:21]) * 3
    lines = analysis.contours(cone, cell=10, interval=20)
    assert {line.level for line in lines} == {20.0, 40.0, 60.0, 80.0}
    top = next(line for line in lines if line.level == 80)
    assert top.closed and np.allclose(np.hypot(*(top.points - 200).T), 66.7, atol=5)
    assert [line.level for line in analysis.contours(cone, cell=10, levels=[50])] == [50]
