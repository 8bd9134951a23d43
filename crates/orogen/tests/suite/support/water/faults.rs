//! Faults for tests of the measurements: layers of some cells are changed in every tile that contains them.

use super::layers::{Tiles, Water};
use orogen::{Result, Window};

/// Tiles in which `change` is applied to every cell that `chosen` selects by its column and row on the lattice.
pub fn changed<'a>(
    tiles: Tiles<'a>,
    chosen: impl Fn([i64; 2]) -> bool + Sync + 'a,
    change: impl Fn(&mut Water, usize) + Sync + 'a,
) -> impl Fn(&Window) -> Result<Water> + Sync + 'a {
    move |window| {
        let mut water = tiles(window)?;
        for cell in 0..window.len() {
            if chosen([window.x + (cell % window.width) as i64, window.y + (cell / window.width) as i64]) {
                change(&mut water, cell);
            }
        }
        Ok(water)
    }
}
