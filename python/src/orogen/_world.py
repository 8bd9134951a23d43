"""Worlds."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias, TypeVar, overload

import numpy as np
import numpy.typing as npt

from orogen import _orogen
from orogen._arrays import F32, F64, Samples, heights as _heights, positions
from orogen._progress import Progress, listener
from orogen.errors import RequestError

if TYPE_CHECKING:
    import xarray as xr
    from typing_extensions import Unpack

    from orogen._options import (
        BlocksOptions,
        BuildOptions,
        ExportOptions,
        FitOptions,
        LayerOptions,
        MapOptions,
        RefineOptions,
        RenderOptions,
        TilemapOptions,
    )

__all__ = ["Objects", "Parameter", "Sampler", "Window", "World", "fit", "presets"]

PathLike: TypeAlias = "str | os.PathLike[str]"

#: A path that is returned as it was given.
PathT = TypeVar("PathT", bound=PathLike)
Size: TypeAlias = "int | tuple[int, int]"
Part: TypeAlias = "str | tuple[int, int, int, int] | Window"
Bounds: TypeAlias = "tuple[float, float, float, float]"


class Window(NamedTuple):
    """Samples of a world: a rectangle of a lattice whose sample (column, row) is at (column, row) * cell metres."""

    x: int
    """Column of the first sample, counted eastward from the origin of the world."""
    y: int
    """Row of the first sample, counted southward."""
    width: int
    """Samples per row."""
    height: int
    """Number of rows."""
    cell: float
    """Distance between samples in metres."""

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of an array of its samples: (height, width)."""
        return (self.height, self.width)

    @property
    def east(self) -> F64:
        """Metres east of the origin, of each column."""
        return np.arange(self.x, self.x + self.width, dtype=np.float64) * self.cell

    @property
    def south(self) -> F64:
        """Metres south of the origin, of each row."""
        return np.arange(self.y, self.y + self.height, dtype=np.float64) * self.cell


class Parameter(NamedTuple):
    """A parameter of a recipe, which `World(..., parameters={name: value})` sets."""

    name: str
    value: float
    minimum: float
    maximum: float
    unit: str
    help: str


class Objects(NamedTuple):
    """Objects on the ground, such as trees and rocks: one element of each array for each object."""

    names: list[str]
    """The names of the kinds of objects."""
    kind: npt.NDArray[np.uint32]
    """Index of the kind."""
    x: F64
    """Metres east of the origin."""
    y: F64
    """Metres south of the origin."""
    height: F64
    """Height of the ground in metres."""
    size: F64
    """Scale factor."""
    turn: F64
    """Turn about the vertical axis in degrees, clockwise seen from above."""


class Sampler:
    """A layer of a world that is prepared for many small requests. It can be used by several threads."""

    def __init__(self, world: World, layer: str = "height") -> None:
        self._points = world._native.sampler(layer)
        self.world = world
        self.layer = layer

    def __call__(self, x: Samples, y: Samples) -> F32:
        """Values at points: see `World.points`."""
        return _at_points(self._points.points, x, y)

    def window(self, window: Window) -> F32:
        """Samples of a window, of shape (height, width)."""
        return self._points.window(window)


