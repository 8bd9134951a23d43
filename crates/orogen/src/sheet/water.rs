//! Rivers and lakes of a sheet, found in its heights.

use crate::contour::chaikin::smooth;
use crate::contour::trace::contours;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::accumulation::accumulate;
use crate::hydrology::lakes::{Lakes, lakes};
use crate::hydrology::outlets::Outlets;
use crate::hydrology::rivers::network;
use crate::hydrology::steepest::Descent;
use crate::hydrology::{drainage, strahler};

/// What counts as water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// Samples that drain to where a river begins.
    pub spring: u32,
    /// Samples that a lake covers.
    pub lake: u32,
    /// Metres that it is deep.
    pub depth: f32,
    /// Whether water goes down by scattered steps: on heights that are smooth between few samples steepest ones run in parallel.
    pub scattered: bool,
}

/// A stretch of river between two confluences.
#[derive(Debug, Clone, PartialEq)]
pub struct River {
    /// Columns and rows, downstream.
    pub points: Vec<[f64; 2]>,
    /// Samples that drain to its end.
    pub drained: u32,
}

/// The water of a grid.
#[derive(Debug, Clone)]
pub struct Water {
    /// Stretches of river, none of them within a lake or the sea.
    pub rivers: Vec<River>,
    /// The shores of lakes, rings and what the border cuts, in columns and rows.
    pub lakes: Vec<Vec<[f64; 2]>>,
    /// The heights, level where there is a lake.
    pub surface: Grid,
}

/// How often the stairs of a river's cells are evened out.
const EVEN: usize = 6;

/// Finds the rivers and lakes of heights.
///
/// # Errors
/// If there are more shores than can be numbered.
pub fn find(heights: &Grid, sea_level: Option<f32>, least: Least) -> Result<Water> {
    let window = Window::new(heights.width(), heights.height(), 1.0);
    let nothing = || Water { rivers: Vec::new(), lakes: Vec::new(), surface: heights.clone() };
    // In samples, so that what is found is, too.
    let Some(heights) = Grid::from_data(window, heights.data().to_vec()) else { return Ok(nothing()) };
    if heights.width() < 3 || heights.height() < 3 {
        return Ok(nothing());
    }
    let outlets = Outlets::new(&heights, sea_level);
    let descent = if least.scattered { Descent::Scattered(1) } else { Descent::Steepest };
    let drainage = drainage::over_bed(&heights, &outlets, descent);
    let found = lakes(&heights, &outlets, &drainage, least.lake);
    let deep: Vec<bool> = std::iter::once(false)
        .chain(found.lakes.iter().map(|lake| lake.level - heights.data()[lake.deepest as usize] >= least.depth))
        .collect();
    let lake = |c: usize| Some(found.labels.data()[c]).filter(|label| deep[*label as usize]);
    let drained = accumulate(&drainage.receivers);
    let orders = strahler::orders(&drainage.receivers, &drained, least.spring.max(1));
    let wet = |c: usize| {
        let height = heights.data()[c];
        !height.is_finite() || sea_level.is_some_and(|sea| height <= sea) || lake(c).is_some()
    };
    let mut rivers = Vec::new();
    for reach in network(&drainage.receivers, &orders) {
        let cells: Vec<usize> = reach.cells.iter().map(|cell| *cell as usize).collect();
        // The parts on land, each with the first cell of the water it comes from and flows into.
        let mut part: Vec<usize> = Vec::new();
        for (k, cell) in cells.iter().enumerate() {
            if !wet(*cell) {
                if part.is_empty() && k > 0 {
                    part.push(cells[k - 1]);
                }
                part.push(*cell);
            }
            let ends = wet(*cell) || k + 1 == cells.len();
            if ends && !part.is_empty() {
                if wet(*cell) {
                    part.push(*cell);
                }
                // The last cell is the next reach's first, which more drains to.
                let end = part[part.len().saturating_sub(2)];
                let area = drained.area.data()[end];
                rivers.push(River { points: even(&part, heights.width()), drained: area });
                part.clear();
            }
        }
    }
    rivers.retain(|river| river.points.len() > 1);
    let shores = shores(&heights, &found, &deep);
    let lines = contours(&shores, &[0.0])?;
    let lakes = lines.iter().map(|line| smooth(line, 1).path().collect()).collect();
    let mut surface = heights.clone();
    for (c, height) in surface.data_mut().iter_mut().enumerate() {
        if let Some(label) = lake(c).and_then(|label| found.lakes.get(label as usize - 1)) {
            *height = label.level.max(*height);
        }
    }
    Ok(Water { rivers, lakes, surface })
}

