//! Which samples of a world an export takes.

use orogen::{Result, Window, World, WorldSpec};

use super::command_line::CommandLine;
use crate::preview::region::Region;

/// Samples along a side of a part of a world, unless another number is chosen.
pub const DEFAULT: usize = 1024;

/// The samples of an export.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Samples {
    /// The whole world at its own cell.
    Own,
    /// The whole world with this many samples along its longer side.
    Fitting(usize),
    /// A part.
    Part(Window),
}

impl Samples {
    /// The samples of a part of a world; `size` is their number along the longer side.
    #[must_use]
    pub fn of(region: Region, size: Option<usize>, world: &WorldSpec) -> Samples {
        match (region.part(world.size, size.unwrap_or(DEFAULT)), size) {
            (Some(window), _) => Samples::Part(window),
            (None, Some(size)) => Samples::Fitting(size),
            (None, None) => Samples::Own,
        }
    }

    /// The window.
    ///
    /// # Errors
    /// If the world is unbounded, and this is not a part.
    pub fn window(self, world: &World) -> Result<Window> {
        match self {
            Samples::Own => world.full_window(world.recipe().world.cell),
            Samples::Fitting(size) => world.window_fitting(size),
            Samples::Part(window) => Ok(window),
        }
    }

    /// The options of a command that counts samples.
    pub fn sized(self, line: &mut CommandLine) {
        match self {
            Samples::Own => {}
            Samples::Fitting(size) => line.option("size", size),
            Samples::Part(window) => part(&window, line),
        }
    }

    /// The options of a command whose size is that of its picture.
    pub fn unsized_for(self, world: &WorldSpec, line: &mut CommandLine) {
        match (self, world.size) {
            (Samples::Fitting(size), Some([width, height])) => line.option("cell", width.max(height) / size as f64),
            (Samples::Part(window), _) => part(&window, line),
            _ => {}
        }
    }
}

/// The options of a part: numbers are written so that they are read as the same ones.
pub fn part(window: &Window, line: &mut CommandLine) {
    let Window { x, y, width, height, cell } = *window;
    line.option("cell", cell);
    line.option("window", format!("{x},{y},{width},{height}"));
}
