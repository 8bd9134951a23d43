//! The coarsest level of land that is given: heights and their drainage, from a solver or a real place.

use super::coarsest::jittered;
use super::given::Given;
use super::hash;
use super::level::{Level, invalid};
use super::refinement::Refinement;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::direction::{NONE, STEPS};
use crate::progress::Progress;

/// Samples of what is given beyond a window of the coarsest level.
pub const REACH: usize = 2;

/// Given land at the cell of the coarsest level. Each grid covers the window grown by [`REACH`].
#[derive(Debug, Clone, Copy)]
pub struct Coarse<'a> {
    /// Heights in metres.
    pub height: &'a Grid,
    /// Drainage area in m^2.
    pub flow: &'a Grid,
    /// Codes of the directions of flow.
    pub receiver: Option<&'a Grid>,
}

impl Refinement {
    /// The coarsest level over `window` of given land.
    ///
    /// # Errors
    /// If a parameter is out of range, the window is not one of the level, a grid covers too little, or the work is cancelled.
    pub fn coarsest_of(&self, land: &Coarse, given: &Given, window: &Window, progress: &Progress) -> Result<Level> {
        self.check(0, window)?;
        let read = window.grown(REACH);
        let grids = [Some(land.height), Some(land.flow), land.receiver];
        if grids.into_iter().flatten().any(|grid| !grid.window().contains(&read)) {
            return Err(invalid(format!("level 0 over {window:?} needs the given land over {REACH} more samples")));
        }
        progress.check()?;
        let (cell, cells) = (self.cell_of(0), window.len());
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
                level.east.push(jittered(draw(0)));
                level.south.push(jittered(draw(1)));
                level.height.push(at(land.height, x, y));
                level.area.push((at(land.flow, x, y) / (cell * cell) as f32).max(1.0));
                level.receiver.push(code);
                level.uplift.push(given.uplift(x, y).unwrap_or(0.0));
                level.shore.push((if code < NONE { 0.5 } else { -0.5 } * cell * 1e-3) as f32);
            }
        }
        Ok(level)
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

/// The direction of flow of a sample, so that no two diagonals cross: the flow that ends higher goes to the lower end.
fn uncrossed(land: &Coarse, x: i64, y: i64) -> u8 {
    let code = receiver(land, x, y);
    if code >= NONE || code & 1 == 0 {
        return code;
    }
    let (east, south) = STEPS[usize::from(code)];
    let (east, south) = (east as i64, south as i64);
    // The other diagonal, from beside to below or the other way.
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
    let own_end = height((x + east, y + south));
    if own_end > height(end) || (own_end == height(end) && south > 0) {
        return code_of((end.0 - x, end.1 - y));
    }
    code
}
