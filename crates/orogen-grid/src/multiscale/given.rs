//! Properties of the land that the caller provides.

use super::continents::Continents;
use super::drawn_ridges::{Crest, DrawnRidges};
use super::drawn_rivers::DrawnRivers;
use super::geography::Geography;
use super::passages::Passages;
use super::refinement::Refinement;
use crate::grid::{Grid, Window};
use std::ops::RangeInclusive;

/// Shores, uplift and factors. Each grid has the cell of the level and covers the samples that the level reads. A
/// factor without a value (NaN, or outside the grid) is 1.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given<'a> {
    /// Distance to the shore in metres, positive on land.
    pub shore: Option<&'a Grid>,
    /// Uplift over erodibility, for example 1 in mountains and 0.1 in plains.
    pub uplift: Option<&'a Grid>,
    /// Factor of the stable slope of hillsides.
    pub stability_factor: Option<&'a Grid>,
    /// Factor of the creep of soil on the finest level.
    pub creep_factor: Option<&'a Grid>,
    /// Factor of the width of valley floors.
    pub floor_factor: Option<&'a Grid>,
    /// Factor of the rain, and thus of the discharge from each cell. On detail levels the rain of streams comes from
    /// the coarser levels.
    pub rain: Option<&'a Grid>,
    /// The land whose geography provides shores and uplift where they have no value. Without it they are taken from the
    /// next coarser level.
    pub continents: Option<&'a Continents>,
    /// Rivers that every level leads along their lines.
    pub rivers: Option<&'a DrawnRivers>,
    /// Ridges and summits that have their heights on every level.
    #[doc(hidden)]
    pub ridges: Option<&'a DrawnRidges>,
    /// If the shore is binding: the position of the samples in the cells, as a share of their sides. The shore is then
    /// read at the nodes.
    #[doc(hidden)]
    pub binding: Option<f32>,
}

/// Minimum of uplift over erodibility, so that its logarithm is finite.
const LEAST_UPLIFT: f32 = 1e-4;

impl Given<'_> {
    /// The distance to the shore in kilometres at a sample of the lattice, if it is given.
    pub(super) fn shore(&self, x: i64, y: i64) -> Option<f32> {
        self.shore.and_then(|grid| at(grid, x, y)).map(|metres| metres * 1e-3)
    }

    /// The distance to the shore in kilometres at a node, if it is given: at its sample, or at its position in the cell
    /// if the shore is binding.
    pub(super) fn shore_at(&self, (x, y): (i64, i64), east: f32, south: f32) -> Option<f32> {
        let Some(sample) = self.binding else { return self.shore(x, y) };
        let part = |index: i64, share: f32| {
            let from = (share - sample).floor();
            (index + from as i64, share - sample - from)
        };
        let ((x, east), (y, south)) = (part(x, east), part(y, south));
        // No sample beyond that of the node is read, which can be the last one.
        let row = |y: i64| {
            let west = self.shore(x, y)?;
            if east == 0.0 { Some(west) } else { Some(west + east * (self.shore(x + 1, y)? - west)) }
        };
        let north = row(y)?;
        if south == 0.0 { Some(north) } else { Some(north + south * (row(y + 1)? - north)) }
    }

    /// Whether the level is a detail level with a binding shore, whose samples are at the corners of its cells.
    pub(super) fn is_of_detail(&self) -> bool {
        self.binding == Some(0.0)
    }

    /// The distance to the shore in kilometres that decides about a cell, if it is given: at its sample, or in its
    /// middle if the shore is binding.
    pub(super) fn shore_of_cell(&self, x: i64, y: i64) -> Option<f32> {
        self.shore_at((x, y), 0.5, 0.5)
    }

    /// The logarithm of uplift over erodibility at a sample of the lattice, if it is given.
    pub(super) fn uplift(&self, x: i64, y: i64) -> Option<f32> {
        let uplift = self.uplift.and_then(|grid| at(grid, x, y))?;
        Some(libm::log(f64::from(uplift.max(LEAST_UPLIFT))) as f32)
    }

    /// The factors of the rain over a window, if they are given.
    pub(super) fn rain(&self, window: &Window) -> Option<Vec<f32>> {
        self.rain.map(|_| factor(self.rain, window, RAIN))
    }

    /// The cells of a window of level `depth` that drawn rivers cross.
    pub(super) fn passages(&self, land: &Refinement, depth: usize, window: &Window) -> Passages {
        self.rivers.map_or_else(Passages::default, |rivers| rivers.passages(land, depth, window))
    }

    /// The cells of a window of level `depth` with drawn ridges.
    pub(super) fn crests(&self, land: &Refinement, depth: usize, window: &Window) -> Vec<Crest> {
        self.ridges.map_or_else(Vec::new, |ridges| ridges.crests(land, depth, window))
    }

    /// The given distance to the shore in kilometres at a sample, or that of the geography at a position in metres.
    pub(super) fn shore_or(&self, (x, y): (i64, i64), geography: &Geography, east: f64, south: f64) -> f32 {
        self.shore(x, y).unwrap_or_else(|| geography.shore(east, south))
    }

    /// The given logarithm of uplift over erodibility at a sample, or that of the geography at a position in metres.
    pub(super) fn uplift_or(&self, (x, y): (i64, i64), geography: &Geography, east: f64, south: f64) -> f32 {
        self.uplift(x, y).unwrap_or_else(|| geography.uplift(east, south))
    }
}

/// Range of factors of the rain.
const RAIN: RangeInclusive<f32> = 0.01..=100.0;

/// The values of a factor over a window, clamped to `range`; 1 where it has no value.
pub(super) fn factor(grid: Option<&Grid>, window: &Window, range: RangeInclusive<f32>) -> Vec<f32> {
    let mut factors = vec![1.0; window.len()];
    if let Some(grid) = grid {
        for (row, y) in factors.chunks_mut(window.width.max(1)).zip(window.y..) {
            for (factor, x) in row.iter_mut().zip(window.x..) {
                *factor = at(grid, x, y).map_or(1.0, |value| value.clamp(*range.start(), *range.end()));
            }
        }
    }
    factors
}

/// The value at a sample of the lattice, if it is finite.
fn at(grid: &Grid, x: i64, y: i64) -> Option<f32> {
    let window = grid.window();
    let (i, j) = (usize::try_from(x - window.x).ok()?, usize::try_from(y - window.y).ok()?);
    grid.get(i, j).filter(|value| value.is_finite())
}
