"""Arrays in: any type and order of samples becomes what the native part takes."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from orogen.errors import RequestError

F32: TypeAlias = npt.NDArray[np.float32]
F64: TypeAlias = npt.NDArray[np.float64]

#: What functions take as an array of samples: an array, a nested sequence, a masked array, a DataArray.
Samples: TypeAlias = Any


def heights(samples: Samples, nodata: float | None = None, name: str = "heights") -> F32:
    """A contiguous float32 array of shape (height, width); masked samples and those equal to `nodata` are NaN."""
    mask = np.ma.getmask(samples)
    # Masked arrays of integers cannot hold NaN: their data is converted first.
    data = np.ma.getdata(samples)
    if data.dtype.kind not in "biuf":
        raise TypeError(f"`{name}` must be numbers, not {data.dtype}")
    if data.ndim != 2:
        raise RequestError(f"`{name}` must have two dimensions, rows and columns; its shape is {data.shape}")
    missing = None if mask is np.ma.nomask else np.asarray(mask)
    if nodata is not None and not np.isnan(nodata):
        same = data == nodata
        missing = same if missing is None else missing | same
    made = np.ascontiguousarray(data, dtype=np.float32)
    if missing is not None and missing.any():
        made = made.copy() if np.shares_memory(made, data) else made
        made[missing] = np.nan
    return made


def positions(values: Samples, name: str) -> F64:
    """A float64 array of any shape."""
    data = np.asarray(values)
    if data.dtype.kind not in "biuf":
        raise TypeError(f"`{name}` must be numbers, not {data.dtype}")
    return data.astype(np.float64, copy=False)
