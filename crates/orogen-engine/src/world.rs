//! Worlds: opened recipes, from which windows and points are requested.

use crate::device::Device;
use crate::engine::inline::PreparedProgram;
use crate::engine::preview::{Preview, may_draft};
use crate::engine::run::Engine;
use crate::plan::domain::world_windows;
use crate::plan::explain::explain;
use crate::plan::key::{Key, link_key};
use crate::plan::planner::Planner;
use crate::plan::resolved::ResolvedRecipe;
use crate::plan::steps::Plan;
use crate::plan::{cost, memory, parts};
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, LayerRef, Link, MAX_SAMPLES};
use crate::recipe::{class, scatter};
use crate::session::{Options, Session};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::{number, suggestion};
use orogen_io::dem::prepared::DEFAULT_MEMORY;
use orogen_ops::budget::{Budget, Reservation};
use orogen_ops::ids::{Id, IndexVec, NodeId};
use orogen_ops::layer::LayerKind;
use orogen_ops::op::{Solution, StepObserver};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// A world, from which any window can be made, at any resolution, always with the same bits.
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
    resolved: ResolvedRecipe,
    session: Session,
    /// Plans for points of layers that need no grids: the same for every point.
    pointwise: Mutex<HashMap<String, Arc<Plan>>>,
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

/// The output from which maps and meshes are made.
pub const HEIGHT: &str = "height";

/// The output with the depth of lakes, in metres, where a recipe has one.
pub const LAKES: &str = "lakes";

/// The smallest and the largest distance between samples, in metres.
pub const CELLS: [f64; 2] = [1e-6, 1e12];

