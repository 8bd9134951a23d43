//! The water of a grid of heights: where it runs, how much of it, and where it stands.

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

/// What counts as water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// Samples that drain to where a river begins.
    pub spring: u32,
    /// Samples that a lake covers.
    pub lake: u32,
    /// Metres that it is deep.
    pub depth: f32,
    /// Whether water goes down by scattered steps: on heights that are smooth between few samples steepest ones run in parallel.
    pub scattered: bool,
}

/// What a sample is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    /// Dry land.
    Land,
    /// A lake, by its number from 1.
    Lake(u32),
    /// Sea.
    Sea,
    /// Not known: the sample has no height.
    Missing,
}

/// The water of a grid.
#[derive(Debug, Clone)]
pub struct Water {
    /// The heights.
    pub heights: Grid,
    /// The heights of dry land, raised where it lies in a depression that is no lake until water runs off it; the level of lakes. Along the receivers
    /// it falls, or is level.
    pub surface: Grid,
    /// Where each sample drains to.
    pub receivers: Receivers,
    /// Samples that drain through each, itself included.
    pub area: Grid<u32>,
    /// The lake that covers each sample, from 1; 0 on land.
    pub labels: Grid<u32>,
    /// The lakes, by their number less 1.
    pub lakes: Vec<Lake>,
    /// The reaches of rivers, from spring or confluence to confluence or outlet, under lakes too.
    pub reaches: Vec<Reach>,
    /// The height of the sea's surface.
    pub sea_level: Option<f32>,
}

/// Columns and rows of the grid that is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Columns.
    pub columns: Range<usize>,
    /// Rows.
    pub rows: Range<usize>,
}

impl Frame {
    /// The frame of all of a grid.
    pub fn whole(water: &Water) -> Frame {
        Frame { columns: 0..water.heights.width(), rows: 0..water.heights.height() }
    }

    /// Whether a sample is in it.
    pub fn holds(&self, water: &Water, cell: usize) -> bool {
        let width = water.heights.width().max(1);
        self.columns.contains(&(cell % width)) && self.rows.contains(&(cell / width))
    }
}

/// Bytes for each sample that finding the water takes, the heights included.
pub const MEMORY: u64 = 44;

impl Water {
    /// Finds the water. On a grid of fewer than three columns or rows there is none.
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
        // Lakes that are not deep enough are none; the others are numbered anew.
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

    /// What a sample is.
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
    pub fn place(&self, cell: usize) -> [f64; 2] {
        let width = self.heights.width().max(1);
        [(cell % width) as f64, (cell / width) as f64]
    }
}
