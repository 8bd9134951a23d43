"""Orogen, a procedural terrain engine: any window of a world, at any resolution, always the same.

>>> import orogen
>>> world = orogen.World("alpine", seed=7)
>>> height = world.window(size=1024)

Arrays have row 0 in the north and column 0 in the west; heights are float32 metres.

- `World`: presets, recipes, files of heights and arrays as worlds; windows, points, files.
- `orogen.noise`: noise at positions.
- `orogen.hydrology`, `orogen.erosion`, `orogen.analysis`: algorithms on 2-D arrays.
- `orogen.errors`: exceptions.
- `orogen.xarray`: methods of xarray's arrays; `orogen.cluster`: builds by a Dask cluster. Both are imported by name.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from orogen._orogen import __version__

if TYPE_CHECKING:
    from orogen import analysis, erosion, errors, hydrology, noise
    from orogen._world import Objects, Parameter, Sampler, Window, World, fit, presets

__all__ = [
    "Objects",
    "Parameter",
    "Sampler",
    "Window",
    "World",
    "__version__",
    "analysis",
    "erosion",
    "errors",
    "fit",
    "hydrology",
    "noise",
    "presets",
]

_MODULES = frozenset({"analysis", "erosion", "errors", "hydrology", "noise"})


def __getattr__(name: str) -> Any:
    # Loaded at first use: NumPy takes most of the time of an import, and few programs use every module.
    if name not in __all__:
        raise AttributeError(f"module 'orogen' has no attribute {name!r}")
    found = import_module(f"orogen.{name}") if name in _MODULES else getattr(import_module("orogen._world"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
