//! The heights of one tile, laid out for reading across many rows.

use crate::grid::Grid;

/// Samples a cache line holds.
const LINE: usize = 16;

/// The samples of a part of a grid, each row begun an odd number of cache lines after the one before, so that neighbouring rows
/// do not compete for the same places in the cache. A register's worth of samples may be read from any of them.
pub(super) struct Tile {
    heights: Vec<f32>,
    /// Samples from one row to the next.
    pub stride: usize,
    /// Samples a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Tile {
    /// The `width` x `height` samples of `grid` from column `left` and row `top` on.
    pub fn of(grid: &Grid, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Tile {
        let stride = (width.div_ceil(LINE) | 1) * LINE;
        let mut heights = vec![0.0; stride * height + LINE];
        for (j, row) in heights.chunks_exact_mut(stride).take(height).enumerate() {
            row[..width].copy_from_slice(&grid.row(top + j)[left..left + width]);
        }
        Tile { heights, stride, width, height }
    }

    /// All samples; row `j` begins at `j * stride`.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The sample in this column and row.
    #[inline(always)]
    pub fn at(&self, [column, row]: [i32; 2]) -> f32 {
        self.heights[row as usize * self.stride + column as usize]
    }

    /// The greatest height without its sign.
    pub fn greatest(&self) -> f32 {
        self.heights.iter().fold(0.0, |greatest, height| greatest.max(height.abs()))
    }
}
