//! Which format a file of heights is in: the one list of those that are read.

use std::path::Path;

use super::dem::{Dem, Input, Place, Unit, refused};
use super::raw::Sample;
use super::sidecar::Sidecar;
use super::{asc, geotiff, grey, hgt, npy, raw};
use crate::error::Result;
use crate::open;

/// The extensions of files that heights are read from.
pub const EXTENSIONS: [&str; 8] = ["tif", "tiff", "asc", "hgt", "png", "r16", "r32", "npy"];

/// Whether a file's name says that it holds heights.
pub fn is_dem(path: &Path) -> bool {
    extension(path).is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Reads the heights of a file whose extension tells its format, in no more than `allowed` bytes for the heights themselves.
///
/// # Errors
/// If there is no such format, or the file cannot be read, or is too large.
pub fn read(path: &Path, allowed: u64) -> Result<Dem> {
    let name = path.display().to_string();
    if !is_dem(path) {
        let known = "known are .tif, .asc, .hgt, .png, .r16, .r32 and .npy";
        return Err(refused(&name, format!("its extension does not tell a format of heights; {known}")));
    }
    let mut file = open::regular(path, "read")?;
    let sidecar = Sidecar::beside(path)?;
    parse(&mut file, &name, &extension(path).unwrap_or_default(), sidecar, allowed)
}

/// The same of bytes at hand: `extension` tells the format.
///
/// # Errors
/// As [`read`].
pub fn parse(
    input: &mut dyn Input,
    name: &str,
    extension: &str,
    sidecar: Option<Sidecar>,
    allowed: u64,
) -> Result<Dem> {
    let told = sidecar.clone().unwrap_or_default();
    match extension {
        "tif" | "tiff" => geotiff::reader::read(input, name, allowed),
        "asc" => asc::read(input, name, allowed),
        "hgt" => hgt::read(input, name, allowed),
        "png" => grey::read(input, name, &told, allowed),
        "r16" => raw::read(input, name, Sample::U16, &told, allowed),
        "r32" => raw::read(input, name, Sample::F32, &told, allowed),
        "npy" => {
            let grid = npy::read_within(input, name, told.cell.unwrap_or(1.0), allowed)?;
            let (width, height) = (grid.width(), grid.height());
            let place = told.cell.map(|cell| Place {
                origin: [0.0, cell * (height as f64 - 1.0)],
                step: [cell; 2],
                unit: Unit::Metres(1.0),
                keys: None,
            });
            Dem::new([width, height], grid.into_data(), place).map_err(|why| refused(name, why))
        }
        other => Err(refused(name, format!("the format .{other} is not read"))),
    }
}
