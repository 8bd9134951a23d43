//! The water of a grid of heights: drainage, rivers, lakes and the sea.

use std::ops::Range;

use super::network::{AT_SEA, Network};
use crate::error::Result;
use crate::grid::Grid;
use crate::hydrology::accumulation::accumulate;
use crate::hydrology::lakes::{Lake, lakes_with};
use crate::hydrology::outlets::Outlets;
use crate::hydrology::receivers::Receivers;
use crate::hydrology::rivers::{Reach, network};
use crate::hydrology::steepest::Descent;
use crate::hydrology::{drainage, strahler};
use crate::progress::Progress;

/// Thresholds of rivers and lakes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Least {
    /// Minimum number of samples that drain to the source of a river.
    pub spring: u32,
    /// Minimum area of a lake, in samples.
    pub lake: u32,
    /// Minimum depth of a lake, in metres.
    pub depth: f32,
    /// Whether receivers are random. On heights that are smooth at the scale of a few samples, steepest descent would
    /// give parallel lines.
    pub scattered: bool,
}

impl Least {
    /// Rivers and lakes with these minimum numbers of samples, lakes of any depth, and receivers by steepest descent.
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
    /// The heights of the samples, in metres.
    pub heights: Grid,
    /// On land, the heights, with depressions that are not lakes raised until they drain; in lakes, their level. The
    /// surface never rises along the receivers. For a given network, the heights of its nodes, which never rise along
    /// rivers.
    pub surface: Grid,
    /// The receiver of each sample.
    pub receivers: Receivers,
    /// Number of samples that drain through each sample, including the sample itself; empty if the network is given.
    pub area: Grid<u32>,
    /// The lake at each sample, from 1; 0 on land.
    pub labels: Grid<u32>,
    /// The lakes; lake k is at index k - 1.
    pub lakes: Vec<Lake>,
    /// The reaches of rivers, from each source or confluence to the next confluence or outlet, also below lakes.
    pub reaches: Vec<Reach>,
    /// The height of the sea in metres; `None` without a sea.
    pub sea_level: Option<f32>,
    /// The network, if it was [given](Water::given).
    pub network: Option<Network>,
    /// Whether each lake is too small to be shown.
    pub(super) small: Vec<bool>,
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
    /// The volume of each lake within a frame, at the index of its label. `cell_area` is the area of a sample.
    #[must_use]
    pub fn lake_volumes(&self, frame: &Frame, cell_area: f64) -> Vec<f64> {
        let mut volumes = vec![0.0f64; self.lakes.len() + 1];
        for row in frame.rows.clone() {
            let columns = frame.columns.clone();
            for (label, height) in self.labels.row(row)[columns.clone()].iter().zip(&self.heights.row(row)[columns]) {
                if let Some(lake) = label.checked_sub(1).and_then(|k| self.lakes.get(k as usize)) {
                    volumes[*label as usize] += (f64::from(lake.level) - f64::from(*height)) * cell_area;
                }
            }
        }
        volumes
    }

    /// Computes the water of a grid. A grid with fewer than three columns or rows has none.
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
        // Shallow lakes are dropped, and the others are renumbered.
        let mut kept = vec![0u32];
        let mut deep = Vec::new();
        for lake in &found.lakes {
            let is_deep = lake.level - heights.data()[lake.deepest as usize] >= least.depth;
            kept.push(if is_deep { deep.len() as u32 + 1 } else { 0 });
            deep.extend(is_deep.then_some(*lake));
        }
        found.labels.data_mut().iter_mut().for_each(|label| *label = kept[*label as usize]);
        let drained = accumulate(&receivers);
        let orders = strahler::strahler_orders(&receivers, &drained, least.spring.max(1));
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
            network: None,
            small: Vec::new(),
        })
    }

    /// The cover of a sample.
    #[must_use]
    pub fn cover(&self, cell: usize) -> Cover {
        let height = self.heights.data()[cell];
        match self.labels.data()[cell] {
            _ if !height.is_finite() => Cover::Missing,
            // The bed of a given lake may be below the sea.
            lake @ 1.. if self.network.is_some() => Cover::Lake(lake),
            _ if self.sea_level.is_some_and(|sea| height <= sea) => Cover::Sea,
            0 => Cover::Land,
            lake => Cover::Lake(lake),
        }
    }

    /// Number of samples that drain through a node, including its own sample. For a given network, its area in samples.
    #[must_use]
    pub fn drained(&self, node: usize) -> f64 {
        match &self.network {
            None => f64::from(self.area.data()[node]),
            Some(network) => {
                let cell = network.flow.window().cell;
                f64::from(network.flow.data()[node]) / (cell * cell)
            }
        }
    }

    /// Whether a lake is too small to be shown.
    #[must_use]
    pub fn is_small(&self, lake: u32) -> bool {
        lake.checked_sub(1).and_then(|k| self.small.get(k as usize)).is_some_and(|small| *small)
    }

    /// The cover of a node.
    #[must_use]
    pub fn node_cover(&self, node: usize) -> Cover {
        match self.network.as_ref().and_then(|network| network.covers.as_ref()).map(|covers| covers.data()[node]) {
            None => self.cover(node),
            Some(0) => Cover::Land,
            Some(AT_SEA) => Cover::Sea,
            Some(lake) => Cover::Lake(lake),
        }
    }

    /// Column and row of a node.
    #[must_use]
    pub fn node_place(&self, node: usize) -> [f64; 2] {
        let [x, y] = self.place(node);
        match self.network.as_ref().and_then(|network| network.offset.as_ref()) {
            None => [x, y],
            Some([east, south]) => [x + f64::from(east.data()[node]), y + f64::from(south.data()[node])],
        }
    }

    /// The node nearest to a sample.
    #[must_use]
    pub fn nearest_node(&self, sample: usize) -> usize {
        if self.network.as_ref().is_none_or(|network| network.offset.is_none()) {
            return sample;
        }
        let (width, height) = (self.heights.width(), self.heights.height());
        let (i, j) = (sample % width, sample / width);
        let far = |node: usize| {
            let [x, y] = self.node_place(node);
            (x - i as f64) * (x - i as f64) + (y - j as f64) * (y - j as f64)
        };
        let rows = j.saturating_sub(2)..(j + 2).min(height);
        let near = rows.flat_map(|y| (i.saturating_sub(2)..(i + 2).min(width)).map(move |x| y * width + x));
        near.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(sample)
    }

    /// Column and row of a sample.
    #[must_use]
    pub fn place(&self, cell: usize) -> [f64; 2] {
        let width = self.heights.width().max(1);
        [(cell % width) as f64, (cell / width) as f64]
    }
}