/// Checks a distance between samples.
///
/// # Errors
/// If it is not in the range of [`CELLS`].
pub fn check_cell(cell: f64) -> Result<()> {
    let [least, most] = CELLS;
    if (least..=most).contains(&cell) {
        return Ok(());
    }
    let message = format!("the cell size must be {} to {} m, not {}", number(least), number(most), cell);
    Err(Error::new(ErrorKind::Request, message))
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
    fn in_session(mut recipe: Recipe, session: Session) -> Result<World> {
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

    fn new(recipe: Recipe, graph: Graph, session: Session) -> World {
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

    /// Number of solutions that this world computed (not found in the store).
    pub(crate) fn solutions_made(&self) -> usize {
        self.session.solutions_made() as usize
    }

    /// A plan that only solves nodes and their sources.
    pub(crate) fn plan_to_solve(&self, nodes: &[NodeId]) -> Result<Plan> {
        let links: Vec<Link> = nodes.iter().map(|&node| Link::Node(LayerRef { node, layer: 0 })).collect();
        self.planned(&links, Window::new(1, 1, self.resolved.world_params.cell), false, self.memory_limit())
    }

    /// Runs a plan with an observer of the steps of a node's solver.
    ///
    /// # Errors
    /// The errors of [`World::run`] and of the observer.
    pub(crate) fn run_observed(
        &self,
        plan: &Plan,
        progress: &Progress,
        node: NodeId,
        observer: &(dyn StepObserver + Sync),
    ) -> Result<()> {
        let _running = self.admit(plan, progress)?;
        let engine = Engine { observer: Some((node, observer)), ..self.engine(progress) };
        engine.run(plan).map(drop)
    }

    /// Runs a plan without the session's device.
    ///
    /// # Errors
    /// The errors of [`World::run`].
    pub(crate) fn run_exactly(&self, plan: &Plan, progress: &Progress) -> Result<Vec<Grid>> {
        let _running = self.admit(plan, progress)?;
        self.engine(progress).run(plan)
    }

    /// The nodes in an order where each comes after those that it reads.
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

    /// The window of the whole world with a cell of `cell` metres: a world of length L has round(L / cell) samples
    /// along that side; the sample at its far edge belongs to the neighbor.
    ///
    /// # Errors
    /// If the world is unbounded, or has no samples or more than 2^31 along a side at that cell.
    pub fn full_window(&self, cell: f64) -> Result<Window> {
        let size = self.bounds()?;
        let samples = size.map(|length| (length / cell).round());
        let fault = |why: &str, other: &str| {
            let [width, height] = size;
            let message = format!(
                "the world of {} x {} m has {why} at a cell size of {} m; use a {other} cell",
                number(width),
                number(height),
                number(cell)
            );
            Err(Error::new(ErrorKind::Request, message))
        };
        if !samples.iter().all(|samples| *samples >= 1.0) {
            return fault("no samples", "smaller");
        }
        if samples.iter().any(|samples| *samples > MAX_SAMPLES) {
            return fault("more than 2^31 samples along a side", "larger");
        }
        Ok(Window::new(samples[0] as usize, samples[1] as usize, cell))
    }

    /// The window of the whole world with `samples` along its longer side.
    ///
    /// # Errors
    /// If the world is unbounded, or `samples` is 0.
    pub fn window_fitting(&self, samples: usize) -> Result<Window> {
        let size = self.bounds()?;
        if samples == 0 {
            return Err(Error::new(ErrorKind::Request, "the longer side of the world must have at least 1 sample"));
        }
        let cell = size[0].max(size[1]) / samples as f64;
        let [width, height] = size.map(|length| ((length / cell).round() as usize).max(1));
        Ok(Window::new(width, height, cell))
    }

    fn bounds(&self) -> Result<[f64; 2]> {
        let message = "this world is unbounded; specify a window";
        self.resolved.world_params.size.ok_or_else(|| Error::new(ErrorKind::Request, message))
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

    fn planned(&self, targets: &[Link], window: Window, scattered: bool, allowed: Option<u64>) -> Result<Plan> {
        let planner = Planner::new(&self.resolved);
        let plan = planner.fitting(targets, window, scattered, self.threads(), allowed)?;
        parts::check(&plan, &self.resolved.recipe)?;
        Ok(plan)
    }

    /// Memory limit of a request beside `bytes` that its caller holds.
    fn limit_beside(&self, bytes: u64) -> Option<u64> {
        self.memory_limit().map(|limit| limit.saturating_sub(bytes))
    }

    /// Maximum disk space for running a plan, in bytes, without the cache.
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

    /// Approximate time of a plan on one core, in nanoseconds: for solving what is not solved yet, and for the steps.
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

    /// Whether a [draft](Session::drafting) of a plan would be other land: because its device solves a solver of it
    /// that is chaotic and not solved yet.
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

    /// A hash of everything that a layer depends on: its nodes with their parameters, and what they read of the world
    /// (seed, extent, cell, sea level). Names of nodes are not included.
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

    /// Runs work on this world's threads.
    #[doc(hidden)]
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.session.install(work)
    }

    /// Runs a plan: returns one grid per layer, in the requested order.
    ///
    /// # Errors
    /// If it is a plan of another recipe, needs more memory than allowed (then nothing was started), or was cancelled.
    pub fn run(&self, plan: &Plan, progress: &Progress) -> Result<Vec<Grid>> {
        let _running = self.admit(plan, progress)?;
        let engine = self.engine(progress);
        let session = &self.session;
        let kept = if session.is_draft { &session.drafts } else { &session.previews };
        let preview =
            session.device.as_deref().map(|device| Preview::new(device, kept, &self.resolved, session.is_draft));
        Engine { preview: preview.as_ref(), ..engine }.run(plan)
    }

    /// Makes layers over a window.
    ///
    /// # Errors
    /// The errors of [`World::plan`] and [`World::run`].
    pub fn grids(&self, layers: &[&str], window: &Window, progress: &Progress) -> Result<Vec<Grid>> {
        self.run(&self.plan(layers, window)?, progress)
    }

    /// Makes a layer over a window that may extend beyond the world by the margin of its solvers; the caller holds
    /// `beside` bytes.
    ///
    /// # Errors
    /// The errors of [`World::plan`] and [`World::run`].
    #[doc(hidden)]
    pub fn grid_beside(&self, layer: &str, window: &Window, beside: u64, progress: &Progress) -> Result<Grid> {
        let mut grids = self.grids_beside(&[layer], window, beside, progress)?;
        grids.pop().ok_or_else(|| Error::new(ErrorKind::Request, "no layer was requested"))
    }

    /// [`World::grid_beside`] for several layers, made together.
    ///
    /// # Errors
    /// The errors of [`World::plan`] and [`World::run`].
    #[doc(hidden)]
    pub fn grids_beside(
        &self,
        layers: &[&str],
        window: &Window,
        beside: u64,
        progress: &Progress,
    ) -> Result<Vec<Grid>> {
        let targets = layers.iter().map(|layer| self.target(layer)).collect::<Result<Vec<_>>>()?;
        let plan = self.planned(&targets, *window, false, self.limit_beside(beside))?;
        self.session.budget.afford(self.memory_of(&plan)?.saturating_add(beside))?;
        self.run(&plan, progress)
    }

    /// A plan for layers over a window, and `bytes` that are reserved beside it.
    ///
    /// # Errors
    /// The errors of [`World::plan`]. If both do not fit together, the message has what both need, so that a limit of
    /// that suffices.
    #[doc(hidden)]
    pub fn plan_beside(&self, layers: &[&str], window: &Window, bytes: u64) -> Result<(Plan, Reservation)> {
        let plan = self.plan_within(layers, window, self.limit_beside(bytes))?;
        self.session.budget.afford(self.memory_of(&plan)?.saturating_add(bytes))?;
        Ok((plan, self.session.budget.reserve(bytes)?))
    }

    /// Makes one layer over a window.
    ///
    /// # Errors
    /// The errors of [`World::plan`] and [`World::run`].
    pub fn window(&self, layer: &str, window: &Window) -> Result<Grid> {
        let mut grids = self.grids(&[layer], window, &Progress::none())?;
        grids.pop().ok_or_else(|| Error::new(ErrorKind::Request, "no layer was requested"))
    }

    /// The height at x metres east and y metres south of the origin, in metres.
    ///
    /// # Errors
    /// If the world has no layer `height`, or the position is outside it.
    pub fn height(&self, x: f64, y: f64) -> Result<f32> {
        Ok(self.points(HEIGHT, &[x], &[y])?.first().copied().unwrap_or(f32::NAN))
    }

    /// A layer's values at points, in metres. At lattice points they equal the samples of a window bit for bit (filters
    /// are computed at the world's cell).
    ///
    /// # Errors
    /// If there is no such layer, coordinates are not finite or differ in number, or a point is outside the world.
    pub fn points(&self, layer: &str, x: &[f64], y: &[f64]) -> Result<Vec<f32>> {
        let target = self.target(layer)?;
        let fault = |message: String| Error::new(ErrorKind::Request, message);
        if x.len() != y.len() {
            return Err(fault(format!("{} eastings and {} southings do not have the same length", x.len(), y.len())));
        }
        x.iter().zip(y).try_for_each(|(x, y)| self.check_point(*x, *y))?;
        if x.is_empty() {
            return Ok(Vec::new());
        }
        let known = self.pointwise.lock().unwrap_or_else(PoisonError::into_inner).get(layer).cloned();
        let plan = match known {
            Some(plan) => plan,
            None => {
                let plan = self.planned(&[target], self.around(x, y), true, self.memory_limit())?;
                let plan = Arc::new(plan);
                if plan.is_pointwise() {
                    let mut plans = self.pointwise.lock().unwrap_or_else(PoisonError::into_inner);
                    plans.insert(layer.to_string(), Arc::clone(&plan));
                }
                plan
            }
        };
        let progress = Progress::none();
        let _running = self.admit(&plan, &progress)?;
        let values = self.engine(&progress).run_points(&plan, x, y)?;
        Ok(values.into_iter().next().unwrap_or_default())
    }

    /// Checks that a point is in this world.
    pub(crate) fn check_point(&self, x: f64, y: f64) -> Result<()> {
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        if !(x.is_finite() && y.is_finite()) {
            return fault(format!("({x}, {y}) is not a position: coordinates must be finite"));
        }
        match self.resolved.world_params.size {
            Some([w, h]) if !((0.0..=w).contains(&x) && (0.0..=h).contains(&y)) => {
                fault(format!("({x}, {y}) is outside the world, which extends from (0, 0) to ({w}, {h}) metres"))
            }
            _ => Ok(()),
        }
    }

    /// A plan for points of a layer within `around`, with everything that it needs computed.
    pub(crate) fn ready(&self, layer: &str, around: Window) -> Result<PreparedProgram> {
        let plan = self.planned(&[self.target(layer)?], around, true, self.memory_limit())?;
        let progress = Progress::none();
        let _running = self.admit(&plan, &progress)?;
        let ready = self.engine(&progress).ready(&plan)?;
        ready.ok_or_else(|| Error::new(ErrorKind::Internal, "a plan for points has no program for them"))
    }

    /// The samples at the world's cell around points that the interpolating cubic reads.
    pub(crate) fn around(&self, x: &[f64], y: &[f64]) -> Window {
        let cell = self.resolved.world_params.cell;
        let span = |values: &[f64]| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let first = ((low / cell).floor() as i64).saturating_sub(2);
            let last = ((high / cell).ceil() as i64).saturating_add(2);
            (first, last.saturating_sub(first).saturating_add(1) as usize)
        };
        let ((x, width), (y, height)) = (span(x), span(y));
        Window { x, y, width, height, cell }
    }

    /// Whether the target of a layer depends on the altitude.
    pub(crate) fn depends_on_altitude(&self, target: &Link) -> bool {
        matches!(target, Link::Node(target) if self.resolved.graph.in_space[target.node])
    }

    /// The samples of a target over a window at each altitude, slice by slice, which take `bytes` of memory.
    pub(crate) fn in_space(&self, target: Link, window: &Window, altitudes: &[f64], bytes: u64) -> Result<Vec<f32>> {
        let progress = Progress::none();
        let plan = self.planned(&[target], *window, true, self.limit_beside(bytes))?;
        self.session.budget.afford(self.memory_of(&plan)?.saturating_add(bytes))?;
        let _running = self.admit(&plan, &progress)?;
        self.engine(&progress).volume(&plan, altitudes)
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

    /// Checks that a window is valid for this world.
    #[doc(hidden)]
    pub fn check(&self, window: &Window) -> Result<()> {
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        check_cell(window.cell)?;
        if window.is_empty() {
            return fault(format!("a window of {} x {} samples is empty", window.width, window.height));
        }
        if window.width.max(window.height) as f64 > MAX_SAMPLES {
            return fault(format!(
                "a window of {} x {} samples is too large: it may have {MAX_SAMPLES:.0} along a side; use a smaller window or a larger cell",
                window.width, window.height
            ));
        }
        const FAR: i64 = 1 << 53;
        let inside = |start: i64, count: usize| (-FAR..=FAR).contains(&start) && start + count as i64 <= FAR;
        if !(inside(window.x, window.width) && inside(window.y, window.height)) {
            return fault(format!(
                "the window of {} x {} samples at ({}, {}) is more than 2^53 samples, {} m, from the origin, where positions are no longer exact",
                window.width,
                window.height,
                window.x,
                window.y,
                number(FAR as f64 * window.cell)
            ));
        }
        if let Some(size) = self.resolved.world_params.size {
            let (world, _) = world_windows(size, window.cell);
            if !world.contains(window) {
                return fault(format!(
                    "the window of {} x {} samples at ({}, {}) is not inside the world, which at a cell of {} m has samples \
                     (0, 0) to ({}, {})",
                    window.width,
                    window.height,
                    window.x,
                    window.y,
                    number(window.cell),
                    world.width - 1,
                    world.height - 1
                ));
            }
        }
        Ok(())
    }

    /// A window extended by `reach` samples on each side, as far as the world extends.
    #[doc(hidden)]
    pub fn surroundings(&self, window: &Window, reach: usize) -> Window {
        let wide = window.grown(reach);
        let wide = match self.resolved.world_params.size {
            Some(size) => wide.intersection(&world_windows(size, window.cell).0),
            None => wide,
        };
        // An unbounded world ends where positions are no longer exact.
        if self.check(&wide).is_ok() { wide } else { *window }
    }

    /// Checks that there is memory for a window's samples.
    pub(crate) fn afford_grid(&self, window: &Window) -> Result<()> {
        self.session.budget.afford((window.width as u64).saturating_mul(window.height as u64).saturating_mul(4))
    }

    /// Rejects a plan of another recipe, whose nodes are not these.
    fn check_plan(&self, plan: &Plan) -> Result<()> {
        if plan.recipe == self.resolved.identity {
            return Ok(());
        }
        let message =
            "the plan was made for another recipe or another state of this one: make it again with `World::plan`";
        Err(Error::new(ErrorKind::Request, message))
    }

    /// Reserves the memory that a plan needs, and drops other solutions to make room. Rejects a plan of another recipe.
    fn admit(&self, plan: &Plan, progress: &Progress) -> Result<Reservation> {
        let running = self.session.budget.admit(self.memory_of(plan)?, progress)?;
        let keys: IndexVec<NodeId, Key> = plan.solves.iter().map(|solve| solve.key).collect();
        self.session.make_room(&keys);
        Ok(running)
    }
}
