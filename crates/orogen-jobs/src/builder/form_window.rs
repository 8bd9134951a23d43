//! The window of a build without one.

use super::spec::Form;
use super::tile_grid;
use crate::options::Options;
use orogen_engine::view::View;
use orogen_engine::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;

impl Form {
    /// The window of a build: that of `view`, otherwise the whole world at its own cell; of tiles of web maps at
    /// the nearest cell of a zoom level. Tiles that share their edges include the far edge of the world.
    ///
    /// # Errors
    /// If a size is chosen for tiles of web maps, or the errors of [`View::window`].
    pub fn window(self, world: &World, view: &View, options: &Options) -> Result<Window> {
        let recipe = world.recipe();
        if self.is_map() && view.size.is_some() {
            let message = "tiles of web maps have fixed cell sizes; leave out --size, or use --cell";
            return Err(Error::new(ErrorKind::Request, message));
        }
        let tile = || options.whole("tile").map(|side| side as usize).or(self.usual_tile()).unwrap_or(1);
        let cell = view.cell.unwrap_or_else(|| match self {
            _ if self.is_map() => tile_grid::cell_near(recipe.world.cell, tile(), recipe.georeference().as_ref()),
            _ => recipe.world.cell,
        });
        if let Some(part) = view.part(recipe, cell)? {
            return Ok(part);
        }
        let whole = match view.size {
            Some(_) => view.window(world, |_| ())?,
            None => world.full_window(cell)?,
        };
        Ok(match self {
            Form::Tiles(_) => Window { width: whole.width + 1, height: whole.height + 1, ..whole },
            _ => whole,
        })
    }
}
