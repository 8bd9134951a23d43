//! Topographic position: the height of a sample relative to its surroundings.
//!
//! The position is the difference from the mean height in a disc, and this difference divided by the standard deviation
//! of the heights in the disc (Weiss, "Topographic position and landforms analysis", 2001; Wilson and Gallant, "Terrain
//! Analysis", 2000, ch. 3). Heights are rounded to 1/256 m, so that all sums are exact and a tile equals the
//! corresponding part of a larger grid.

use crate::parallel;

use crate::checks::{never, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;

/// Units of rounded heights per metre.
const COUNTS: f64 = 256.0;

/// Maximum absolute height, in metres; heights beyond it are clamped.
const HIGHEST: f64 = 131_072.0;

/// The topographic position of one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Position {
    /// Height above the mean of the disc, in metres.
    pub above_mean: f32,
    /// The height above the mean divided by the standard deviation of the heights in the disc; 0 if they are all equal.
    pub deviation: f32,
}

/// Half width, in samples, of each row of a disc, from the northernmost to the southernmost row.
#[doc(hidden)]
#[must_use]
pub fn half_widths(radius: usize) -> Vec<usize> {
    let square = radius * radius;
    (0..=2 * radius).map(|row| (square - row.abs_diff(radius) * row.abs_diff(radius)).isqrt()).collect()
}

/// The position of every sample of `grid` that is at least `radius` samples from its border. The disc around a sample
/// has this radius and includes the sample itself.
///
/// Needs 16 bytes per sample of `grid`. The time is O(samples times radius). Rows are computed in parallel.
#[must_use]
pub fn positions(grid: &Grid, radius: usize) -> Grid<Position> {
    let Ok(out) = positions_by_rows(grid, radius, &never);
    out
}

/// [`positions`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn positions_with(grid: &Grid, radius: usize, progress: &Progress) -> error::Result<Grid<Position>> {
    positions_by_rows(grid, radius, &steps(progress, 2 * grid.height()))
}

/// [`positions`]; `row` is called for each row that is summed and each that is compared.
fn positions_by_rows<E: Send>(
    grid: &Grid,
    radius: usize,
    row: &(impl Fn() -> Result<(), E> + Sync),
) -> Result<Grid<Position>, E> {
    let window = grid.window().shrunk(radius);
    let mut out = Grid::filled(window, Position { above_mean: 0.0, deviation: 0.0 });
    if window.is_empty() {
        return Ok(out);
    }
    let sum = |j: usize| row().map(|()| prefix_sums(grid.row(j)));
    let sums = parallel::try_map(0..grid.height(), sum)?;
    let disc = half_widths(radius);
    let count = disc.iter().map(|half| 2 * half + 1).sum::<usize>() as f64;
    parallel::try_for_each(out.data_mut().chunks_mut(window.width).enumerate(), |(j, positions)| {
        row()?;
        for (i, position) in positions.iter_mut().enumerate() {
            let middle = i + radius;
            let (mut sum, mut squares) = (0i64, 0i128);
            for (row, half) in sums[j..].iter().zip(&disc) {
                let ([s0, q0], [s1, q1]) = (row[middle - half], row[middle + half + 1]);
                sum = sum.wrapping_add(s1.wrapping_sub(s0));
                // Running sums may wrap around; differences within a disc are still correct.
                squares += i128::from(q1.wrapping_sub(q0));
            }
            let mean = sum as f64 / count;
            let variance = (squares as f64 - sum as f64 * mean) / count;
            let above = f64::from(grid[(middle, j + radius)]) - mean / COUNTS;
            // A variance below one unit is only rounding.
            let deviation = if variance < 1.0 { 0.0 } else { above * COUNTS / variance.sqrt() };
            *position = Position { above_mean: above as f32, deviation: deviation as f32 };
        }
        Ok(())
    })?;
    Ok(out)
}

/// Sums of heights and of their squares before each sample of a row, and of the whole row at the end.
fn prefix_sums(row: &[f32]) -> Vec<[i64; 2]> {
    let mut sums = Vec::with_capacity(row.len() + 1);
    let mut last = [0i64; 2];
    sums.push(last);
    for height in row {
        let count = (f64::from(*height).clamp(-HIGHEST, HIGHEST) * COUNTS).round() as i64;
        last = [last[0].wrapping_add(count), last[1].wrapping_add(count.wrapping_mul(count))];
        sums.push(last);
    }
    sums
}

/// The six slope positions, in the order of their codes from 1.
pub const CLASSES: [&str; 6] = ["ridge", "upper slope", "middle slope", "flat", "lower slope", "valley"];

/// The slope position (Weiss 2001) of a deviation and a slope in degrees, as a code from 1 (see [`CLASSES`]).
#[must_use]
pub fn class(deviation: f32, slope: f32) -> u8 {
    match deviation {
        d if d > 1.0 => 1,
        d if d > 0.5 => 2,
        d if d >= -0.5 => 3 + u8::from(slope <= 5.0),
        d if d >= -1.0 => 5,
        _ => 6,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    fn hills(width: usize, height: usize) -> Grid {
        let data = (0..width * height)
            .map(|k| {
                (1800.0 + 300.0 * libm::sin((k % width) as f64 * 0.3) * libm::cos((k / width) as f64 * 0.21)) as f32
            })
            .collect();
        Grid::from_data(Window::new(width, height, 30.0), data).unwrap()
    }

    #[test]
    fn positions_are_those_of_summing_up() {
        let grid = hills(40, 31);
        for radius in [1usize, 2, 5, 9] {
            let got = positions(&grid, radius);
            for j in 0..got.height() {
                for i in 0..got.width() {
                    let mut members = Vec::new();
                    for (dy, dx) in (0..=2 * radius).flat_map(|dy| (0..=2 * radius).map(move |dx| (dy, dx))) {
                        let (y, x) = (dy as f64 - radius as f64, dx as f64 - radius as f64);
                        if x * x + y * y <= (radius * radius) as f64 {
                            members.push(f64::from(grid[(i + dx, j + dy)]));
                        }
                    }
                    let mean = members.iter().sum::<f64>() / members.len() as f64;
                    let variance = members.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / members.len() as f64;
                    let above = f64::from(grid[(i + radius, j + radius)]) - mean;
                    let position = got[(i, j)];
                    assert!((f64::from(position.above_mean) - above).abs() < 0.003, "{radius} {position:?} {above}");
                    let deviation = above / variance.sqrt();
                    assert!((f64::from(position.deviation) - deviation).abs() < 1e-3, "{position:?} {deviation}");
                }
            }
        }
    }

    #[test]
    fn level_ground_is_flat_and_a_peak_a_ridge() {
        let mut grid = Grid::filled(Window::new(21, 21, 10.0), 500.0f32);
        assert!(positions(&grid, 4).data().iter().all(|p| *p == Position { above_mean: 0.0, deviation: 0.0 }));
        grid.row_mut(10)[10] = 600.0;
        let peak = positions(&grid, 4)[(6, 6)];
        assert_eq!(class(peak.deviation, 30.0), 1);
        assert_eq!(
            [class(0.0, 2.0), class(0.0, 9.0), class(0.7, 9.0), class(-0.7, 0.0), class(-1.2, 0.0)],
            [4, 3, 2, 5, 6]
        );
    }
}
