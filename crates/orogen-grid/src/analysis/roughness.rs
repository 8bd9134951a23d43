//! Ruggedness of the ground.

use super::nine::{over_nine, over_nine_with};
use super::slope::inner;
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;

/// The mean absolute difference, in metres, between a sample and its eight neighbors (Wilson and others 2007, after
/// Riley 1999). Smaller than `grid` by a border of one sample; NaN where one of the nine samples is not finite.
#[must_use]
pub fn ruggedness(grid: &Grid) -> Grid {
    let window = inner(grid.window());
    let mut out = Grid::filled(window, 0.0f32);
    for j in 0..window.height {
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        for (i, out) in out.row_mut(j).iter_mut().enumerate() {
            let middle = rows[1][i + 1];
            let sum: f32 = rows.iter().flat_map(|row| &row[i..i + 3]).map(|h| (h - middle).abs()).sum();
            *out = sum / 8.0;
        }
    }
    out
}

/// The terrain ruggedness index: the square root of the sum of squared differences, in metres, between a sample and its
/// eight neighbors (Riley, DeGloria and Elliot, "A terrain ruggedness index that quantifies topographic
/// heterogeneity", 1999). Smaller than `grid` by a border of one sample; NaN where one of the nine samples is not
/// finite.
#[must_use]
pub fn riley(grid: &Grid) -> Grid {
    over_nine(grid, riley_at)
}

/// [`riley`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn riley_with(grid: &Grid, progress: &Progress) -> Result<Grid> {
    over_nine_with(grid, progress, riley_at)
}

fn riley_at(z: [[f64; 3]; 3]) -> f32 {
    let here = z[1][1];
    z.iter().flatten().map(|there| (there - here) * (there - here)).sum::<f64>().sqrt() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn a_slope_of_one_a_cell() {
        let grid = Grid::from_data(Window::new(5, 4, 1.0), (0..20).map(|k| (k % 5) as f32).collect()).unwrap();
        let rugged = ruggedness(&grid);
        assert!(rugged.data().len() == 6 && rugged.data().iter().all(|r| *r == 0.75));
    }

    #[test]
    fn the_index_of_a_plane_and_of_a_peak() {
        let made = |f: fn(usize, usize) -> f32| {
            let data = (0..25).map(|k| f(k % 5, k / 5)).collect();
            riley(&Grid::from_data(Window::new(5, 5, 10.0), data).unwrap())
        };
        // A plane that rises by 3 per sample: six of the eight neighbors differ by 3.
        assert!(made(|x, _| 3.0 * x as f32).data().iter().all(|r| (r - 54.0f32.sqrt()).abs() < 1e-6));
        let peak = made(|x, y| if (x, y) == (2, 2) { 7.0 } else { 0.0 });
        assert!((peak[(1, 1)] - 392.0f32.sqrt()).abs() < 1e-5 && peak[(0, 0)] == 7.0, "{:?}", peak.data());
        assert!(made(|x, _| if x == 0 { f32::NAN } else { 0.0 })[(0, 1)].is_nan());
    }
}
