//! Windows and grids.

use std::ops::{Index, IndexMut};

use crate::parallel;
use serde::{Deserialize, Serialize};

/// Maximum distance of columns and rows from the origin of a lattice, in samples. Sums of such numbers do not overflow,
/// and no window of this size fits in memory.
pub const FARTHEST: i64 = 1 << 60;

/// A rectangle of samples of the infinite lattice with spacing `cell`.
///
/// Sample (i, j) of a window is *at* x = (self.x + i) * cell, y = (self.y + j) * cell in metres: a lattice point, not
/// the center of a pixel, so neighboring windows can share an edge. x increases eastward, y increases southward.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Window {
    /// Column of the first sample on the lattice.
    pub x: i64,
    /// Row of the first sample on the lattice.
    pub y: i64,
    /// Number of samples per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Distance between samples, in metres.
    pub cell: f64,
}

impl Window {
    /// A window of `width` x `height` samples whose first sample is at the origin.
    #[must_use]
    pub fn new(width: usize, height: usize, cell: f64) -> Window {
        Window { x: 0, y: 0, width, height, cell }
    }

    /// The same window with its first sample at column `x` and row `y`.
    #[must_use]
    pub fn at(self, x: i64, y: i64) -> Window {
        Window { x, y, ..self }
    }

    /// The number of samples, or `usize::MAX` if it does not fit in a `usize`.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width.saturating_mul(self.height)
    }

    /// Whether the window has no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    /// The column after the last one.
    #[must_use]
    pub fn right(&self) -> i64 {
        self.x + self.width as i64
    }

    /// The row after the last one.
    #[must_use]
    pub fn bottom(&self) -> i64 {
        self.y + self.height as i64
    }

    /// The window extended by `halo` samples on each side, up to [`FARTHEST`] samples from the origin.
    #[must_use]
    pub fn grown(&self, halo: usize) -> Window {
        let halo = i64::try_from(halo).map_or(2 * FARTHEST, |halo| halo.min(2 * FARTHEST));
        let side = |first: i64, samples: usize| {
            let (start, end) =
                (first.saturating_sub(halo), first.saturating_add_unsigned(samples as u64).saturating_add(halo));
            let start = start.clamp(-FARTHEST, FARTHEST);
            (start, (end.clamp(-FARTHEST, FARTHEST) - start) as usize)
        };
        let ((x, width), (y, height)) = (side(self.x, self.width), side(self.y, self.height));
        Window { x, y, width, height, cell: self.cell }
    }

    /// The window without a border of `border` samples on each side; possibly empty.
    #[must_use]
    pub fn shrunk(&self, border: usize) -> Window {
        Window {
            x: self.x + border as i64,
            y: self.y + border as i64,
            width: self.width.saturating_sub(2 * border),
            height: self.height.saturating_sub(2 * border),
            cell: self.cell,
        }
    }

    /// The smallest window that contains both windows. Both must have the same cell.
    #[must_use]
    pub fn union(&self, other: &Window) -> Window {
        debug_assert_eq!(self.cell, other.cell);
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        Window {
            x,
            y,
            width: (self.right().max(other.right()) - x) as usize,
            height: (self.bottom().max(other.bottom()) - y) as usize,
            cell: self.cell,
        }
    }

    /// The samples that are in both windows; empty if there are none. Both must have the same cell.
    #[must_use]
    pub fn intersection(&self, other: &Window) -> Window {
        debug_assert_eq!(self.cell, other.cell);
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let (right, bottom) = (self.right().min(other.right()), self.bottom().min(other.bottom()));
        Window { x, y, width: (right - x).max(0) as usize, height: (bottom - y).max(0) as usize, cell: self.cell }
    }

    /// Whether both windows have the same cell and every sample of `other` belongs to this window.
    #[must_use]
    pub fn contains(&self, other: &Window) -> bool {
        self.cell == other.cell
            && self.x <= other.x
            && self.y <= other.y
            && self.right() >= other.right()
            && self.bottom() >= other.bottom()
    }

    /// The window split into tiles of at most `side` x `side` samples, row by row from the north, each row from west to
    /// east.
    pub fn tiles(&self, side: usize) -> impl Iterator<Item = Window> + use<> {
        let (window, side) = (*self, side.max(1));
        let columns = window.width.div_ceil(side);
        (0..columns * window.height.div_ceil(side)).map(move |index| {
            let (left, top) = (index % columns * side, index / columns * side);
            Window {
                x: window.x + left as i64,
                y: window.y + top as i64,
                width: side.min(window.width - left),
                height: side.min(window.height - top),
                cell: window.cell,
            }
        })
    }

    /// The easting of column `i`, in metres. Always the global index times the cell, never a running sum.
    #[must_use]
    pub fn east(&self, i: usize) -> f64 {
        (self.x + i as i64) as f64 * self.cell
    }

    /// The southing of row `j`, in metres.
    #[must_use]
    pub fn south(&self, j: usize) -> f64 {
        (self.y + j as i64) as f64 * self.cell
    }

    /// The eastings of all columns, in metres.
    #[must_use]
    pub fn eastings(&self) -> Vec<f64> {
        (0..self.width).map(|i| self.east(i)).collect()
    }

    /// The southings of all rows, in metres.
    #[must_use]
    pub fn southings(&self) -> Vec<f64> {
        (0..self.height).map(|j| self.south(j)).collect()
    }
}

