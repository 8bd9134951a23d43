//! The visible part of a world.

use orogen::{Result, Window, World};
use serde::{Deserialize, Serialize};

/// A part of a world.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Region {
    /// The whole of a bounded world.
    Whole,
    /// A square.
    Square {
        /// The center: metres east and south of the origin.
        center: [f64; 2],
        /// The length of the sides in metres.
        side: f64,
    },
}

/// Initial side of the square that is shown of an unbounded world, in cells.
const CELLS: f64 = 1024.0;

impl Region {
    /// The initial region of a world.
    #[must_use]
    pub fn of(size: Option<[f64; 2]>, cell: f64) -> Region {
        match size {
            Some(_) => Region::Whole,
            None => Region::Square { center: [0.0; 2], side: CELLS * cell },
        }
    }

    /// The window of the region with about `samples` along the longer side.
    ///
    /// # Errors
    /// If the region is whole and the world unbounded.
    pub fn window(&self, world: &World, samples: usize) -> Result<Window> {
        self.part(world.recipe().world.size, samples).map_or_else(|| world.window_fitting(samples), Ok)
    }

    /// The window of a square in a world of this size, or in an unbounded world; `None` for the whole world.
    #[must_use]
    pub fn part(&self, world: Option<[f64; 2]>, samples: usize) -> Option<Window> {
        let Region::Square { center, side } = *self else { return None };
        let cell = (side / samples as f64).max(1e-3);
        let first = |center: f64| ((center - side / 2.0) / cell).round() as i64;
        let window = Window::new(samples, samples, cell).at(first(center[0]), first(center[1]));
        let Some(size) = world else { return Some(window) };
        // A bounded world ends at its sides.
        let ends = size.map(|length| (length / cell).floor() as usize + 1);
        let whole = Window::new(ends[0], ends[1], cell);
        let part = window.intersection(&whole);
        Some(if part.width > 1 && part.height > 1 { part } else { whole })
    }

    /// West, north and side length of a square, moved and shrunk so that it is inside a world of this size; `None` for
    /// the whole world.
    #[must_use]
    pub fn square(&self, world: Option<[f64; 2]>) -> Option<[f64; 3]> {
        let Region::Square { center, side } = *self else { return None };
        let most = world.map_or(f64::INFINITY, |size| size[0].min(size[1]));
        let side = side.min(most);
        let first = |axis: usize| {
            let first = center[axis] - side / 2.0;
            world.map_or(first, |size| first.clamp(0.0, (size[axis] - side).max(0.0)))
        };
        Some([first(0), first(1), side])
    }

    /// The region for a view: all of a bounded world, unless the view shows less than half of it.
    #[must_use]
    pub fn in_view(world: Option<[f64; 2]>, center: [f64; 2], side: f64) -> Region {
        match world {
            Some(size) if side > 0.5 * size[0].max(size[1]) => Region::Whole,
            _ => Region::Square { center, side },
        }
    }
}
