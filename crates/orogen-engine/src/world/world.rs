//! Worlds: opened recipes, from which windows and points are requested.

use super::session::{Options, Session};
use crate::device::Device;
use crate::engine::preview::may_draft;
use crate::engine::run::Engine;
use crate::plan::explain::explain;
use crate::plan::key::{Key, link_key};
use crate::plan::planner::Planner;
use crate::plan::resolved::ResolvedRecipe;
use crate::plan::steps::Plan;
use crate::plan::{cost, memory, parts};
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, LayerRef, Link};
use crate::recipe::outputs::HEIGHT;
use crate::recipe::{class, scatter};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::suggestion;
use orogen_io::dem::prepared::DEFAULT_MEMORY;
use orogen_ops::budget::Budget;
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::layer::LayerKind;
use orogen_ops::op::Solution;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::{Arc, Mutex};

/// A world: an opened recipe, from which any window can be made at any resolution, always with the same bits.
///
/// ```
/// use orogen_engine::{Recipe, Window, World};
///
/// let recipe = Recipe::parse(
///     r#"
///     orogen = 1
///     [world]
///     seed = 7
///     [nodes.hills]
///     op = "fbm"
///     wavelength = 500
///     [outputs]
///     height = "hills"
///     "#,
///     "example",
/// )?;
/// let world = World::open(recipe)?;
/// let tile = world.window("height", &Window::new(64, 64, 10.0).at(-32, 1_000_000))?;
/// assert_eq!(tile[(3, 5)], world.height(tile.window().east(3), tile.window().south(5))?);
/// # Ok::<(), orogen_engine::Error>(())
/// ```
pub struct World {
    pub(super) resolved: ResolvedRecipe,
    pub(super) session: Session,
    /// Plans for points of layers that need no grids, which are valid for every point.
    pub(super) pointwise: Mutex<HashMap<String, Arc<Plan>>>,
}

impl Session {
    /// Opens a recipe in this session.
    ///
    /// # Errors
    /// If the recipe is not valid, or a file that it names cannot be read.
    pub fn open(&self, recipe: Recipe) -> Result<World> {
        World::in_session(recipe, self.clone())
    }
}

impl World {
    /// Opens a recipe.
    ///
    /// # Errors
    /// If the recipe is not valid: all diagnostics at once.
    pub fn open(recipe: Recipe) -> Result<World> {
        World::with_options(recipe, Options::default())
    }

    /// Opens a recipe with options.
    ///
    /// # Errors
    /// If the recipe is not valid, a file that it names cannot be read, or no threads can be started.
    pub fn with_options(recipe: Recipe, options: Options) -> Result<World> {
        Session::new(options)?.open(recipe)
    }

    /// Opens a recipe in a shared session.
    pub(super) fn in_session(mut recipe: Recipe, session: Session) -> Result<World> {
        scatter::expand::expand(&mut recipe);
        class::expand::expand(&mut recipe)?;
        let graph = Graph::resolve(&recipe).map_err(Graph::error)?;
        recipe.load(session.budget.left().unwrap_or(DEFAULT_MEMORY))?;
        if recipe.outputs().next().is_none() {
            let message = "the recipe has no outputs; add at least one, such as `height`";
            return Err(Error::new(ErrorKind::Recipe, message));
        }
        Ok(World::new(recipe, graph, session))
    }

    pub(super) fn new(recipe: Recipe, graph: Graph, session: Session) -> World {
        World { resolved: ResolvedRecipe::new(recipe, graph), session, pointwise: Mutex::default() }
    }

    /// A world of the same recipe with other parameters, with the same threads and memory limit. Its solutions are not
    /// stored; `solved` are existing ones.
    ///
    /// # Errors
    /// If the recipe is not valid.
    pub(crate) fn variant(&self, recipe: Recipe, solved: Vec<(Key, Arc<Solution>)>) -> Result<World> {
        let graph = Graph::resolve(&recipe).map_err(Graph::error)?;
        Ok(World::new(recipe, graph, self.session.with_solutions(solved)))
    }

    /// The solution stored under a key, if there is one.
    pub(crate) fn solution(&self, key: &Key, on_disk: bool) -> Result<Option<Arc<Solution>>> {
        self.session.kept.store.find(key, on_disk)
    }

