//! Land shaped by glaciers: troughs with flat floors and steep walls, hanging side valleys, basins below the level of
//! their outlets, cirques, sharp crests, end moraines and outwash plains.
//!
//! Glaciers follow the valleys of rivers. How much ice passes a point is a sum along the drainage, like a drainage
//! area: the balance of snow that falls and ice that melts, positive above the equilibrium line and negative below it.
//! The land is then a function of the heights, the receivers and that sum within a fixed distance.

mod beds;
mod ends;
mod glaciers;
mod troughs;
mod walls;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use beds::Beds;
pub use glaciers::Glaciers;

/// How glaciers shape land.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Glaciation {
    /// Width of the trough of a glacier whose ice is that of 1 km^2, in metres.
    pub width: f64,
    /// Depth of that trough below the bed of the river, in metres.
    pub depth: f64,
    /// Maximum width of a trough, in metres.
    pub max_width: f64,
    /// Share of the heads of glaciers that have a cirque, 0 to 1.
    pub cirques: f64,
    /// Height of the end moraine of a large glacier, in metres.
    pub moraines: f64,
    /// Seed of the cirques and of the variation of depths.
    pub seed: u64,
}

impl Default for Glaciation {
    /// The defaults of the op `glaciate`.
    fn default() -> Glaciation {
        Glaciation { width: 400.0, depth: 80.0, max_width: 2400.0, cirques: 0.3, moraines: 40.0, seed: 0 }
    }
}

orogen_noise::builder!(
    Glaciation:
    with_width(width: f64),
    with_depth(depth: f64),
    with_max_width(max_width: f64),
    with_cirques(cirques: f64),
    with_moraines(moraines: f64),
    with_seed(seed: u64)
);

/// Land and its ice, on grids over one window.
#[derive(Debug, Clone, Copy)]
pub struct Glaciated<'a> {
    /// Heights in metres.
    pub height: &'a Grid,
    /// Codes of the directions to the receivers.
    pub receiver: &'a Grid,
    /// The ice that passes: the sum of the balance along the drainage, in m^2 of ground with a balance of 1.
    pub ice: &'a Grid,
    /// Height of the equilibrium line in metres.
    pub equilibrium_line: &'a Grid,
}

/// The width of a trough grows with the ice to this power.
const WIDTH_EXPONENT: f64 = 0.32;

impl Glaciated<'_> {
    /// The window of all grids.
    fn window(&self) -> Result<Window> {
        let window = *self.height.window();
        if [self.receiver, self.ice, self.equilibrium_line].iter().any(|grid| *grid.window() != window) {
            return Err(Error::new(ErrorKind::Request, "the land and its ice must have the same window"));
        }
        Ok(window)
    }
}

/// Ice of the smallest glaciers, in km^2.
const MIN_ICE: f32 = 0.6;

impl Glaciation {
    /// Number of samples around a window that [`Glaciation::run`] reads.
    #[must_use]
    pub fn halo(&self, cell: f64) -> usize {
        let carved = beds::reach(cell) + self.trough_reach(cell) + walls::reach(cell);
        carved.max(ends::reach(cell))
    }

    /// Half of the width of a trough in metres, by its ice in km^2.
    fn half_width(&self, ice: f32) -> f32 {
        let half = 0.5 * self.width * libm::pow(f64::from(ice), WIDTH_EXPONENT);
        half.min(0.5 * self.max_width) as f32
    }

    /// Reach of a trough from its line, in samples.
    fn trough_reach(&self, cell: f64) -> usize {
        troughs::reach(0.5 * self.max_width, cell)
    }

    /// The ground without the ice, over a window that is smaller by [`Glaciation::halo`] on each side.
    ///
    /// # Errors
    /// If the grids have different windows, or the work is cancelled.
    pub fn run(&self, land: &Glaciated, progress: &Progress) -> Result<Grid> {
        let window = land.window()?;
        progress.expect(10.0);
        let beds = Beds::new(self, land);
        progress.step(4.0)?;
        let troughs = troughs::carved(self, &beds, &window, progress)?;
        progress.step(4.0)?;
        let mut ground = walls::ground(land.height, &troughs, progress)?;
        ends::lay(self, land, &beds, &mut ground);
        progress.step(2.0)?;
        let inner = window.shrunk(self.halo(window.cell));
        Ok(ground.crop(&inner).unwrap_or_else(|| Grid::filled(inner, f32::NAN)))
    }
}

#[cfg(test)]
mod tests;
