"""Worlds as xarray datasets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import orogen
import pytest

xr = pytest.importorskip("xarray")
pytest.importorskip("dask")

RECIPE = """
orogen = 1
[world]
size = [6000, 4000]
cell = 20
crs = "EPSG:32632"
origin = [600000, 5200000]
[nodes.a]
op = "fbm"
wavelength = 900
[nodes.b]
op = "remap"
source = "a"
to = [0, 300]
[outputs]
height = "b"
rough = "a"
"""


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    path = tmp_path / "world.toml"
    path.write_text(RECIPE)
    return path


def test_a_dataset_has_coordinates_units_and_crs() -> None:
    world = orogen.World(RECIPE, cache=False)
    data = world.to_xarray(["height", "rough"], window=(10, 20, 30, 40))
    assert data.height.dims == ("y", "x") and data.height.shape == (40, 30)
    assert float(data.x[0]) == 600_200 and float(data.y[0]) == 5_199_600
    assert float(data.y[1]) < float(data.y[0]) and data.height.attrs["units"] == "m"
    assert 'WGS 84 / UTM zone 32N' in data.spatial_ref.attrs["crs_wkt"]
    assert data.spatial_ref.attrs["GeoTransform"] == "600190.0 20.0 0 5199610.0 0 -20.0"
    assert np.array_equal(data.height, world.window(window=(10, 20, 30, 40)))


def test_a_dataset_is_lazy_and_any_chunks_are_the_same(recipe: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = orogen.World(recipe, cache=False).window()
    made: list[tuple[int, int]] = []
    read = orogen.World.window

    def counted(self: orogen.World, *layers: str, **view: object) -> np.ndarray:
        samples = read(self, *layers, **view)
        made.append(samples.shape)
        return samples

    monkeypatch.setattr(orogen.World, "window", counted)
    data = xr.open_dataset(recipe, engine="orogen")
    assert list(data.data_vars) == ["height", "rough"] and data.height.shape == whole.shape and not made
    assert np.array_equal(data.height[30:50, 7:19], whole[30:50, 7:19])
    assert made == [(20, 12)]
    assert np.array_equal(data.height[::-7, 5:60:3], whole[::-7, 5:60:3])
    assert np.array_equal(data.height[4], whole[4]) and float(data.height[4, 5]) == whole[4, 5]
    assert data.height[5:5].shape == (0, 300)
    assert np.array_equal(data.height.isel(x=[5, 2, 9]), whole[:, [5, 2, 9]])
    for chunks in ({"x": 64, "y": 64}, {"x": 31, "y": -1}, {}):
        chunked = xr.open_dataset(recipe, engine="orogen", chunks=chunks)
        assert np.array_equal(chunked.height.compute(scheduler="threads"), whole)
    north = data.height.sel(x=slice(600_500, 601_000), y=slice(5_199_500, 5_199_000))
    assert north.shape == (26, 26) and np.array_equal(north, whole[25:51, 25:51])


def test_options_choose_layers_and_samples(recipe: Path) -> None:
    data = xr.open_dataset(recipe, engine="orogen", cell=40, layers=["rough"], seed=5)
    assert list(data.data_vars) == ["rough"] and data.rough.shape == (100, 150) and data.attrs["seed"] == 5
    assert not xr.open_dataset(recipe, engine="orogen", drop_variables="rough").data_vars.keys() & {"rough"}
    assert xr.open_dataset("hills", engine="orogen", size=64).height.shape == (64, 64)
    with pytest.raises(orogen.errors.RequestError, match="nothing"):
        xr.open_dataset(recipe, engine="orogen", layers=["nothing"])
