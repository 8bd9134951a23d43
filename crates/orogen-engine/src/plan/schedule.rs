//! Ordering: turns the requested layers into steps, last step first, so that all requests for a node are known before
//! the steps that serve them.

use super::compile::{Scope, compile};
use super::grid_merge::{Cluster, clusters};
use super::keep::Evaluations;
use super::levels::{self, Serving};
use super::request::{GridRequest, Requests};
use super::steps::{Step, wanted};
use crate::plan::resolved::ResolvedRecipe;
use crate::recipe::graph::{LayerRef, Link};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_ops::ids::{GridId, Id, IndexVec, NodeId, RequestId};
use orogen_ops::op::{Filter, Levelled, Op};
use std::collections::HashSet;

/// The request for which a plan is made.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// The layers.
    pub targets: &'a [Link],
    /// The window.
    pub window: Window,
    /// Whether the layers are evaluated at arbitrary points within the window instead of at its lattice.
    pub scattered: bool,
}

/// A grid to make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DraftGrid {
    /// Its window.
    pub window: Window,
    /// The node it holds; `None` for a constant.
    pub node: Option<NodeId>,
}

/// The steps of a plan, last step first, which still read requests instead of grids.
#[derive(Default)]
pub struct Schedule {
    pub steps: Vec<Step<RequestId>>,
    pub requests: Requests,
    pub grids: IndexVec<GridId, DraftGrid>,
    pub outputs: Vec<GridId>,
    pub evaluations: Evaluations,
}

/// Finds the steps for a request. The results of the nodes in `kept` are read from grids.
///
/// # Errors
/// If nested warps lead to more evaluations than can be planned.
pub fn schedule(resolved: &ResolvedRecipe, kept: &HashSet<NodeId>, asked: &Asked) -> Result<Schedule> {
    let nothing_kept = HashSet::new();
    // Scattered points are not on a lattice: nothing is kept for them, and filters are interpolated.
    let first = Scope { resolved, kept: if asked.scattered { &nothing_kept } else { kept }, own: None };
    let mut scheduler = Scheduler { resolved, kept, schedule: Schedule::default() };
    scheduler.answer(first, asked)?;
    // In reverse order: all readers of a node have been planned before the node.
    for &node in resolved.graph.order.iter().rev() {
        scheduler.make_results(node)?;
        scheduler.make_raw(node)?;
    }
    Ok(scheduler.schedule)
}

/// A constant input, and the grid that is filled with it.
struct Constant {
    link: Link,
    window: Window,
    grid: GridId,
}

struct Scheduler<'a> {
    resolved: &'a ResolvedRecipe,
    kept: &'a HashSet<NodeId>,
    schedule: Schedule,
}

