//! The coarsest level of given land: heights and their drainage, from a solver or a digital elevation model.

use super::given::Given;
use super::hash::{self, JITTER};
use super::level::{Level, invalid};
use super::refinement::Refinement;
use super::valley::valley;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::direction::{NONE, STEPS};
use crate::progress::Progress;

/// Number of samples of given land beyond a window of the coarsest level.
pub const REACH: usize = 2;

/// Given land at the cell size of the coarsest level. Each grid covers the window grown by [`REACH`].
#[derive(Debug, Clone, Copy)]
pub struct Coarse<'a> {
    /// Heights in metres.
    pub height: &'a Grid,
    /// Drainage area in m^2.
    pub flow: &'a Grid,
    /// Codes of the directions of flow; steepest descent without it.
    pub receiver: Option<&'a Grid>,
}

impl Refinement {
    /// The coarsest level over `window` of given land. The samples of the land are in the middles of the cells, and the
    /// nodes are near them.
    ///
    /// # Errors
    /// If a parameter is out of range, the window does not belong to the level, a grid is too small, or the work is
    /// cancelled.
    pub fn coarsest_of(&self, land: &Coarse, given: &Given, window: &Window, progress: &Progress) -> Result<Level> {
        self.check(0, window)?;
        let read = window.grown(REACH);
        let grids = [Some(land.height), Some(land.flow), land.receiver];
        if grids.into_iter().flatten().any(|grid| !grid.window().contains(&read)) {
            return Err(invalid(format!("level 0 over {window:?} needs the given land over {REACH} more samples")));
        }
        progress.check()?;
        let (cell, cells) = (self.cell_of(0), window.len());
        let rain = given.rain(window);
        let mut level = Level {
            depth: 0,
            window: *window,
            east: Vec::with_capacity(cells),
            south: Vec::with_capacity(cells),
            height: Vec::with_capacity(cells),
            area: Vec::with_capacity(cells),
            receiver: Vec::with_capacity(cells),
            variation: vec![0.0; cells],
            uplift: Vec::with_capacity(cells),
            shore: Vec::with_capacity(cells),
        };
        for y in window.y..window.bottom() {
            for x in window.x..window.right() {
                let draw = |stream| hash::unit(hash::node(self.seed, 0, x, y, stream));
                let code = uncrossed(land, x, y);
                let (east, south) = valley(|east, south| at(land.height, x + east, y + south));
                level.east.push(self.around_middle(east, draw(0)));
                level.south.push(self.around_middle(south, draw(1)));
                level.height.push(at(land.height, x, y));
                let own = rain.as_ref().map_or(1.0, |rain| rain[level.area.len()]);
                level.area.push((at(land.flow, x, y) / (cell * cell) as f32).max(own));
                level.receiver.push(code);
                level.uplift.push(given.uplift(x, y).unwrap_or(0.0));
                level.shore.push((if code < NONE { 0.5 } else { -0.5 } * cell * 1e-3) as f32);
            }
        }
        Ok(level)
    }
}

impl Refinement {
    /// The position of a node in a coarsest cell, 0 to 1. It is between the position of the cell's valley, relative to
    /// the middle, and a random position from `draw`, 0 to 1. Its distance from the middle is at most that on other
    /// levels, and it is within the cell.
    fn around_middle(&self, valley: f32, draw: f32) -> f32 {
        let middle = 0.5 + self.half_finest(0);
        let width = JITTER.min(2.0 * (1.0 - middle));
        let valley = valley.clamp(-0.5 * width, 0.5 * width);
        middle + valley + self.jitter as f32 * (width * (draw - 0.5) - valley)
    }
}

fn at(grid: &Grid, x: i64, y: i64) -> f32 {
    let window = grid.window();
    grid[((x - window.x) as usize, (y - window.y) as usize)]
}

