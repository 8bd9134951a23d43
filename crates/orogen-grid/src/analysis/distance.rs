//! Distance to the nearest marked sample.

use crate::checks::{never, steps};
use crate::grid::Grid;
use crate::progress::Progress;
use crate::{error, parallel};

/// The exact Euclidean distance, in samples, to the nearest sample whose value is at least `threshold`; infinite if
/// there is none within `reach` samples. The result is smaller than `grid` by a border of `reach` samples.
///
/// The columns are scanned first, then the rows with the lower envelope of parabolas in integers (A. Meijster, J.
/// Roerdink and W. Hesselink, "A general algorithm for computing distance transforms in linear time", 2000). The time
/// is O(samples) for any reach.
#[must_use]
pub fn nearest(grid: &Grid, threshold: f32, reach: usize) -> Grid {
    let Ok(out) = nearest_within(grid, threshold, reach, reach, &never);
    out
}

/// [`nearest`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn nearest_with(grid: &Grid, threshold: f32, reach: usize, progress: &Progress) -> error::Result<Grid> {
    nearest_within(grid, threshold, reach, reach, &steps(progress, 3 * grid.height()))
}

/// [`nearest`] for every sample of `grid` and without a limit of distance, with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn nearest_in_whole(grid: &Grid, threshold: f32, progress: &Progress) -> error::Result<Grid> {
    nearest_within(grid, threshold, 0, grid.width() + grid.height(), &steps(progress, 3 * grid.height()))
}

/// The distance of each sample inside a border of `border` samples, up to `reach`. `row` is called for each row of all
/// three scans.
fn nearest_within<E: Send>(
    grid: &Grid,
    threshold: f32,
    border: usize,
    reach: usize,
    row: &(impl Fn() -> Result<(), E> + Sync),
) -> Result<Grid, E> {
    let window = grid.window().shrunk(border);
    let mut out = Grid::filled(window, f32::INFINITY);
    if window.is_empty() {
        return Ok(out);
    }
    let columns = down_columns(grid, threshold, border, window.height, row)?;
    let rows = out.data_mut().chunks_mut(window.width).zip(columns.chunks(grid.width()));
    parallel::try_for_each_init(rows, Vec::new, |hull, (out, down)| {
        row()?;
        along_row(down, border, reach, hull, out);
        Ok(())
    })?;
    Ok(out)
}

/// Larger than every distance that is used.
const NONE: u32 = u32::MAX / 2;

/// Distance to the nearest marked sample in the same column, for the inner samples, row by row.
fn down_columns<E>(
    grid: &Grid,
    threshold: f32,
    border: usize,
    height: usize,
    check: &impl Fn() -> Result<(), E>,
) -> Result<Vec<u32>, E> {
    let width = grid.width();
    let mut out = vec![NONE; width * height];
    let rows: [Box<dyn Iterator<Item = usize>>; 2] = [Box::new(0..grid.height()), Box::new((0..grid.height()).rev())];
    for rows in rows {
        let mut steps = vec![NONE; width];
        for j in rows {
            check()?;
            for (step, value) in steps.iter_mut().zip(grid.row(j)) {
                *step = if *value >= threshold { 0 } else { (*step + 1).min(NONE) };
            }
            if (border..border + height).contains(&j) {
                let row = &mut out[(j - border) * width..(j - border + 1) * width];
                row.iter_mut().zip(&steps).for_each(|(nearest, step)| *nearest = (*nearest).min(*step));
            }
        }
    }
    Ok(out)
}

/// A column whose parabola is the lowest one from column `from` on.
struct Lowest {
    column: i64,
    square: i64,
    from: i64,
}

/// Distances of the inner samples of a row, from the distances within their columns.
fn along_row(down: &[u32], border: usize, reach: usize, hull: &mut Vec<Lowest>, out: &mut [f32]) {
    hull.clear();
    let columns = down.iter().enumerate().filter(|(_, steps)| (**steps as usize) <= reach);
    for (column, steps) in columns {
        let (column, square) = (column as i64, i64::from(*steps) * i64::from(*steps));
        let mut from = 0;
        while let Some(last) = hull.last() {
            // The first column at which the new parabola is lower.
            let doubled = 2 * (column - last.column);
            let sum = column * column - last.column * last.column + square - last.square;
            from = (sum.div_euclid(doubled) + 1).max(0);
            if from > last.from {
                break;
            }
            hull.pop();
            from = 0;
        }
        if from < down.len() as i64 {
            hull.push(Lowest { column, square, from });
        }
    }
    let farthest = (reach * reach) as i64;
    let mut k = 0;
    for (i, out) in out.iter_mut().enumerate() {
        let at = (i + border) as i64;
        while hull.get(k + 1).is_some_and(|next| next.from <= at) {
            k += 1;
        }
        if let Some(lowest) = hull.get(k) {
            let square = (at - lowest.column) * (at - lowest.column) + lowest.square;
            if square <= farthest {
                *out = (square as f64).sqrt() as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn it_is_what_trying_all_finds() {
        for (width, height, reach, one_in) in
            [(40, 30, 9, 60), (25, 33, 5, 7), (30, 30, 14, 900), (31, 17, 0, 3), (12, 12, 6, 1)]
        {
            let window = Window::new(width, height, 1.0);
            let mut grid = Grid::filled(window, 0.0f32);
            let mut state = 12345u64 + width as u64;
            for value in grid.data_mut() {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                *value = if (state >> 33).is_multiple_of(one_in) { 1.0 } else { 0.5 };
            }
            let found = nearest(&grid, 1.0, reach);
            assert_eq!(*found.window(), window.shrunk(reach));
            for j in 0..found.height() {
                for i in 0..found.width() {
                    let mut best = f64::INFINITY;
                    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                        let (dx, dy) = (x as f64 - (i + reach) as f64, y as f64 - (j + reach) as f64);
                        let square = dx * dx + dy * dy;
                        if grid[(x, y)] >= 1.0 && square <= (reach * reach) as f64 {
                            best = best.min(square);
                        }
                    }
                    assert_eq!(found[(i, j)], best.sqrt() as f32, "({i}, {j}) of {width} x {height}, {reach}");
                }
            }
        }
    }
}
