//! Reading heights by path: a file, a band of a file, a folder of tiles, a virtual raster or a Zarr array.

use std::path::{Path, PathBuf};

use super::mosaic;
use crate::format::dem::{Dem, Request};
use crate::format::import;
use crate::format::zarr::reader as zarr;
use crate::fs;
use orogen_grid::error::Result;

/// Whether a path names heights: a file with a known extension, optionally with a band after a colon, or a folder of
/// tiles.
#[must_use]
pub fn is_dem(path: &Path) -> bool {
    let (path, _) = split(path);
    import::is_dem(&path)
        || is_virtual(&path)
        || fs::is_dir(&path) && (zarr::is_zarr(&path) || mosaic::tiles(&path).is_ok_and(|tiles| !tiles.is_empty()))
}

/// Splits a path from the band after a colon: `alps.tif:2`. If a file with the whole name exists, there is no band.
#[must_use]
pub fn split(path: &Path) -> (PathBuf, Option<u32>) {
    let whole = || (path.to_path_buf(), None);
    let Some(text) = path.to_str() else { return whole() };
    match text.rsplit_once(':').map(|(file, band)| (Path::new(file), band.parse())) {
        Some((file, Ok(band))) if file.extension().is_some() && !fs::is_present(path) => {
            (file.to_path_buf(), Some(band))
        }
        _ => whole(),
    }
}

/// All files that heights at a path are read from: the file itself, the tiles of a folder, the sources of a virtual
/// raster. Empty if the path cannot be read.
#[must_use]
pub fn files(path: &Path) -> Vec<PathBuf> {
    let (path, _) = split(path);
    let mut files = match fs::is_dir(&path) {
        true => mosaic::tiles(&path).unwrap_or_default(),
        false if is_virtual(&path) => mosaic::sources(&path),
        false => Vec::new(),
    };
    files.push(path);
    files
}

fn is_virtual(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vrt"))
}

/// Reads heights.
///
/// # Errors
/// If there are no heights, they cannot be read, or exceed the memory limit.
pub fn read(path: &Path, request: Request) -> Result<Dem> {
    let (path, band) = split(path);
    let request = Request { band: band.or(request.band), ..request };
    if fs::is_dir(&path) {
        return match zarr::is_zarr(&path) {
            true => zarr::read(&path, request),
            false => mosaic::folder(&path, request),
        };
    }
    if is_virtual(&path) {
        return mosaic::virtual_raster(&path, request);
    }
    import::read(&path, request)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_stand_behind_a_colon() {
        for (text, file, band) in [
            ("a.tif:2", "a.tif", Some(2)),
            ("a.tif", "a.tif", None),
            ("C:/a.tif:3", "C:/a.tif", Some(3)),
            ("C:7", "C:7", None),
            ("a.tif:b", "a.tif:b", None),
        ] {
            assert_eq!(split(Path::new(text)), (PathBuf::from(file), band), "{text}");
        }
        assert!(is_dem(Path::new("a.tif:2")) && is_dem(Path::new("b.VRT")) && !is_dem(Path::new("b.toml")));
    }
}
