//! Faults for tests of the measurements: layers of single cells changed in every tile that has the cell.

use super::layers::{Tiles, Water};
use orogen::{Result, Window};

/// Tiles with one cell changed; `at` is its column and row on the lattice.
pub fn with_cell<'a>(
    tiles: Tiles<'a>,
    at: [i64; 2],
    change: impl Fn(&mut Water, usize) + 'a,
) -> impl Fn(&Window) -> Result<Water> + 'a {
    move |window| {
        let mut water = tiles(window)?;
        let (i, j) = (at[0] - window.x, at[1] - window.y);
        if (0..window.width as i64).contains(&i) && (0..window.height as i64).contains(&j) {
            change(&mut water, j as usize * window.width + i as usize);
        }
        Ok(water)
    }
}

/// Tiles in which everything from this column on has another `flow`: `change` returns it, in m².
pub fn with_flow_behind<'a>(
    tiles: Tiles<'a>,
    column: i64,
    change: impl Fn(f32) -> f32 + 'a,
) -> impl Fn(&Window) -> Result<Water> + 'a {
    move |window| {
        let mut water = tiles(window)?;
        for (k, flow) in water.flow.data_mut().iter_mut().enumerate() {
            if window.x + (k % window.width) as i64 >= column {
                *flow = change(*flow);
            }
        }
        Ok(water)
    }
}
