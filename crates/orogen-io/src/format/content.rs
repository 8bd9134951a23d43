//! Detection of formats by the first bytes of a file, for files whose extension belongs to another format.

use std::path::Path;

use super::foreign::of_name;
use crate::open;

/// Number of bytes that are compared.
const LENGTH: usize = 64;

/// Advice for a file of a known format.
#[derive(Debug, Clone, Copy)]
enum Advice {
    /// Give the file one of these extensions.
    Rename(&'static [&'static str]),
    /// Run this command; `FILE` stands for the file's name.
    Command(&'static str),
    /// Follow this sentence.
    Sentence(&'static str),
}

use Advice::{Command, Rename, Sentence};

const GDAL: Advice = Command("gdal_translate FILE out.tif");

/// The first bytes of a file, its format, and the advice.
const FORMATS: &[(&[u8], &str, Advice)] = &[
    (b"II\x2a\0", "a TIFF", Rename(&["tif", "tiff"])),
    (b"MM\0\x2a", "a TIFF", Rename(&["tif", "tiff"])),
    (b"II\x2b\0", "a BigTIFF", Rename(&["tif", "tiff"])),
    (b"MM\0\x2b", "a BigTIFF", Rename(&["tif", "tiff"])),
    (b"\x89PNG\r\n\x1a\n", "a PNG", Rename(&["png"])),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture", Rename(&["exr"])),
    (b"\x93NUMPY", "a NumPy array", Rename(&["npy"])),
    (b"CDF\x01", "NetCDF-3", Rename(&["nc", "cdf", "grd"])),
    (b"CDF\x02", "NetCDF-3", Rename(&["nc", "cdf", "grd"])),
    (b"CDF\x05", "NetCDF-3", Rename(&["nc", "cdf", "grd"])),
    (b"UHL1", "DTED", Rename(&["dt2", "dt0", "dt1"])),
    (b"<VRTDataset", "a virtual raster", Rename(&["vrt"])),
    (b"\x89HDF\r\n\x1a\n", "HDF5, such as NetCDF-4", GDAL),
    (b"\x0e\x03\x13\x01", "HDF4", GDAL),
    (b"GRIB", "GRIB", GDAL),
    (b"\0\0\0\x0cjP  ", "JPEG 2000", GDAL),
    (b"\xff\x4f\xff\x51", "JPEG 2000", GDAL),
    (b"\xff\xd8\xff", "JPEG", GDAL),
    (b"GIF8", "GIF", GDAL),
    (b"EHFA_HEADER_TAG", "ERDAS Imagine", GDAL),
    (b"DSAA", "a grid of Surfer", GDAL),
    (b"DSBB", "a grid of Surfer", GDAL),
    (b"DSRB", "a grid of Surfer", GDAL),
    (b"SQLite format 3\0", "SQLite, such as a GeoPackage", GDAL),
    (b"%PDF", "PDF", GDAL),
    (b"SIMPLE  =", "FITS", GDAL),
    (b"NITF", "NITF", GDAL),
    (b"msid", "MrSID", GDAL),
    (b"LASF", "a point cloud (LAS)", Command("pdal translate FILE out.tif --writers.gdal.resolution=1")),
    (b"PK\x03\x04", "an archive (ZIP)", Command("unzip FILE")),
    (b"\x1f\x8b", "compressed with gzip", Command("gunzip -c FILE > out.tif")),
    (b"\xfd7zXZ\0", "compressed with xz", Command("xz -dc FILE > out.tif")),
    (b"\x28\xb5\x2f\xfd", "compressed with Zstandard", Command("zstd -dc FILE > out.tif")),
    (b"BZh", "compressed with bzip2", Command("bzip2 -dc FILE > out.tif")),
    (b"7z\xbc\xaf\x27\x1c", "an archive (7z)", Command("7z x FILE")),
    (b"version https://git-lfs", "a pointer of Git LFS, not the file itself", Sentence("fetch it with git lfs pull")),
    (b"<!DOCTYPE html", "a web page, perhaps the error of a download", Sentence("download it again")),
    (b"<html", "a web page, perhaps the error of a download", Sentence("download it again")),
];

/// The message about a file with these first bytes, if its extension belongs to another format; `None` if the format is
/// not known.
fn of_bytes(path: &Path, head: &[u8]) -> Option<String> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    // A recipe may begin with any text.
    if matches!(extension.as_deref(), Some("toml" | "json")) {
        return None;
    }
    let (first, format, advice) = FORMATS.iter().find(|(first, ..)| head.starts_with(first))?;
    // The readers of these formats give better messages.
    if matches!(
        (extension.as_deref(), *first),
        (Some("nc" | "cdf" | "grd"), b"\x89HDF\r\n\x1a\n") | (Some("zip"), b"PK\x03\x04")
    ) {
        return None;
    }
    match advice {
        Rename(extensions) if extension.is_some_and(|own| extensions.contains(&own.as_str())) => None,
        Rename(extensions) => Some(format!(
            "its content is {format}, which its name does not say; give it the extension .{}",
            extensions[0]
        )),
        Command(command) => Some(of_name(path, format, command)),
        Sentence(sentence) => Some(format!("its content is {format}; {sentence}")),
    }
}

/// The message about the format of a file, if its extension belongs to another format; `None` if the format is not
/// known, or the file cannot be read.
#[must_use]
pub fn of_file(path: &Path) -> Option<String> {
    let mut file = open::regular(path, "read").ok()?;
    let mut head = Vec::with_capacity(LENGTH);
    std::io::Read::read_to_end(&mut std::io::Read::take(&mut file, LENGTH as u64), &mut head).ok()?;
    of_bytes(path, &head)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::import;
    use crate::test_folder::TestFolder;

    #[test]
    fn content_is_known_by_its_first_bytes() {
        let of = |name: &str, head: &[u8]| of_bytes(Path::new(name), head).unwrap_or_default();
        assert!(
            of("a.tif", b"PK\x03\x04..").contains("an archive (ZIP)")
                && of("a.tif", b"PK\x03\x04").contains("unzip a.tif")
        );
        assert!(of("a.tif", b"GRIB\0").ends_with("for example with gdal_translate a.tif out.tif"));
        assert!(
            of("a.png", b"II\x2a\0")
                .ends_with("its content is a TIFF, which its name does not say; give it the extension .tif")
        );
        assert!(of("a", b"II\x2a\0").contains("give it the extension .tif"));
        assert_eq!((of("a.TIF", b"II\x2a\0"), of("a.tif", b"ncols 3"), of("a.tif", b"")), Default::default());
    }

    #[test]
    fn a_file_of_another_format_is_named() {
        let folder = TestFolder::new("content").unwrap();
        for (name, bytes, expect) in [
            ("a.tif", &b"\x89HDF\r\n\x1a\n and more"[..], "its content is HDF5, such as NetCDF-4"),
            ("b.png", b"MM\0\x2a\0\0", "its content is a TIFF"),
            ("c.asc", b"PK\x03\x04", "its content is an archive (ZIP)"),
            ("d.hgt", b"PK\x03\x04", "its content is an archive (ZIP)"),
            ("e.tif", b"ncols 3\n", "it is not a TIFF"),
            ("f.xyzzy", b"LASF", "pdal translate f.xyzzy out.tif"),
        ] {
            let path = folder.join(name);
            std::fs::write(&path, bytes).unwrap();
            let why = import::read(&path, 1 << 20).unwrap_err().to_string();
            assert!(why.contains(expect), "{name}: {why}");
        }
    }
}
