//! Tilesets from files of any supported kind.

use std::path::Path;

use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::{Error, ErrorKind, Result};

use super::loaded::Loaded;
use super::picture::{Cut, Grid};
use super::{description, tsx};
use crate::tilemap::tileset::Tileset;

/// Whether the name of a tileset is a file name.
#[must_use]
pub fn is_file(name: &str) -> bool {
    let has = |extension: &str| Path::new(name).extension().is_some_and(|of| of.eq_ignore_ascii_case(extension));
    has("tsx") || has("toml")
}

/// Reads a Tiled tileset (.tsx) or a [description] (.toml). `layout` says how tiles on corners are placed:
/// [`Layout::Corner`] or [`Layout::Dual`]. `wang_set` names the wang set to use if a .tsx has several.
///
/// # Errors
/// If a file cannot be read, or is not a valid tileset.
pub fn load(path: &Path, layout: Option<Layout>, wang_set: Option<&str>) -> Result<Loaded> {
    let is_toml = path.extension().is_some_and(|of| of.eq_ignore_ascii_case("toml"));
    let loaded = match is_toml {
        true if wang_set.is_some() => {
            let message = format!("{} is a description of a tileset and has no wang sets", path.display());
            return Err(Error::new(ErrorKind::Request, message));
        }
        true => description::load(path)?,
        false => tsx::load(path, wang_set)?,
    };
    let Loaded { mut tileset, picture } = loaded;
    if let Some(layout) = layout
        && layout != tileset.layout
    {
        if !(layout.is_on_corners() && tileset.layout.is_on_corners()) {
            let message = format!(
                "{} has tiles for the layout `{}`, not `{}`; leave out --layout",
                path.display(),
                tileset.layout.name(),
                layout.name()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        tileset.layout = layout;
    }
    Ok(Loaded { tileset, picture })
}

/// Parses the text of a tileset whose picture has `count` tiles without content; for fuzzing.
///
/// # Errors
/// If the text is not a valid tileset.
#[doc(hidden)]
pub fn parse(text: &str, is_toml: bool, wang_set: Option<&str>, count: usize) -> Result<Tileset> {
    let blank =
        |_: &Path, grid: &Grid| Ok(Cut { count, columns: count, pixels: vec![[0; 4]; count * grid.size.min(4)] });
    let loaded = match is_toml {
        true => description::read(Path::new("it.toml"), text, blank)?,
        false => tsx::read(Path::new("it.tsx"), text, wang_set, blank)?,
    };
    Ok(loaded.tileset)
}
