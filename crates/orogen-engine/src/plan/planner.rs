//! The planner: from a recipe and a window to a plan, in passes.
//!
//! | pass | from | to |
//! |---|---|---|
//! | `schedule` | layers over a window, nodes that are kept as grids | steps in reverse order, which read requests |
//! | `compile`, in it | layers over a window | a program, the requests for grids that it reads |
//! | `grid_merge`, in it | requests | fewer, larger grids |
//! | `keep` | what the programs of a schedule evaluate | nodes to be kept as grids |
//! | `assemble` | a schedule | a plan without solvers |
//! | `solves` | the solvers that the steps read | solvers in order |
//! | `memory` | a plan, the memory allowed | the same plan with solvers on disk |

use super::assemble::assemble;
use super::memory;
use super::resolved::ResolvedRecipe;
use super::schedule::{Asked, schedule};
use super::steps::Plan;
use crate::recipe::graph::Link;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use std::collections::HashSet;

/// Sides of solvers' tiles, in order of preference: large enough to keep the cost of halos small, small enough for any
/// memory.
pub const TILES: [usize; 3] = [1024, 512, 256];

/// A planner for one recipe.
pub struct Planner<'a> {
    pub(super) resolved: &'a ResolvedRecipe,
    /// Side of the tiles in which solvers' sources are made, in samples.
    pub(super) side: usize,
    /// Number of threads that the plan will run on.
    pub(super) threads: usize,
}

impl<'a> Planner<'a> {
    /// A planner for a recipe.
    #[must_use]
    pub fn new(resolved: &'a ResolvedRecipe) -> Planner<'a> {
        Planner { resolved, side: TILES[0], threads: 1 }
    }

    /// A plan for layers over a window that needs at most `allowed` bytes on `threads` threads, if possible: large
    /// solutions are moved to disk, and solvers' sources are made in smaller tiles.
    ///
    /// # Errors
    /// The errors of [`Planner::plan`]. A plan that does not fit is not an error; it is the one that needs least
    /// memory.
    pub fn fitting(
        self,
        targets: &[Link],
        window: Window,
        scattered: bool,
        threads: usize,
        allowed: Option<u64>,
    ) -> Result<Plan> {
        let mut planner = Planner { threads, ..self };
        let mut smallest = planner.plan(targets, window, scattered)?;
        let Some(allowed) = allowed else { return Ok(smallest) };
        if memory::fit(&mut smallest, &planner.resolved.recipe, threads, allowed) || smallest.solves.is_empty() {
            return Ok(smallest);
        }
        for side in TILES.into_iter().skip(1) {
            planner.side = side;
            let mut plan = planner.plan(targets, window, scattered)?;
            if memory::fit(&mut plan, &planner.resolved.recipe, threads, allowed) {
                return Ok(plan);
            }
            let needed = |plan: &Plan| memory::needed(plan, &planner.resolved.recipe, threads);
            if needed(&plan) < needed(&smallest) {
                smallest = plan;
            }
        }
        Ok(smallest)
    }

    /// A plan for layers over a window.
    ///
    /// # Errors
    /// If nested warps lead to more evaluations than can be planned.
    pub fn plan(&self, targets: &[Link], window: Window, scattered: bool) -> Result<Plan> {
        let mut plan = self.steps(&Asked { targets, window, scattered })?;
        plan.recipe = self.resolved.identity;
        plan.solves = self.solves(plan.solvers_read())?;
        Ok(plan)
    }

    /// A plan for a solver's source over a tile. The solvers that it reads are solved by then, so they are not part of
    /// it.
    pub fn source(&self, link: Link, tile: Window) -> Result<Plan> {
        self.steps(&Asked { targets: &[link], window: tile, scattered: false })
    }

    /// The steps of a plan, without solvers. First, results that are grids anyway are read instead of computed again;
    /// then expensive nodes that several programs compute are kept.
    fn steps(&self, asked: &Asked) -> Result<Plan> {
        let mut kept = HashSet::new();
        let mut steps = schedule(self.resolved, &kept, asked)?;
        let more = steps.evaluations.of_grids();
        if !more.is_empty() {
            kept.extend(more);
            steps = schedule(self.resolved, &kept, asked)?;
        }
        let more = steps.evaluations.of_expensive_fields(&self.resolved.recipe);
        if !more.is_empty() {
            kept.extend(more);
            steps = schedule(self.resolved, &kept, asked)?;
        }
        assemble(steps, asked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::document::{Recipe, WorldSpec};
    use crate::recipe::graph::{Graph, LayerRef};
    use orogen_grid::error::ErrorKind;
    use orogen_ops::field::Fbm;
    use orogen_ops::filter::Blur;
    use orogen_ops::ids::{Id, NodeId};

    #[test]
    fn broken_invariants_are_internal_errors() {
        let mut recipe = Recipe::new(WorldSpec::default());
        recipe.add("noise", Fbm::default()).add("soft", Blur { source: "noise".into(), ..Blur::default() });
        recipe.output("height", "soft");
        let graph = Graph::resolve(&recipe).unwrap();
        let window = Window::new(16, 16, 10.0);
        let planned = |graph: &Graph, target: Link| {
            let resolved = ResolvedRecipe::new(recipe.clone(), graph.clone());
            Planner::new(&resolved).plan(&[target], window, false)
        };
        let soft = NodeId::new(1);
        assert!(planned(&graph, Link::Node(LayerRef { node: soft, layer: 0 })).is_ok());
        let unordered = Graph { order: vec![NodeId::new(0)], ..graph.clone() };
        for (graph, target, said) in [
            (&graph, Link::None, "an input that is not given was read"),
            (&graph, Link::Node(LayerRef { node: soft, layer: 7 }), "a filter has no layer 7"),
            // A filter that is not in the order is never applied.
            (&unordered, Link::Node(LayerRef { node: soft, layer: 0 }), "no step makes a grid that is read"),
        ] {
            let error = planned(graph, target).unwrap_err();
            assert_eq!((error.kind(), error.to_string().contains(said)), (ErrorKind::Internal, true), "{error}");
        }
    }
}
