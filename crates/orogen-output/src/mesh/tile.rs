//! The heights of one tile, laid out for reading across many rows.

use orogen_grid::grid::Grid;

/// Samples a cache line holds.
const LINE: usize = 16;

/// One of a tile's samples, by its column and row. They are ordered row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Sample(u32);

impl Sample {
    /// The one in the north-western corner.
    pub const FIRST: Sample = Sample(0);

    /// The sample in this column and row, both below 2^15.
    #[inline(always)]
    pub fn at([column, row]: [i32; 2]) -> Sample {
        Sample(row as u32 * Sample::ROW + column as u32)
    }

    /// The sample with this number.
    #[inline(always)]
    pub fn from_number(number: u32) -> Sample {
        Sample(number)
    }

    /// How far apart the numbers of a sample and the one south of it are. To the east they follow each other.
    pub const ROW: u32 = 1 << 16;

    /// Its number.
    #[inline(always)]
    pub fn number(self) -> u32 {
        self.0
    }

    /// Its column and row.
    #[inline(always)]
    pub fn place(self) -> [i32; 2] {
        [(self.0 % Sample::ROW) as i32, (self.0 / Sample::ROW) as i32]
    }
}

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
    /// The `width` x `height` samples of `grid` from column `left` and row `top` on, in `memory` that may have held another tile.
    pub fn of(grid: &Grid, [left, top]: [usize; 2], [width, height]: [usize; 2], memory: Vec<f32>) -> Tile {
        let stride = (width.div_ceil(LINE) | 1) * LINE;
        let mut heights = memory;
        heights.clear();
        heights.resize(stride * height + LINE, 0.0);
        for (j, row) in heights.chunks_exact_mut(stride).take(height).enumerate() {
            row[..width].copy_from_slice(&grid.row(top + j)[left..left + width]);
        }
        Tile { heights, stride, width, height }
    }

    /// Its memory, for another tile.
    pub fn into_memory(self) -> Vec<f32> {
        self.heights
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
