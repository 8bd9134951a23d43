//! Solving the solvers of a plan.

use super::grids::missing;
use super::run::{Engine, Solutions};
use super::tiles::Tiles;
use crate::plan::planner::Planner;
use crate::plan::steps::{Plan, Solve};
use crate::plan::{cost, parts};
use crate::recipe::graph::Link;
use crate::store::solutions::{Begun, Store};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::op::{Op, Solution};
use std::sync::Arc;

impl Engine<'_> {
    /// The solutions that a plan's steps read. They are found in the store, or computed after the solutions that their
    /// sources read. Solvers that only a stored solution would read are skipped.
    pub(crate) fn solve(&self, plan: &Plan) -> Result<Solutions> {
        let mut wanted = plan.solvers_read();
        let (mut there, mut missing) = (Solutions::new(), Vec::new());
        // Sources come first in the plan: in reverse order, all readers of a solution are known before it is looked up.
        for order in plan.solves.iter().rev() {
            if !wanted.contains(&order.node) {
                continue;
            }
            match self.found(order)? {
                Some(solution) if !self.is_observed(order.node) => {
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
            let begun = match self.is_observed(order.node) {
                true => self.kept.store.begin_again(&order.key),
                false => self.store_of(order.node).begin(&order.key, self.may_wait(), &part)?,
            };
            let solution = match begun {
                Begun::Found(solution) => solution,
                // It is stored on a thread of the pool: the calling thread may run work of another request that waits
                // for it.
                Begun::Make(making) => {
                    let made = || Ok::<_, Error>(making.finish(self.solved(order, &there, &part)?, order.work()));
                    self.pool.install(made)?
                }
            };
            part.finish();
            there.insert(order.node, self.moved(order, solution)?);
        }
        Ok(there)
    }

    /// An existing solution: an exact one or, in a preview, one that an earlier preview made.
    fn found(&self, order: &Solve) -> Result<Option<Arc<Solution>>> {
        let exact = self.kept.store.find(&order.key, order.on_disk)?;
        match self.preview {
            Some(preview) if exact.is_none() => preview.kept.store.find(&order.key, order.on_disk),
            _ => Ok(exact),
        }
    }

    /// The store that keeps the solution of a node.
    fn store_of(&self, node: NodeId) -> &Store {
        match self.preview {
            Some(preview) if preview.is_approximate(node) => &preview.kept.store,
            _ => &self.kept.store,
        }
    }

    /// Whether this thread may wait for a solution or a tile that another request is computing. A thread of the pool
    /// may not: that request could be further down its own stack.
    pub(super) fn may_wait(&self) -> bool {
        !self.pool.is_current()
    }

    /// Whether the steps of a node's solver are observed; it is then solved even if its solution is stored.
    fn is_observed(&self, node: NodeId) -> bool {
        self.observer.is_some_and(|(observed, _)| observed == node)
    }

    /// Approximate time of solving before the steps of a plan, on one core, in nanoseconds.
    pub fn solving_work(&self, plan: &Plan) -> f64 {
        let mut wanted = plan.solvers_read();
        let mut work = 0.0;
        for order in plan.solves.iter().rev() {
            if wanted.contains(&order.node) && !self.kept.store.has(&order.key) {
                wanted.extend(&order.reads);
                work += order.work();
            }
        }
        work
    }

    /// Moves a solution to disk if this request needs it there: another request may have computed the same solution in
    /// memory.
    fn moved(&self, order: &Solve, solution: Arc<Solution>) -> Result<Arc<Solution>> {
        match order.on_disk {
            true => Ok(self.store_of(order.node).find(&order.key, true)?.unwrap_or(solution)),
            false => Ok(solution),
        }
    }

    /// Runs one solver. `there` has all solutions that its sources read.
    fn solved(&self, order: &Solve, there: &Solutions, progress: &Progress) -> Result<Solution> {
        let Op::Solver(solver) = self.resolved.recipe.nodes()[order.node.index()].node.op() else {
            return Err(Error::new(ErrorKind::Internal, "a node that is not a solver was to be solved"));
        };
        let planner = Planner::new(self.resolved);
        let [sources, own] = progress.parts([order.source_work, order.own_work]);
        sources.expect(order.source_work);
        let make = |link: Link, tile: Window| {
            let plan = planner.source(link, tile)?;
            let recipe = &self.resolved.recipe;
            let _heights = parts::read(&plan, recipe, parts::memory_of_tile(&plan, recipe))?;
            // The solution is kept, its sources are not. An exact solution has exact sources.
            let preview = self.preview.filter(|preview| preview.is_approximate(order.node));
            let engine = Engine { keeps_grids: false, preview, ..*self };
            engine.steps(&plan, there, &sources.part(cost::steps(&plan, recipe)))
        };
        let links = &self.resolved.graph.links[order.node];
        let tiles = Tiles { spec: solver.spec(), links, order, make: &make, scratch: self.kept.store.scratch() };
        let may = !order.on_disk && !self.is_observed(order.node);
        let made = self.execute(may, |executor| executor.solve(solver, &tiles, &own))?;
        made.done().ok_or_else(|| missing("a solution"))
    }
}