    /// Number of solutions that this world computed, without those found in the store.
    pub(crate) fn solutions_made(&self) -> usize {
        self.session.solutions_made() as usize
    }

    /// A plan that only solves nodes and their sources.
    pub(crate) fn plan_to_solve(&self, nodes: &[NodeId]) -> Result<Plan> {
        let links: Vec<Link> = nodes.iter().map(|&node| Link::Node(LayerRef { node, layer: 0 })).collect();
        self.planned(&links, Window::new(1, 1, self.resolved.world_params.cell), false, self.memory_limit())
    }

    /// The nodes in an order where each comes after the nodes that it reads.
    pub(crate) fn order(&self) -> &[NodeId] {
        &self.resolved.graph.order
    }

    /// The layers of nodes that a layer depends on, including masks.
    pub(crate) fn layers_read(&self, layer: &str) -> Result<BTreeSet<LayerRef>> {
        let mut read = BTreeSet::new();
        let mut waiting = vec![self.target(layer)?];
        while let Some(link) = waiting.pop() {
            let Link::Node(target) = link else { continue };
            if read.insert(target) {
                waiting.extend(
                    self.resolved.graph.links[target.node].iter().chain([&self.resolved.graph.masks[target.node]]),
                );
            }
        }
        Ok(read)
    }

    /// The recipe.
    pub fn recipe(&self) -> &Recipe {
        &self.resolved.recipe
    }

    /// A plan for layers over a window.
    ///
    /// # Errors
    /// If there is no such layer, or the window is not valid for this world.
    pub fn plan(&self, layers: &[&str], window: &Window) -> Result<Plan> {
        self.plan_within(layers, window, self.memory_limit())
    }

    /// [`World::plan`] for `allowed` bytes of memory, if possible; `None` for no limit.
    ///
    /// # Errors
    /// The errors of [`World::plan`].
    #[doc(hidden)]
    pub fn plan_within(&self, layers: &[&str], window: &Window, allowed: Option<u64>) -> Result<Plan> {
        let targets = layers.iter().map(|layer| self.target(layer)).collect::<Result<Vec<Link>>>()?;
        self.check(window)?;
        self.planned(&targets, *window, false, allowed)
    }

    /// The session of the world.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The memory budget, which callers can reserve from: see [`Budget::reserve`].
    pub fn budget(&self) -> &Budget {
        &self.session.budget
    }

    /// The folder for data that does not fit in memory.
    pub fn scratch(&self) -> &Path {
        self.session.kept.store.scratch()
    }

    /// Memory limit of a request, in bytes; `None` for no limit.
    pub fn memory_limit(&self) -> Option<u64> {
        self.session.budget.left()
    }

    pub(super) fn planned(
        &self,
        targets: &[Link],
        window: Window,
        scattered: bool,
        allowed: Option<u64>,
    ) -> Result<Plan> {
        let planner = Planner::new(&self.resolved);
        let plan = planner.fitting(targets, window, scattered, self.threads(), allowed)?;
        parts::check(&plan, &self.resolved.recipe)?;
        Ok(plan)
    }

    /// Memory limit of a request whose caller holds another `bytes`.
    pub(super) fn limit_beside(&self, bytes: u64) -> Option<u64> {
        self.memory_limit().map(|limit| limit.saturating_sub(bytes))
    }

    /// Maximum disk space for running a plan, in bytes, without the store.
    pub fn disk_of(&self, plan: &Plan) -> u64 {
        memory::disk(plan)
    }

    /// Maximum memory for running a plan, in bytes.
    ///
    /// # Errors
    /// The plan was made for another recipe.
    pub fn memory_of(&self, plan: &Plan) -> Result<u64> {
        self.check_plan(plan)?;
        Ok(memory::needed(plan, &self.resolved.recipe, self.threads()))
    }

    /// Approximate time of a plan on one core, in nanoseconds: for solvers that are not solved yet, and for the steps.
    ///
    /// # Errors
    /// The plan was made for another recipe.
    #[doc(hidden)]
    pub fn work_of(&self, plan: &Plan) -> Result<[f64; 2]> {
        self.check_plan(plan)?;
        Ok([self.engine(&Progress::none()).solving_work(plan), cost::steps(plan, &self.resolved.recipe)])
    }

