"""The rows of docs/python.md, "Coming from": both run where both install, on the same land."""

from __future__ import annotations

import warnings
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from orogen import analysis, erosion, hydrology, noise


def module(name: str) -> ModuleType:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip(name)


@pytest.fixture(scope="module")
def land() -> np.ndarray:
    """Hills with depressions, without two equal heights."""
    y, x = np.ogrid[0:60, 0:80]
    hills = 100 * noise.perlin(x, y, wavelength=30, octaves=4, seed=3).astype(np.float64)
    return hills + 0.3 * x + 1e-6 * np.random.default_rng(2).random(hills.shape)


def inside(array: Any) -> np.ndarray:
    return np.asarray(array)[2:-2, 2:-2]


@pytest.mark.filterwarnings("ignore")
def test_pysheds(land: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    module("pysheds")
    # Version 0.5 calls what NumPy 2.4 has no more.
    monkeypatch.setattr(np, "in1d", np.isin, raising=False)
    from affine import Affine
    from pysheds.grid import Grid
    from pysheds.view import Raster, ViewFinder

    shape = ViewFinder(affine=Affine(10, 0, 0, 0, -10, 0), shape=land.shape, nodata=np.float64(-9999))
    theirs = Raster(land, viewfinder=shape)
    grid = Grid.from_raster(theirs)
    filled = grid.fill_depressions(grid.fill_pits(theirs))
    assert np.allclose(inside(hydrology.fill(land)), inside(filled), atol=1e-3)
    # On ground that drains, directions and areas are the same.
    drains = erosion.stream_power(land, cell=10, years=1000, steps=1).astype(np.float64)
    raster = Raster(drains, viewfinder=shape)
    direction = grid.flowdir(raster, routing="d8")
    ours = hydrology.flow_direction(drains)
    assert (inside(direction) == inside(ours)).mean() > 0.99
    area = grid.accumulation(direction, routing="d8")
    assert np.median(np.abs(inside(area) - inside(hydrology.accumulate(drains)))) == 0


@pytest.mark.filterwarnings("ignore")
def test_richdem(land: np.ndarray) -> None:
    richdem = module("richdem")
    theirs = richdem.rdarray(land, no_data=-9999)
    assert np.allclose(hydrology.fill(land), richdem.FillDepressions(theirs), atol=1e-3)
    slope = richdem.TerrainAttribute(theirs, attrib="slope_degrees")
    assert np.allclose(inside(analysis.slope(land, cell=1)), inside(slope), atol=0.01)


@pytest.mark.filterwarnings("ignore")
def test_fastscapelib(land: np.ndarray) -> None:
    fastscapelib = module("fastscapelib")
    status = fastscapelib.NodeStatus.FIXED_VALUE
    grid = fastscapelib.RasterGrid(land.shape, [10.0, 10.0], status)
    routers = [fastscapelib.SingleFlowRouter(), fastscapelib.MSTSinkResolver()]
    graph = fastscapelib.FlowGraph(grid, routers)
    # On ground that drains, areas and erosion are the same.
    drains = erosion.stream_power(land, cell=10, years=1000, steps=1).astype(np.float64)
    graph.update_routes(drains)
    theirs = graph.accumulate(1.0)
    ours = hydrology.accumulate(drains, cell=10)
    assert np.median(np.abs(inside(theirs) - inside(ours))) == 0
    eroder = fastscapelib.SPLEroder(graph, 1e-4, 0.45, 1.0, 1e-5)
    cut = eroder.erode(drains, theirs, 1000.0)
    eroded = erosion.stream_power(drains, cell=10, years=1000, steps=1, erodibility=1e-4, uplift=0)
    assert np.corrcoef(inside(cut).ravel(), inside(drains - eroded).ravel())[0, 1] > 0.95
    assert inside(cut).mean() == pytest.approx(inside(drains - eroded).mean(), rel=0.2)


@pytest.mark.filterwarnings("ignore")
def test_xarray_spatial(land: np.ndarray) -> None:
    xrspatial = module("xrspatial")
    import xarray as xr

    y, x = 10.0 * np.arange(land.shape[0])[::-1], 10.0 * np.arange(land.shape[1])
    theirs = xr.DataArray(land, {"y": y, "x": x}, ("y", "x"), attrs={"res": (10.0, 10.0)})
    assert np.allclose(inside(xrspatial.slope(theirs)), inside(analysis.slope(land, cell=10)), atol=0.01)
    aspect = np.abs(inside(xrspatial.aspect(theirs)) - inside(analysis.aspect(land, cell=10)))
    assert np.median(np.minimum(aspect, 360 - aspect)) < 0.1


@pytest.mark.filterwarnings("ignore")
def test_opensimplex() -> None:
    opensimplex = module("opensimplex")
    x, y = np.arange(40) / 7.0, np.arange(30) / 7.0
    opensimplex.seed(1)
    theirs = opensimplex.noise2array(x, y)
    ours = noise.opensimplex2(x, y[:, None], seed=1)
    assert ours.shape == theirs.shape and abs(ours.std() / theirs.std() - 1) < 0.6


@pytest.mark.filterwarnings("ignore")
def test_noise() -> None:
    theirs = module("noise")
    made = np.array([[theirs.pnoise2(x / 9, y / 9, octaves=3) for x in range(40)] for y in range(30)])
    ours = noise.perlin(np.arange(40), np.arange(30)[:, None], wavelength=9, octaves=3)
    assert ours.shape == made.shape and abs(ours.std() / made.std() - 1) < 0.6


@pytest.mark.filterwarnings("ignore")
def test_perlin_numpy() -> None:
    perlin_numpy = module("perlin_numpy")
    theirs = perlin_numpy.generate_perlin_noise_2d((64, 64), (4, 4))
    y, x = np.ogrid[0:64, 0:64]
    ours = noise.perlin(x, y, wavelength=16)
    assert ours.shape == theirs.shape and abs(ours.std() / theirs.std() - 1) < 0.6
