//! The list of all readers of heights.

use std::path::Path;

use super::dem::{Dem, Input, Placement, Request, refused};
use super::noted::noted;
use super::raw::Sample;
use super::sidecar::Sidecar;
use super::{asc, exr_reader, geotiff, grey, hgt, npy, raw};
use crate::open;
use orogen_grid::error::Result;

/// Extensions of readable files.
pub const EXTENSIONS: [&str; 9] = ["tif", "tiff", "asc", "hgt", "png", "r16", "r32", "npy", "exr"];

/// Extensions of files that may have several bands.
const SEVERAL_BANDS: [&str; 3] = ["tif", "tiff", "exr"];

/// Whether a file's name has one of these extensions.
#[must_use]
pub fn is_dem(path: &Path) -> bool {
    extension(path).is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Whether a file's size and position can be read without its heights, as tiles require.
#[must_use]
pub fn has_head(path: &Path) -> bool {
    extension(path).is_some_and(|extension| matches!(extension.as_str(), "tif" | "tiff" | "asc" | "hgt"))
}

/// The size and position of a file that [has a head](has_head).
///
/// # Errors
/// If it cannot be read.
pub fn head(path: &Path) -> Result<([usize; 2], Option<Placement>)> {
    let name = path.display().to_string();
    let mut file = open::regular(path, "read")?;
    let (size, mut place) = noted(&mut file, |file| match extension(path).unwrap_or_default().as_str() {
        "asc" => asc::head(file, &name),
        "hgt" => hgt::head(file, &name),
        _ => geotiff::reader::head(file, &name),
    })?;
    if let (Some(place), Some(told)) = (&mut place, Sidecar::beside(path)?) {
        told.complete(place);
    }
    Ok((size, place))
}

/// Reads one band of a file; its extension determines the format. `request` limits the memory of the heights.
///
/// # Errors
/// If the format is unknown, or the file cannot be read, or is too large.
pub fn read(path: &Path, request: impl Into<Request>) -> Result<Dem> {
    let name = path.display().to_string();
    if !is_dem(path) {
        let known = "supported are .tif, .asc, .hgt, .png, .r16, .r32, .npy, .exr and .vrt, folders of .tif, .hgt or .asc, and Zarr";
        return Err(refused(&name, format!("its extension is not that of a format for heights; {known}")));
    }
    let mut file = open::regular(path, "read")?;
    let sidecar = Sidecar::beside(path)?;
    parse(&mut file, &name, &extension(path).unwrap_or_default(), sidecar, request)
}

/// [`read`] for bytes in memory: `extension` determines the format.
///
/// # Errors
/// The errors of [`read`].
pub fn parse(
    input: &mut dyn Input,
    name: &str,
    extension: &str,
    sidecar: Option<Sidecar>,
    request: impl Into<Request>,
) -> Result<Dem> {
    noted(input, |input| band(input, name, extension, sidecar, request.into()))
}

fn band(input: &mut dyn Input, name: &str, extension: &str, sidecar: Option<Sidecar>, request: Request) -> Result<Dem> {
    let Request { allowed, .. } = request;
    let told = sidecar.unwrap_or_default();
    if !SEVERAL_BANDS.contains(&extension) {
        request.choose(1).map_err(|why| refused(name, why))?;
    }
    let mut dem = match extension {
        "tif" | "tiff" => geotiff::reader::read(input, name, request)?,
        "asc" => asc::read(input, name, allowed)?,
        "hgt" => hgt::read(input, name, allowed)?,
        "png" => grey::read(input, name, &told, allowed)?,
        "r16" => raw::read(input, name, Sample::U16, &told, allowed)?,
        "r32" => raw::read(input, name, Sample::F32, &told, allowed)?,
        "exr" => exr_reader::read(input, name, &told, request)?,
        "npy" => {
            let grid = npy::read_within(input, name, told.cell.unwrap_or(1.0), allowed)?;
            let size = [grid.width(), grid.height()];
            let read = told.north_first(grid.into_data(), size[0]);
            read.and_then(|heights| Dem::new(size, heights, told.place(size[1])?)).map_err(|why| refused(name, why))?
        }
        other => return Err(refused(name, format!("the format .{other} is not supported"))),
    };
    // A GeoTIFF without position tags, but with a world file.
    if dem.place.is_none() && told.geotransform.is_some() {
        let heights = std::mem::take(&mut dem.heights);
        dem.heights = told.north_first(heights, dem.width).map_err(|why| refused(name, why))?;
        dem.place = told.place(dem.height).map_err(|why| refused(name, why))?;
    }
    if let Some(place) = &mut dem.place {
        told.complete(place);
        if place.keys.is_none() {
            dem.notes.extend(told.notes);
        }
    }
    Ok(dem)
}
