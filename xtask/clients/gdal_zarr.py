"""Reads an array of a Zarr store with the GDAL of pyogrio: `gdal_zarr.py NAME OUT.npy` prints its place as JSON.

This GDAL has no Blosc, so the one of numcodecs is registered as its decompressor.
"""

import ctypes
import json
import pathlib
import sys

import numpy
import pyogrio
from numcodecs import blosc

FOLDER = pathlib.Path(pyogrio.__file__).parent
POINTER = ctypes.c_void_p
gdal = ctypes.CDLL(str(next((FOLDER.parent / "pyogrio.libs").glob("libgdal*"))))
for name, result, arguments in (
    ("CPLGetLastErrorMsg", ctypes.c_char_p, []),
    ("CPLSetConfigOption", None, [ctypes.c_char_p, ctypes.c_char_p]),
    ("CPLRegisterCompressor", ctypes.c_bool, [POINTER]),
    ("CPLRegisterDecompressor", ctypes.c_bool, [POINTER]),
    ("VSIMalloc", POINTER, [ctypes.c_size_t]),
    ("GDALOpenEx", POINTER, [ctypes.c_char_p, ctypes.c_uint, POINTER, POINTER, POINTER]),
    ("GDALGetRasterBand", POINTER, [POINTER, ctypes.c_int]),
    ("GDALGetRasterXSize", ctypes.c_int, [POINTER]),
    ("GDALGetRasterYSize", ctypes.c_int, [POINTER]),
    ("GDALGetGeoTransform", ctypes.c_int, [POINTER, POINTER]),
    ("GDALGetProjectionRef", ctypes.c_char_p, [POINTER]),
    ("GDALRasterIO", ctypes.c_int, [POINTER, *[ctypes.c_int] * 5, POINTER, *[ctypes.c_int] * 5]),
):
    function = getattr(gdal, name)
    function.restype, function.argtypes = result, arguments

READS, FLOAT32, RASTER = 0, 6, 0x02
Unpack = ctypes.CFUNCTYPE(
    ctypes.c_bool, POINTER, ctypes.c_size_t, ctypes.POINTER(POINTER), ctypes.POINTER(ctypes.c_size_t), POINTER, POINTER
)


class Compressor(ctypes.Structure):
    """`CPLCompressor` of cpl_compressor.h."""

    _fields_ = (
        ("version", ctypes.c_int),
        ("id", ctypes.c_char_p),
        ("type", ctypes.c_int),
        ("metadata", POINTER),
        ("function", Unpack),
        ("user", POINTER),
    )


@Unpack
def unpack(packed, length, out, size, options, user):
    """Unpacks a frame to a buffer of GDAL, or to a new one."""
    data = blosc.decompress(ctypes.string_at(packed, length))
    if not out[0]:
        out[0] = gdal.VSIMalloc(len(data))
    elif size[0] < len(data):
        return False
    ctypes.memmove(out[0], data, len(data))
    size[0] = len(data)
    return True


gdal.CPLSetConfigOption(b"PROJ_DATA", str(FOLDER / "proj_data").encode())
gdal.OSRSetPROJSearchPaths((ctypes.c_char_p * 2)(str(FOLDER / "proj_data").encode(), None))
gdal.GDALAllRegister()
codec = Compressor(1, b"blosc", 0, None, unpack, None)
# The driver also looks whether there is a compressor, which only writing uses.
for register in (gdal.CPLRegisterCompressor, gdal.CPLRegisterDecompressor):
    register(ctypes.byref(codec))

dataset = gdal.GDALOpenEx(sys.argv[1].encode(), RASTER, None, None, None)
if not dataset:
    sys.exit(gdal.CPLGetLastErrorMsg().decode())
width, height = gdal.GDALGetRasterXSize(dataset), gdal.GDALGetRasterYSize(dataset)
samples = numpy.empty((height, width), numpy.float32)
band = gdal.GDALGetRasterBand(dataset, 1)
if gdal.GDALRasterIO(band, READS, 0, 0, width, height, samples.ctypes.data, width, height, FLOAT32, 0, 0):
    sys.exit(gdal.CPLGetLastErrorMsg().decode())
numpy.save(sys.argv[2], samples)
geotransform = (ctypes.c_double * 6)()
gdal.GDALGetGeoTransform(dataset, geotransform)
print(json.dumps({"geotransform": list(geotransform), "crs": gdal.GDALGetProjectionRef(dataset).decode()}))
