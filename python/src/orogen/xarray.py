"""Methods of xarray's arrays: `import orogen.xarray` adds `.orogen` to every DataArray.

>>> import orogen.xarray
>>> import xarray as xr
>>> height = xr.open_dataset("alpine", engine="orogen", size=256).height
>>> slope = height.orogen.slope()

Worlds as datasets need no import: `xarray.open_dataset(path, engine="orogen")` and `World.to_xarray` add `.orogen` too.
"""

from orogen._accessor import OrogenAccessor

__all__ = ["OrogenAccessor"]
