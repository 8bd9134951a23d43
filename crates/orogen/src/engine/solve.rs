//! Solves what a plan needs solved.

use super::run::{Engine, Solutions};
use super::tiles::Tiles;
use crate::error::{Error, ErrorKind, Result};
use crate::grid::Window;
use crate::op::{Context, Op, Solution};
use crate::plan::planner::Planner;
use crate::plan::steps::{Plan, Solve};
use crate::recipe::graph::Link;
use std::cell::Cell;
use std::sync::Arc;

impl Engine<'_> {
    /// The solutions that a plan's steps read: found in the store, or made, after those that their own sources read. What only a
    /// solution that is found would read is not even looked for.
    pub(super) fn solve(&self, plan: &Plan) -> Result<Solutions> {
        let mut wanted = plan.solvers_read();
        let (mut there, mut missing) = (Solutions::new(), Vec::new());
        // Sources come first in the plan: backwards, whoever reads a solution is known before the solution is looked for.
        for order in plan.solves.iter().rev() {
            if !wanted.contains(&order.node) {
                continue;
            }
            match self.store.find(&order.key, order.on_disk)? {
                Some(solution) => {
                    there.insert(order.node, solution);
                }
                None => {
                    wanted.extend(&order.reads);
                    missing.push(order);
                }
            }
        }
        missing.iter().for_each(|order| self.progress.expect(order.samples as i64));
        for order in missing.into_iter().rev() {
            let solution = self.store.make(&order.key, || self.solved(order, &there))?;
            there.insert(order.node, self.moved(order, solution)?);
        }
        Ok(there)
    }

    /// A solution that two requests made at once may be in memory though this one wants it on disk.
    fn moved(&self, order: &Solve, solution: Arc<Solution>) -> Result<Arc<Solution>> {
        match order.on_disk {
            true => Ok(self.store.find(&order.key, true)?.unwrap_or(solution)),
            false => Ok(solution),
        }
    }

    /// Solves one solver, all that its sources read being there.
    fn solved(&self, order: &Solve, there: &Solutions) -> Result<Solution> {
        let Op::Solver(solver) = self.recipe.nodes()[order.node].node.op() else {
            return Err(Error::new(ErrorKind::Recipe, "a node that is no solver was to be solved"));
        };
        let planner = Planner::new(self.recipe, self.graph);
        let left = Cell::new(order.samples);
        let make = |link: Link, tile: Window| {
            let plan = planner.source(link, tile)?;
            // How much there is to do was estimated: what is beyond that becomes known now.
            let (samples, expected) = (plan.samples(), left.get());
            left.set(expected.saturating_sub(samples));
            self.progress.expect(samples.saturating_sub(expected) as i64);
            self.steps(&plan, there)
        };
        let tiles = Tiles { links: &self.graph.links[order.node], order, make: &make, scratch: self.store.scratch() };
        let context = Context { setting: self.setting, progress: self.progress };
        let solution = solver.solve(&tiles, &context)?;
        self.progress.expect(-(left.get() as i64));
        Ok(solution)
    }
}
