//! The heights of one tile, in a layout for access across many rows.

use orogen_grid::grid::Grid;

/// Samples per cache line.
const LINE: usize = 16;

/// A sample of a tile, as a number that combines its column and row. Samples are ordered row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Sample(u32);

impl Sample {
    /// The sample in the north-western corner.
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

    /// The difference between the numbers of a sample and its southern neighbor. Eastern neighbors have consecutive
    /// numbers.
    pub const ROW: u32 = 1 << 16;

    /// The number of the sample.
    #[inline(always)]
    pub fn number(self) -> u32 {
        self.0
    }

    /// The column and row of the sample.
    #[inline(always)]
    pub fn place(self) -> [i32; 2] {
        [(self.0 % Sample::ROW) as i32, (self.0 / Sample::ROW) as i32]
    }
}

/// The samples of a part of a grid. Rows are an odd number of cache lines apart, so that neighboring rows do not map to
/// the same cache sets. A SIMD register can be loaded from any sample.
pub(super) struct Tile {
    heights: Vec<f32>,
    /// Samples between the starts of rows.
    pub stride: usize,
    /// Samples per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

impl Tile {
    /// The `width` x `height` samples of `grid` from column `left` and row `top`, in `memory` that may have held
    /// another tile.
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

    /// The memory, for use by another tile.
    pub fn into_memory(self) -> Vec<f32> {
        self.heights
    }

    /// All samples; row `j` starts at `j * stride`.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The sample in this column and row.
    #[inline(always)]
    pub fn at(&self, [column, row]: [i32; 2]) -> f32 {
        self.heights[row as usize * self.stride + column as usize]
    }

    /// The largest absolute height.
    pub fn greatest(&self) -> f32 {
        self.heights.iter().fold(0.0, |greatest, height| greatest.max(height.abs()))
    }
}
