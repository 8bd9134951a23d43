//! Rows of planes and of their eight neighbors, as slices.

use crate::hydrology::direction::STEPS;

/// Size of the planes of a pass, and the number of cells at each edge that it omits.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    pub width: usize,
    pub height: usize,
    /// Number of cells at each edge whose values are not exact; at least 1 where neighbors are read.
    pub inset: usize,
}

impl Extent {
    /// The extent after a pass that reads neighbors up to `reach` cells away.
    pub fn shrunk(self, reach: usize) -> Extent {
        Extent { inset: self.inset + reach, ..self }
    }

    pub fn len(self) -> usize {
        self.width * self.height
    }

    /// The rows of the extent without the inset.
    pub fn rows(self) -> std::ops::Range<usize> {
        self.inset..self.height.saturating_sub(self.inset).max(self.inset)
    }

    /// The columns of the extent without the inset.
    pub fn columns(self) -> std::ops::Range<usize> {
        self.inset..self.width.saturating_sub(self.inset).max(self.inset)
    }

    /// The part of row `j` of a plane without the inset.
    #[inline(always)]
    pub fn row<T>(self, plane: &[T], j: usize) -> &[T] {
        let columns = self.columns();
        &plane[j * self.width + columns.start..j * self.width + columns.end]
    }

    /// The part of row `j` of a plane without the inset, mutable.
    #[inline(always)]
    pub fn row_mut<T>(self, plane: &mut [T], j: usize) -> &mut [T] {
        let columns = self.columns();
        &mut plane[j * self.width + columns.start..j * self.width + columns.end]
    }

    /// The eight neighbors of the part of row `j` without the inset, in the order of [`STEPS`].
    #[inline(always)]
    pub fn around<T>(self, plane: &[T], j: usize) -> [&[T]; 8] {
        let columns = self.columns();
        STEPS.map(|(east, south)| {
            let row = j.wrapping_add_signed(south) * self.width;
            let start = (row + columns.start).wrapping_add_signed(east);
            &plane[start..start + columns.len()]
        })
    }
}

/// The code of the direction of a step: `east` and `south` are -1, 0 or 1.
#[inline(always)]
pub fn code(east: isize, south: isize) -> u8 {
    const CODES: [u8; 9] = [5, 6, 7, 4, 8, 0, 3, 2, 1];
    let index = (south + 1) * 3 + east + 1;
    CODES[index.clamp(0, 8) as usize]
}
