//! Which neighbour each cell drains to.

use super::direction::{NONE, neighbour, strides};
use crate::grid::{Grid, Window};

/// The receiver of every cell, as the code of a direction ([`NONE`] for outlets and pits).
///
/// No code leads out of the grid: cells of its border have none.
#[derive(Debug, Clone, PartialEq)]
pub struct Receivers {
    codes: Grid<u8>,
    strides: [isize; 9],
}

impl Receivers {
    /// No cell drains anywhere yet.
    pub fn none(window: Window) -> Receivers {
        let mut all = [0; 9];
        all[..8].copy_from_slice(&strides(window.width));
        Receivers { codes: Grid::filled(window, NONE), strides: all }
    }

    /// The codes, row-major.
    pub fn codes(&self) -> &[u8] {
        self.codes.data()
    }

    /// The codes, to change. A code must not lead out of the grid.
    pub fn codes_mut(&mut self) -> &mut [u8] {
        self.codes.data_mut()
    }

    /// The grid of codes.
    pub fn grid(&self) -> &Grid<u8> {
        &self.codes
    }

    /// Where the cells lie.
    pub fn window(&self) -> &Window {
        self.codes.window()
    }

    /// The cell that `index` drains to; itself if it drains to none.
    #[inline(always)]
    pub fn of(&self, index: usize) -> usize {
        // The mask changes no code; it spares the check that it is below the length.
        let code = self.codes.data()[index];
        neighbour(index, self.strides[usize::from(code.min(NONE))])
    }

    /// The code of cell `index`.
    #[inline(always)]
    pub fn code(&self, index: usize) -> u8 {
        self.codes.data()[index]
    }
}
