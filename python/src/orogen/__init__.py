"""Orogen, a procedural terrain engine: any window of a world, at any resolution, always the same.

>>> import orogen
>>> world = orogen.World("alpine", seed=7)
>>> height = world.window(size=1024)

Arrays have row 0 in the north and column 0 in the west; heights are float32 metres.

- `World`: presets, recipes, files of heights and arrays as worlds; windows, points, files.
- `orogen.noise`: noise at positions.
- `orogen.hydrology`, `orogen.erosion`, `orogen.analysis`: algorithms on 2-D arrays.
- `orogen.errors`: exceptions.
"""

from orogen import analysis, erosion, errors, hydrology, noise
from orogen._orogen import __version__
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
