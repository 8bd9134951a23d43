//! What a network sees of rivers that are known.

use super::cubic::interpolated;
use super::features::{Features, REACH};
use super::weights::{OF_RIVERS, PHASES};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::strides;

/// The binary logarithm of the largest drainage area, in samples, that a network tells from larger ones.
const LARGEST: f32 = 10.0;

/// Land with rivers. All grids have the same window.
#[derive(Debug, Clone, Copy)]
pub struct Drained<'a> {
    /// Height in metres.
    pub height: &'a Grid,
    /// Drainage area in m².
    pub flow: &'a Grid,
    /// Flow direction, clockwise from east (0) to north-east (7); others where there is none.
    pub receiver: &'a Grid,
    /// Above 0 in lakes.
    pub lake: Option<&'a Grid>,
}

/// Rivers of fine samples: their beds and drainage areas.
pub struct Rivers {
    /// The fine heights, from two samples before the first coarse one to two samples behind the last.
    heights: Grid,
    /// Binary logarithms of drainage areas in samples; 0 where there is no river.
    areas: Vec<f32>,
    is_known: Vec<bool>,
}

/// Samples that are kept downstream of a river where the drainage area falls below the least one.
pub const GAP: usize = 16;

impl Rivers {
    /// Rivers where the drainage area is at least `least` samples or was so up to [`GAP`] samples upstream, and water:
    /// lakes, and where there is no receiver.
    pub fn of(land: &Drained<'_>, least: u32) -> Rivers {
        let window = land.height.window();
        let samples = 1.0 / (window.cell * window.cell);
        let area = |at: usize| (f64::from(land.flow.data()[at]) * samples) as f32;
        let flows = |at: &usize| (0.0..8.0).contains(&land.receiver.data()[*at]);
        let is_lake = |at: usize| land.lake.is_some_and(|lake| lake.data()[at] > 0.0);
        let least = least as f32;
        let mut is_known: Vec<bool> =
            (0..window.len()).map(|at| area(at) >= least || !flows(&at) || is_lake(at)).collect();
        let steps = strides(window.width);
        let mut last: Vec<usize> = (0..window.len()).filter(|at| is_known[*at]).collect();
        for _ in 0..GAP {
            // On the border a step can lead to the other side; from there it stays within `GAP` samples of the border.
            let below = |at: usize| {
                let step = steps[usize::from(land.receiver.data()[at] as u8 & 7)];
                at.checked_add_signed(step).filter(|below| *below < window.len())
            };
            last = last.into_iter().filter(flows).filter_map(below).filter(|at| !is_known[*at]).collect();
            last.iter().for_each(|at| is_known[*at] = true);
        }
        let areas = is_known.iter().enumerate().map(|(at, is_known)| match is_known {
            true => libm::log2f(area(at).max(least)),
            false => 0.0,
        });
        Rivers { heights: land.height.clone(), areas: areas.collect(), is_known }
    }

    pub fn window(&self) -> &Window {
        self.heights.window()
    }

    /// The height of the bed at a sample, if there is a river or a lake.
    pub fn bed(&self, at: usize) -> Option<f32> {
        self.is_known[at].then(|| self.heights.data()[at])
    }

    /// Index of the fine sample of a column and a row of the lattice.
    pub fn index(&self, x: i64, y: i64) -> usize {
        let window = self.window();
        (y - window.y) as usize * window.width + (x - window.x) as usize
    }

    /// What a network reads for node (i, j) of the features: the beds of its fine samples above the interpolated
    /// heights, in units of the scale of slopes, and their areas.
    pub fn of_node(&self, coarse: &Grid, features: &Features, i: usize, j: usize) -> [f32; OF_RIVERS] {
        let mut out = [0.0; OF_RIVERS];
        let scale = features.scale[j * features.width + i];
        let unit = 2.0 / (scale * coarse.window().cell as f32);
        let (column, row) = (i + REACH, j + REACH);
        let [x, y] = [coarse.window().x + column as i64, coarse.window().y + row as i64].map(|node| 2 * node);
        for phase in 0..PHASES {
            let [east, south] = [phase % 2, phase / 2];
            let at = self.index(x + east as i64, y + south as i64);
            if let Some(bed) = self.bed(at) {
                out[phase] = (bed - interpolated(coarse, [column, row], [east, south])) * unit;
            }
            out[PHASES + phase] = self.areas[at].min(LARGEST) * 0.2 - 0.5;
        }
        out
    }
}
