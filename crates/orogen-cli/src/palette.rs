//! The argument NAME|FILE of a palette.

use std::path::Path;

use orogen::nearest;
use orogen::palette::palette::Palette;
use orogen::palette::{named, read};

use crate::failure::Failure;

/// The palette of `--palette`, with its colors not mixed if `nearest`.
pub fn chosen(argument: Option<&Path>, nearest: bool) -> Result<Option<Palette>, Failure> {
    let palette = argument.map(find).transpose()?;
    Ok(if nearest { palette.map(Palette::nearest) } else { palette })
}

/// The palette with this name, otherwise the one in this file.
fn find(argument: &Path) -> Result<Palette, Failure> {
    let name = argument.to_string_lossy();
    if let Some(named) = named::find(&name) {
        return Ok(named.palette());
    }
    if argument.extension().is_some() || argument.exists() {
        return Ok(read::read(argument)?);
    }
    let hint = match nearest(&name, named::all().iter().map(|named| named.name)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`orogen palettes` lists them".into(),
    };
    Err(Failure::Usage(format!("no palette or file is called `{name}`; {hint}")))
}
