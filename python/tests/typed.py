"""Examples that type checkers must accept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import orogen
import xarray as xr
from orogen import analysis, erosion, hydrology, noise
from orogen.xarray import OrogenAccessor


def heights() -> npt.NDArray[np.float32]:
    world = orogen.World("alpine", seed=7, memory="2GiB")
    layers = world.window(["height", "flow"], size=64)
    flow: npt.NDArray[np.float32] = layers["flow"]
    window: orogen.Window = world.view(size=64)
    shade = world.window("hillshade", window=window, azimuth=315.0)
    return shade + flow + world.window(size=64)


def files(world: orogen.World) -> str:
    world.export("alpine.tif", "flow", size=64)
    world.map("alpine.pdf", contours=200.0, title="Alps")
    world.render("alpine.png", size=(640, 360), camera=(200, 24), haze=0.5)
    made: Path = world.export(Path("alpine.png"), bits="16")
    return world.export("alpine.png") + made.name


def arrays() -> npt.NDArray[np.float32]:
    y, x = np.ogrid[0:64, 0:64]
    land = 100 * noise.perlin(x, y, wavelength=32, octaves=5)
    value, dx, dy = noise.simplex(x, y, gradient=True)
    eroded = erosion.thermal(land, cell=10.0)
    water: hydrology.Lakes = hydrology.lakes(eroded, cell=10.0, area=500)
    lines = analysis.contours(water.surface, cell=10.0, interval=20)
    labels: npt.NDArray[np.uint32] = water.labels
    area: npt.NDArray[np.float32] = hydrology.accumulate(eroded, cell=10.0)
    assert labels.shape == (64, 64) and lines[0].points.shape[1] == 2
    slope: npt.NDArray[np.float32] = analysis.slope(eroded, cell=10.0)
    return slope + area + value + dx + dy


def methods(height: xr.DataArray) -> xr.DataArray:
    land = OrogenAccessor(height)
    water: xr.Dataset = land.lakes(area=500)
    lines: list[analysis.Contour] = land.contours(interval=20)
    assert lines and "surface" in water
    shade: xr.DataArray = land.hillshade(azimuth=315.0)
    return OrogenAccessor(shade).accumulate(rain=height)
