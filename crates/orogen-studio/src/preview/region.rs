//! The part of a world that is shown.

use orogen::{Result, Window, World};

/// A part of a world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Region {
    /// The whole of a bounded world.
    Whole,
    /// A square.
    Square {
        /// Its middle: metres east and south of the origin.
        center: [f64; 2],
        /// The length of its sides in metres.
        side: f64,
    },
}

/// The side of the square that is shown of an unbounded world at first, in its cells.
const CELLS: f64 = 1024.0;

impl Region {
    /// What is shown of a world at first.
    #[must_use]
    pub fn of(size: Option<[f64; 2]>, cell: f64) -> Region {
        match size {
            Some(_) => Region::Whole,
            None => Region::Square { center: [0.0; 2], side: CELLS * cell },
        }
    }

    /// Its window with about `samples` along the longer side.
    ///
    /// # Errors
    /// If the region is whole and the world unbounded.
    pub fn window(&self, world: &World, samples: usize) -> Result<Window> {
        let Region::Square { center, side } = *self else { return world.window_fitting(samples) };
        let cell = (side / samples as f64).max(1e-3);
        let first = |center: f64| ((center - side / 2.0) / cell).round() as i64;
        let window = Window::new(samples, samples, cell).at(first(center[0]), first(center[1]));
        let Some(size) = world.recipe().world.size else { return Ok(window) };
        // A bounded world has nothing beyond its sides.
        let ends = size.map(|length| (length / cell).floor() as usize + 1);
        let whole = Window::new(ends[0], ends[1], cell);
        let part = window.intersection(&whole);
        Ok(if part.width > 1 && part.height > 1 { part } else { whole })
    }

    /// The part that a view shows: all of a bounded world, unless it shows less than half of it.
    #[must_use]
    pub fn in_view(world: Option<[f64; 2]>, center: [f64; 2], side: f64) -> Region {
        match world {
            Some(size) if side > 0.5 * size[0].max(size[1]) => Region::Whole,
            _ => Region::Square { center, side },
        }
    }
}
