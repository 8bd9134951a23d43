//! Retreat of the shore, as a front that waves drive into the land.

use super::Coast;
use super::climate::Climate;
use super::march::{Start, march, neighbors};
use crate::error::Result;
use crate::grid::Window;
use crate::parallel;
use crate::progress::Progress;

/// The shore moves in as many parts of the time; waves are computed anew for each.
pub(super) const ROUNDS: usize = 4;
/// Height of a cliff that halves the retreat: the sea has to remove what falls down (Limber and Murray 2011).
const HIGH: f64 = 40.0;
/// Width of a platform on which waves lose half of their power (after Sunamura 1992, and Trenhaile 2000).
const WIDE: f64 = 150.0;
/// A retreat slower than this, in m/yr, is none.
const SLOWEST: f64 = 1e-7;
/// Distance of cells that are not beside the shore.
pub(super) const FAR: f32 = 1e9;

/// Distances to the shore of the cells beside it, positive on land, from values that are above 0 on land. Other cells
/// are far.
pub(super) fn beside(window: &Window, values: &[f32]) -> Vec<f32> {
    let distance = |cell: usize| {
        let own = values[cell];
        let land = own > 0.0;
        let around = neighbors(window, cell);
        let mut sum = 0.0f64;
        for pair in [[around[0], around[1]], [around[2], around[3]]] {
            let mut nearest = f64::INFINITY;
            for other in pair.into_iter().flatten().map(|other| values[other]) {
                if (other > 0.0) != land {
                    let share = f64::from(own) / (f64::from(own) - f64::from(other));
                    nearest = nearest.min(share * window.cell);
                }
            }
            sum += 1.0 / (nearest * nearest).max(1e-6);
        }
        let distance = if sum > 1e-12 { (1.0 / sum.sqrt()) as f32 } else { FAR };
        if land { distance } else { -distance }
    };
    let mut out = vec![0.0; values.len()];
    let width = window.width.max(1);
    parallel::for_each(out.chunks_mut(width).enumerate(), |(j, row)| {
        row.iter_mut().enumerate().for_each(|(i, out)| *out = distance(j * width + i));
    });
    out
}

/// The cells beside the shore on one side as starts of a front, with what `carried` gives for each.
pub(super) fn starts(beside: &[f32], land: bool, carried: impl Fn(usize, f64) -> (f64, [f32; 2])) -> Vec<Start> {
    let near = beside.iter().enumerate().filter(|(_, d)| d.abs() < FAR && (**d > 0.0) == land);
    let start = |(cell, d): (usize, &f32)| {
        let (time, carried) = carried(cell, f64::from(d.abs()));
        Start { cell, time, carried }
    };
    near.map(start).collect()
}

/// Mean of the values of the marked cells in the 3 x 3 cells around one; 0 without any.
pub(super) fn mean_around(window: &Window, marked: impl Fn(usize) -> bool, values: &[f32], cell: usize) -> f32 {
    let (i, j) = (cell % window.width, cell / window.width);
    let (mut sum, mut count) = (0.0, 0.0);
    for y in j.saturating_sub(1)..(j + 2).min(window.height) {
        for x in i.saturating_sub(1)..(i + 2).min(window.width) {
            let at = y * window.width + x;
            if marked(at) {
                sum += values[at];
                count += 1.0;
            }
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The shore after the retreat.
pub(super) struct Shore {
    /// Distances to the shore of the cells beside it, positive on land; others are far.
    pub(super) beside: Vec<f32>,
    /// Distance of the old land to the old shore, as far as the retreat may reach; 0 in the old sea.
    pub(super) origin: Vec<f32>,
    /// Power of the waves over that of an open coast.
    pub(super) exposure: Vec<f32>,
}

impl Shore {
    /// Whether a cell is sea.
    pub(super) fn is_sea(&self, cell: usize) -> bool {
        self.beside[cell] <= 0.0
    }
}

/// Moves the shore for all years. `height` is above the sea; `erodibility` gives a factor of each cell.
pub(super) fn retreat(
    law: &Coast,
    window: &Window,
    height: &[f32],
    erodibility: impl Fn(usize) -> f64,
    wind: &Climate,
    progress: &Progress,
) -> Result<Shore> {
    let mut shore = beside(window, height);
    let weakest = (0..height.len()).map(&erodibility).fold(0.0, f64::max);
    let run = 1.5 * law.retreat * law.years * weakest;
    let farthest = WIDE * ((1.0 + 2.0 * run / WIDE).sqrt() - 1.0) + 3.0 * window.cell;
    let first = starts(&shore, true, |_, d| (d, [0.0; 2]));
    let mut origin = march(window, first, |cell| height[cell] > 0.0, |_, _| 1.0, farthest).time;
    origin.iter_mut().zip(height).filter(|(_, height)| **height <= 0.0).for_each(|(origin, _)| *origin = 0.0);
    let years = law.years / ROUNDS as f64;
    let slowness = |cell: usize, carried: [f32; 2]| {
        let rate = law.retreat * erodibility(cell) * f64::from(carried[0]);
        let hindered = (1.0 + f64::from(height[cell]).max(0.0) / HIGH) * (1.0 + f64::from(origin[cell]) / WIDE);
        if rate > SLOWEST { hindered / rate } else { f64::INFINITY }
    };
    for _ in 0..ROUNDS {
        let exposure = wind.exposure(window, &shore, progress)?;
        let reached = |cell: usize| [mean_around(window, |at| shore[at] <= 0.0, &exposure, cell), 0.0];
        let begin = starts(&shore, true, |cell, d| {
            let carried = reached(cell);
            (d * slowness(cell, carried), carried)
        });
        let front = march(window, begin, |cell| shore[cell] > 0.0, slowness, years);
        let moved = |cell: usize| {
            let pace = slowness(cell, front.carried[cell]);
            if shore[cell] > 0.0 && front.time[cell].is_finite() {
                ((f64::from(front.time[cell]) - years) / pace) as f32
            } else if shore[cell] > 0.0 {
                window.cell as f32 / 2.0
            } else if shore[cell] > -FAR {
                // Beside the old shore: further from the new one, as far as the shore has moved.
                let around = neighbors(window, cell).into_iter().flatten().filter(|at| shore[*at] > 0.0);
                let least = around.map(|at| slowness(at, front.carried[at])).fold(f64::INFINITY, f64::min);
                shore[cell] - (years / least) as f32
            } else {
                -FAR
            }
        };
        let values: Vec<f32> = (0..height.len()).map(moved).collect();
        shore = beside(window, &values);
        progress.step(1.0)?;
    }
    let exposure = wind.exposure(window, &shore, progress)?;
    Ok(Shore { beside: shore, origin, exposure })
}
