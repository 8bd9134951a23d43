//! Rivers and lakes of a sheet, from a known network or found in its heights.

use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::rivers::rivers;
use orogen_grid::hydrography::shores::Shores;
use orogen_grid::hydrography::water::{self, Cover, Frame};
use orogen_grid::progress::Progress;

pub use orogen_grid::hydrography::water::Least;

/// A stretch of river between two confluences.
#[derive(Debug, Clone, PartialEq)]
pub struct River {
    /// Columns and rows, downstream.
    pub points: Vec<[f64; 2]>,
    /// Number of samples that drain to its end.
    pub drained: f64,
}

/// The water of a grid.
#[derive(Debug, Clone)]
pub struct Water {
    /// Stretches of river outside of lakes and the sea.
    pub rivers: Vec<River>,
    /// The shores of lakes, as rings or cut at the border, in columns and rows.
    pub lakes: Vec<Vec<[f64; 2]>>,
    /// The heights, level in lakes.
    pub surface: Grid,
}

/// Known water, in columns and rows of the heights of a sheet.
#[derive(Debug, Clone)]
pub struct KnownWater {
    /// Stretches of river outside of lakes and the sea, with their drainage area in samples of the heights.
    pub rivers: Vec<River>,
    /// The shores of lakes, as rings.
    pub lakes: Vec<Vec<[f64; 2]>>,
    /// The height of the surface of lakes over the window of the heights; NaN elsewhere.
    pub levels: Grid,
}

impl KnownWater {
    /// Converts the water to columns and rows of a grid that covers the same land.
    #[must_use]
    pub fn on(&self, grid: &Grid) -> Water {
        let sides = [self.levels.width(), self.levels.height()];
        let across = |axis: usize, count: usize| (count - 1) as f64 / (sides[axis].max(2) - 1) as f64;
        let [x, y] = [across(0, grid.width()), across(1, grid.height())];
        let moved = |points: &[[f64; 2]]| points.iter().map(|at| [at[0] * x, at[1] * y]).collect();
        let rivers =
            self.rivers.iter().map(|river| River { points: moved(&river.points), drained: river.drained * x * y });
        let mut surface = grid.clone();
        let near = |at: usize, ratio: f64, count: usize| ((at as f64 / ratio).round() as usize).min(count - 1);
        for j in 0..grid.height() {
            let levels = self.levels.row(near(j, y, sides[1]));
            for (i, height) in surface.row_mut(j).iter_mut().enumerate() {
                // Where there is no lake the level is NaN, and `max` keeps the ground.
                *height = height.max(levels[near(i, x, sides[0])]);
            }
        }
        Water { rivers: rivers.collect(), lakes: self.lakes.iter().map(|ring| moved(ring)).collect(), surface }
    }
}

/// Smoothing rounds of rivers, and of shores.
const EVEN: usize = 6;
const CUT: usize = 1;

