//! Conversions of a tile's samples: padding, range, and bytes for temporary files.

use std::io;

use super::job::JobFile;
use super::output_store::OutputStore;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_io::file;
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_io::samples::from_bytes;

/// The samples of a file of the store, exactly `count`.
pub fn read(store: &OutputStore, place: &JobFile, count: usize) -> Result<Vec<f32>> {
    let mut bytes = Vec::with_capacity(4 * count);
    let path = store.path(place);
    store.read(place, &mut bytes).map_err(|cause: io::Error| file::explain("read", &path, &cause))?;
    if bytes.len() != 4 * count {
        return Err(changed(store, place));
    }
    Ok(from_bytes(&bytes))
}

/// The error for a file that has changed since it was written.
pub fn changed(store: &OutputStore, place: &JobFile) -> Error {
    let path = store.path(place);
    let message = format!("{} has been changed or damaged; resume the build to make it again", path.display());
    Error::new(ErrorKind::File, message)
}

/// A grid's samples in a square of side `side`; positions outside the grid are filled with `beyond`.
pub fn square(grid: &Grid, side: usize, beyond: f32) -> Vec<f32> {
    let mut out = vec![beyond; side * side];
    for j in 0..grid.height() {
        out[j * side..j * side + grid.width()].copy_from_slice(grid.row(j));
    }
    out
}

/// [`square`] with the grid's edge repeated outside.
pub fn square_repeated(grid: &Grid, side: usize) -> Vec<f32> {
    let mut out = Vec::with_capacity(side * side);
    for j in 0..side {
        let row = grid.row(j.min(grid.height() - 1));
        out.extend_from_slice(row);
        out.resize((j + 1) * side, row[row.len() - 1]);
    }
    out
}

/// The minimum and maximum finite sample; `[inf, -inf]` if there is none.
pub fn range(grid: &Grid) -> [f32; 2] {
    extremes(NO_SAMPLES, grid.data())
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    #[test]
    fn what_lies_beyond() {
        let grid = Grid::from_data(Window::new(2, 2, 1.0), vec![1.0, 2.0, 3.0, f32::INFINITY]).unwrap();
        assert_eq!(square(&grid, 3, 9.0), [1.0, 2.0, 9.0, 3.0, f32::INFINITY, 9.0, 9.0, 9.0, 9.0]);
        let inf = f32::INFINITY;
        assert_eq!(square_repeated(&grid, 3), [1.0, 2.0, 2.0, 3.0, inf, inf, 3.0, inf, inf]);
        assert_eq!(range(&grid), [1.0, 3.0]);
    }
}
