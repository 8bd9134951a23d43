//! The water of a grid of heights: drainage, rivers, lakes and the sea.

use std::ops::Range;

use crate::error::Result;
use crate::grid::Grid;
use crate::hydrology::accumulation::accumulate;
use crate::hydrology::drainage;
use crate::hydrology::lakes::{Lake, lakes_with};
use crate::hydrology::outlets::Outlets;
use crate::hydrology::receivers::Receivers;
use crate::hydrology::rivers::{Reach, network};
use crate::hydrology::steepest::Descent;
use crate::hydrology::strahler;
use crate::progress::Progress;

/// Thresholds of rivers and lakes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Least {
    /// Samples that must drain to the source of a river.
    pub spring: u32,
    /// Minimum area of a lake, in samples.
    pub lake: u32,
    /// Minimum depth of a lake, in metres.
    pub depth: f32,
    /// Whether receivers are random: on heights that are smooth at the scale of a few samples, steepest descent gives
    /// parallel lines.
    pub scattered: bool,
}

impl Least {
    /// Rivers and lakes from these numbers of samples on; lakes of any depth, receivers by steepest descent.
    #[must_use]
    pub const fn new(spring: u32, lake: u32) -> Least {
        Least { spring, lake, depth: 0.0, scattered: false }
    }
}

orogen_noise::builder!(
    Least:
    with_spring(spring: u32),
    with_lake(lake: u32),
    with_depth(depth: f32),
    with_scattered(scattered: bool)
);

/// The cover of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cover {
    /// Land without water.
    Land,
    /// A lake, by its number from 1.
    Lake(u32),
    /// The sea.
    Sea,
    /// Unknown: the sample has no height.
    Missing,
}

/// The water of a grid.
#[derive(Debug, Clone)]
pub struct Water {
    /// The heights.
    pub heights: Grid,
    /// Land: the heights, with depressions that are not lakes raised until they drain. Lakes: their level. The surface
    /// never rises along the receivers.
    pub surface: Grid,
    /// The receiver of each sample.
    pub receivers: Receivers,
    /// Number of samples that drain through each sample, including itself.
    pub area: Grid<u32>,
    /// The lake at each sample, from 1; 0 on land.
    pub labels: Grid<u32>,
    /// The lakes; lake k is at index k - 1.
    pub lakes: Vec<Lake>,
    /// The reaches of rivers, from source or confluence to confluence or outlet, also below lakes.
    pub reaches: Vec<Reach>,
    /// The height of the sea.
    pub sea_level: Option<f32>,
}

/// A range of columns and rows of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Columns.
    pub columns: Range<usize>,
    /// Rows.
    pub rows: Range<usize>,
}

impl Frame {
    /// The frame of the whole grid.
    #[must_use]
    pub fn whole(water: &Water) -> Frame {
        Frame { columns: 0..water.heights.width(), rows: 0..water.heights.height() }
    }

    /// Whether the frame contains a sample.
    #[must_use]
    pub fn holds(&self, water: &Water, cell: usize) -> bool {
        let width = water.heights.width().max(1);
        self.columns.contains(&(cell % width)) && self.rows.contains(&(cell / width))
    }
}

/// Memory per sample for computing the water, in bytes, including the heights.
pub const MEMORY: u64 = 44;

impl Water {
    /// Computes the water of a grid. A grid of fewer than three columns or rows has none.
    ///
    /// # Errors
    /// If the work was cancelled.
    pub fn of(heights: Grid, sea_level: Option<f32>, least: Least, progress: &Progress) -> Result<Water> {
        let outlets = Outlets::new(&heights, sea_level);
        let descent = if least.scattered { Descent::Scattered(1) } else { Descent::Steepest };
        progress.check()?;
        let drainage = drainage::route_carving_with(&heights, &outlets, descent, &progress.part(0.0))?;
        let mut found = lakes_with(&heights, &outlets, &drainage, least.lake, &progress.part(0.0))?;
        let receivers = drainage.receivers;
        drop(drainage.basins);
        progress.check()?;
        // Shallow lakes are dropped, and the others renumbered.
        let mut kept = vec![0u32];
        let mut deep = Vec::new();
        for lake in &found.lakes {
            let is_deep = lake.level - heights.data()[lake.deepest as usize] >= least.depth;
            kept.push(if is_deep { deep.len() as u32 + 1 } else { 0 });
            deep.extend(is_deep.then_some(*lake));
        }
        found.labels.data_mut().iter_mut().for_each(|label| *label = kept[*label as usize]);
        let drained = accumulate(&receivers);
        let orders = strahler::orders(&receivers, &drained, least.spring.max(1));
        let reaches = network(&receivers, &orders);
        progress.check()?;
        Ok(Water {
            heights,
            surface: found.surface,
            receivers,
            area: drained.area,
            labels: found.labels,
            lakes: deep,
            reaches,
            sea_level,
        })
    }

    /// The cover of a sample.
    #[must_use]
    pub fn cover(&self, cell: usize) -> Cover {
        let height = self.heights.data()[cell];
        match self.labels.data()[cell] {
            _ if !height.is_finite() => Cover::Missing,
            _ if self.sea_level.is_some_and(|sea| height <= sea) => Cover::Sea,
            0 => Cover::Land,
            lake => Cover::Lake(lake),
        }
    }

    /// Column and row of a sample.
    #[must_use]
    pub fn place(&self, cell: usize) -> [f64; 2] {
        let width = self.heights.width().max(1);
        [(cell % width) as f64, (cell / width) as f64]
    }
}
