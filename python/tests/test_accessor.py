"""`DataArray.orogen`: coordinates give cell and north, and chunks give the bits of the whole array."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import orogen
import pytest
from orogen import analysis, erosion, hydrology

xr = pytest.importorskip("xarray")
import orogen.xarray  # noqa: E402
from orogen._accessor import HALOS, HEIGHTS, UNITS  # noqa: E402
from orogen._methods import Methods  # noqa: E402

METHODS = [name for name in vars(Methods) if not name.startswith("_")]

#: Options that functions require, or that make them quick and their halos differ.
OPTIONS: dict[str, dict[str, Any]] = {
    "above_drainage": {"area": 2e4},
    "droplets": {"density": 300, "lifetime": 200},
    "insolation": {"day": 172},
    "lakes": {"area": 2e3},
    "pipes": {"iterations": 4},
    "stream_order": {"area": 2e4},
    "stream_power": {"years": 1e4, "steps": 2},
    "thermal": {"passes": 5, "talus": 0.2},
}


def land(rows: int = 46, columns: int = 61) -> np.ndarray:
    y, x = np.ogrid[0:rows, 0:columns]
    return 120 * orogen.noise.perlin(x, y, wavelength=25, octaves=4, seed=3)


def placed(heights: np.ndarray, cell: float = 30.0) -> Any:
    rows, columns = heights.shape
    coordinates = {"y": 5_200_000 - cell * np.arange(rows), "x": 600_000 + cell * np.arange(columns)}
    return xr.DataArray(heights, coordinates, ("y", "x"), "height", {"units": "m"})


def called(array: Any, name: str, **more: Any) -> Any:
    options = OPTIONS.get(name, {}) | more
    if name == "viewshed":
        options |= {"observer": (float(array.x.mean()), float(array.y.mean()))}
    return getattr(array.orogen, name)(**options)


def same(one: Any, other: Any) -> bool:
    return bool(np.array_equal(one, other, equal_nan=one.dtype.kind == "f"))


def test_every_function_of_heights_is_a_method() -> None:
    functions: set[str] = set()
    for module in (hydrology, erosion, analysis):
        functions |= {name for name in module.__all__ if name[0].islower()}
    assert set(METHODS) == functions
    assert {name.split(".")[0] for name in UNITS} | set(HALOS) | HEIGHTS <= functions
    assert Methods.slope.__doc__ and "Horn" in Methods.slope.__doc__


@pytest.mark.parametrize("name", METHODS)
def test_a_method_is_the_function_in_any_order_of_samples(name: str) -> None:
    whole = placed(land())
    result = called(whole, name)
    turned = {
        "y ascends": whole[::-1],
        "x descends": whole[:, ::-1],
        "columns first": whole.T,
        "both": whole[::-1, ::-1].T,
    }
    if name == "contours":
        assert result and all(np.array_equal(a.points, b.points) for a, b in zip(result, called(turned["both"], name)))
        sloping = whole.y - 5_199_000 + 0 * whole.x
        assert np.allclose(sloping.orogen.contours(levels=[40])[0].points[:, 1], 5_199_040)
        return
    parts = result.data_vars.values() if isinstance(result, xr.Dataset) else [result]
    for part in parts:
        assert part.dims[-2:] == ("y", "x") and part.coords.equals(whole.coords)
    module = hydrology if hasattr(hydrology, name) else erosion if hasattr(erosion, name) else analysis
    options = OPTIONS.get(name, {}) | ({"observer": (30 * 30, 22.5 * 30)} if name == "viewshed" else {})
    if name not in ("fill", "breach", "flow_direction", "watersheds"):
        options = options | {"cell": 30.0}
    plain = getattr(module, name)(whole.values, **options)
    for part, expect in zip(parts, [plain] if isinstance(plain, np.ndarray) else plain, strict=True):
        assert same(part.values, expect) and part.dtype == expect.dtype
    for kind, array in turned.items():
        again = called(array, name)
        assert again.dims == result.dims[:-2] + array.dims if isinstance(again, xr.DataArray) else True, kind
        assert (again.sel(x=whole.x, y=whole.y).transpose(*result.dims)).identical(result), kind


def test_results_have_names_and_units() -> None:
    height = placed(land())
    slope = height.orogen.slope()
    assert slope.name == "slope" and slope.attrs == {"long_name": "slope", "units": "degree"}
    filled = height.orogen.fill()
    assert filled.name == "height" and filled.attrs == height.attrs
    water = height.orogen.lakes(area=2e3)
    assert list(water.data_vars) == ["labels", "surface"] and water.surface.attrs["units"] == "m"
    rain = xr.ones_like(height) * 2
    assert np.allclose(height[::-1].orogen.accumulate(rain=rain[::-1]).sel(y=height.y), 2 * height.orogen.accumulate())
    with pytest.raises(orogen.errors.RequestError, match="coordinates"):
        height.orogen.accumulate(rain=rain[1:])


def test_layers_of_worlds_keep_their_place() -> None:
    world = orogen.World(land(), cell=25.0, crs="EPSG:32632", origin=(600_000, 5_200_000), cache=False)
    height = world.to_xarray().height
    slope = height.orogen.slope()
    assert slope.attrs["grid_mapping"] == "spatial_ref" and "spatial_ref" in slope.coords
    assert np.array_equal(slope, world.window("slope"))


@pytest.mark.parametrize("name", sorted(HALOS))
def test_chunks_have_the_bits_of_the_whole(name: str) -> None:
    pytest.importorskip("dask")
    # A large cell makes for small halos.
    for cell, options in ((110.0, {}), (30.0, {"disc": 95.0} if name in ("tpi", "slope_position") else {})):
        whole = placed(land(), cell)
        expect = called(whole, name, **options)
        random = np.random.default_rng(8)
        cuts = [((46,), (61,)), ((1, 45), (60, 1)), ((23, 23), (20, 21, 20)), ((2,) * 23, (61,))]
        for _ in range(3):
            cuts.append(tuple(_pieces(random, length) for length in whole.shape))  # type: ignore[arg-type]
        for chunks in cuts:
            lazy = called(whole.chunk({"y": chunks[0], "x": chunks[1]}), name, **options)
            assert lazy.chunks is not None and lazy.name == expect.name
            assert same(lazy.values, expect.values), (name, cell, chunks)
        turned = called(whole[::-1].T.chunk({"y": 17, "x": 23}), name, **options)
        assert same(turned.sel(x=whole.x, y=whole.y).transpose(*expect.dims).values, expect.values)


def _pieces(random: np.random.Generator, length: int) -> tuple[int, ...]:
    cuts = sorted({0, length, *random.integers(1, length, 3).tolist()})
    return tuple(b - a for a, b in zip(cuts, cuts[1:], strict=False))


@pytest.mark.parametrize("name", sorted(set(METHODS) - set(HALOS)))
def test_what_reads_the_whole_is_refused_on_chunks(name: str) -> None:
    pytest.importorskip("dask")
    with pytest.raises(orogen.errors.RequestError, match=rf"whole array.*compute\(\)\.orogen\.{name}"):
        called(placed(land()).chunk(20), name)


def test_missing_samples_of_chunks() -> None:
    pytest.importorskip("dask")
    heights = land()
    heights[:, :30] = np.nan
    whole = placed(heights)
    far = whole.chunk({"y": 46, "x": (10, 51)})
    with pytest.raises(orogen.errors.RequestError, match="fillna"):
        far.orogen.slope().compute()
    assert bool(far.orogen.slope()[:, :9].isnull().all())
    expect = whole.orogen.thermal(passes=4)
    assert same(far.orogen.thermal(passes=4).values, expect.values)
    filled = far.fillna(0).orogen.slope()
    assert same(filled.values, whole.fillna(0).orogen.slope().values)


def test_coordinates_must_be_even_and_in_metres() -> None:
    height = placed(land())
    refused = orogen.errors.RequestError
    with pytest.raises(refused, match="`x` is not evenly spaced"):
        height.assign_coords(x=np.arange(61.0) ** 1.3).orogen.slope()
    with pytest.raises(refused, match="30 m apart along `x` and 60 m"):
        height[::2].orogen.slope()
    with pytest.raises(refused, match="degrees"):
        height.rename(x="lon", y="lat").orogen.slope()
    with pytest.raises(refused, match="'ft'"):
        height.assign_coords(x=("x", height.x.values, {"units": "ft"})).orogen.slope()
    with pytest.raises(refused, match="set `cell`"):
        height.drop_vars(["x", "y"]).orogen.slope()
    with pytest.raises(refused, match="two dimensions"):
        height.expand_dims("time").orogen.slope()
    expect = height.orogen.slope().values
    assert same(height.rename(x="lon", y="lat").orogen.slope(cell=30).values, expect)
    assert same(height.drop_vars(["x", "y"]).orogen.slope(cell=30).values, expect)
    assert same(height.assign_coords(x=height.x.astype("f4"), y=height.y.astype("f4")).orogen.slope().values, expect)
    kilometres = {name: (name, height[name].values / 1000, {"units": "km"}) for name in ("x", "y")}
    assert same(height.assign_coords(kilometres).orogen.slope().values, expect)
    assert height[:1, :1].drop_vars(["x", "y"]).orogen.fill().shape == (1, 1)
    assert height[:1].orogen.slope().shape == (1, 61)


def test_arrays_of_worlds_have_the_methods() -> None:
    code = "import orogen, xarray; orogen.World('hills').to_xarray(size=8).height.orogen.slope()"
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)
    assert orogen.xarray.OrogenAccessor(placed(land())).slope().name == "slope"
