//! Terrain classes of the cells of a window.

use crate::random::{STEP, mix64};

/// Random bits of the cell (x, y) of the plane, independent of the window.
#[inline]
pub(super) fn hash([x, y]: [i64; 2], seed: u64) -> u64 {
    mix64(mix64(seed ^ (x as u64).wrapping_mul(STEP)) ^ (y as u64).wrapping_mul(0xD1B5_4A32_D192_ED03))
}

/// Terrain classes, row-major, with the position of the first cell in the plane, so that a part of a map is cleaned and
/// drawn like the whole map. Outside the window, the class of the nearest cell counts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Classes {
    /// Column of the first cell.
    pub x: i64,
    /// Row of the first cell.
    pub y: i64,
    width: usize,
    height: usize,
    data: Vec<u8>,
}

impl Classes {
    /// The classes of `width` x `height` cells from the cell (x, y). If `data` is too short, the missing classes are 0;
    /// if it is too long, the rest is ignored.
    #[must_use]
    pub fn new([x, y]: [i64; 2], width: usize, height: usize, mut data: Vec<u8>) -> Classes {
        data.resize(width * height, 0);
        Classes { x, y, width, height, data }
    }

    /// Number of cells per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All classes, row-major.
    #[must_use]
    pub fn data(&self) -> &[u8] {
        &self.data
    }

    /// Row `y` of the window, or the nearest row if it is outside. A window without cells has empty rows.
    #[must_use]
    pub fn row(&self, y: i64) -> &[u8] {
        let y = y.clamp(0, (self.height as i64 - 1).max(0)) as usize;
        self.data.get(y * self.width..(y + 1) * self.width).unwrap_or_default()
    }

    /// The class in column `x` and row `y` of the window, or the class of the nearest cell if it is outside; 0 in a
    /// window without cells.
    #[inline]
    #[must_use]
    pub fn at(&self, x: i64, y: i64) -> u8 {
        let x = x.clamp(0, (self.width as i64 - 1).max(0)) as usize;
        self.row(y).get(x).copied().unwrap_or_default()
    }

    /// Sets the class in column `x` and row `y`; cells outside the window are ignored.
    pub fn set(&mut self, x: i64, y: i64, class: u8) {
        let inside = |at: i64, side: usize| usize::try_from(at).ok().filter(|at| *at < side);
        if let (Some(x), Some(y)) = (inside(x, self.width), inside(y, self.height)) {
            self.data[y * self.width + x] = class;
        }
    }

    /// The part of `width` x `height` cells from the cell (x, y) of the plane. Cells outside the window have the class
    /// of the nearest cell.
    #[must_use]
    pub fn part(&self, [x, y]: [i64; 2], width: usize, height: usize) -> Classes {
        let rows = (0..height as i64)
            .flat_map(|row| (0..width as i64).map(move |column| self.at(x - self.x + column, y - self.y + row)));
        Classes::new([x, y], width, height, rows.collect())
    }

    /// The number of cells of each class, up to the largest class.
    #[must_use]
    pub fn counts(&self) -> Vec<usize> {
        let mut counts = [0; 256];
        self.data.iter().for_each(|class| counts[usize::from(*class)] += 1);
        let used = counts.iter().rposition(|count| *count > 0).map_or(0, |last| last + 1);
        counts[..used].to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_the_sides_the_nearest_cell_counts() {
        let classes = Classes::new([10, -5], 2, 2, vec![1, 2, 3, 4]);
        assert_eq!([(-9, -9), (0, 0), (5, 0), (0, 7), (9, 9)].map(|(x, y)| classes.at(x, y)), [1, 1, 2, 3, 4]);
        assert_eq!(classes.part([11, -5], 2, 3).data(), [2, 2, 4, 4, 4, 4]);
        assert_eq!(classes.counts(), [0, 1, 1, 1, 1]);
        assert_eq!(Classes::new([0, 0], 0, 0, vec![]).at(3, 3), 0);
    }
}
