//! Functions of a sample and its eight neighbors.

use crate::parallel;

use super::slope::inner;
use crate::checks::{never, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;

/// Applies `value` to the 3 x 3 heights around every sample of `grid` except its border of one sample. The heights are
/// in rows from the north. Rows of the grid are computed in parallel.
pub fn over_nine(grid: &Grid, value: impl Fn([[f64; 3]; 3]) -> f32 + Sync) -> Grid {
    let Ok(out) = by_rows(grid, value, &never);
    out
}

/// [`over_nine`] with progress and cancellation.
pub fn over_nine_with(
    grid: &Grid,
    progress: &Progress,
    value: impl Fn([[f64; 3]; 3]) -> f32 + Sync,
) -> error::Result<Grid> {
    by_rows(grid, value, &steps(progress, inner(grid.window()).height))
}

fn by_rows<E: Send>(
    grid: &Grid,
    value: impl Fn([[f64; 3]; 3]) -> f32 + Sync,
    row: &(impl Fn() -> Result<(), E> + Sync),
) -> Result<Grid, E> {
    let window = inner(grid.window());
    let mut out = Grid::filled(window, 0.0f32);
    parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, made)| {
        row()?;
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        for (i, out) in made.iter_mut().enumerate() {
            *out = value(rows.map(|row| [0, 1, 2].map(|x| f64::from(row[i + x]))));
        }
        Ok(())
    })?;
    Ok(out)
}
