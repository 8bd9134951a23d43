//! The ground of troughs: what ice has not carved stays, on walls that it has made smooth.

use super::troughs::{RIM, Troughs};
use crate::error::Result;
use crate::grid::Grid;
use crate::parallel;
use crate::progress::Progress;

/// Length in metres over which walls are smoothed along and across.
const SMOOTHED: f64 = 60.0;

/// Height in metres over which a wall goes over into the ground above it.
const ROUNDED: f32 = 15.0;

/// The share of the relief of walls that stays where they are steepest.
const KEPT: f32 = 0.35;

/// Half width in metres from which on troughs have smooth walls: side valleys of smaller glaciers stay.
const SMOOTH_WALLS: [f32; 2] = [200.0, 420.0];

fn passes(cell: f64) -> usize {
    (2.0 * (SMOOTHED / cell) * (SMOOTHED / cell)).round().clamp(1.0, 40.0) as usize
}

/// Number of samples around a sample on which its ground depends, beyond troughs.
pub fn reach(cell: f64) -> usize {
    passes(cell) + 1
}

/// The ground: land lowered to the troughs.
pub fn ground(land: &Grid, troughs: &Troughs, progress: &Progress) -> Result<Grid> {
    let window = *land.window();
    // How much a sample is smoothed: fully on the walls of large troughs, not above them.
    let shares: Vec<f32> = troughs
        .across
        .data()
        .iter()
        .zip(troughs.half.data())
        .map(|(across, half)| smooth_step(RIM, 1.0, *across) * smooth_step(SMOOTH_WALLS[0], SMOOTH_WALLS[1], *half))
        .collect();
    let smoothed = smooth(land, &shares, passes(window.cell), progress)?;
    let mut carved = smoothed.clone();
    let samples = carved.data_mut().iter_mut().zip(troughs.height.data()).zip(troughs.across.data());
    for ((height, trough), across) in samples {
        let above = *height - trough;
        if above > 0.0 {
            let kept = KEPT * smooth_step(0.15, 0.8, *across);
            *height -= above * above / (above + ROUNDED) * (1.0 - kept);
        }
    }
    let carved_shares: Vec<f32> = troughs.across.data().iter().map(|across| smooth_step(RIM, 1.2, *across)).collect();
    smooth(&carved, &carved_shares, 1, progress)
}

/// Passes of a mean of 3 x 3 samples, each mixed in by the share of its sample.
fn smooth(land: &Grid, shares: &[f32], passes: usize, progress: &Progress) -> Result<Grid> {
    let (width, height) = (land.width(), land.height());
    let mut from = land.clone();
    for _ in 0..passes {
        let mut to = from.clone();
        let rows = to.data_mut().chunks_mut(width.max(1)).enumerate().skip(1).take(height.saturating_sub(2));
        parallel::try_for_each(rows, |(j, row)| {
            progress.check()?;
            let [north, here, south] = [j - 1, j, j + 1].map(|j| from.row(j));
            for i in 1..width.saturating_sub(1) {
                let share = shares[j * width + i];
                if share > 0.0 {
                    let sides = here[i - 1] + here[i + 1] + north[i] + south[i];
                    let corners = north[i - 1] + north[i + 1] + south[i - 1] + south[i + 1];
                    row[i] += share * 0.5 * ((4.0 * sides + corners) * (1.0 / 20.0) - here[i]);
                }
            }
            Ok(())
        })?;
        from = to;
    }
    Ok(from)
}

/// 0 at `from`, 1 at `to`, and smooth between them.
fn smooth_step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
