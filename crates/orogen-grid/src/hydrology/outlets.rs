//! Outlets: the cells where water leaves a map.

use super::direction::{neighbor, strides};
use crate::grid::Grid;

/// The outlets of a map: all cells on the grid's border; cells that are not finite, and their neighbors; cells of the
/// sea. All other cells drain to one of these.
///
/// In a grid of fewer than 3 columns or rows every cell is on the border.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlets {
    mask: Grid<bool>,
}

impl Outlets {
    /// The outlets of a grid of heights. With a sea level, cells at or below it are sea.
    #[must_use]
    pub fn new(heights: &Grid, sea_level: Option<f32>) -> Outlets {
        let (width, height) = (heights.width(), heights.height());
        let mut mask = Grid::filled(*heights.window(), false);
        let sea = sea_level.unwrap_or(f32::NEG_INFINITY);
        let mut holes = Vec::new();
        for j in 0..height {
            let border = j == 0 || j + 1 == height;
            let row = heights.row(j);
            for (i, (outlet, h)) in mask.row_mut(j).iter_mut().zip(row).enumerate() {
                *outlet = border || *h <= sea || !h.is_finite();
                if !h.is_finite() {
                    holes.push((i, j));
                }
            }
            if let [first, .., last] = mask.row_mut(j) {
                (*first, *last) = (true, true);
            } else {
                mask.row_mut(j).fill(true);
            }
        }
        let strides = strides(width);
        for (i, j) in holes {
            // Neighbors of a hole at the border are border cells, except those inside the grid, so each neighbor is
            // tested.
            if i > 0 && j > 0 && i + 1 < width && j + 1 < height {
                for stride in strides {
                    mask.data_mut()[neighbor(j * width + i, stride)] = true;
                }
            } else {
                for y in j.saturating_sub(1)..(j + 2).min(height) {
                    mask.row_mut(y)[i.saturating_sub(1)..(i + 2).min(width)].fill(true);
                }
            }
        }
        Outlets { mask }
    }

    /// Whether sample `index` of the row-major grid is an outlet.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, index: usize) -> bool {
        self.mask.data()[index]
    }

    /// The outlets as a mask.
    #[must_use]
    pub fn mask(&self) -> &Grid<bool> {
        &self.mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn border_sea_and_the_rim_of_holes() {
        let mut heights = Grid::filled(Window::new(8, 7, 1.0), 5.0);
        heights.row_mut(3)[2] = f32::NAN;
        heights.row_mut(5)[6] = 1.0;
        heights.row_mut(0)[5] = f32::INFINITY;
        let outlets = Outlets::new(&heights, Some(1.0));
        let expect = [
            "########", //
            "#...####", "####...#", "####...#", "####...#", "#.....##", "########",
        ];
        for (j, row) in expect.iter().enumerate() {
            let got: String = outlets.mask().row(j).iter().map(|o| if *o { '#' } else { '.' }).collect();
            assert_eq!(&got, row, "row {j}");
        }
    }

    #[test]
    fn narrow_grids_are_all_border() {
        for (width, height) in [(1, 5), (2, 5), (5, 1), (5, 2), (0, 3), (1, 1)] {
            let outlets = Outlets::new(&Grid::filled(Window::new(width, height, 1.0), 0.0), None);
            assert!(outlets.mask().data().iter().all(|o| *o));
        }
    }
}
