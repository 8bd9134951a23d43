//! Measures the coasts and heights of continents, of recipes and of Earth alike. Prints a table.
#![allow(clippy::disallowed_methods, reason = "a measurement, of which no terrain is made")]

use orogen::Grid;

use crate::land::{Request, grid, name, parse, quantile, sorted};

/// Cell in metres that sources have without `--cell`.
const CELL: f64 = 30_720.0;

/// Columns and rows of sources without bounds, around the origin, without `--window`.
const SIDE: i64 = 256;

/// Sides of the boxes, in cells, between which the dimension of the coast is measured.
const BOXES: [usize; 2] = [2, 16];

/// Distances from the coast, in km, between which the sea is searched for shelves.
const RINGS: [std::ops::Range<f64>; 3] = [40.0..80.0, 80.0..150.0, 150.0..300.0];

/// Depth of a shelf, in metres.
const SHELF: f32 = -200.0;

/// Runs the measurement.
pub fn run(args: &[String]) -> Result<(), String> {
    let request = parse(args)?;
    println!(
        "| land | share | coast: dimension | islands | shelf: 40-80 km | 80-150 km | 150-300 km | heights: p25 | p50 | p75 | p90 |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for source in &request.sources {
        let window = request.window.or(source.starts_with("endless").then_some([-SIDE / 2, -SIDE / 2, SIDE, SIDE]));
        let request = Request { cell: request.cell.or(Some(CELL)), window, ..request.clone() };
        let heights = grid(source, &request, "height")?;
        let coast = Coast::new(&heights);
        let land =
            sorted(heights.data().iter().filter(|height| **height > 0.0).map(|height| f64::from(*height)).collect());
        let share = land.len() as f64 / heights.data().len() as f64;
        let (dimension, islands) = (coast.dimension(), coast.islands());
        let shelves = RINGS.map(|ring| format!("{:.2}", coast.shelf(&heights, &ring))).join(" | ");
        let tops = [0.25, 0.5, 0.75, 0.9].map(|part| format!("{:.0} m", quantile(&land, part))).join(" | ");
        println!("| {} | {share:.2} | {dimension:.2} | {islands} | {shelves} | {tops} |", name(source));
    }
    Ok(())
}

/// Land and sea of a window.
struct Coast {
    width: usize,
    height: usize,
    land: Vec<bool>,
    /// The distance of each cell of the sea from the nearest land, in km.
    away: Vec<f64>,
}

impl Coast {
    fn new(heights: &Grid) -> Coast {
        let window = heights.window();
        let (width, height) = (window.width, window.height);
        let land: Vec<bool> = heights.data().iter().map(|height| *height > 0.0).collect();
        let mut coast = Coast { width, height, away: Vec::new(), land };
        // Only the land of the coast can be the nearest.
        let shores: Vec<(f64, f64)> =
            coast.cells().filter(|&(i, j)| coast.is_coast(i, j)).map(|(i, j)| (i as f64, j as f64)).collect();
        let nearest = |(i, j): (usize, usize)| {
            let square = |&(x, y): &(f64, f64)| (x - i as f64) * (x - i as f64) + (y - j as f64) * (y - j as f64);
            if coast.is_land(i, j) { 0.0 } else { shores.iter().map(square).fold(f64::INFINITY, f64::min).sqrt() }
        };
        let away = coast.cells().map(|cell| nearest(cell) * window.cell * 1e-3).collect();
        coast.away = away;
        coast
    }

    fn cells(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let width = self.width;
        (0..self.height).flat_map(move |j| (0..width).map(move |i| (i, j)))
    }

    fn is_land(&self, i: usize, j: usize) -> bool {
        self.land[j * self.width + i]
    }

    /// Whether a cell is land next to the sea.
    fn is_coast(&self, i: usize, j: usize) -> bool {
        let sea = |i: usize, j: usize| i < self.width && j < self.height && !self.is_land(i, j);
        self.is_land(i, j) && (sea(i + 1, j) || sea(i, j + 1) || sea(i.wrapping_sub(1), j) || sea(i, j.wrapping_sub(1)))
    }

    /// The dimension of the coast by counted boxes: 1 is a smooth line.
    fn dimension(&self) -> f64 {
        let [fine, coarse] = BOXES.map(|side| {
            let boxes: std::collections::BTreeSet<(usize, usize)> =
                self.cells().filter(|&(i, j)| self.is_coast(i, j)).map(|(i, j)| (i / side, j / side)).collect();
            boxes.len() as f64
        });
        (fine / coarse).ln() / (BOXES[1] as f64 / BOXES[0] as f64).ln()
    }

    /// The number of islands smaller than a thousand cells.
    fn islands(&self) -> usize {
        let mut left = self.land.clone();
        let mut count = 0;
        for start in self.cells() {
            let mut open = vec![start];
            let mut size = 0;
            while let Some((i, j)) = open.pop() {
                if i >= self.width || j >= self.height || !std::mem::take(&mut left[j * self.width + i]) {
                    continue;
                }
                size += 1;
                open.extend([(i + 1, j), (i, j + 1), (i.wrapping_sub(1), j), (i, j.wrapping_sub(1))]);
            }
            count += usize::from((1..1000).contains(&size));
        }
        count
    }

    /// The share of the sea at these distances from the coast that is a shelf.
    fn shelf(&self, heights: &Grid, ring: &std::ops::Range<f64>) -> f64 {
        let within = || self.away.iter().zip(heights.data()).filter(|(away, _)| **away > 0.0 && ring.contains(*away));
        within().filter(|(_, height)| **height > SHELF).count() as f64 / within().count() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Window;

    #[test]
    fn a_straight_coast_has_dimension_one_and_its_shelf() {
        // Land west of column 128, and an island of one cell.
        let height = |q: usize| match (q % 256, q / 256) {
            (0..128, _) | (200, 40) => 100.0,
            (128..132, _) => -100.0,
            _ => -3000.0,
        };
        let heights = Grid::from_data(Window::new(256, 256, CELL), (0..256 * 256).map(height).collect()).expect("fits");
        let coast = Coast::new(&heights);
        assert!((coast.dimension() - 1.0).abs() < 0.03, "{}", coast.dimension());
        assert_eq!(coast.islands(), 1);
        assert!(coast.shelf(&heights, &RINGS[0]) > 0.9 && coast.shelf(&heights, &RINGS[2]) < 0.02);
    }
}