class World:
    """A world: terrain of which any window can be made, at any resolution, always with the same bits.

    Parameters
    ----------
    recipe
        The name of a preset ("alpine"), the path of a recipe (.toml, .json) or of a file of heights (GeoTIFF, .asc,
        .hgt, ...), a recipe as a dict or as TOML in a str of several lines, or heights in metres as a 2-D array.
    parameters
        Values of the recipe's parameters.
    seed
        Seed of the world, instead of the recipe's.
    cell
        Distance between the samples of an array in metres.
    crs, origin
        Coordinate reference system such as "EPSG:32632", and the position of the north-west corner in it.
    threads
        Number of threads; by default one for each core.
    memory
        Memory limit in bytes, or as text such as "2GiB"; by default there is none.
    cache
        Folder in which slow solutions are kept for later; True is $OROGEN_CACHE or the cache folder of the system, and
        False keeps them for this world only.

    Raises
    ------
    RecipeError, RequestError, FileError
        If the recipe is not valid or not found, or a file cannot be read.
    """

    def __init__(
        self,
        recipe: PathLike | Mapping[str, Any] | Samples,
        *,
        parameters: Mapping[str, float] | None = None,
        seed: int | None = None,
        cell: float | None = None,
        crs: str | None = None,
        origin: tuple[float, float] | None = None,
        threads: int | None = None,
        memory: int | str | None = None,
        cache: PathLike | bool = True,
    ) -> None:
        source = text = heights = None
        self._name = "world"
        if isinstance(recipe, Mapping):
            text = json.dumps(recipe)
        elif isinstance(recipe, str) and "\n" in recipe:
            text = recipe
        elif isinstance(recipe, (str, os.PathLike)):
            source = os.fspath(recipe)
            self._name = Path(source).stem
        else:
            heights = _heights(recipe)
            self._name = "heights"
        if cell is not None and heights is None:
            raise TypeError("`cell` is for heights in an array; give it to `window` to choose a resolution")
        if cache is True:
            folder = _orogen.cache_folder()
        else:
            folder = None if cache is False else os.fspath(cache)
        self._arguments: dict[str, Any] = {
            "recipe": recipe,
            "parameters": parameters,
            "seed": seed,
            "cell": cell,
            "crs": crs,
            "origin": origin,
            "threads": threads,
            "memory": memory,
            "cache": cache,
        }
        self._native = _orogen.World(
            source=source,
            text=text,
            heights=heights,
            cell=1.0 if cell is None else cell,
            parameters=list((parameters or {}).items()),
            seed=seed,
            crs=crs,
            origin=origin,
            threads=threads,
            memory=_bytes(memory),
            cache=folder,
        )
        for note in self._native.notes:
            warnings.warn(note, stacklevel=2)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self._arguments,))

    def __repr__(self) -> str:
        size = "unbounded" if self.size is None else f"{self.size[0]:g} x {self.size[1]:g} m"
        return f"<orogen.World {self._name}: {size}, cell {self.cell:g} m, seed {self.seed}, {', '.join(self.layers)}>"

    @property
    def name(self) -> str:
        """The name of the preset or file."""
        return self._name

    @property
    def about(self) -> str:
        """The description of the recipe."""
        return self._native.about

    @property
    def seed(self) -> int:
        """The seed."""
        return self._native.seed

    @property
    def cell(self) -> float:
        """The world's own distance between samples in metres."""
        return self._native.cell

    @property
    def size(self) -> tuple[float, float] | None:
        """Width and height in metres; None if the world has no bounds."""
        return self._native.size

    @property
    def sea_level(self) -> float:
        """Height of the sea in metres."""
        return self._native.sea_level

    @property
    def epsg(self) -> int | None:
        """EPSG code of the coordinate reference system, if there is one."""
        return self._native.epsg

    @property
    def layers(self) -> dict[str, str]:
        """The layers of the recipe, each with its unit. Layers derived from the heights are in `orogen.analysis`."""
        return dict(self._native.layers)

    @property
    def parameters(self) -> list[Parameter]:
        """The parameters of the recipe."""
        return [Parameter(*parameter) for parameter in self._native.parameters]

    @property
    def toml(self) -> str:
        """The recipe as TOML."""
        return self._native.toml

    def key(self, layer: str = "height") -> str:
        """A hash of all that a layer depends on: worlds with the same key have the same samples."""
        return self._native.key(layer)

    def view(
        self,
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
    ) -> Window:
        """The window that a choice of samples selects; by default the whole world at its own cell.

        Parameters
        ----------
        size
            Samples along the longer side, or (width, height) of the same aspect ratio.
        window
            A part of the world: (x, y, width, height) in samples, a text in metres such as "0m,500m,2km,2km", or a
            `Window`.
        bounds
            West, south, east and north in map coordinates; in a world without a CRS, metres east and north of its
            north-west corner.
        cell
            Distance between samples in metres.

        Raises
        ------
        RequestError
            If the part is not inside the world or has no sample, or the choices contradict each other.
        """
        found, notes = self._native.view(_choice(size, window, bounds, cell))
        for note in notes:
            warnings.warn(note, stacklevel=2)
        return Window(*found)

    @overload
    def window(
        self,
        layer: str = "height",
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        progress: Progress = None,
        **options: Unpack[LayerOptions],
    ) -> F32: ...

    @overload
    def window(
        self,
        layer: list[str] | tuple[str, ...],
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        progress: Progress = None,
    ) -> dict[str, F32]: ...

    def window(
        self,
        layer: str | list[str] | tuple[str, ...] = "height",
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        progress: Progress = None,
        **options: Any,
    ) -> F32 | dict[str, F32]:
        """Samples of a layer: a float32 array of shape (height, width), row 0 in the north.

        Parameters
        ----------
        layer
            A layer of the recipe, or one derived from the heights such as "hillshade"; several names give a dict. A
            derived layer of several channels, such as "normal", has the shape (channels, height, width).
        size, window, bounds, cell
            Which samples: see `view`.
        progress
            A function that is called with the share that is done, or True for a bar of tqdm.
        **options
            Options of the derived layer, such as `azimuth=315`.

        Raises
        ------
        RequestError
            If there is no such layer or window.
        MemoryLimitError
            If the samples need more memory than `memory`.
        """
        part = self.view(size=size, window=window, bounds=bounds, cell=cell)
        names = [layer] if isinstance(layer, str) else list(layer)
        with listener(progress) as heard:
            made = self._native.read(names, part, options, heard)
        if not isinstance(layer, str):
            return dict(zip(names, made, strict=True))
        return made[0] if len(made) == 1 else np.stack(made)

    def points(self, x: Samples, y: Samples, layer: str = "height") -> F32:
        """Values of a layer at points: the same bits as in any window.

        `x` and `y` are metres east and south of the origin, arrays that broadcast against each other.
        """
        return _at_points(lambda x, y: self._native.points(layer, x, y), x, y)

    def sampler(self, layer: str = "height") -> Sampler:
        """A layer that is prepared for many small requests."""
        return Sampler(self, layer)

    def tiles(
        self,
        side: int = 512,
        layer: str = "height",
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
    ) -> Iterator[tuple[Window, F32]]:
        """Tiles of a layer, row by row from the north-west; those at the east and south edge may be smaller.

        One tile is made at a time, so the whole need not fit in memory.
        """
        whole = self.view(size=size, window=window, bounds=bounds, cell=cell)
        if side < 1:
            raise RequestError("`side` must be at least 1 sample")
        for top in range(0, whole.height, side):
            for left in range(0, whole.width, side):
                tile = Window(
                    whole.x + left,
                    whole.y + top,
                    min(side, whole.width - left),
                    min(side, whole.height - top),
                    whole.cell,
                )
                yield tile, self.window(layer, window=tile)

    def objects(
        self,
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        progress: Progress = None,
    ) -> Objects:
        """The objects that the recipe scatters over a window, such as trees and rocks."""
        part = self.view(size=size, window=window, bounds=bounds, cell=cell)
        with listener(progress) as heard:
            names, kinds, columns = self._native.objects(part, heard)
        return Objects(names, kinds, *columns)

    def analyze(
        self,
        page: PathLike | None = None,
        *,
        layer: str = "height",
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
    ) -> dict[str, Any]:
        """Statistics of the terrain next to those of real land, as `orogen analyze --json` prints them.

        With `page`, a page of charts is written to this .png file; see `export` for existing files.
        """
        part = self.view(size=size, window=window, bounds=bounds, cell=cell)
        with listener(progress) as heard:
            file = None if page is None else os.fspath(page)
            text = self._native.analyze(self._name, layer, part, file, overwrite, heard)
        made: dict[str, Any] = json.loads(text)
        return made

    def refined(self, cell: float | None = None, **options: Unpack[RefineOptions]) -> World:
        """Heights of a file or an array at a smaller cell, by default an eighth of theirs.

        With `detail="rivers"` their rivers are kept, and side valleys and slopes are added. With `detail="learned"` a
        network adds what real land has at the smaller cell, and depressions are drained; `noise` is the share of chance.
        See `orogen refine`.

        Layers: `height` and `flow` (drainage area).
        """
        made = World.__new__(World)
        made._name = self._name
        made._native = self._native.refined(cell, dict(options))
        made._arguments = self._arguments | {"refined": {"cell": cell, **options}}
        return made

    def to_xarray(
        self,
        layers: str | Sequence[str] = "height",
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        progress: Progress = None,
    ) -> xr.Dataset:
        """Layers as an `xarray.Dataset` with coordinates `y` and `x`, units and CRS. Needs xarray.

        In a world with a CRS, x and y are its coordinates, otherwise metres east and north of the north-west corner.
        `xarray.open_dataset(path, engine="orogen")` makes only what is read.
        """
        from orogen._dataset import dataset

        names = [layers] if isinstance(layers, str) else list(layers)
        found = self.view(size=size, window=window, bounds=bounds, cell=cell)
        return dataset(self, names, found, self.window(names, window=found, progress=progress))

    def export(
        self,
        path: PathT,
        layer: str = "height",
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
        **options: Unpack[ExportOptions],
    ) -> PathT:
        """Writes a layer to a file; the extension chooses the format (`orogen export`). Returns the path.

        An existing file is replaced if it has the same kind; with `overwrite=True` in any case, with False never. Files
        appear whole or not at all. `options` are those of the format and of a derived layer.
        """
        choice = _choice(size, window, bounds, cell)
        return self._write("export", path, choice, overwrite, progress, dict(options), layer)

    def map(
        self,
        path: PathT,
        *,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
        **options: Unpack[MapOptions],
    ) -> PathT:
        """Draws a map sheet as .png, .svg or .pdf (`orogen map`). Returns the path.

        `size` is the size of the sheet, as on the command line; `cell` chooses the samples. See `export` for existing files.
        """
        return self._write("map", path, _choice(None, window, bounds, cell), overwrite, progress, dict(options))

    def render(
        self,
        path: PathT,
        *,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
        **options: Unpack[RenderOptions],
    ) -> PathT:
        """Renders a picture in perspective as .png (`orogen render`). `size` is the size of the picture in pixels."""
        return self._write("render", path, _choice(None, window, bounds, cell), overwrite, progress, dict(options))

    def blocks(
        self,
        path: PathT,
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        format: Literal["minecraft"] | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
        **options: Unpack[BlocksOptions],
    ) -> PathT:
        """Writes voxels as .vox, .schem, .glb or .png, or a folder for Luanti (`orogen blocks`).

        With `format="minecraft"` the folder is a save of Minecraft: Java Edition.
        """
        if format not in (None, "minecraft"):
            raise ValueError(f"the format of blocks must be 'minecraft' or None, not {format!r}")
        return self._write(format or "blocks", path, _choice(size, window, bounds, cell), overwrite, progress, dict(options))

    def tilemap(
        self,
        path: PathT,
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
        **options: Unpack[TilemapOptions],
    ) -> PathT:
        """Writes a tilemap for Tiled, LDtk and Godot into a folder (`orogen tilemap`)."""
        return self._write("tilemap", path, _choice(size, window, bounds, cell), overwrite, progress, dict(options))

    def build(
        self,
        path: PathT,
        *,
        size: Size | None = None,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
        overwrite: bool | None = None,
        progress: Progress = None,
        **options: Unpack[BuildOptions],
    ) -> PathT:
        """Builds a window of any size: a Cloud-Optimized GeoTIFF (.tif), a Zarr v3 group (.zarr), tiles of web maps
        (.pmtiles) or a folder of tiles.

        A build that was interrupted goes on where it stopped; with `overwrite=True` it begins anew (`orogen build`).

        With `part="3/64"` it makes one of 64 parts. Each part is one call, in any process on any machine that shares
        the file system or object store, and the call that completes the last part finishes the result.
        """
        return self._write("build", path, _choice(size, window, bounds, cell), overwrite, progress, dict(options))

    def _write(
        self,
        work: str,
        path: PathT,
        choice: tuple[Any, ...],
        overwrite: bool | None,
        progress: Progress,
        options: dict[str, Any],
        layer: str = "height",
    ) -> PathT:
        given: PathLike = path
        with listener(progress) as heard:
            found = _orogen.write(
                self._native, work, os.fspath(given), layer, self._name, choice, overwrite, options, heard
            )
        for warning in found:
            warnings.warn(warning, stacklevel=3)
        return path

    def _repr_png_(self) -> bytes:
        return self.picture()

    def picture(
        self,
        size: Size | None = 512,
        *,
        window: Part | None = None,
        bounds: Bounds | None = None,
        cell: float | None = None,
    ) -> bytes:
        """A shaded relief in hypsometric colors as the bytes of a .png, as notebooks show it."""
        size = None if cell is not None or isinstance(window, (Window, tuple)) else size
        part = self.view(size=size, window=window, bounds=bounds, cell=cell)
        return self._native.picture(part)

    def plot(self, layer: str = "height", ax: Any = None, *, size: Size | None = 512, **view: Any) -> Any:
        """Draws a layer with matplotlib, with coordinates in metres and a color bar. Returns the axes.

        Heights are shaded, with blue below the sea level; positive values over more than three orders of magnitude,
        such as drainage areas, have a logarithmic scale.
        """
        import matplotlib.pyplot as plt
        from matplotlib import cm, colors

        size = None if "cell" in view or isinstance(view.get("window"), (Window, tuple)) else size
        found = self.view(size=size, **view)
        samples = self.window(layer, window=found)
        ax = plt.gca() if ax is None else ax
        half = found.cell / 2
        east, south = found.east, found.south
        extent = (east[0] - half, east[-1] + half, south[-1] + half, south[0] - half)
        low, high = float(np.nanmin(samples)), float(np.nanmax(samples))
        if layer == "height":
            # The first quarter of this color map is the sea.
            sea = self.sea_level
            shares = np.interp(np.linspace(low, high, 256), [min(low, sea - 1), sea, max(high, sea + 1)], [0, 0.25, 1])
            shares = shares if low < sea else np.linspace(0.25, 1, 256)
            hypsometric = colors.ListedColormap(plt.get_cmap("terrain")(shares))
            norm = colors.Normalize(low, high)
            shaded = colors.LightSource(315, 45).shade(
                samples, hypsometric, norm=norm, blend_mode="soft", dx=found.cell, dy=found.cell
            )
            ax.imshow(shaded, extent=extent)
            image = cm.ScalarMappable(norm, hypsometric)
        else:
            is_wide = low > 0 and high > 1000 * low
            image = ax.imshow(samples, extent=extent, norm=colors.LogNorm(low, high) if is_wide else None)
        unit = self.layers.get(layer, "")
        ax.figure.colorbar(image, ax=ax, label=f"{layer} ({unit})" if unit else layer)
        ax.set(xlabel="east (m)", ylabel="south (m)", title=self._name)
        return ax


