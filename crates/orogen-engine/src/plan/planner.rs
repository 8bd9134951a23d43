//! The planner: from a recipe and a window to a plan.

use super::compile::{Compiler, Draft, GridRequest};
use super::cost;
use super::domain::Domain;
use super::grid_merge::clusters;
use super::key::{Key, identity};
use super::memory;
use super::program::{Instruction, Program};
use super::steps::{GridSlot, Plan, Solve, Step};
use crate::op::{Op, WorldParams};
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, LayerRef, Link};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Sides of solvers' tiles, in order of preference: large enough to keep the cost of halos small, small enough for any
/// memory.
pub const TILES: [usize; 3] = [1024, 512, 256];

/// A planner for one recipe.
pub struct Planner<'a> {
    recipe: &'a Recipe,
    graph: &'a Graph,
    world_params: WorldParams,
    keys: &'a [Key],
    /// Side of the tiles in which solvers' sources are made, in samples.
    side: usize,
    /// Number of threads that the plan will run on.
    threads: usize,
}

impl<'a> Planner<'a> {
    /// A planner for a resolved recipe and the content keys of its nodes.
    #[must_use]
    pub fn new(recipe: &'a Recipe, graph: &'a Graph, keys: &'a [Key]) -> Planner<'a> {
        Planner { recipe, graph, world_params: recipe.world.world_params(), keys, side: TILES[0], threads: 1 }
    }

    /// A plan for layers over a window that needs at most `allowed` bytes on `threads` threads, if possible: large
    /// solutions are moved to disk, and solvers' sources are made in smaller tiles.
    ///
    /// # Errors
    /// The errors of [`Planner::plan`]. A plan that does not fit is not an error; its memory tells.
    pub fn fitting(
        self,
        targets: &[Link],
        window: Window,
        scattered: bool,
        threads: usize,
        allowed: Option<u64>,
    ) -> Result<Plan> {
        let mut planner = Planner { threads, ..self };
        let mut first = planner.plan(targets, window, scattered)?;
        let Some(allowed) = allowed else { return Ok(first) };
        if memory::fit(&mut first, planner.recipe, threads, allowed) || first.solves.is_empty() {
            return Ok(first);
        }
        for side in TILES.into_iter().skip(1) {
            planner.side = side;
            let mut plan = planner.plan(targets, window, scattered)?;
            if memory::fit(&mut plan, planner.recipe, threads, allowed) {
                return Ok(plan);
            }
        }
        Ok(first)
    }

    /// A plan for layers over a window.
    ///
    /// # Errors
    /// If nested warps lead to more evaluations than can be planned.
    pub fn plan(&self, targets: &[Link], window: Window, scattered: bool) -> Result<Plan> {
        let mut plan = self.steps(targets, window, scattered)?;
        plan.recipe = identity(self.keys);
        plan.solves = self.solves(plan.solvers_read())?;
        Ok(plan)
    }

    /// A plan for a solver's source over a tile. The solvers that it reads are solved by then, so they are not part of
    /// it.
    pub fn source(&self, link: Link, tile: Window) -> Result<Plan> {
        self.steps(&[link], tile, false)
    }

    /// The steps of a plan, without solvers.
    fn steps(&self, targets: &[Link], window: Window, scattered: bool) -> Result<Plan> {
        // First, results that are grids anyway are read instead of computed again; then expensive nodes that several
        // programs compute are kept.
        let mut kept = HashSet::new();
        let mut attempt = Attempt::new(self, HashSet::new(), scattered).run(targets, window)?;
        for choose in [Attempt::grids_made_again, Attempt::expensive_made_again] {
            let more = choose(&attempt, self);
            if !more.is_empty() {
                kept.extend(more);
                attempt = Attempt::new(self, kept.clone(), scattered).run(targets, window)?;
            }
        }
        Ok(attempt.finish(window))
    }

    fn solve(&self, node: usize) -> Result<Solve> {
        let Op::Solver(solver) = self.recipe.nodes()[node].node.op() else {
            return Err(Error::new(ErrorKind::Internal, "a node that is not a solver was to be solved"));
        };
        let Domain { window: domain, padded } = Domain::of(solver, &self.world_params);
        let window = Window { width: padded.width.min(self.side), height: padded.height.min(self.side), ..padded };
        let share = padded.width as f64 * padded.height as f64 / window.len().max(1) as f64;
        let (mut tile, mut reads, mut samples) = (0, BTreeSet::new(), 0);
        let own_work = solver.cost() * padded.width as f64 * padded.height as f64;
        let mut source_work = 0.0;
        for link in self.graph.links[node].iter().filter(|link| **link != Link::None) {
            let plan = self.source(*link, window)?;
            tile = tile.max(memory::steps(&plan, self.recipe, self.threads));
            samples += (plan.samples() as f64 * share) as u64;
            source_work += cost::steps(&plan, self.recipe) * share;
            reads.append(&mut plan.solvers_read());
        }
        Ok(Solve {
            node,
            key: self.keys[node],
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

    /// The solvers that are read and those that their sources read, sources first.
    fn solves(&self, read: BTreeSet<usize>) -> Result<Vec<Solve>> {
        let mut rank = vec![0usize; self.recipe.nodes().len()];
        self.graph.order.iter().enumerate().for_each(|(position, &node)| rank[node] = position);
        let mut solves: BTreeMap<usize, Solve> = BTreeMap::new();
        let mut waiting: Vec<usize> = read.into_iter().collect();
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
}

/// The steps under construction, last step first: the requests of a step are known before the steps that serve them.
struct Attempt<'a> {
    planner: &'a Planner<'a>,
    kept: HashSet<usize>,
    scattered: bool,
    requests: Vec<GridRequest>,
    /// Requests by node.
    by_node: HashMap<usize, Vec<usize>>,
    /// The grid that serves each request.
    served: Vec<usize>,
    grids: Vec<(Window, usize)>,
    steps: Vec<DraftStep>,
    outputs: Vec<usize>,
    /// Fields that were a step's target, and how often each was evaluated at the block itself.
    filled: HashSet<usize>,
    evaluated: HashMap<usize, usize>,
}

enum DraftStep {
    /// A program whose grids are the requests from `first` on.
    Fill { program: Program, first: usize, window: Window, out: Vec<usize> },
    /// A filter whose inputs are requests.
    Apply { node: usize, inputs: Vec<Option<usize>>, window: Window, halo: usize, out: Vec<Option<usize>> },
}

impl<'a> Attempt<'a> {
    fn new(planner: &'a Planner<'a>, kept: HashSet<usize>, scattered: bool) -> Attempt<'a> {
        Attempt {
            planner,
            kept,
            scattered,
            requests: Vec::new(),
            by_node: HashMap::new(),
            served: Vec::new(),
            grids: Vec::new(),
            steps: Vec::new(),
            outputs: Vec::new(),
            filled: HashSet::new(),
            evaluated: HashMap::new(),
        }
    }

    fn run(mut self, targets: &[Link], window: Window) -> Result<Attempt<'a>> {
        let nothing_kept = HashSet::new();
        // Scattered points are not on a lattice: nothing is kept for them, and filters are interpolated.
        let kept = if self.scattered { nothing_kept } else { self.kept.clone() };
        let draft = Compiler::compile(self.planner.recipe, self.planner.graph, &kept, None, targets, window)?;
        let out = match self.scattered {
            true => Vec::new(),
            false => targets.iter().map(|link| self.grid(window, node_of(link))).collect(),
        };
        self.outputs.clone_from(&out);
        self.fill(draft, window, out);
        // In reverse order: all readers of a node have been planned before the node.
        for &node in self.planner.graph.order.iter().rev() {
            self.make_results(node)?;
            self.make_raw(node)?;
        }
        Ok(self)
    }

    fn grid(&mut self, window: Window, node: usize) -> usize {
        self.grids.push((window, node));
        self.grids.len() - 1
    }

    fn fill(&mut self, draft: Draft, window: Window, out: Vec<usize>) {
        let first = self.requests.len();
        for request in draft.requests {
            self.request(request);
        }
        for node in draft.evaluated {
            *self.evaluated.entry(node).or_default() += 1;
        }
        self.steps.push(DraftStep::Fill { program: draft.program, first, window, out });
    }

    fn request(&mut self, request: GridRequest) -> usize {
        self.requests.push(request);
        self.served.push(usize::MAX);
        let index = self.requests.len() - 1;
        self.by_node.entry(request.target.node).or_default().push(index);
        index
    }

    /// Serves the requests for a node's result: one program per layer.
    fn make_results(&mut self, node: usize) -> Result<()> {
        let mut layers: Vec<usize> = Vec::new();
        for &i in self.by_node.get(&node).into_iter().flatten().filter(|&&i| !self.requests[i].raw) {
            layers.push(self.requests[i].target.layer);
        }
        layers.sort_unstable();
        layers.dedup();
        for layer in layers {
            let wanted: Vec<usize> = self.by_node[&node]
                .iter()
                .copied()
                .filter(|&i| !self.requests[i].raw && self.requests[i].target.layer == layer)
                .collect();
            for cluster in clusters(&self.requests, wanted.into_iter()) {
                let target = Link::Node(LayerRef { node, layer });
                let draft = Compiler::compile(
                    self.planner.recipe,
                    self.planner.graph,
                    &self.kept,
                    Some(node),
                    &[target],
                    cluster.window,
                )?;
                let grid = self.grid(cluster.window, node);
                cluster.serves.iter().for_each(|&i| self.served[i] = grid);
                self.filled.insert(node);
                self.fill(draft, cluster.window, vec![grid]);
            }
        }
        Ok(())
    }

    /// Serves the requests for a filter's own layers: one application for all of them.
    fn make_raw(&mut self, node: usize) -> Result<()> {
        let Op::Filter(filter) = self.planner.recipe.nodes()[node].node.op() else { return Ok(()) };
        let wanted: Vec<usize> =
            self.by_node.get(&node).into_iter().flatten().copied().filter(|&i| self.requests[i].raw).collect();
        for cluster in clusters(&self.requests, wanted.into_iter()) {
            let window = cluster.window;
            let layers = self.planner.recipe.nodes()[node].node.layers().len();
            let mut out: Vec<Option<usize>> = vec![None; layers];
            for &i in &cluster.serves {
                let Some(slot) = out.get_mut(self.requests[i].target.layer) else { continue };
                self.served[i] = *slot.get_or_insert_with(|| {
                    self.grids.push((window, node));
                    self.grids.len() - 1
                });
            }
            let halo = filter.halo(window.cell);
            let grown = window.grown(halo);
            let graph = self.planner.graph;
            let mut inputs = Vec::new();
            let mut constants = Vec::new();
            for link in &graph.links[node] {
                inputs.push(match link {
                    Link::None => None,
                    Link::Value(_) => {
                        constants.push((inputs.len(), *link));
                        None
                    }
                    Link::Node(target) => {
                        let source = &self.planner.recipe.nodes()[target.node].node;
                        let raw = matches!(source.op(), Op::Filter(_)) && graph.masks[target.node] == Link::None;
                        Some(self.request(GridRequest { target: *target, raw, window: grown }))
                    }
                });
            }
            // A constant input becomes a grid with that value, filled by a step right before.
            let mut fills = Vec::new();
            for (i, link) in constants {
                let index = self.requests.len();
                self.requests.push(GridRequest { target: LayerRef { node, layer: 0 }, raw: false, window: grown });
                let grid = self.grid(grown, node);
                self.served.push(grid);
                inputs[i] = Some(index);
                let none = HashSet::new();
                fills.push((
                    Compiler::compile(self.planner.recipe, graph, &none, None, &[link], grown)?,
                    grown,
                    vec![grid],
                ));
            }
            self.steps.push(DraftStep::Apply { node, inputs, window, halo, out });
            for (draft, window, out) in fills {
                self.fill(draft, window, out);
            }
        }
        Ok(())
    }

    /// Nodes that were made for a filter and that other programs compute again.
    fn grids_made_again(&self, _: &Planner) -> HashSet<usize> {
        self.filled.iter().filter(|node| self.evaluated.get(node).is_some_and(|count| *count >= 2)).copied().collect()
    }

    /// Expensive fields that several programs compute.
    fn expensive_made_again(&self, planner: &Planner) -> HashSet<usize> {
        const EXPENSIVE: f64 = 1.0;
        let is_expensive = |node: &usize| match planner.recipe.nodes()[*node].node.op() {
            Op::Field(field) => field.cost() >= EXPENSIVE,
            _ => false,
        };
        let again = self.evaluated.iter().filter(|(_, count)| **count >= 2).map(|(node, _)| *node);
        again.filter(is_expensive).collect()
    }

    fn finish(self, window: Window) -> Plan {
        let served = self.served;
        let mut steps: Vec<Step> = self
            .steps
            .into_iter()
            .map(|step| match step {
                DraftStep::Fill { mut program, first, window, out } => {
                    for instruction in &mut program.instructions {
                        if let Instruction::Grid { grid, .. } = instruction {
                            *grid = served[first + *grid];
                        }
                    }
                    Step::Fill { program, window, out }
                }
                DraftStep::Apply { node, inputs, window, halo, out } => {
                    let inputs = inputs.into_iter().map(|input| input.map(|request| served[request])).collect();
                    Step::Apply { node, inputs, window, halo, out }
                }
            })
            .collect();
        steps.reverse();
        let mut grids: Vec<GridSlot> =
            self.grids.into_iter().map(|(window, node)| GridSlot { window, node, last_use: 0 }).collect();
        for (at, step) in steps.iter().enumerate() {
            for grid in step.reads().into_iter().chain(step.writes()) {
                grids[grid].last_use = grids[grid].last_use.max(at);
            }
        }
        self.outputs.iter().for_each(|&grid| grids[grid].last_use = steps.len());
        let recipe = Key::default();
        Plan { recipe, window, scattered: self.scattered, solves: Vec::new(), steps, grids, outputs: self.outputs }
    }
}

fn node_of(link: &Link) -> usize {
    match link {
        Link::Node(target) => target.node,
        _ => usize::MAX,
    }
}
