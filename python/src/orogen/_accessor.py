"""Methods of xarray's arrays: `DataArray.orogen`."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from orogen._arrays import F32, F64, heights as _heights
from orogen._methods import Methods
from orogen.analysis import Contour
from orogen.errors import RequestError

#: Names of the dimensions of columns and rows.
EASTWARD = ("x", "lon", "longitude", "easting", "east")
NORTHWARD = ("y", "lat", "latitude", "northing", "north")

#: Metres in a unit of coordinates.
METRES = {"": 1.0, "m": 1.0, "meter": 1.0, "metre": 1.0, "meters": 1.0, "metres": 1.0, "km": 1000.0}

#: Units of results, as in the layers of worlds.
UNITS = {
    "above_drainage.height": "m",
    "above_drainage.distance": "m",
    "accumulate": "m^2",
    "aspect": "degree",
    "curvature": "1/m",
    "drainage_area": "m^2",
    "filled": "m",
    "flow_distance": "m",
    "height_above_drainage": "m",
    "insolation": "kWh/m^2",
    "lakes.surface": "m",
    "pipes.ground": "m",
    "pipes.water": "m",
    "slope": "degree",
    "soil_depth": "m",
    "stream_distance": "m",
    "stream_power_index": "m",
    "tpi": "m",
    "tri": "m",
}

#: Functions whose results are heights: they keep the name and the attributes of the array.
HEIGHTS = frozenset({"breach", "droplets", "fill", "filled", "stream_power", "thermal"})


def _disc(limit: int, usual: float, key: str) -> Callable[[float, Mapping[str, Any]], int]:
    """The halo of a function that reads up to a distance in metres."""

    def halo(cell: float, options: Mapping[str, Any]) -> int:
        reach = options.get(key)
        return min(max(math.floor((usual if reach is None else reach) / cell), 1), limit)

    return halo


#: Functions that read a finite neighborhood: its radius in samples, as the ops of the engine declare it.
HALOS: dict[str, Callable[[float, Mapping[str, Any]], int]] = {
    **dict.fromkeys(("aspect", "curvature", "hillshade", "normal", "slope", "soil_depth", "tri"), lambda *_: 1),
    "landforms": _disc(1024, 500.0, "reach"),
    "occlusion": lambda cell, _: min(max(math.ceil(1000.0 / cell), 1), 128),
    "slope_position": _disc(1024, 300.0, "disc"),
    "thermal": lambda _, options: max(int(options["passes"]), 1),
    "tpi": _disc(1024, 300.0, "disc"),
}


class Layout(NamedTuple):
    """How an array lies on the map."""

    rows: str
    columns: str
    #: The steps that put row 0 in the north and column 0 in the west: 1 or -1.
    order: tuple[int, int]
    #: Coordinates of the first sample in this order, and from one sample to the next, (x, y); None without coordinates.
    start: tuple[float, float] | None
    step: tuple[float, float] | None

    @property
    def flip(self) -> tuple[slice, slice]:
        """The key that orders rows and columns, and brings them back."""
        return (slice(None, None, self.order[0]), slice(None, None, self.order[1]))


class OrogenAccessor(Methods):
    """The functions of `orogen.hydrology`, `orogen.erosion` and `orogen.analysis` for an array of heights.

    The array has two dimensions, such as `y` and `x`, with evenly spaced coordinates in metres; they give `cell` and
    the direction of north. `cell=` replaces the distance, for coordinates in degrees or none. Results have the
    coordinates of the array; functions with several results return a Dataset. Factors such as `rain` are arrays with
    the same coordinates. The `observer` of a viewshed and the points of contours are in coordinates of the array.

    On chunks of Dask, functions that read a finite neighborhood are lazy, with the bits of the whole array.
    """

    def __init__(self, array: xr.DataArray) -> None:
        self._heights = array

    def _array(self, function: str, options: Mapping[str, Any]) -> xr.DataArray:
        layout, made = self._run(function, options)
        name = function.split(".")[1]
        return self._wrapped(layout, made, name, UNITS.get(name, ""), name in HEIGHTS)

    def _dataset(self, function: str, options: Mapping[str, Any]) -> xr.Dataset:
        layout, made = self._run(function, options)
        name = function.split(".")[1]
        parts = zip(made._fields, made, strict=True)
        return xr.Dataset(
            {key: self._wrapped(layout, part, key, UNITS.get(f"{name}.{key}", ""), False) for key, part in parts}
        )

    def _lines(self, function: str, options: Mapping[str, Any]) -> list[Contour]:
        layout, made = self._run(function, options)
        if layout.start is None or layout.step is None:
            return list(made)
        cell = self._cell(layout, options.get("cell"))
        per_metre = np.array(layout.step) / cell
        return [line._replace(points=layout.start + line.points * per_metre) for line in made]

    def _run(self, function: str, options: Mapping[str, Any]) -> tuple[Layout, Any]:
        """The result of a function for the array with row 0 in the north and column 0 in the west."""
        module, name = function.split(".")
        array = self._heights
        layout = _layout(array)
        given = dict(options)
        if "cell" in given:
            given["cell"] = self._cell(layout, given["cell"])
        if given.get("observer") is not None:
            given["observer"] = _metres(layout, given["observer"], given["cell"])
        for key, value in given.items():
            if isinstance(value, xr.DataArray) or np.ndim(value) == 2:
                given[key] = _factor(array, layout, key, value)
        heights = array.transpose(layout.rows, layout.columns).data[layout.flip]
        if array.chunks is None:
            return layout, getattr(importlib.import_module(f"orogen.{module}"), name)(np.ma.asarray(heights), **given)
        if name not in HALOS:
            raise RequestError(
                f"`{name}` reads the whole array, so it cannot be computed chunk by chunk; load the array first, if it "
                f"fits in memory: `array.compute().orogen.{name}(...)`"
            )
        if given.pop("progress", None):
            raise RequestError("`progress` is not for chunked arrays; use dask.diagnostics.ProgressBar")
        return layout, _blockwise(heights, function, HALOS[name](given["cell"], given), given)

    def _cell(self, layout: Layout, given: float | None) -> float:
        """The distance between samples in metres."""
        if given is not None:
            return given
        if layout.step is None:
            raise RequestError("the array has no coordinates; set `cell`, the distance between samples in metres")
        array = self._heights
        sizes = []
        for name, step in zip((layout.columns, layout.rows), layout.step, strict=True):
            unit = str(array[name].attrs.get("units", "")).lower() if name in array.coords else ""
            if unit.startswith("degree") or name in ("lon", "longitude", "lat", "latitude") or _is_geographic(array):
                raise RequestError(
                    f"the coordinate `{name}` is in degrees; reproject the array to metres, or set `cell`, the "
                    "distance between samples in metres"
                )
            if unit not in METRES:
                raise RequestError(
                    f"the coordinate `{name}` is in {unit!r}, not in metres; set `cell`, the distance between samples "
                    "in metres"
                )
            if not math.isnan(step):
                sizes.append(abs(step) * METRES[unit])
        if not sizes:
            raise RequestError("a single sample has no distance to others; set `cell`, in metres")
        if max(sizes) - min(sizes) > 1e-6 * max(sizes):
            raise RequestError(
                f"the samples are {sizes[0]:g} m apart along `{layout.columns}` and {sizes[1]:g} m along "
                f"`{layout.rows}`; resample the array to square cells"
            )
        # Without the rounding of coordinates, which differs from part to part of an array.
        return float(f"{sizes[0]:.9g}")

    def _wrapped(self, layout: Layout, made: Any, name: str, unit: str, is_height: bool) -> xr.DataArray:
        """A result with the coordinates, the order and the dimensions of the array."""
        array = self._heights
        made = made[(..., *layout.flip)]
        if isinstance(made, np.ndarray):
            made = np.ascontiguousarray(made)
        if is_height:
            about, name = dict(array.attrs), str(array.name or name)
        else:
            about = {"long_name": name.replace("_", " ")} | ({"units": unit} if unit else {})
            about |= {key: array.attrs[key] for key in ("grid_mapping",) if key in array.attrs}
        channels = ("channel",) * (made.ndim - 2)
        result = xr.DataArray(made, array.coords, (*channels, layout.rows, layout.columns), name, about)
        return result.transpose(*channels, *array.dims)


register: Any = xr.register_dataarray_accessor
register("orogen")(OrogenAccessor)


def _layout(array: xr.DataArray) -> Layout:
    """Which dimension is which, and their directions."""
    if array.ndim != 2:
        raise RequestError(
            f"an array of heights has two dimensions, such as y and x; this one has {array.dims}: choose from the "
            "others with `.isel(...)` or `.squeeze()`"
        )
    names = [str(name) for name in array.dims]
    columns = next((name for name in names if _is_named(array, name, EASTWARD, "X")), None)
    rows = next((name for name in names if name != columns and _is_named(array, name, NORTHWARD, "Y")), None)
    if rows is None:
        rows = next(name for name in names if name != columns)
    if columns is None:
        columns = next(name for name in names if name != rows)
    (left, east), (top, north) = _axis(array, columns), _axis(array, rows)
    order = (-1 if north > 0 else 1, -1 if east < 0 else 1)
    if columns not in array.coords or rows not in array.coords:
        return Layout(rows, columns, order, None, None)
    west = left + east * (array.sizes[columns] - 1) if east < 0 else left
    first = top + north * (array.sizes[rows] - 1) if north > 0 else top
    return Layout(rows, columns, order, (west, first), (abs(east), -abs(north)))


def _is_named(array: xr.DataArray, name: str, names: tuple[str, ...], axis: str) -> bool:
    return name.lower() in names or (name in array.coords and array[name].attrs.get("axis") == axis)


def _axis(array: xr.DataArray, name: str) -> tuple[float, float]:
    """The first coordinate, and the distance from one to the next; NaN for a single one or none."""
    if name not in array.coords:
        return (math.nan, math.nan)
    values = np.asarray(array[name].values)
    if values.dtype.kind not in "iuf":
        raise RequestError(f"the coordinate `{name}` must be numbers, not {values.dtype}")
    places: F64 = values.astype(np.float64)
    if len(places) < 2:
        return (float(places[0]) if len(places) else math.nan, math.nan)
    step = float(places[-1] - places[0]) / (len(places) - 1)
    # Coordinates in float32 are rounded.
    exact = np.finfo(values.dtype if values.dtype.kind == "f" else np.float64).eps * float(np.abs(places).max())
    if not abs(step) > 0 or float(np.abs(np.diff(places) - step).max()) > 1e-3 * abs(step) + 2 * exact:
        raise RequestError(
            f"the coordinate `{name}` is not evenly spaced; resample the array to a regular grid, such as with "
            "`.interp(...)`"
        )
    return (float(places[0]), step)


def _is_geographic(array: xr.DataArray) -> bool:
    """Whether the coordinate reference system, as rioxarray and CF write it, is in degrees."""
    name = array.attrs.get("grid_mapping", "spatial_ref")
    text = str(array[name].attrs.get("crs_wkt", "")) if name in array.coords else ""
    return text.startswith(("GEOGCS", "GEOGCRS"))


def _metres(layout: Layout, place: Any, cell: float) -> tuple[float, float]:
    """A position in coordinates as metres east and south of the north-west sample."""
    x, y = (float(value) for value in place)
    if layout.start is None or layout.step is None:
        return (x, y)
    (west, north), (east, south) = layout.start, layout.step
    return ((x - west) / east * cell, (y - north) / south * cell)


def _factor(array: xr.DataArray, layout: Layout, name: str, value: Any) -> Any:
    """An array beside the heights, in the order of the heights."""
    if isinstance(value, xr.DataArray):
        try:
            value = xr.align(array, value, join="exact", copy=False)[1].transpose(layout.rows, layout.columns)
        except ValueError:
            raise RequestError(f"`{name}` must have the dimensions and coordinates of the array") from None
        return value.values[layout.flip]
    value = np.ma.asarray(value)
    if value.shape != array.shape:
        raise RequestError(f"`{name}` has the shape {value.shape}, and the array {array.shape}")
    return (value if array.dims == (layout.rows, layout.columns) else value.T)[layout.flip]


def _blockwise(heights: Any, function: str, halo: int, options: Mapping[str, Any]) -> Any:
    """A function for each chunk, with the samples around it that it reads."""
    import dask.array

    da: Any = dask.array
    # Along an axis that is no longer than the halo there is one chunk, which needs none.
    depth = {axis: 0 if halo >= size else halo for axis, size in enumerate(heights.shape)}
    heights = heights.rechunk({axis: -1 for axis, size in enumerate(heights.shape) if halo >= size})
    call = partial(_block, function=function, options=dict(options))
    grown = da.overlap.overlap(heights, depth, boundary="none", allow_rechunk=True)
    if function != "analysis.normal":
        made = da.map_blocks(call, grown, dtype=np.float32, meta=np.empty((0, 0), np.float32))
        return da.overlap.trim_internal(made, depth, boundary="none")
    made = da.map_blocks(
        call,
        grown,
        dtype=np.float32,
        new_axis=0,
        chunks=((3,), *grown.chunks),
        meta=np.empty((0, 0, 0), np.float32),
    )
    return da.overlap.trim_internal(made, {0: 0, 1: depth[0], 2: depth[1]}, boundary="none")


def _block(heights: Any, function: str, options: Mapping[str, Any]) -> F32:
    module, name = function.split(".")
    if module == "analysis":
        missing = np.isnan(_heights(heights, options.get("nodata")))
        if missing.all():
            return np.full((3, *missing.shape) if name == "normal" else missing.shape, np.nan, np.float32)
        if missing.any():
            # The interpolated heights depend on the whole array.
            raise RequestError(
                f"`{name}` of a chunked array needs heights everywhere, because missing ones are interpolated from the "
                "whole array; fill them first, such as with `.fillna(0)`, and mask the result with `.where(...)`, or "
                "load the array with `.compute()`"
            )
    made: F32 = getattr(importlib.import_module(f"orogen.{module}"), name)(heights, **options)
    return made
