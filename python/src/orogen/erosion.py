"""Erosion of 2-D arrays of heights.

All functions take heights in metres as an array of shape (rows, columns), row 0 in the north, of any number type and
memory order, and return new float32 arrays of the same shape. `cell` is the distance between samples in metres. NaN
stays NaN. Long work can be interrupted with Ctrl-C; `progress` is a function that is called with the share that is done,
or True for a bar of tqdm.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from orogen import _orogen
from orogen._arrays import F32, Samples, heights as _heights
from orogen._progress import Progress, listener

__all__ = ["Pipes", "droplets", "pipes", "stream_power", "thermal"]


class Pipes(NamedTuple):
    """Result of `pipes`."""

    ground: F32
    """Heights of the ground in metres."""
    water: F32
    """Depth of the water in metres."""


def stream_power(
    heights: Samples,
    *,
    cell: float,
    years: float = 1e6,
    steps: int = 50,
    erodibility: float = 2e-5,
    area_exponent: float = 0.45,
    slope_exponent: float = 1.0,
    uplift: float = 2e-4,
    creep: float = 0.0,
    erodibility_factor: Samples | None = None,
    uplift_factor: Samples | None = None,
    rain: Samples | None = None,
    sea_level: float | None = None,
    progress: Progress = None,
) -> F32:
    """Uplift and erosion by rivers: dz/dt = U - K A^m S^n, implicit in time (Braun and Willett 2013).

    Parameters
    ----------
    years, steps
        Duration, and the number of time steps in which it is computed.
    erodibility
        K, in m^(1 - 2 m) per year: 1e-6 for hard rock to 5e-5 for soft.
    area_exponent, slope_exponent
        m and n.
    uplift
        U, in metres per year.
    creep
        Diffusivity of soil creep, in square metres per year.
    erodibility_factor, uplift_factor, rain
        Factors of the erodibility, of the uplift and of the rain, as arrays of the shape of the heights.
    sea_level
        Height of the sea, whose cells keep their heights, as those of the border do.

    The result has no depressions and no flats.
    """
    data = _heights(heights)
    factor = {
        name: None if samples is None else _heights(samples, name=name)
        for name, samples in (
            ("erodibility_factor", erodibility_factor),
            ("uplift_factor", uplift_factor),
            ("rain", rain),
        )
    }
    with listener(progress) as heard:
        return _orogen.stream_power(
            data,
            cell,
            years=years,
            steps=steps,
            erodibility=erodibility,
            area_exponent=area_exponent,
            slope_exponent=slope_exponent,
            uplift=uplift,
            creep=creep,
            sea_level=sea_level,
            progress=heard,
            **factor,
        )


def thermal(
    heights: Samples,
    *,
    cell: float,
    talus: float = 0.6,
    rate: float = 1.0,
    passes: int = 50,
    progress: Progress = None,
) -> F32:
    """Thermal weathering: material on slopes above `talus` (rise over run) moves down (Musgrave and others 1989).

    `rate` is the share of the excess that moves in a pass, 0 to 1. Mass is conserved inside the border.
    """
    data = _heights(heights)
    with listener(progress) as heard:
        return _orogen.thermal(data, cell, talus=talus, rate=rate, passes=passes, progress=heard)


def pipes(
    heights: Samples,
    *,
    cell: float,
    iterations: int = 300,
    rain: float = 0.002,
    evaporation: float = 0.01,
    capacity: float = 2.0,
    erosion: float = 0.3,
    deposition: float = 0.3,
    friction: float = 0.05,
    progress: Progress = None,
) -> Pipes:
    """Hydraulic erosion with virtual pipes, within walls (Mei and others 2007, Stava and others 2008).

    `rain` is in metres of water per second; `evaporation`, `erosion`, `deposition` and `friction` are shares per second;
    `capacity` is the sediment in metres that a discharge of 1 m^2/s carries on a vertical slope. An iteration is a second,
    or the longest stable step.
    """
    data = _heights(heights)
    with listener(progress) as heard:
        made: Any = _orogen.pipes(
            data,
            cell,
            iterations=iterations,
            rain=rain,
            evaporation=evaporation,
            capacity=capacity,
            erosion=erosion,
            deposition=deposition,
            friction=friction,
            progress=heard,
        )
    return Pipes(*made)


def droplets(
    heights: Samples,
    *,
    cell: float,
    density: float = 5000.0,
    batches: int = 4,
    lifetime: float = 300.0,
    radius: float = 30.0,
    inertia: float = 0.05,
    capacity: float = 0.4,
    erosion: float = 0.3,
    deposition: float = 0.3,
    evaporation: float = 0.001,
    gravity: float = 4.0,
    seed: int = 0,
    progress: Progress = None,
) -> F32:
    """Erosion by droplets (Beyer 2015), in batches whose changes are summed exactly.

    `density` is in droplets per square kilometre, `lifetime` the longest path and `radius` that of the brush in metres,
    `evaporation` a share per metre, `gravity` in m/s^2.
    """
    data = _heights(heights)
    with listener(progress) as heard:
        return _orogen.droplets(
            data,
            cell,
            density=density,
            batches=batches,
            lifetime=lifetime,
            radius=radius,
            inertia=inertia,
            capacity=capacity,
            erosion=erosion,
            deposition=deposition,
            evaporation=evaporation,
            gravity=gravity,
            seed=seed,
            progress=heard,
        )
