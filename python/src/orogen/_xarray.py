"""Worlds as lazy xarray datasets: `xarray.open_dataset(path, engine="orogen")`."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from orogen._arrays import F32
from orogen._dataset import dataset
from orogen._world import Window, World
from orogen.errors import RequestError


class LayerArray(BackendArray):
    """A layer over a window, of which only the samples that are read are made."""

    def __init__(self, world: World, layer: str, window: Window) -> None:
        self.world = world
        self.layer = layer
        self.whole = window
        self.shape = window.shape
        self.dtype: npt.DTypeLike = np.dtype(np.float32)

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return len(self.shape)

    def __getitem__(self, key: Any) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[Any, ...]) -> Any:
        rows, columns = (_spread(part, length) for part, length in zip(key, self.shape, strict=True))
        whole = self.whole
        window = Window(
            whole.x + columns.start, whole.y + rows.start, len(columns) or 1, len(rows) or 1, whole.cell
        )
        if len(rows) == 0 or len(columns) == 0:
            samples: F32 = np.empty((len(rows), len(columns)), np.float32)
        else:
            samples = self.world.window(self.layer, window=window)
        # What is left of the key: an index drops its dimension, and a step or a direction chooses among the samples.
        return samples[tuple(_rest(part, length) for part, length in zip(key, self.shape, strict=True))]


def _spread(part: Any, length: int) -> range:
    """All samples between the first and the last one of an index or a slice."""
    if isinstance(part, slice):
        chosen = range(*part.indices(length))
        return range(min(chosen), max(chosen) + 1) if len(chosen) else range(0)
    return range(int(part), int(part) + 1)


def _rest(part: Any, length: int) -> Any:
    if not isinstance(part, slice):
        return 0
    return slice(None, None, part.indices(length)[2])


class OrogenBackend(BackendEntrypoint):
    """Presets, recipes and files of heights as datasets whose samples are made when they are read."""

    description = "Worlds of Orogen: presets, recipes (.toml) and their layers, lazily"
    open_dataset_parameters = ("filename_or_obj", "drop_variables")

    def open_dataset(
        self,
        filename_or_obj: Any,
        *,
        drop_variables: str | Iterable[str] | None = None,
        layers: Sequence[str] | None = None,
        size: int | tuple[int, int] | None = None,
        window: Any = None,
        bounds: tuple[float, float, float, float] | None = None,
        cell: float | None = None,
        parameters: dict[str, float] | None = None,
        seed: int | None = None,
        memory: int | str | None = None,
    ) -> xr.Dataset:
        """Opens a world; `layers` are by default those of the recipe, the other options as those of `World`."""
        world = World(filename_or_obj, parameters=parameters, seed=seed, memory=memory)
        names = list(world.layers) if layers is None else [layers] if isinstance(layers, str) else list(layers)
        dropped = [drop_variables] if isinstance(drop_variables, str) else list(drop_variables or ())
        names = [name for name in names if name not in dropped]
        unknown = [name for name in names if name not in world.layers]
        if unknown:
            raise RequestError(f"the recipe has no layer {unknown[0]!r}; it has: {', '.join(world.layers)}")
        found = world.view(size=size, window=window, bounds=bounds, cell=cell)
        arrays = {name: indexing.LazilyIndexedArray(LayerArray(world, name, found)) for name in names}
        return dataset(world, names, found, arrays)

    def guess_can_open(self, filename_or_obj: Any) -> bool:
        """Recipes alone: other readers open files of heights."""
        try:
            return str(os.fspath(filename_or_obj)).endswith(".toml")
        except TypeError:
            return False
