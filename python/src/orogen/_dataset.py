"""Arrays of a world as an xarray dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import xarray as xr

# Arrays of worlds have the methods without another import.
import orogen._accessor  # noqa: F401
from orogen._arrays import F64


class Lattice(Protocol):
    """A window."""

    @property
    def east(self) -> F64: ...
    @property
    def south(self) -> F64: ...
    @property
    def cell(self) -> float: ...


class Described(Protocol):
    """A world."""

    _native: Any

    @property
    def name(self) -> str: ...
    @property
    def about(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def epsg(self) -> int | None: ...
    @property
    def layers(self) -> dict[str, str]: ...


def dataset(world: Described, layers: Sequence[str], window: Lattice, arrays: dict[str, Any]) -> xr.Dataset:
    """Arrays of a window with its coordinates; arrays may be lazy."""
    (west, north), (per_east, per_north) = world._native.placement
    x, y = west + window.east * per_east, north - window.south * per_north
    units = "degree" if world.epsg is not None and abs(per_east) < 0.1 else "m"
    coordinates: dict[str, Any] = {
        "y": ("y", y, {"units": units, "axis": "Y", "long_name": "northing"}),
        "x": ("x", x, {"units": units, "axis": "X", "long_name": "easting"}),
    }
    mapping: dict[str, Any] = {}
    if world.epsg is not None:
        attributes: dict[str, Any] = {"crs_wkt": world._native.wkt, "GeoTransform": _transform(x, y, window, per_east, per_north)}
        coordinates["spatial_ref"] = ((), 0, attributes)
        mapping = {"grid_mapping": "spatial_ref"}
    variables: dict[str, Any] = {}
    for layer in layers:
        unit = world.layers.get(layer, "")
        about_layer: dict[str, Any] = {"long_name": layer, "cell": window.cell} | ({"units": unit} if unit else {}) | mapping
        array = arrays[layer]
        dims = ("y", "x") if array.ndim == 2 else ("channel", "y", "x")
        variables[layer] = xr.Variable(dims, array, about_layer)
    about = {"title": world.name, "comment": world.about, "source": "Orogen", "seed": world.seed}
    return xr.Dataset(variables, coordinates, about)


def _transform(x: F64, y: F64, window: Lattice, per_east: float, per_north: float) -> str:
    """The transform of GDAL: from the corner of the first pixel."""
    step_x, step_y = window.cell * per_east, -window.cell * per_north
    left, top = float(x[0] - step_x / 2), float(y[0] - step_y / 2)
    return f"{left!r} {step_x!r} 0 {top!r} 0 {step_y!r}"
