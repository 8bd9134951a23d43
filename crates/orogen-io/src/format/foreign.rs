//! Unsupported formats of heights, by their extensions, and how to convert them.

use std::path::Path;

/// Extensions, the name of the format, and the command that converts a file to GeoTIFF; `FILE` stands for the file's
/// name.
const FORMATS: &[(&[&str], &str, &str)] = &[
    (&["nc4"], "NetCDF-4", "gdal_translate NETCDF:FILE:VARIABLE out.tif"),
    (&["h5", "hdf5", "he5", "hdf", "hdf4"], "HDF", "gdal_translate HDF5:FILE://DATASET out.tif"),
    (&["grib", "grb", "grib2", "grb2"], "GRIB", "gdal_translate FILE out.tif"),
    (&["jp2", "j2k", "jpx"], "JPEG 2000", "gdal_translate FILE out.tif"),
    (&["jpg", "jpeg", "webp", "jxl"], "a lossy picture", "gdal_translate FILE out.tif"),
    (&["img", "ige"], "ERDAS Imagine", "gdal_translate FILE out.tif"),
    (&["adf"], "ArcInfo binary grid", "gdal_translate FILE out.tif"),
    (&["gsb", "gtx"], "a binary grid", "gdal_translate FILE out.tif"),
    (&["bag"], "Bathymetry Attributed Grid", "gdal_translate FILE out.tif"),
    (&["dem", "ddf"], "USGS DEM", "gdal_translate FILE out.tif"),
    (
        &["bip", "bsq", "ers", "rst", "kea", "mbtiles", "gpkg", "sdat", "sgrd", "bt", "pix", "mrf"],
        "a raster",
        "gdal_translate FILE out.tif",
    ),
    (&["sid", "ecw"], "a wavelet-compressed raster", "gdal_translate FILE out.tif"),
    (&["fits"], "FITS", "gdal_translate FILE out.tif"),
    (&["ntf", "nitf"], "NITF", "gdal_translate FILE out.tif"),
    (&["gif", "bmp"], "a picture", "gdal_translate FILE out.tif"),
    (&["ter"], "Terragen", "gdal_translate FILE out.tif"),
    (&["las", "laz", "e57"], "a point cloud", "pdal translate FILE out.tif --writers.gdal.resolution=1"),
    (&["zip"], "an archive", "unzip FILE"),
    (&["gz"], "an archive", "gunzip FILE"),
    (&["tar", "tgz", "7z", "rar"], "an archive", "tar -xf FILE"),
];

/// The reason why a file with this name cannot be read, and the command that converts it; `None` if its extension does
/// not belong to a known format.
#[must_use]
pub fn foreign(path: &Path) -> Option<String> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let (_, format, command) = FORMATS.iter().find(|(extensions, ..)| extensions.contains(&extension.as_str()))?;
    let command = with_name(path, command);
    Some(format!("its format, {format} (.{extension}), is not supported; convert it, for example with {command}"))
}

/// The message for a file with content in such a format, whatever its extension.
pub(super) fn of_name(path: &Path, format: &str, command: &str) -> String {
    let command = with_name(path, command);
    format!("its content is {format}, which is not supported; convert it, for example with {command}")
}

/// A command with the name of a file.
fn with_name(path: &Path, command: &str) -> String {
    command.replace("FILE", &path.file_name().unwrap_or_default().to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::import;

    #[test]
    fn formats_that_are_not_read_are_named() {
        let why = foreign(Path::new("d/sea.NC4")).unwrap();
        assert!(
            why.contains("NetCDF-4 (.nc4)") && why.contains("gdal_translate NETCDF:sea.NC4:VARIABLE out.tif"),
            "{why}"
        );
        assert_eq!((foreign(Path::new("a.toml")), foreign(Path::new("a"))), (None, None));
        assert!(FORMATS.iter().flat_map(|row| row.0).all(|own| !import::EXTENSIONS.contains(own)));
        let error = import::read(Path::new("a.jp2"), 1 << 20).unwrap_err().to_string();
        assert!(error.starts_with("cannot read a.jp2: its format, JPEG 2000"), "{error}");
    }
}