/// Samples over a window in row-major order. The first row is the northernmost, and each row runs from west to east.
///
/// It is serialized as a table of `window` and `data`. Data whose length differs from the window's is rejected. JSON
/// has no NaN and therefore cannot represent samples without a value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "GridData<T>", bound(serialize = "T: Serialize", deserialize = "T: Copy + Deserialize<'de>"))]
pub struct Grid<T = f32> {
    window: Window,
    data: Vec<T>,
}

/// A grid as it was read, before its length is checked.
#[derive(Deserialize)]
#[serde(rename = "Grid")]
struct GridData<T> {
    window: Window,
    data: Vec<T>,
}

impl<T: Copy> TryFrom<GridData<T>> for Grid<T> {
    type Error = String;

    fn try_from(GridData { window, data }: GridData<T>) -> Result<Grid<T>, String> {
        // The sides come from a file, so their product may overflow.
        match window.width.checked_mul(window.height) {
            Some(samples) if samples == data.len() => Ok(Grid { window, data }),
            _ => Err(format!(
                "a grid of {} x {} samples cannot have {} in `data`",
                window.width,
                window.height,
                data.len()
            )),
        }
    }
}

impl<T: Copy> Grid<T> {
    /// A grid with one value everywhere.
    pub fn filled(window: Window, value: T) -> Grid<T> {
        Grid { window, data: vec![value; window.len()] }
    }

    /// A grid over `data`; `None` if the length of `data` is not the number of samples of the window.
    #[must_use]
    pub fn from_data(window: Window, data: Vec<T>) -> Option<Grid<T>> {
        (data.len() == window.len()).then_some(Grid { window, data })
    }

    /// The window of the samples.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Number of samples per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.window.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.window.height
    }

    /// All samples in row-major order.
    #[must_use]
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// All samples in row-major order, mutable.
    pub fn data_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// The samples in row-major order, without the window.
    #[must_use]
    pub fn into_data(self) -> Vec<T> {
        self.data
    }

    /// Row `j` of the window, from 0.
    #[must_use]
    pub fn row(&self, j: usize) -> &[T] {
        &self.data[j * self.window.width..(j + 1) * self.window.width]
    }

    /// Row `j` of the window, from 0, mutable.
    pub fn row_mut(&mut self, j: usize) -> &mut [T] {
        let width = self.window.width;
        &mut self.data[j * width..(j + 1) * width]
    }

    /// The sample in column `i` and row `j`, both from 0, or `None` outside of the grid.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> Option<T> {
        let inside = i < self.window.width && j < self.window.height;
        if inside { self.data.get(j * self.window.width + i).copied() } else { None }
    }

    /// The part of the grid in `window`; `None` if `window` is not completely inside the grid.
    #[must_use]
    pub fn crop(&self, window: &Window) -> Option<Grid<T>> {
        if !self.window.contains(window) {
            return None;
        }
        let (left, top) = ((window.x - self.window.x) as usize, (window.y - self.window.y) as usize);
        let mut data = Vec::with_capacity(window.len());
        for j in 0..window.height {
            data.extend_from_slice(&self.row(top + j)[left..left + window.width]);
        }
        Some(Grid { window: *window, data })
    }

    /// The grid with `samples` more samples on each side, which repeat those at the edges. Filters on grids return a
    /// window that is smaller by their halo, so a filter on a padded grid returns the window of the original grid.
    ///
    /// ```
    /// use orogen_grid::{Grid, Progress, Window};
    /// use orogen_grid::erosion::Thermal;
    ///
    /// let heights = Grid::from_data(Window::new(3, 1, 10.0), vec![0.0, 0.0, 50.0]).expect("3 samples");
    /// let settled = Thermal::new(0.6).run(&heights.padded(20), 20, &Progress::none())?;
    /// assert_eq!(settled.window(), heights.window());
    /// # Ok::<(), orogen_grid::Error>(())
    /// ```
    #[must_use]
    pub fn padded(&self, samples: usize) -> Grid<T> {
        let window = self.window.grown(samples);
        let mut data = Vec::with_capacity(window.len());
        for j in 0..window.height {
            let row = self.row(j.saturating_sub(samples).min(self.window.height.saturating_sub(1)));
            let (Some(&first), Some(&last)) = (row.first(), row.last()) else { return self.clone() };
            data.extend(std::iter::repeat_n(first, samples));
            data.extend_from_slice(row);
            data.extend(std::iter::repeat_n(last, samples));
        }
        Grid { window, data }
    }

    /// Copies the samples of `other` that lie in this grid's window.
    pub fn paste(&mut self, other: &Grid<T>) {
        let (ours, theirs) = (self.window, other.window);
        let (left, right) = (ours.x.max(theirs.x), ours.right().min(theirs.right()));
        if ours.cell != theirs.cell || left >= right {
            return;
        }
        let width = (right - left) as usize;
        for y in ours.y.max(theirs.y)..ours.bottom().min(theirs.bottom()) {
            let from = (left - theirs.x) as usize;
            let to = (left - ours.x) as usize;
            let source = &other.row((y - theirs.y) as usize)[from..from + width];
            self.row_mut((y - ours.y) as usize)[to..to + width].copy_from_slice(source);
        }
    }
}

