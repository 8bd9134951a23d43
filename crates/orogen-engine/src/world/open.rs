//! Opening worlds by name.

use super::world::World;
use crate::recipe::source::RecipeSource;
use orogen_grid::error::Result;
use orogen_io::dem::prepared::DEFAULT_MEMORY;
use std::path::Path;

/// Opens a world: a preset by name (`"alpine"`), a recipe file (`"land.toml"`, `"land.json"`), or a file of heights
/// (`"alps.tif"`), of which at most 4 GiB are kept in memory. A file takes precedence over a preset of the same name.
///
/// Use [`World::open`] for a recipe made or changed in code, and a [`Session`](crate::Session) for a memory limit.
///
/// ```
/// let world = orogen_engine::open("hills")?;
/// let height = world.height(1200.0, 800.0)?;
/// assert!(orogen_engine::open("hils").is_err_and(|error| error.to_string().contains("did you mean `hills`?")));
/// # Ok::<(), orogen_engine::Error>(())
/// ```
///
/// # Errors
/// If there is no such preset or file (the message suggests the closest name), the file cannot be read, or the recipe
/// is not valid.
pub fn open(source: impl AsRef<Path>) -> Result<World> {
    World::open(RecipeSource::find(source.as_ref())?.open(&[], DEFAULT_MEMORY, |_| {})?)
}
