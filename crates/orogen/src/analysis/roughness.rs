//! How rough the ground is underfoot.

use super::slope::inner;
use crate::grid::Grid;

/// The ruggedness index: the mean absolute difference in metres between a sample and its eight neighbours (Wilson and others 2007, after
/// Riley 1999). Smaller than `grid` by a border of one sample; NaN where one of the nine is missing.
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
}