/// Finds the rivers and lakes of heights.
///
/// # Errors
/// If there are too many shores.
pub fn find(heights: &Grid, sea_level: Option<f32>, least: Least) -> Result<Water> {
    let window = Window::new(heights.width(), heights.height(), 1.0);
    // In units of samples, like the result.
    let grid = Grid::from_data(window, heights.data().to_vec()).filter(|_| window.width.min(window.height) > 2);
    let Some(grid) = grid else {
        return Ok(Water { rivers: Vec::new(), lakes: Vec::new(), surface: heights.clone() });
    };
    let found = water::Water::of(grid, sea_level, least, &Progress::none())?;
    let frame = Frame::whole(&found);
    let mut shores = Shores::of(&found, &frame, CUT)?;
    let rivers = rivers(&found, &frame, EVEN, &mut shores)
        .into_iter()
        .map(|river| River { points: river.points.iter().map(|[x, y, _]| [*x, *y]).collect(), drained: river.drained });
    let rivers = rivers.collect();
    let lakes =
        shores.lines.into_iter().zip(shores.waters).filter(|(_, lake)| *lake > 0).map(|(line, _)| line).collect();
    let mut surface = heights.clone();
    for (cell, height) in surface.data_mut().iter_mut().enumerate() {
        if let Cover::Lake(lake) = found.cover(cell) {
            *height = found.lakes[lake as usize - 1].level.max(*height);
        }
    }
    Ok(Water { rivers, lakes, surface })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A valley that descends to the south, with a depression.
    fn valley() -> Grid {
        let mut grid = Grid::filled(Window::new(61, 81, 30.0), 0.0);
        for j in 0..81 {
            for i in 0..61 {
                let (x, y) = (i as f64 - 30.0, j as f64 - 40.0);
                let hollow = -60.0 * libm::exp(-(x * x + y * y) / 40.0);
                grid.row_mut(j)[i] = (400.0 - 3.0 * y + 4.0 * x.abs() + hollow) as f32;
            }
        }
        grid
    }

    #[test]
    fn a_river_runs_to_the_lake_and_on_from_it() {
        let heights = valley();
        let water = find(&heights, None, Least::new(100, 10).with_depth(5.0).with_scattered(false)).unwrap();
        assert_eq!(water.lakes.len(), 1);
        let shore = &water.lakes[0];
        assert!(shore.first() == shore.last() && shore.len() > 10);
        let inside = |x: f64, y: f64| (x - 30.0).abs() < 2.0 && (y - 41.0).abs() < 2.0;
        assert!(!water.rivers.is_empty());
        assert!(water.rivers.iter().all(|river| river.points.iter().all(|[x, y]| !inside(*x, *y))));
        let middle = water.rivers.iter().filter(|river| river.points.iter().all(|p| (p[0] - 30.0).abs() < 4.0));
        let rows: Vec<f64> = middle.flat_map(|river| river.points.iter().map(|p| p[1])).collect();
        assert!(rows.iter().any(|y| *y < 25.0) && rows.iter().any(|y| *y > 60.0));
        let level = water.surface[(30, 40)];
        assert!(level > heights[(30, 40)] + 20.0 && level == water.surface[(31, 41)]);
        // A lake below the minimum area or depth is omitted.
        for least in [
            Least::new(100, 4000).with_depth(5.0).with_scattered(false),
            Least::new(100, 10).with_depth(500.0).with_scattered(false),
        ] {
            assert!(find(&heights, None, least).unwrap().lakes.is_empty());
        }
    }

    #[test]
    fn known_water_is_moved_to_another_lattice() {
        let mut levels = Grid::filled(Window::new(5, 3, 30.0), f32::NAN);
        levels[(2, 1)] = 7.0;
        let river = River { points: vec![[0.0, 0.0], [4.0, 2.0]], drained: 10.0 };
        let known = KnownWater { rivers: vec![river], lakes: vec![vec![[2.0, 1.0], [3.0, 1.0]]], levels };
        let water = known.on(&Grid::filled(Window::new(9, 5, 15.0), 5.0));
        assert_eq!(water.rivers, [River { points: vec![[0.0, 0.0], [8.0, 4.0]], drained: 40.0 }]);
        assert_eq!(water.lakes, [[[4.0, 2.0], [6.0, 2.0]]]);
        assert_eq!((water.surface[(4, 2)], water.surface[(0, 0)]), (7.0, 5.0));
    }

    #[test]
    fn the_sea_takes_the_rivers() {
        let heights = valley();
        let sea = heights[(30, 70)];
        let water = find(&heights, Some(sea), Least::new(100, 10).with_depth(5.0).with_scattered(false)).unwrap();
        let under =
            water.rivers.iter().flat_map(|river| &river.points[..river.points.len() - 1]).filter(|p| p[1] > 74.0);
        assert_eq!(under.count(), 0);
        let flat = find(
            &Grid::filled(Window::new(9, 9, 1.0), 5.0),
            Some(10.0),
            Least::new(1, 1).with_depth(0.0).with_scattered(false),
        );
        assert!(flat.unwrap().rivers.is_empty());
    }
}
