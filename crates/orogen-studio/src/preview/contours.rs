//! Contour lines of a picture.

use orogen::grid::contour::levels::is_index;
use orogen::grid::contour::{Line, chaikin, levels_every, round_interval, trace};
use orogen::{Grid, Result, Window};
use serde::{Deserialize, Serialize};

use super::statistics::range;

/// Maximum number of levels between the lowest and the highest height if the interval is not given.
const MOST: usize = 25;

/// Maximum number of samples along the longer side of the grid on which lines are traced. With finer grids, lines would
/// have more points than a window can show.
const FINEST: usize = 1024;

/// Contour lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contours {
    /// The interval in metres.
    pub interval: f64,
    /// The lines. Positions are metres east and south of the origin.
    pub lines: Vec<Line>,
}

impl Contours {
    /// The contours of heights; with an `interval` of 0, a round interval is chosen from the range of heights.
    ///
    /// # Errors
    /// If there would be too many levels.
    pub fn of(heights: &Grid, interval: f64) -> Result<Contours> {
        let [low, high] = range(heights.data().iter().copied()).map(f64::from);
        let interval = suiting(interval, [low, high]);
        let levels = levels_every(interval, low, high)?;
        let step = heights.width().max(heights.height()).div_ceil(FINEST);
        let lines = match thinned(heights, step) {
            Some(thin) => trace::contours(&thin, &levels)?,
            None => trace::contours(heights, &levels)?,
        };
        let cell = heights.window().cell * step as f64;
        // Rings around single samples are noise.
        let lines = lines.into_iter().filter(|line| line.length() > 6.0 * cell).map(|line| chaikin(&line, 1));
        Ok(Contours { interval, lines: lines.collect() })
    }

    /// Whether a line is drawn thicker, and labeled.
    #[must_use]
    pub fn is_index(&self, line: &Line) -> bool {
        is_index(line.elevation, self.interval)
    }
}

/// The interval, or if it is 0, a round interval that suits the range of heights.
#[must_use]
pub fn suiting(interval: f64, [low, high]: [f64; 2]) -> f64 {
    if interval > 0.0 { interval } else { round_interval(high - low, MOST) }
}

/// Every `step`-th sample of a grid; `None` if that is all of them.
fn thinned(grid: &Grid, step: usize) -> Option<Grid> {
    if step < 2 {
        return None;
    }
    let window = grid.window();
    let step_of = step as i64;
    // Samples keep their positions: the first one is at a multiple of the step.
    let skip = [window.x, window.y].map(|at| (-at).rem_euclid(step_of) as usize);
    let columns = window.width.checked_sub(skip[0])?.div_ceil(step);
    let rows = window.height.checked_sub(skip[1])?.div_ceil(step);
    let at = [0, 1].map(|k| ([window.x, window.y][k] + skip[k] as i64).div_euclid(step_of));
    let thin = Window::new(columns, rows, window.cell * step as f64).at(at[0], at[1]);
    let mut data = Vec::with_capacity(columns * rows);
    for j in 0..rows {
        let row = grid.row(skip[1] + j * step);
        data.extend((0..columns).filter_map(|i| row.get(skip[0] + i * step)));
    }
    Grid::from_data(thin, data)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope(width: usize, x: i64) -> Grid {
        let window = Window::new(width, 40, 10.0).at(x, -7);
        Grid::from_data(window, (0..40 * width).map(|k| (x + (k % width) as i64) as f32).collect()).unwrap()
    }

    #[test]
    fn lines_are_where_the_heights_are() {
        for (width, x) in [(700, 0), (3000, -1501), (2500, 77)] {
            let grid = slope(width, x);
            let contours = Contours::of(&grid, 100.0).unwrap();
            assert!(contours.lines.len() >= width / 100 - 1);
            for line in &contours.lines {
                assert!(line.points.iter().all(|point| (point[0] - line.elevation * 10.0).abs() < 1e-3), "{line:?}");
            }
            assert!(contours.lines.iter().any(|line| contours.is_index(line)));
        }
    }

    #[test]
    fn intervals_are_round_and_level_ground_has_none() {
        for (relief, expect) in [(2500.0, 100.0), (1000.0, 50.0), (30.0, 2.0)] {
            assert_eq!(suiting(0.0, [0.0, relief]), expect);
        }
        let level = Grid::filled(Window::new(20, 20, 1.0), 5.0);
        assert!(Contours::of(&level, 0.0).unwrap().lines.is_empty());
        assert!(Contours::of(&slope(3000, 0), 1e-3).is_err());
    }
}
