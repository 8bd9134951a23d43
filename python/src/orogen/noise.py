"""Coherent noise on arrays: the same bits on every machine.

Each function takes positions as arrays that broadcast against each other, in any unit of length, and returns float32
values in -1 to 1 of the broadcast shape. Positions of a grid are fastest as a row of `x` and a column of `y`:

>>> import numpy as np
>>> from orogen import noise
>>> y, x = np.ogrid[0:512, 0:512]
>>> noise.perlin(x, y, wavelength=64, octaves=6, seed=7).shape
(512, 512)

All functions have the same parameters:

x, y : array_like
    Positions; x to the east, y to the south.
z, w : array_like, optional
    Third and fourth coordinate.
seed : int, default 0
    Any number; neighboring seeds give unrelated noise.
wavelength : float, default 1
    Approximate distance between hills in the first octave, in the unit of the positions.
octaves : int, default 1
    Number of octaves, each finer and weaker than the one before.
lacunarity : float, default 2
    Frequency ratio between successive octaves.
gain : float, default 0.5
    Amplitude ratio between successive octaves.
fractal : str, default "fbm"
    How octaves are combined: fbm, ridged, billow, weighted, ping-pong, hybrid, hetero, swiss or jordan.
gradient : bool, default False
    Also return the slopes along x, y (and z, w) per unit of length: a tuple (value, dx, dy, ...).
**options
    Parameters of the fractal: `k` and `falloff` of weighted, `strength` of ping-pong, `offset` of hybrid and hetero,
    `warp` of swiss and jordan, `damp` of jordan; see `orogen noise --help`.
"""

from __future__ import annotations

from typing import Any, Literal, Protocol, overload

import numpy as np

from orogen import _orogen
from orogen._arrays import F32, F64, Samples, positions
from orogen.errors import RequestError

__all__ = [
    "classic_angle",
    "classic_diagonal",
    "classic_eight",
    "opensimplex2",
    "opensimplex2_smooth",
    "perlin",
    "simplex",
    "value",
    "white",
    "worley",
    "worley_edge",
]


class Noise(Protocol):
    """A noise function; see the module for its parameters."""

    __name__: str

    @overload
    def __call__(
        self,
        x: Samples,
        y: Samples,
        z: Samples | None = ...,
        w: Samples | None = ...,
        *,
        seed: int = ...,
        wavelength: float = ...,
        octaves: int = ...,
        lacunarity: float = ...,
        gain: float = ...,
        fractal: str = ...,
        gradient: Literal[False] = ...,
        **options: float | str,
    ) -> F32: ...

    @overload
    def __call__(
        self,
        x: Samples,
        y: Samples,
        z: Samples | None = ...,
        w: Samples | None = ...,
        *,
        seed: int = ...,
        wavelength: float = ...,
        octaves: int = ...,
        lacunarity: float = ...,
        gain: float = ...,
        fractal: str = ...,
        gradient: Literal[True],
        **options: float | str,
    ) -> tuple[F32, ...]: ...


def _noise(basis: str, about: str) -> Noise:
    def noise(
        x: Samples,
        y: Samples,
        z: Samples | None = None,
        w: Samples | None = None,
        *,
        seed: int = 0,
        wavelength: float = 1.0,
        octaves: int = 1,
        lacunarity: float = 2.0,
        gain: float = 0.5,
        fractal: str = "fbm",
        gradient: bool = False,
        **options: float | str,
    ) -> Any:
        if w is not None and z is None:
            raise RequestError("`w` needs `z`")
        names = "xyzw"
        given = [positions(axis, names[k]) for k, axis in enumerate((x, y, z, w)) if axis is not None]
        try:
            shape = np.broadcast_shapes(*(axis.shape for axis in given))
        except ValueError:
            shapes = ", ".join(f"{names[k]} {axis.shape}" for k, axis in enumerate(given))
            raise RequestError(f"the positions do not broadcast against each other: {shapes}") from None
        is_lattice = _is_lattice(given[0].shape, given[1].shape, shape)
        first, second = (
            np.ascontiguousarray(axis).ravel() if is_lattice else _flat(axis, shape) for axis in given[:2]
        )
        depths: list[F64 | None] = [None, None]
        for k, axis in enumerate(given[2:]):
            depths[k] = axis.ravel() if axis.size == 1 else _flat(axis, shape)
        keys = {
            "seed": seed,
            "wavelength": wavelength,
            "octaves": octaves,
            "lacunarity": lacunarity,
            "gain": gain,
            "fractal": fractal,
            **options,
        }
        made = _orogen.noise(basis, first, second, depths[0], depths[1], is_lattice, gradient, keys)
        arrays = tuple(values.reshape(shape) for values in made)
        return arrays if gradient else arrays[0]

    noise.__name__ = noise.__qualname__ = basis.replace("-", "_")
    noise.__doc__ = f"{about}\n\nSee the module `orogen.noise` for the parameters."
    return noise


def _is_lattice(x: tuple[int, ...], y: tuple[int, ...], shape: tuple[int, ...]) -> bool:
    """Whether x is a row, and y a column, of a grid."""
    if len(shape) != 2:
        return False
    return x in ((shape[1],), (1, shape[1])) and y == (shape[0], 1)


def _flat(axis: F64, shape: tuple[int, ...]) -> F64:
    return np.ascontiguousarray(np.broadcast_to(axis, shape)).ravel()


white = _noise("white", "White noise: an independent value for each square.")
value = _noise("value", "Value noise: random values on a lattice, interpolated.")
perlin = _noise("perlin", "Perlin's gradient noise on a hashed lattice; it has no period.")
classic_diagonal = _noise("classic-diagonal", "Perlin's 2002 table, four diagonal gradients, as in most textbooks.")
classic_eight = _noise("classic-eight", "Perlin's 2002 table, eight gradients.")
classic_angle = _noise("classic-angle", "Perlin's 2002 table, unit gradients at 256 angles.")
simplex = _noise("simplex", "Perlin's Simplex noise: gradients at the corners of a triangular lattice.")
opensimplex2 = _noise("opensimplex2", "OpenSimplex2, fast variant: Simplex noise with more gradient directions.")
opensimplex2_smooth = _noise("opensimplex2-smooth", "OpenSimplex2, smooth variant: wider and rounder kernels.")
worley = _noise("worley", "Worley's cellular noise: distance to the nearest feature point.")
worley_edge = _noise("worley-edge", "Worley's cellular noise: distance to the nearest cell edge.")
