"""The native part. Its functions are called by the Python part only, which has their docs."""

from collections.abc import Callable
from os import PathLike
from typing import Any, Final, TypeAlias, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "Points",
    "World",
    "__version__",
    "above_drainage",
    "accumulate",
    "breach",
    "cache_folder",
    "contours",
    "declared",
    "derived_layers",
    "droplets",
    "fill",
    "fit",
    "flow_direction",
    "lakes",
    "layer",
    "memory_of",
    "noise",
    "pipes",
    "presets",
    "stream_order",
    "stream_power",
    "thermal",
    "watersheds",
    "write",
]
__version__: Final[str]

_F32: TypeAlias = npt.NDArray[np.float32]
_F64: TypeAlias = npt.NDArray[np.float64]
_U8: TypeAlias = npt.NDArray[np.uint8]
_U32: TypeAlias = npt.NDArray[np.uint32]
_Listener: TypeAlias = Callable[[float], object] | None
_Part: TypeAlias = tuple[int, int, int, int, float]
_Choice: TypeAlias = tuple[Any, ...]
_Declaration: TypeAlias = tuple[str, str, str, str]

@final
class Points:
    def points(self, x: _F64, y: _F64) -> _F32: ...
    def window(self, part: _Part) -> _F32: ...

@final
class World:
    def __new__(
        cls,
        *,
        source: str | PathLike[str] | None,
        text: str | None,
        heights: _F32 | None,
        cell: float,
        parameters: list[tuple[str, float]],
        seed: int | None,
        crs: str | None,
        origin: tuple[float, float] | None,
        threads: int | None,
        memory: int | None,
        cache: str | PathLike[str] | None,
    ) -> World: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def layers(self) -> list[tuple[str, str]]: ...
    @property
    def toml(self) -> str: ...
    @property
    def about(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def cell(self) -> float: ...
    @property
    def size(self) -> tuple[float, float] | None: ...
    @property
    def sea_level(self) -> float: ...
    @property
    def epsg(self) -> int | None: ...
    @property
    def wkt(self) -> str | None: ...
    @property
    def placement(self) -> tuple[list[float], list[float]]: ...
    @property
    def parameters(self) -> list[tuple[str, float, float, float, str, str]]: ...
    def key(self, layer: str) -> str: ...
    def view(self, choice: _Choice) -> tuple[_Part, list[str]]: ...
    def read(self, layers: list[str], part: _Part, options: dict[str, Any], progress: _Listener) -> list[_F32]: ...
    def points(self, layer: str, x: _F64, y: _F64) -> _F32: ...
    def sampler(self, layer: str) -> Points: ...
    def picture(self, part: _Part) -> bytes: ...
    def analyze(
        self,
        name: str,
        layer: str,
        part: _Part,
        page: str | PathLike[str] | None,
        overwrite: bool | None,
        progress: _Listener,
    ) -> str: ...
    def refined(self, cell: float | None, options: dict[str, Any]) -> World: ...
    def objects(self, part: _Part, progress: _Listener) -> tuple[list[str], _U32, list[_F64]]: ...

def write(
    world: World,
    name: str,
    path: str | PathLike[str],
    layer: str,
    title: str,
    choice: _Choice,
    overwrite: bool | None,
    options: dict[str, Any],
    progress: _Listener,
) -> list[str]: ...
def presets() -> list[tuple[str, str]]: ...
def fit(
    heights: _F32,
    cell: float,
    name: str,
    options: dict[str, Any],
    threads: int | None,
    memory: int | None,
    progress: _Listener,
) -> tuple[str, str]: ...
def cache_folder() -> Any: ...
def memory_of(text: str) -> int: ...
def declared(work: str) -> list[_Declaration]: ...
def derived_layers() -> list[tuple[str, str, list[_Declaration]]]: ...
def layer(
    heights: _F32, layer: str, cell: float, options: dict[str, Any], progress: _Listener
) -> list[_F32]: ...
def noise(
    basis: str,
    x: _F64,
    y: _F64,
    z: _F64 | None,
    w: _F64 | None,
    is_lattice: bool,
    gradient: bool,
    options: dict[str, Any],
) -> list[_F32]: ...
def fill(heights: _F32, sea_level: float | None, progress: _Listener) -> _F32: ...
def breach(
    heights: _F32, max_depth: float, max_length: int, sea_level: float | None, progress: _Listener
) -> _F32: ...
def flow_direction(
    heights: _F32, convention: str, random: int | None, sea_level: float | None, progress: _Listener
) -> _U8: ...
def accumulate(
    heights: _F32, cell: float, rain: _F32 | None, sea_level: float | None, progress: _Listener
) -> _F32: ...
def watersheds(heights: _F32, sea_level: float | None, progress: _Listener) -> _U32: ...
def stream_order(heights: _F32, cell: float, area: float, sea_level: float | None, progress: _Listener) -> _U8: ...
def above_drainage(
    heights: _F32, cell: float, area: float, sea_level: float | None, progress: _Listener
) -> tuple[_F32, _F32]: ...
def lakes(
    heights: _F32, cell: float, area: float, sea_level: float | None, progress: _Listener
) -> tuple[_U32, _F32]: ...
def stream_power(
    heights: _F32,
    cell: float,
    *,
    years: float,
    steps: int,
    erodibility: float,
    area_exponent: float,
    slope_exponent: float,
    uplift: float,
    creep: float,
    erodibility_factor: _F32 | None,
    uplift_factor: _F32 | None,
    rain: _F32 | None,
    sea_level: float | None,
    progress: _Listener,
) -> _F32: ...
def thermal(heights: _F32, cell: float, *, talus: float, rate: float, passes: int, progress: _Listener) -> _F32: ...
def pipes(
    heights: _F32,
    cell: float,
    *,
    iterations: int,
    rain: float,
    evaporation: float,
    capacity: float,
    erosion: float,
    deposition: float,
    friction: float,
    progress: _Listener,
) -> tuple[_F32, _F32]: ...
def droplets(
    heights: _F32,
    cell: float,
    *,
    density: float,
    batches: int,
    lifetime: float,
    radius: float,
    inertia: float,
    capacity: float,
    erosion: float,
    deposition: float,
    evaporation: float,
    gravity: float,
    seed: int,
    progress: _Listener,
) -> _F32: ...
def contours(
    heights: _F32, cell: float, levels: list[float] | None, interval: float | None
) -> list[tuple[float, bool, _F64]]: ...
