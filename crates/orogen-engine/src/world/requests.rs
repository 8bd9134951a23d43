//! Requests: admission and execution of a world's plans.

use super::world::World;
use crate::engine::inline::PreparedProgram;
use crate::engine::preview::Preview;
use crate::engine::run::Engine;
use crate::plan::key::Key;
use crate::plan::parts;
use crate::plan::steps::Plan;
use crate::recipe::graph::Link;
use crate::recipe::outputs::HEIGHT;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::dem::prepared::{DEFAULT_MEMORY, PreparedDem};
use orogen_ops::budget::Reservation;
use orogen_ops::ids::{IndexVec, NodeId};
use orogen_ops::op::StepObserver;
use std::sync::{Arc, PoisonError};

/// What a running request holds.
pub(super) struct Running {
    _memory: Reservation,
    /// The windows of files that it reads.
    _heights: Vec<Arc<PreparedDem>>,
}

impl World {
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
    /// another `beside` bytes of memory.
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

    /// A plan for layers over a window, and a reservation of another `bytes`.
    ///
    /// # Errors
    /// The errors of [`World::plan`]. If both do not fit together, the message has the memory that both need, which
    /// suffices as a limit.
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

    /// A plan for points of a layer within `around`, with everything that it needs computed.
    pub(crate) fn ready(&self, layer: &str, around: Window) -> Result<PreparedProgram> {
        let plan = self.planned(&[self.target(layer)?], around, true, self.memory_limit())?;
        let progress = Progress::none();
        let _running = self.admit(&plan, &progress)?;
        let ready = self.engine(&progress).ready(&plan)?;
        ready.ok_or_else(|| Error::new(ErrorKind::Internal, "a plan for points has no program for them"))
    }

    /// The samples of a target over a window at each altitude, slice by slice, which take `bytes` of memory.
    pub(crate) fn in_space(&self, target: Link, window: &Window, altitudes: &[f64], bytes: u64) -> Result<Vec<f32>> {
        let progress = Progress::none();
        let plan = self.planned(&[target], *window, true, self.limit_beside(bytes))?;
        self.session.budget.afford(self.memory_of(&plan)?.saturating_add(bytes))?;
        let _running = self.admit(&plan, &progress)?;
        self.engine(&progress).volume(&plan, altitudes)
    }

    /// Runs work on this world's threads.
    #[doc(hidden)]
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.session.install(work)
    }

    /// Reserves the memory that a plan needs, drops other solutions to make room, and reads the windows of large files
    /// that it needs. Rejects a plan of another recipe.
    pub(super) fn admit(&self, plan: &Plan, progress: &Progress) -> Result<Running> {
        let needed = self.memory_of(plan)?;
        let memory = self.session.budget.admit(needed, progress)?;
        let keys: IndexVec<NodeId, Key> = plan.solves.iter().map(|solve| solve.key).collect();
        self.session.make_room(&keys);
        let recipe = &self.resolved.recipe;
        // Heights that fill large holes are not known before they are read; they may take what the rest of the plan
        // leaves of the limit.
        let rest = needed.saturating_sub(parts::memory(plan, recipe));
        let heights = parts::read(plan, recipe, self.limit_beside(rest).unwrap_or(DEFAULT_MEMORY))?;
        Ok(Running { _memory: memory, _heights: heights })
    }

    /// Checks that there is memory for a window's samples.
    pub(crate) fn afford_grid(&self, window: &Window) -> Result<()> {
        self.session.budget.afford((window.width as u64).saturating_mul(window.height as u64).saturating_mul(4))
    }

    /// Rejects a plan of another recipe, which refers to other nodes.
    pub(super) fn check_plan(&self, plan: &Plan) -> Result<()> {
        if plan.recipe == self.resolved.identity {
            return Ok(());
        }
        let message =
            "the plan was made for another recipe or another state of this one: make it again with `World::plan`";
        Err(Error::new(ErrorKind::Request, message))
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
}
