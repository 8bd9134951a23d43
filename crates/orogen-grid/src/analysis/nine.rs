//! Functions of a sample and its eight neighbours.

use rayon::prelude::*;

use super::slope::inner;
use crate::grid::Grid;

/// Applies `value` to the 3 x 3 heights around every sample of `grid` except its border, rows from the north. Rows are
/// computed in parallel.
pub fn over_nine(grid: &Grid, value: impl Fn([[f64; 3]; 3]) -> f32 + Sync) -> Grid {
    let window = inner(grid.window());
    let mut out = Grid::filled(window, 0.0f32);
    out.data_mut().par_chunks_mut(window.width.max(1)).enumerate().for_each(|(j, row)| {
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        for (i, out) in row.iter_mut().enumerate() {
            *out = value(rows.map(|row| [0, 1, 2].map(|x| f64::from(row[i + x]))));
        }
    });
    out
}
