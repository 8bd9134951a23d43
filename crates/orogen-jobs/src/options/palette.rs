//! Palettes by name or file.

use std::path::Path;

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::nearest;
use orogen_io::fs;
use orogen_io::palette::palette::Palette;
use orogen_io::palette::{named, read};

/// The palette with this name, or else the palette in this file.
///
/// # Errors
/// If there is neither, or the file cannot be read.
pub fn find_palette(palette: &Path) -> Result<Palette> {
    let name = palette.to_string_lossy();
    if let Some(named) = named::find(&name) {
        return Ok(named.palette());
    }
    if palette.extension().is_some() || fs::is_present(palette) {
        return read(palette);
    }
    let hint = match nearest(&name, named::all().iter().map(|named| named.name)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`orogen palettes` lists them".into(),
    };
    Err(Error::new(ErrorKind::Request, format!("no palette or file is called `{name}`; {hint}")))
}
