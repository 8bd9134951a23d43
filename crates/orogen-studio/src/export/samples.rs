//! The samples of a world that an export takes.

use orogen::{Result, Window, World, WorldSpec};

use super::command_line::CommandLine;
use crate::preview::region::Region;

/// Default number of samples along a side of a part of a world.
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
    /// The samples of a part of a world; `size` is the number along the longer side.
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
    /// If the world is unbounded, and these samples are not a part of it.
    pub fn window(self, world: &World) -> Result<Window> {
        match self {
            Samples::Own => world.full_window(world.recipe().world.cell),
            Samples::Fitting(size) => world.window_fitting(size),
            Samples::Part(window) => Ok(window),
        }
    }

    /// Adds the options for a command that counts samples.
    pub fn sized(self, line: &mut CommandLine) {
        match self {
            Samples::Own => {}
            Samples::Fitting(size) => line.option("size", size),
            Samples::Part(window) => part(&window, line),
        }
    }

    /// Adds the options for a command whose size option is that of its picture.
    pub fn unsized_for(self, world: &WorldSpec, line: &mut CommandLine) {
        match (self, world.size) {
            (Samples::Fitting(size), Some([width, height])) => line.option("cell", width.max(height) / size as f64),
            (Samples::Part(window), _) => part(&window, line),
            _ => {}
        }
    }
}

/// Adds the options for a part. Numbers are written so that they are read back exactly.
pub fn part(window: &Window, line: &mut CommandLine) {
    let Window { x, y, width, height, cell } = *window;
    line.option("cell", cell);
    line.option("window", format!("{x},{y},{width},{height}"));
}