    /// Approximate time of a plan on one core, in nanoseconds, without existing solutions: the weight of a
    /// [part](Progress::part) of more work.
    ///
    /// # Errors
    /// The plan was made for another recipe.
    pub fn work(&self, plan: &Plan) -> Result<f64> {
        Ok(self.work_of(plan)?.iter().sum())
    }

    /// Approximate time of a plan's steps on one core, in nanoseconds, without solving.
    pub(crate) fn steps_work(&self, plan: &Plan) -> f64 {
        cost::steps(plan, &self.resolved.recipe)
    }

    /// A description of the plan for users.
    ///
    /// # Errors
    /// The plan was made for another recipe.
    pub fn explain(&self, plan: &Plan) -> Result<String> {
        self.check_plan(plan)?;
        Ok(explain(plan, &self.resolved.recipe, &self.resolved.graph, self.threads()))
    }

    /// The device that computes in place of the processor where exact bits are not needed, if the session has one.
    #[doc(hidden)]
    pub fn device(&self) -> Option<&dyn Device> {
        self.session.device.as_deref()
    }

    /// Whether a [draft](Session::drafting) of a plan would have different terrain, because its device would run a
    /// chaotic solver that is not solved yet.
    ///
    /// # Errors
    /// The plan was made for another recipe.
    #[doc(hidden)]
    pub fn may_draft(&self, plan: &Plan) -> Result<bool> {
        self.check_plan(plan)?;
        Ok(self.session.device.is_some() && may_draft(&self.resolved, &self.session.kept.store, plan))
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.session.threads()
    }

    /// A hash of everything that a layer depends on: its nodes with their parameters, and the properties of the world
    /// that they read (seed, extent, cell, sea level). Names of nodes are not included.
    ///
    /// # Errors
    /// If there is no such layer.
    pub fn key(&self, layer: &str) -> Result<[u8; 32]> {
        Ok(link_key(&self.target(layer)?, &self.resolved.keys))
    }

    /// The unit of a layer: metres for [`HEIGHT`], otherwise the unit that its node declares, which may be empty.
    ///
    /// # Errors
    /// If there is no such layer.
    pub fn unit(&self, layer: &str) -> Result<&'static str> {
        Ok(match self.target(layer)? {
            _ if layer == HEIGHT => "m",
            Link::Node(target) => self.resolved.recipe.nodes()[target.node.index()].node.unit(target.layer),
            _ => "",
        })
    }

    /// The kind of a layer: heights, labels or amounts.
    ///
    /// # Errors
    /// If there is no such layer.
    pub fn kind(&self, layer: &str) -> Result<LayerKind> {
        Ok(match self.target(layer)? {
            Link::Node(target) => self.resolved.graph.layer_kind(&self.resolved.recipe, target),
            _ => LayerKind::Height,
        })
    }

    /// Whether the target of a layer depends on the altitude.
    pub(crate) fn depends_on_altitude(&self, target: &Link) -> bool {
        matches!(target, Link::Node(target) if self.resolved.graph.in_space[target.node])
    }

    pub(crate) fn engine<'a>(&'a self, progress: &'a Progress) -> Engine<'a> {
        Engine {
            resolved: &self.resolved,
            kept: &self.session.kept,
            keeps_grids: true,
            budget: &self.session.budget,
            pool: &self.session.pool,
            progress,
            preview: None,
            observer: None,
        }
    }

    /// The target of a layer's name: an output, otherwise a node or `node.layer`.
    pub(crate) fn target(&self, layer: &str) -> Result<Link> {
        if let Some(index) = self.resolved.recipe.outputs().position(|name| name == layer) {
            return Ok(self.resolved.graph.outputs[index]);
        }
        Graph::find(&self.resolved.recipe, layer).map(Link::Node).map_err(|why| {
            let message = match layer.contains('.') {
                true => format!("unknown layer `{layer}`: {why}"),
                false => {
                    format!("the recipe has no layer `{layer}`; {}", suggestion(layer, self.resolved.recipe.outputs()))
                }
            };
            Error::new(ErrorKind::Request, message)
        })
    }
}
