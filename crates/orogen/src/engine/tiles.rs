//! A solver's sources, made tile by tile as it asks.

use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::Sources;
use crate::plan::planner::TILE;
use crate::plan::steps::Solve;
use crate::recipe::graph::Link;

/// The inputs of one solver; `make` makes an input over a tile.
pub struct Tiles<'a> {
    pub links: &'a [Link],
    pub order: &'a Solve,
    pub make: &'a dyn Fn(Link, Window) -> Result<Vec<Grid>>,
}

impl Sources for Tiles<'_> {
    fn world(&self) -> &Window {
        &self.order.world
    }

    fn padded(&self) -> &Window {
        &self.order.padded
    }

    fn each_tile(&self, i: usize, window: &Window, visit: &mut dyn FnMut(&Grid)) -> Result<()> {
        let Some(link) = self.links.get(i).filter(|link| **link != Link::None) else { return Ok(()) };
        for top in (0..window.height).step_by(TILE) {
            for left in (0..window.width).step_by(TILE) {
                let tile = Window {
                    x: window.x + left as i64,
                    y: window.y + top as i64,
                    width: TILE.min(window.width - left),
                    height: TILE.min(window.height - top),
                    cell: window.cell,
                };
                for grid in (self.make)(*link, tile)? {
                    visit(&grid);
                }
            }
        }
        Ok(())
    }
}
