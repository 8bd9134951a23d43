//! Depression filling.

use super::basins::Basins;
use super::drainage;
use super::outlets::Outlets;
use super::steepest::Descent;
use crate::grid::Grid;
use crate::parallel;

/// The heights with every depression filled to its spill level. This is the lowest surface on which every cell has a
/// path to an outlet that never rises. The result has the same bits as Priority-Flood without an epsilon (Barnes,
/// Lehman and Mulla 2014), and filled areas are level.
///
/// Heights that are not finite are unchanged, and their neighbors are outlets. The time is O(cells).
#[must_use]
pub fn fill(heights: &Grid, outlets: &Outlets) -> Grid {
    filled(heights, &drainage::route_carving(heights, outlets, Descent::Steepest).basins)
}

/// [`fill`] with basins that are already known.
#[must_use]
pub fn filled(heights: &Grid, basins: &Basins) -> Grid {
    let mut out = heights.clone();
    let width = heights.width().max(1);
    let rows = out.data_mut().chunks_mut(width).zip(basins.labels.chunks(width));
    parallel::for_each(rows, |(row, labels)| {
        for (h, label) in row.iter_mut().zip(labels) {
            let level = basins.spills[*label as usize].level;
            if *h < level {
                *h = level;
            }
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::direction::{neighbor, strides};
    use crate::hydrology::samples;

    /// The method of Planchon and Darboux (2002): infinitely high water sinks until the heights are stable.
    fn sunk(heights: &Grid, outlets: &Outlets) -> Vec<f32> {
        let h = heights.data();
        let strides = strides(heights.width());
        let mut water: Vec<f32> = (0..h.len()).map(|c| if outlets.at(c) { h[c] } else { f32::INFINITY }).collect();
        loop {
            let mut changed = false;
            for c in (0..h.len()).filter(|c| !outlets.at(*c)) {
                let least = strides.iter().map(|stride| water[neighbor(c, *stride)]).fold(f32::INFINITY, f32::min);
                let level = h[c].max(least);
                changed |= level < water[c];
                water[c] = water[c].min(level);
            }
            if !changed {
                return water;
            }
        }
    }

    #[test]
    fn it_is_the_lowest_surface_that_drains() {
        for heights in samples::grids() {
            for sea in [None, Some(3.0), Some(250.0)] {
                let outlets = Outlets::new(&heights, sea);
                let expect = sunk(&heights, &outlets);
                let got = fill(&heights, &outlets);
                for (c, (got, expect)) in got.data().iter().zip(&expect).enumerate() {
                    assert!(
                        got.to_bits() == expect.to_bits() || got.is_nan() && expect.is_nan(),
                        "cell {c}: {got} {expect}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_bowl_fills_to_its_brim() {
        let mut heights = Grid::filled(Window::new(7, 7, 10.0), 9.0);
        for j in 2..5 {
            heights.row_mut(j)[2..5].fill(1.0);
        }
        heights.row_mut(3)[5] = 4.0;
        heights.row_mut(3)[6] = 3.0;
        let got = fill(&heights, &Outlets::new(&heights, None));
        assert_eq!(got.row(3), [9.0, 9.0, 4.0, 4.0, 4.0, 4.0, 3.0]);
    }
}