/// The direction of flow of a sample.
fn receiver(land: &Coarse, x: i64, y: i64) -> u8 {
    if let Some(receiver) = land.receiver {
        let code = at(receiver, x, y);
        return if code >= 0.0 { (code as u8).min(NONE) } else { NONE };
    }
    let own = at(land.height, x, y);
    let mut steepest = (0.0, NONE);
    for (code, (east, south)) in (0..).zip(STEPS) {
        let drop = own - at(land.height, x + east as i64, y + south as i64);
        let drop = if code & 1 == 1 { drop * std::f32::consts::FRAC_1_SQRT_2 } else { drop };
        if drop > steepest.0 {
            steepest = (drop, code);
        }
    }
    steepest.1
}

/// The direction of flow of a sample, such that no two diagonals cross. The flow that would end higher is redirected to
/// the lower end.
fn uncrossed(land: &Coarse, x: i64, y: i64) -> u8 {
    let code = receiver(land, x, y);
    if code >= NONE || code & 1 == 0 {
        return code;
    }
    let (east, south) = STEPS[usize::from(code)];
    let (east, south) = (east as i64, south as i64);
    // The other diagonal, from the cell next to this one to the cell below it, or the opposite direction.
    let (beside, below) = ((x + east, y), (x, y + south));
    let code_of = |step: (i64, i64)| {
        STEPS.iter().position(|&(east, south)| (east as i64, south as i64) == step).unwrap_or(usize::from(NONE)) as u8
    };
    let end = if receiver(land, beside.0, beside.1) == code_of((-east, south)) {
        below
    } else if receiver(land, below.0, below.1) == code_of((east, -south)) {
        beside
    } else {
        return code;
    };
    let height = |(x, y): (i64, i64)| at(land.height, x, y);
    if height((x + east, y + south)) < height(end) { code } else { code_of((end.0 - x, end.1 - y)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;
    use crate::hydrology::direction::{DISTANCES, strides};

    /// Hills that fall to a valley along the middle row, which falls to the east, and drainage areas by steepest
    /// descent.
    fn valley(window: Window) -> (Grid, Grid) {
        let mut height = Grid::filled(window, 0.0f32);
        for j in 0..window.height {
            for i in 0..window.width {
                let (x, y) = (window.x + i as i64, window.y + j as i64);
                let rough = hash::unit(hash::node(5, 0, x, y, 77));
                height[(i, j)] = 4000.0 - 25.0 * x as f32 + 40.0 * y.abs() as f32 + 20.0 * rough;
            }
        }
        let mut flow = Grid::filled(window, 960.0 * 960.0f32);
        let mut order: Vec<usize> = (0..window.len()).collect();
        order.sort_by(|a, b| height.data()[*b].total_cmp(&height.data()[*a]));
        let steps = strides(window.width);
        for q in order {
            let (i, j) = (q % window.width, q / window.width);
            if (1..window.width - 1).contains(&i) && (1..window.height - 1).contains(&j) {
                let land = Coarse { height: &height, flow: &flow, receiver: None };
                let code = receiver(&land, window.x + i as i64, window.y + j as i64);
                if code < NONE {
                    let (to, area) = (q.wrapping_add_signed(steps[usize::from(code)]), flow.data()[q]);
                    flow.data_mut()[to] += area;
                }
            }
        }
        (height, flow)
    }

    fn refinement() -> Refinement {
        Refinement::new(9).with_levels(4)
    }

    #[test]
    fn rivers_keep_their_area_and_fall_through_all_levels() {
        let land = refinement();
        let window = Window::new(80, 80, land.cell_of(0)).at(-40, -40);
        let (height, flow) = valley(window.grown(REACH));
        let coarse = Coarse { height: &height, flow: &flow, receiver: None };
        let mut level = land.coarsest_of(&coarse, &Given::default(), &window, &Progress::none()).unwrap();
        assert_eq!(level.height, height.crop(&window).unwrap().data());
        let mut inner = window;
        for depth in 1..=4 {
            let reach = land.reach(depth) as i64;
            let (x, y) = (2 * (inner.x + reach), 2 * (inner.y + reach));
            let side = 2 * (inner.width - 2 * reach as usize) - 2;
            let next = Window::new(side, side, land.cell_of(depth)).at(x, y);
            level = land.refine(&level, &Given::default(), &next, &Progress::none()).unwrap();
            inner = next;
            // The river along the middle of the land: the largest area of each column.
            let cell = land.cell_of(depth);
            let mut kept = 0;
            for i in 0..side {
                let column = (0..side).map(|j| j * side + i);
                let river = column.max_by(|a, b| level.area[*a].total_cmp(&level.area[*b])).unwrap();
                let x = (inner.x + i as i64) >> depth;
                let given = (-4..=4).map(|y| at(&flow, x, y)).fold(0.0, f32::max);
                let area = level.area[river] * (cell * cell) as f32;
                kept += usize::from((0.5..2.0).contains(&(area / given)));
            }
            assert!(kept == side, "level {depth}: the area is kept in {kept} of {side} columns");
            // Each node is above its receiver.
            let steps = strides(side);
            for j in 1..side - 1 {
                for q in j * side + 1..(j + 1) * side - 1 {
                    let code = usize::from(level.receiver[q]);
                    assert!(code < 8, "level {depth}: a pit");
                    let to = q.wrapping_add_signed(steps[code]);
                    assert!(level.height[q] > level.height[to], "level {depth}: {} m", DISTANCES[code] * cell);
                }
            }
        }
    }

    #[test]
    fn flow_never_crosses() {
        let window = Window::new(60, 60, 960.0);
        let random = |factor: f32, stream: u64| {
            let mut grid = Grid::filled(window.grown(REACH), 0.0f32);
            for (q, value) in grid.data_mut().iter_mut().enumerate() {
                *value = (factor * hash::unit(hash::node(1, 0, q as i64, 0, stream))).floor();
            }
            grid
        };
        // Few different heights, so that some are equal. No flow to the north, so that no two cells drain to each other
        // across a corner.
        let (height, receivers) = (random(9.0, 3), random(5.0, 4));
        let land = Coarse { height: &height, flow: &height, receiver: Some(&receivers) };
        let crossings = |code: &dyn Fn(i64, i64) -> u8| {
            let crosses = |x: i64, y: i64| {
                let down = code(x, y) == 1 || code(x + 1, y + 1) == 5;
                down && (code(x + 1, y) == 3 || code(x, y + 1) == 7)
            };
            (1..58).flat_map(|y| (1..58).map(move |x| (x, y))).filter(|(x, y)| crosses(*x, *y)).count()
        };
        assert!(crossings(&|x, y| receiver(&land, x, y)) > 50);
        assert_eq!(crossings(&|x, y| uncrossed(&land, x, y)), 0);
    }

    #[test]
    fn land_that_is_too_small_is_refused_and_any_values_are_taken() {
        let land = refinement();
        let window = Window::new(40, 40, land.cell_of(0));
        let (height, flow) = valley(window.grown(REACH));
        let none = Progress::none();
        let coarse = Coarse { height: &height, flow: &flow, receiver: None };
        assert!(land.coarsest_of(&coarse, &Given::default(), &window, &none).is_ok());
        let error = land.coarsest_of(&coarse, &Given::default(), &window.grown(1), &none).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Request);
        for value in [f32::NAN, f32::INFINITY, -1e30] {
            let odd = Grid::filled(window.grown(REACH), value);
            let coarse = Coarse { height: &odd, flow: &odd, receiver: Some(&odd) };
            let level = land.coarsest_of(&coarse, &Given::default(), &window, &none).unwrap();
            assert!(level.receiver.iter().all(|code| *code <= NONE) && level.area.iter().all(|area| *area >= 1.0));
        }
    }
}
