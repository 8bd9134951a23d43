//! Receivers: the neighbor that each cell drains to.

use super::direction::{Convention, NONE, neighbor, opposite, strides};
use crate::grid::{Grid, Window};
use crate::parallel;

/// The receiver of every cell, as the code of a direction ([`NONE`] for outlets and pits).
///
/// No code leads out of the grid: border cells have none.
#[derive(Debug, Clone, PartialEq)]
pub struct Receivers {
    codes: Grid<u8>,
    strides: [isize; 9],
}

impl Receivers {
    /// Receivers with [`NONE`] for every cell.
    #[must_use]
    pub fn none(window: Window) -> Receivers {
        let mut all = [0; 9];
        all[..8].copy_from_slice(&strides(window.width));
        Receivers { codes: Grid::filled(window, NONE), strides: all }
    }

    /// The codes, row-major.
    #[must_use]
    pub fn codes(&self) -> &[u8] {
        self.codes.data()
    }

    /// The codes, mutable. A code must not lead out of the grid.
    pub fn codes_mut(&mut self) -> &mut [u8] {
        self.codes.data_mut()
    }

    /// The grid of codes.
    #[must_use]
    pub fn grid(&self) -> &Grid<u8> {
        &self.codes
    }

    /// The window of the cells.
    #[must_use]
    pub fn window(&self) -> &Window {
        self.codes.window()
    }

    /// The receiver of cell `index`; the cell itself if it has none.
    #[inline(always)]
    #[must_use]
    pub fn of(&self, index: usize) -> usize {
        // Codes are at most [`NONE`]; `min` only removes the bounds check.
        let code = self.codes.data()[index];
        neighbor(index, self.strides[usize::from(code.min(NONE))])
    }

    /// The donors of each cell as a set: bit k stands for the neighbor in direction k. Rows are computed in parallel.
    #[must_use]
    pub fn donors(&self) -> Vec<u8> {
        let (width, height) = (self.window().width, self.window().height);
        let mut donors = vec![0u8; width * height];
        parallel::for_each(donors.chunks_mut(width.max(1)).enumerate(), |(j, row)| {
            for (south, east) in [(-1, 7), (0, 0), (1, 1)] {
                let Some(from) = j.checked_add_signed(south).filter(|from| *from < height) else { continue };
                let from = self.codes.row(from);
                // The directions whose cells lie one column east or west.
                let straight = if south < 0 { 6 } else { 2 };
                let west = if south < 0 { 5 } else { 4 - south as u8 };
                mark(row, &from[1..], east);
                if south != 0 {
                    mark(row, from, straight);
                }
                mark(&mut row[1..], from, west);
            }
        });
        donors
    }

    /// The codes in the numbers of another program.
    #[must_use]
    pub fn coded(&self, convention: Convention) -> Grid<u8> {
        let mut codes = self.codes.clone();
        codes.data_mut().iter_mut().for_each(|code| *code = convention.of(*code));
        codes
    }

    /// The code of cell `index`.
    #[inline(always)]
    #[must_use]
    pub fn code(&self, index: usize) -> u8 {
        self.codes.data()[index]
    }
}

/// Marks the cells into which the neighbor in this direction drains.
fn mark(sets: &mut [u8], neighbors: &[u8], direction: u8) {
    let here = opposite(direction);
    sets.iter_mut().zip(neighbors).for_each(|(set, code)| *set |= u8::from(*code == here) << direction);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::direction::hashed;

    #[test]
    fn donors_are_those_whose_receiver_a_cell_is() {
        for (width, height) in [(9, 7), (3, 3), (1, 5), (5, 1), (0, 3)] {
            let mut receivers = Receivers::none(Window::new(width, height, 1.0));
            for j in 1..height.saturating_sub(1) {
                for i in 1..width.saturating_sub(1) {
                    receivers.codes_mut()[j * width + i] = (hashed(i as i64, j as i64) % 9) as u8;
                }
            }
            let donors = receivers.donors();
            let strides = strides(width);
            let mut expect = vec![0u8; width * height];
            for c in (0..width * height).filter(|c| receivers.code(*c) != NONE) {
                expect[neighbor(c, strides[usize::from(receivers.code(c))])] |= 1 << opposite(receivers.code(c));
            }
            assert_eq!(donors, expect);
        }
    }
}
