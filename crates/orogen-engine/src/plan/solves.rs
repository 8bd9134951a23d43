//! The solvers of a plan: which ones must be solved, in which order, and their time and memory.

use super::domain::Domain;
use super::planner::Planner;
use super::steps::Solve;
use super::{cost, memory, parts};
use crate::recipe::graph::Link;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_ops::ids::{Id, IndexVec, NodeId};
use orogen_ops::op::Op;
use std::collections::{BTreeMap, BTreeSet};

impl Planner<'_> {
    /// The solvers in `read` and all solvers that their sources read, sources first.
    pub(super) fn solves(&self, read: BTreeSet<NodeId>) -> Result<Vec<Solve>> {
        let mut rank: IndexVec<NodeId, usize> = vec![0; self.resolved.recipe.nodes().len()].into();
        self.resolved.graph.order.iter().enumerate().for_each(|(position, &node)| rank[node] = position);
        let mut solves: BTreeMap<usize, Solve> = BTreeMap::new();
        let mut waiting: Vec<NodeId> = read.into_iter().collect();
        while let Some(node) = waiting.pop() {
            if solves.contains_key(&rank[node]) {
                continue;
            }
            let solve = self.solve(node)?;
            waiting.extend(&solve.reads);
            solves.insert(rank[node], solve);
        }
        Ok(solves.into_values().collect())
    }

    fn solve(&self, node: NodeId) -> Result<Solve> {
        let Op::Solver(solver) = self.resolved.recipe.nodes()[node.index()].node.op() else {
            return Err(Error::new(ErrorKind::Internal, "a node that is not a solver was to be solved"));
        };
        let Domain { window: domain, padded } = Domain::of(solver, &self.resolved.world_params);
        let window = Window { width: padded.width.min(self.side), height: padded.height.min(self.side), ..padded };
        let share = padded.width as f64 * padded.height as f64 / window.len().max(1) as f64;
        let (mut tile, mut reads, mut samples) = (0, BTreeSet::new(), 0);
        let own_work = solver.cost() * padded.width as f64 * padded.height as f64;
        let mut source_work = 0.0;
        for link in self.resolved.graph.links[node].iter().filter(|link| **link != Link::None) {
            let plan = self.source(*link, window)?;
            let steps = memory::steps(&plan, &self.resolved.recipe, self.threads);
            tile = tile.max(steps.saturating_add(parts::memory_of_tile(&plan, &self.resolved.recipe)));
            samples += (plan.samples() as f64 * share) as u64;
            source_work += cost::steps(&plan, &self.resolved.recipe) * share;
            reads.append(&mut plan.solvers_read());
        }
        Ok(Solve {
            node,
            key: self.resolved.keys[node],
            domain,
            padded,
            rasters: solver.rasters(),
            on_disk: false,
            scratch: solver.scratch(&padded),
            scratch_on_disk: solver.scratch_on_disk(&padded),
            side: self.side,
            tile,
            reads: reads.into_iter().collect(),
            samples,
            source_work,
            own_work,
        })
    }
}
