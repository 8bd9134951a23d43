//! Solves a solver: makes its sources tile by tile as it asks.

use super::run::Engine;
use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::op::{Context, Op, Solution, Sources};
use crate::plan::planner::{Planner, Solve, TILE};
use crate::recipe::graph::Link;

struct Tiles<'a> {
    engine: &'a Engine<'a>,
    planner: &'a Planner<'a>,
    links: &'a [Link],
    order: &'a Solve,
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
                let plan = self.planner.plan(&[*link], tile, false)?;
                for grid in self.engine.run(&plan)? {
                    visit(&grid);
                }
            }
        }
        Ok(())
    }
}

/// Solves one solver whose own sources' solvers are solved already.
pub fn solve(engine: &Engine, planner: &Planner, order: &Solve) -> Result<Solution> {
    let Op::Solver(solver) = engine.recipe.nodes()[order.node].node.op() else {
        return Err(Error::new(ErrorKind::Recipe, "a node that is no solver was to be solved"));
    };
    let tiles = Tiles { engine, planner, links: &engine.graph.links[order.node], order };
    let context = Context { setting: engine.setting, progress: engine.progress };
    solver.solve(&tiles, &context)
}