def presets() -> dict[str, str]:
    """The presets: name and description."""
    return dict(_orogen.presets())


def fit(
    heights: Samples,
    *,
    cell: float,
    nodata: float | None = None,
    threads: int | None = None,
    memory: int | str | None = None,
    progress: Progress = None,
    **options: Unpack[FitOptions],
) -> tuple[World, dict[str, Any]]:
    """A world with the statistics of real heights, without their data, and its comparison with them.

    `heights` are in metres, of at least 64 x 64 samples with some relief; `threads` and `memory` limit the search as
    they limit a `World`. See `orogen fit`.
    """
    data = _heights(heights, nodata)
    if np.isnan(data).any():
        raise RequestError("`heights` must have no missing samples; fill them, or choose a part without any")
    with listener(progress) as heard:
        recipe, report = _orogen.fit(data, cell, "heights", dict(options), threads, _bytes(memory), heard)
    return World(recipe), json.loads(report)


def _bytes(memory: int | str | None) -> int | None:
    return _orogen.memory_of(memory) if isinstance(memory, str) else memory


def _restored(arguments: dict[str, Any]) -> World:
    own = {key: value for key, value in arguments.items() if key not in ("recipe", "refined")}
    world = World(arguments["recipe"], **own)
    return world.refined(**arguments["refined"]) if "refined" in arguments else world


def _choice(size: Size | None, window: Part | None, bounds: Bounds | None, cell: float | None) -> tuple[Any, ...]:
    """What the native part takes."""
    if isinstance(window, Window):
        if size is not None or cell not in (None, window.cell):
            raise RequestError("a `Window` counts samples of its own cell; leave out `size` and `cell`")
        cell = window.cell
        window = (window.x, window.y, window.width, window.height)
    sides = None if size is None else [size] if isinstance(size, (int, np.integer)) else list(size)
    return (window, bounds, sides, cell)


def _at_points(points: Any, x: Samples, y: Samples) -> F32:
    east, south = positions(x, "x"), positions(y, "y")
    try:
        shape = np.broadcast_shapes(east.shape, south.shape)
    except ValueError:
        raise RequestError(f"`x` {east.shape} and `y` {south.shape} do not broadcast against each other") from None
    flat = [np.ascontiguousarray(np.broadcast_to(axis, shape)).ravel() for axis in (east, south)]
    made: F32 = points(*flat)
    return made.reshape(shape)