/// The way through cells, its stairs evened out; its ends stay.
fn even(cells: &[usize], width: usize) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = cells.iter().map(|c| [(c % width) as f64, (c / width) as f64]).collect();
    for _ in 0..EVEN {
        let before = points.clone();
        for (point, three) in points.iter_mut().skip(1).zip(before.windows(3)) {
            *point = [0, 1].map(|c| (three[0][c] + 2.0 * three[1][c] + three[2][c]) / 4.0);
        }
    }
    points
}

/// Water over ground in and beside the deep lakes, below 0 elsewhere: 0 is their shore.
fn shores(heights: &Grid, found: &Lakes, deep: &[bool]) -> Grid {
    let mut depth = Grid::filled(*heights.window(), -1.0f32);
    let (width, height) = (heights.width(), heights.height());
    for j in 0..height {
        for i in 0..width {
            let here = heights.get(i, j);
            let label = found.labels.get(i, j);
            if deep[label as usize] {
                depth.row_mut(j)[i] = (found.lakes[label as usize - 1].level - here).max(1e-3);
                continue;
            }
            // Land beside a lake lies above its surface by what it does.
            let mut beside: Option<f32> = None;
            for y in j.saturating_sub(1)..(j + 2).min(height) {
                for x in i.saturating_sub(1)..(i + 2).min(width) {
                    let other = found.labels.get(x, y);
                    if deep[other as usize] {
                        let level = found.lakes[other as usize - 1].level;
                        beside = Some(beside.map_or(level, |best: f32| best.max(level)));
                    }
                }
            }
            if let Some(level) = beside {
                depth.row_mut(j)[i] = (level - here).min(-1e-3);
            }
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A valley that falls to the south, with a hollow on its way.
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
        let water = find(&heights, None, Least { spring: 100, lake: 10, depth: 5.0, scattered: false }).unwrap();
        assert_eq!(water.lakes.len(), 1);
        let shore = &water.lakes[0];
        assert!(shore.first() == shore.last() && shore.len() > 10);
        let inside = |x: f64, y: f64| (x - 30.0).abs() < 2.0 && (y - 41.0).abs() < 2.0;
        assert!(!water.rivers.is_empty());
        assert!(water.rivers.iter().all(|river| river.points.iter().all(|[x, y]| !inside(*x, *y))));
        let middle = water.rivers.iter().filter(|river| river.points.iter().all(|p| (p[0] - 30.0).abs() < 4.0));
        let rows: Vec<f64> = middle.flat_map(|river| river.points.iter().map(|p| p[1])).collect();
        assert!(rows.iter().any(|y| *y < 25.0) && rows.iter().any(|y| *y > 60.0));
        let level = water.surface.get(30, 40);
        assert!(level > heights.get(30, 40) + 20.0 && level == water.surface.get(31, 41));
        // A lake that must be larger or deeper is none.
        for least in [
            Least { spring: 100, lake: 4000, depth: 5.0, scattered: false },
            Least { spring: 100, lake: 10, depth: 500.0, scattered: false },
        ] {
            assert!(find(&heights, None, least).unwrap().lakes.is_empty());
        }
    }

    #[test]
    fn the_sea_takes_the_rivers() {
        let heights = valley();
        let sea = heights.get(30, 70);
        let water = find(&heights, Some(sea), Least { spring: 100, lake: 10, depth: 5.0, scattered: false }).unwrap();
        let under =
            water.rivers.iter().flat_map(|river| &river.points[..river.points.len() - 1]).filter(|p| p[1] > 74.0);
        assert_eq!(under.count(), 0);
        let flat = find(
            &Grid::filled(Window::new(9, 9, 1.0), 5.0),
            Some(10.0),
            Least { spring: 1, lake: 1, depth: 0.0, scattered: false },
        );
        assert!(flat.unwrap().rivers.is_empty());
    }
}
