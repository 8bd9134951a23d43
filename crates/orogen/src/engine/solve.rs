//! Solves what a plan needs solved.

use super::run::{Engine, Solutions};
use super::tiles::Tiles;
use crate::error::{Error, ErrorKind, Result};
use crate::grid::Window;
use crate::op::{Context, Op, Solution};
use crate::plan::cost;
use crate::plan::planner::Planner;
use crate::plan::steps::{Plan, Solve};
use crate::progress::Progress;
use crate::recipe::graph::Link;
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
                Some(solution) if self.observer.is_none_or(|(node, _)| node != order.node) => {
                    there.insert(order.node, solution);
                }
                _ => {
                    wanted.extend(&order.reads);
                    missing.push(order);
                }
            }
        }
        missing.iter().for_each(|order| self.progress.expect(order.work()));
        for order in missing.into_iter().rev() {
            let part = self.progress.part(order.work());
            let solution = self.store.make(&order.key, || self.solved(order, &there, &part))?;
            part.finish();
            there.insert(order.node, self.moved(order, solution)?);
        }
        Ok(there)
    }

    /// Nanoseconds of one core that solving takes before a plan's steps can be run, about.
    pub fn solving_work(&self, plan: &Plan) -> f64 {
        let mut wanted = plan.solvers_read();
        let mut work = 0.0;
        for order in plan.solves.iter().rev() {
            if wanted.contains(&order.node) && !self.store.has(&order.key) {
                wanted.extend(&order.reads);
                work += order.work();
            }
        }
        work
    }

    /// A solution that two requests made at once may be in memory though this one wants it on disk.
    fn moved(&self, order: &Solve, solution: Arc<Solution>) -> Result<Arc<Solution>> {
        match order.on_disk {
            true => Ok(self.store.find(&order.key, true)?.unwrap_or(solution)),
            false => Ok(solution),
        }
    }

    /// Solves one solver, all that its sources read being there.
    fn solved(&self, order: &Solve, there: &Solutions, progress: &Progress) -> Result<Solution> {
        let Op::Solver(solver) = self.recipe.nodes()[order.node].node.op() else {
            return Err(Error::new(ErrorKind::Recipe, "a node that is no solver was to be solved"));
        };
        let planner = Planner::new(self.recipe, self.graph);
        let [sources, own] = progress.parts([order.source_work, order.own_work]);
        sources.expect(order.source_work);
        let make = |link: Link, tile: Window| {
            let plan = planner.source(link, tile)?;
            self.steps(&plan, there, &sources.part(cost::steps(&plan, self.recipe)))
        };
        let tiles = Tiles { links: &self.graph.links[order.node], order, make: &make, scratch: self.store.scratch() };
        let observer = self.observer.and_then(|(node, observer)| (node == order.node).then_some(observer));
        solver.solve(&tiles, &Context { world_params: self.world_params, progress: &own, observer })
    }
}
