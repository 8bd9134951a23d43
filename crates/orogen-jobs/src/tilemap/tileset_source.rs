//! Tilesets by name: a built-in one, or a file.

use std::path::PathBuf;

use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::{Error, ErrorKind, Result};

use super::art::set::{SETS, Set};
use super::load::any as load;
use super::load::loaded::Loaded;
use super::tileset::Tileset;

/// A tileset, and the files that it was read from.
#[derive(Debug)]
pub struct TilesetSource {
    /// The tileset.
    pub tileset: Tileset,
    /// The files; empty for a built-in tileset.
    pub files: Vec<PathBuf>,
}

/// Finds the built-in tileset with this name, or reads the file: a Tiled tileset (.tsx) or a description (.toml).
/// `layout` says how tiles depend on their surroundings; by default the layout of the file, or `blob`. `wang_set` names
/// the wang set to use if a .tsx has several.
///
/// # Errors
/// If there is no such tileset, or it has no such layout or wang set.
pub fn find(name: &str, layout: Option<Layout>, wang_set: Option<&str>) -> Result<TilesetSource> {
    let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
    if load::is_file(name) {
        let path = PathBuf::from(name);
        let Loaded { tileset, picture } = load::load(&path, layout, wang_set)?;
        return Ok(TilesetSource { tileset, files: vec![path, picture] });
    }
    let Some(set) = Set::named(name) else {
        let names: Vec<&str> = SETS.iter().map(|set| set.name).collect();
        return refuse(format!(
            "there is no tileset `{name}`; the tilesets of the program are {}, and files of others end in .tsx or .toml",
            names.join(" and ")
        ));
    };
    if wang_set.is_some() {
        return refuse(format!("--wang-set chooses one of a .tsx; `{}` is a tileset of the program", set.name));
    }
    Ok(TilesetSource { tileset: set.draw(layout.unwrap_or(Layout::Blob)), files: Vec::new() })
}