impl<T: Copy> Index<(usize, usize)> for Grid<T> {
    type Output = T;

    /// The sample in column `i` and row `j`, both from 0: `grid[(i, j)]`.
    ///
    /// # Panics
    /// Outside of the grid, as slices do. [`Grid::get`] returns `None` there.
    fn index(&self, (i, j): (usize, usize)) -> &T {
        &self.row(j)[i]
    }
}

impl<T: Copy> IndexMut<(usize, usize)> for Grid<T> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        &mut self.row_mut(j)[i]
    }
}

/// Transposes rows of `columns` samples in squares that fit in the cache. Squares are processed in parallel.
pub fn transposed<T: Copy + Default + Send + Sync>(samples: &[T], columns: usize) -> Vec<T> {
    const SIDE: usize = 32;
    let rows = samples.len() / columns.max(1);
    let mut out = vec![T::default(); samples.len()];
    parallel::for_each(out.chunks_mut(SIDE * rows.max(1)).enumerate(), |(block, out)| {
        let first = block * SIDE;
        for top in (0..rows).step_by(SIDE) {
            for (i, column) in out.chunks_exact_mut(rows.max(1)).enumerate() {
                for (j, out) in column.iter_mut().enumerate().take(rows.min(top + SIDE)).skip(top) {
                    *out = samples[j * columns + first + i];
                }
            }
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_padded_grid_repeats_its_edges_and_crops_back() {
        let grid = Grid::from_data(Window::new(2, 2, 1.0).at(-1, 5), vec![1, 2, 3, 4]).unwrap();
        let padded = grid.padded(1);
        assert_eq!(padded.data(), [1, 1, 2, 2, 1, 1, 2, 2, 3, 3, 4, 4, 3, 3, 4, 4]);
        assert_eq!((padded.window().x, padded.window().y), (-2, 4));
        assert_eq!(padded.crop(grid.window()), Some(grid.clone()));
        assert_eq!(grid.padded(0), grid);
        let empty = Grid::from_data(Window::new(0, 3, 1.0), Vec::<u8>::new()).unwrap();
        assert_eq!(empty.padded(2), empty);
    }

    #[test]
    fn grids_are_read_as_they_were_written() {
        let grid =
            Grid::from_data(Window::new(3, 2, 0.1).at(-4, 9), vec![0.1f32, -0.0, 1e-45, f32::MAX, 5.0, 6.5]).unwrap();
        let text = serde_json::to_string(&grid).unwrap();
        assert!(text.starts_with(r#"{"window":{"x":-4,"y":9,"width":3,"height":2,"cell":0.1},"data":[0.1,"#), "{text}");
        let read: Grid = serde_json::from_str(&text).unwrap();
        let bits = |grid: &Grid| grid.data().iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
        assert_eq!((read.window(), bits(&read)), (grid.window(), bits(&grid)));
        let labels = Grid::filled(Window::new(2, 2, 1.0), 7u32);
        assert_eq!(serde_json::from_str::<Grid<u32>>(&serde_json::to_string(&labels).unwrap()).unwrap(), labels);
    }

    #[test]
    fn data_of_another_length_are_refused() {
        for (width, height, samples) in
            [("3", "2", "1,2,3,4,5"), ("2", "2", "1,2,3,4,5"), ("4294967296", "4294967296", "")]
        {
            let text = format!(
                r#"{{"window":{{"x":0,"y":0,"width":{width},"height":{height},"cell":1.0}},"data":[{samples}]}}"#
            );
            let count = samples.split_terminator(',').count();
            let message = serde_json::from_str::<Grid>(&text).unwrap_err().to_string();
            assert_eq!(message, format!("a grid of {width} x {height} samples cannot have {count} in `data`"));
        }
    }

    #[test]
    fn rows_become_columns() {
        for (columns, rows) in [(1usize, 1usize), (5, 3), (70, 33), (33, 70), (32, 64), (0, 0)] {
            let samples: Vec<usize> = (0..columns * rows).collect();
            let turned = transposed(&samples, columns);
            assert!((0..samples.len()).all(|k| turned[k % columns * rows + k / columns] == k), "{columns} x {rows}");
        }
    }

    #[test]
    fn a_window_grows_to_the_end_of_the_lattice() {
        let window = Window::new(10, 20, 1.0).at(-5, 7);
        assert_eq!(window.grown(3), Window::new(16, 26, 1.0).at(-8, 4));
        let side = 2 * FARTHEST as usize;
        for halo in [usize::MAX, 1 << 62, 2 * FARTHEST as usize] {
            let all = window.grown(halo);
            assert_eq!(all, Window::new(side, side, 1.0).at(-FARTHEST, -FARTHEST));
            assert_eq!((all.grown(halo), all.len()), (all, usize::MAX));
        }
    }
}
