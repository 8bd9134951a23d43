//! The samples just outside a grid, which affect the normals at its border.

use super::slope::{beyond, extend_row};
use crate::grid::{Grid, Window};

/// A border of one sample around a grid, where the world has ground. Elsewhere, at the edges of the world, heights are
/// extrapolated linearly.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Halo {
    /// The rows north and south of the grid, extended by one sample at each end.
    north: Option<Vec<f32>>,
    south: Option<Vec<f32>>,
    /// The columns west and east of the grid.
    west: Option<Vec<f32>>,
    east: Option<Vec<f32>>,
}

impl Halo {
    /// An empty halo of `window`. Only the parts inside `there`, the window of the world, can hold samples.
    #[must_use]
    pub fn new(window: &Window, there: &Window) -> Halo {
        let row = |is_there: bool| is_there.then(|| vec![f32::NAN; window.width + 2]);
        let column = |is_there: bool| is_there.then(|| vec![f32::NAN; window.height]);
        Halo {
            north: row(there.y < window.y),
            south: row(there.bottom() > window.bottom()),
            west: column(there.x < window.x),
            east: column(there.right() > window.right()),
        }
    }

    /// Copies the halo's samples from `band`, a band of rows of the ground around `window`.
    pub fn take(&mut self, window: &Window, band: &Grid) {
        let there = band.window();
        let inside = usize::try_from(window.x - there.x).unwrap_or(0).min(1);
        for j in 0..there.height {
            let (row, y) = (band.row(j), there.y + j as i64);
            let wide = |out: &mut [f32]| {
                let west = self.west.is_some().then(|| row[0]);
                let east = self.east.is_some().then(|| row[inside + window.width]);
                widen(&row[inside..inside + window.width], [west, east], out);
            };
            if y < window.y {
                self.north.iter_mut().for_each(|out| wide(out));
            } else if y >= window.bottom() {
                self.south.iter_mut().for_each(|out| wide(out));
            } else {
                let at = (y - window.y) as usize;
                self.west.iter_mut().for_each(|out| out[at] = row[0]);
                self.east.iter_mut().for_each(|out| out[at] = row[inside + window.width]);
            }
        }
    }

    /// Calls `change` with slices that together hold all samples of the halo.
    pub fn each(&mut self, mut change: impl FnMut(&mut [f32])) {
        [&mut self.north, &mut self.south, &mut self.west, &mut self.east]
            .into_iter()
            .flatten()
            .for_each(|samples| change(samples));
    }

    /// Row `j` of the grid and the rows next to it, each extended by one sample at both ends. `wide` is scratch space.
    #[doc(hidden)]
    pub fn rows<'w>(&self, grid: &Grid, j: usize, wide: &'w mut Vec<f32>) -> [&'w [f32]; 3] {
        let (width, last) = (grid.width() + 2, grid.height() - 1);
        wide.resize(3 * width, 0.0);
        let (above, rest) = wide.split_at_mut(width);
        let (here, below) = rest.split_at_mut(width);
        self.row(grid, j, here);
        let north = match (j.checked_sub(1), &self.north) {
            (Some(there), _) => {
                self.row(grid, there, above);
                true
            }
            (None, Some(north)) => {
                above.copy_from_slice(north);
                true
            }
            (None, None) => false,
        };
        let south = match (j == last, &self.south) {
            (false, _) => {
                self.row(grid, j + 1, below);
                true
            }
            (true, Some(south)) => {
                below.copy_from_slice(south);
                true
            }
            (true, None) => false,
        };
        // Beyond an edge of the world, heights are extrapolated linearly from the opposite row. A single row is level.
        let run_on = |out: &mut [f32], other: &[f32]| {
            out.iter_mut().zip(&*here).zip(other).for_each(|((out, here), other)| *out = beyond(*here, *other));
        };
        match (north, south) {
            (true, true) => {}
            (true, false) => run_on(below, above),
            (false, true) => run_on(above, below),
            (false, false) => {
                above.copy_from_slice(here);
                below.copy_from_slice(here);
            }
        }
        [above, here, below]
    }

    fn row(&self, grid: &Grid, j: usize, out: &mut [f32]) {
        let side = |column: &Option<Vec<f32>>| column.as_ref().map(|column| column[j]);
        widen(grid.row(j), [side(&self.west), side(&self.east)], out);
    }
}

/// Extends a row by the samples west and east of it, or by linear extrapolation where there is none.
fn widen(row: &[f32], [west, east]: [Option<f32>; 2], out: &mut [f32]) {
    extend_row(row, out);
    let last = out.len() - 1;
    out[0] = west.unwrap_or(out[0]);
    out[last] = east.unwrap_or(out[last]);
    // A single sample is extrapolated from the opposite side.
    if row.len() == 1 {
        match (west, east) {
            (Some(west), None) => out[last] = beyond(row[0], west),
            (None, Some(east)) => out[0] = beyond(row[0], east),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::slope::extended;

    #[test]
    fn rows_are_those_of_the_ground_and_go_on_where_it_ends() {
        let whole = Window::new(9, 7, 5.0);
        let data = (0..whole.len()).map(|k| (k * k % 23) as f32).collect();
        let ground = Grid::from_data(whole, data).unwrap();
        let wide = extended(&ground);
        for window in [
            whole,
            Window { x: 2, y: 1, width: 4, height: 3, ..whole },
            Window { width: 3, height: 2, ..whole },
            Window { x: 5, y: 4, width: 4, height: 3, ..whole },
            Window { x: 8, y: 0, width: 1, height: 7, ..whole },
            Window { x: 3, y: 6, width: 2, height: 1, ..whole },
        ] {
            let grid = ground.crop(&window).unwrap();
            let (x, y) = ((window.x - 1).max(0), (window.y - 1).max(0));
            let (right, bottom) = ((window.right() + 1).min(9), (window.bottom() + 1).min(7));
            let around = Window { x, y, width: (right - x) as usize, height: (bottom - y) as usize, ..whole };
            let mut halo = Halo::new(&window, &around);
            for j in 0..around.height {
                let band = Window { y: y + j as i64, height: 1, ..around };
                halo.take(&window, &ground.crop(&band).unwrap());
            }
            let expected = wide.crop(&window.grown(1)).unwrap();
            let mut scratch = Vec::new();
            for j in 0..window.height {
                let rows = halo.rows(&grid, j, &mut scratch);
                assert_eq!(rows, [expected.row(j), expected.row(j + 1), expected.row(j + 2)], "{window:?} {j}");
            }
        }
    }
}