impl Scheduler<'_> {
    /// The last step: a program for the requested layers.
    fn answer(&mut self, scope: Scope, asked: &Asked) -> Result<()> {
        if !asked.scattered {
            let node = |link: &Link| match link {
                Link::Node(target) => Some(target.node),
                Link::Value(_) | Link::None => None,
            };
            self.schedule.outputs = asked
                .targets
                .iter()
                .map(|link| self.schedule.grids.push(DraftGrid { window: asked.window, node: node(link) }))
                .collect();
        }
        self.fill(scope, asked.targets, asked.window, self.schedule.outputs.clone())
    }

    fn grid(&mut self, window: Window, node: NodeId) -> GridId {
        self.schedule.grids.push(DraftGrid { window, node: Some(node) })
    }

    /// A step that fills grids with layers.
    fn fill(&mut self, scope: Scope, targets: &[Link], window: Window, out: Vec<GridId>) -> Result<()> {
        let draft = compile(scope, targets, window, &mut self.schedule.requests)?;
        self.schedule.evaluations.add(&draft.evaluated);
        self.schedule.steps.push(Step::Fill { program: draft.program, window, out });
        Ok(())
    }

    /// Serves the requests for a node's result: one program per layer.
    fn make_results(&mut self, node: NodeId) -> Result<()> {
        let requests = &self.schedule.requests;
        let mut layers: Vec<usize> = requests.of(node, false).map(|id| requests.get(id).target.layer).collect();
        layers.sort_unstable();
        layers.dedup();
        for layer in layers {
            let requests = &self.schedule.requests;
            let wanted = requests.of(node, false).filter(|id| requests.get(*id).target.layer == layer);
            for cluster in clusters(requests, wanted) {
                let grid = self.grid(cluster.window, node);
                cluster.serves.iter().for_each(|id| self.schedule.requests.serve(*id, grid));
                self.schedule.evaluations.fill(node);
                let scope = Scope { resolved: self.resolved, kept: self.kept, own: Some(node) };
                self.fill(scope, &[Link::Node(LayerRef { node, layer })], cluster.window, vec![grid])?;
            }
        }
        Ok(())
    }

    /// Serves the requests for the own layers of a filter or a levelled op: one step for all of them.
    fn make_raw(&mut self, node: NodeId) -> Result<()> {
        let op = self.resolved.recipe.nodes()[node.index()].node.op();
        let requests = &self.schedule.requests;
        for cluster in clusters(requests, requests.of(node, true)) {
            let window = cluster.window;
            let out = self.layers(node, &cluster)?;
            match op {
                Op::Filter(filter) => self.apply(node, filter, window, out)?,
                Op::Levelled(op) => self.refine(node, op, window, out)?,
                Op::Field(_) | Op::Solver(_) => {}
            }
        }
        Ok(())
    }

    /// The grids of the layers that requests read, which serve them.
    fn layers(&mut self, node: NodeId, cluster: &Cluster) -> Result<Vec<Option<GridId>>> {
        let window = cluster.window;
        let mut out: Vec<Option<GridId>> = vec![None; self.resolved.recipe.nodes()[node.index()].node.layers().len()];
        for &id in &cluster.serves {
            let layer = self.schedule.requests.get(id).target.layer;
            let Some(slot) = out.get_mut(layer) else {
                let op = self.resolved.recipe.nodes()[node.index()].node.spec().locality.name();
                return Err(Error::new(ErrorKind::Internal, format!("a {op} has no layer {layer}")));
            };
            let grid = match *slot {
                Some(grid) => grid,
                None => *slot.insert(self.schedule.grids.push(DraftGrid { window, node: Some(node) })),
            };
            self.schedule.requests.serve(id, grid);
        }
        Ok(out)
    }

    fn apply(&mut self, node: NodeId, filter: &dyn Filter, window: Window, out: Vec<Option<GridId>>) -> Result<()> {
        let halo = filter.halo(window.cell);
        let (inputs, constants) = self.inputs(node, window.grown(halo));
        self.schedule.steps.push(Step::Apply { node, inputs, window, halo, out });
        constants.into_iter().try_for_each(|constant| self.fill_constant(constant))
    }

    /// A step that makes layers of a levelled op, with its inputs at each level.
    fn refine(&mut self, node: NodeId, op: &dyn Levelled, window: Window, out: Vec<Option<GridId>>) -> Result<()> {
        Serving::of(&op.levels(), &window).check(
            &op.levels(),
            &window,
            &self.resolved.recipe.nodes()[node.index()].name,
        )?;
        let (mut inputs, mut constants) = (Vec::new(), Vec::new());
        if self.resolved.graph.links[node].iter().any(|link| *link != Link::None) {
            let windows = levels::covering(op, &wanted(&out), &window);
            for (level, window) in windows.into_iter().enumerate() {
                let read = |input: usize| op.reads_input(level, input);
                let (given, more) = self.inputs_read(node, window.grown(op.source_halo(level)), read);
                inputs.push(given);
                constants.extend(more);
            }
        }
        self.schedule.steps.push(Step::Refine { node, inputs, window, out });
        constants.into_iter().try_for_each(|constant| self.fill_constant(constant))
    }

    /// The requests for a node's inputs over a window. A constant input becomes a grid with that value, filled by a
    /// step right before.
    fn inputs(&mut self, node: NodeId, window: Window) -> (Vec<Option<RequestId>>, Vec<Constant>) {
        self.inputs_read(node, window, |_| true)
    }

    /// As [`Scheduler::inputs`], for the inputs whose number is `read`.
    fn inputs_read(
        &mut self,
        node: NodeId,
        window: Window,
        read: impl Fn(usize) -> bool,
    ) -> (Vec<Option<RequestId>>, Vec<Constant>) {
        let graph = &self.resolved.graph;
        let mut inputs: Vec<Option<RequestId>> = Vec::new();
        let mut constants = Vec::new();
        for (number, link) in graph.links[node].iter().enumerate() {
            inputs.push(match link {
                _ if !read(number) => None,
                Link::None => None,
                Link::Value(_) => {
                    let grid = self.grid(window, node);
                    let request = GridRequest { target: LayerRef { node, layer: 0 }, raw: false, window };
                    constants.push(Constant { link: *link, window, grid });
                    Some(self.schedule.requests.add_served(request, grid))
                }
                Link::Node(target) => Some(self.schedule.requests.add(GridRequest::of(self.resolved, *target, window))),
            });
        }
        (inputs, constants)
    }

    fn fill_constant(&mut self, Constant { link, window, grid }: Constant) -> Result<()> {
        let none = HashSet::new();
        let scope = Scope { resolved: self.resolved, kept: &none, own: None };
        self.fill(scope, &[link], window, vec![grid])
    }
}
