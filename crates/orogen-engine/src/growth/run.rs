//! An observed run of a recipe's stages.
//!
//! The `stream-power` nodes of a recipe are its stages. They run one after the other, in the order of their
//! dependencies: during the steps of one, earlier stages are complete and later ones have not started. Nodes that no
//! stage affects are solved once. Each stage runs once and is observed. For a requested step, only the nodes downstream
//! of the stage are computed. Frames of stages that others follow are made from drafts.

use super::draft;
use super::frame_spool::FrameSpool;
use crate::plan::key::keys;
use crate::plan::steps::Plan;
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, LayerRef};
use crate::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::fs;
use orogen_io::spool::Spool;
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::layer::LayerKind;
use orogen_ops::node::Node;
use orogen_ops::op::{Solution, StepObserver};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The erosion steps of a layer over a window.
pub struct Growth<'w> {
    world: &'w World,
    layer: String,
    window: Window,
    plan: Plan,
    stages: Vec<Stage>,
    /// The layers that the requested layer depends on.
    read: BTreeSet<LayerRef>,
    /// Whether frames of stages that others follow are made from drafts.
    drafted: bool,
}

/// A node that runs step by step.
#[derive(Debug, Clone, Copy)]
struct Stage {
    node: NodeId,
    years: f64,
    steps: u32,
    /// Number of steps of all earlier stages.
    before: u32,
}

impl Stage {
    /// The step at its end.
    fn end(&self) -> u32 {
        self.before + self.steps
    }
}

/// The solution of a stage.
type Solved = (NodeId, Arc<Solution>);

/// The number of solutions that a run computed, without those found in the store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Solves {
    /// Solutions shared by all frames: of each stage, and of nodes that no stage affects.
    pub shared: usize,
    /// Solutions of single frames: of nodes downstream of the stages.
    pub in_frames: usize,
}

/// Receives a step and the layer after it.
pub type Visit<'a> = &'a (dyn Fn(u32, &Grid) -> Result<()> + Sync);

impl<'w> Growth<'w> {
    /// Finds the stages of a layer.
    ///
    /// # Errors
    /// If there are none, or the errors of [`World::plan`].
    pub fn new(world: &'w World, layer: &str, window: Window) -> Result<Growth<'w>> {
        let plan = world.plan(&[layer], &window)?;
        let solved: BTreeSet<NodeId> = plan.solves.iter().map(|solve| solve.node).collect();
        let mut stages: Vec<Stage> = Vec::new();
        for &node in world.order().iter().filter(|node| solved.contains(node)) {
            if let Node::StreamPower(law) = &world.recipe().nodes()[node.index()].node {
                let before = stages.last().map_or(0, Stage::end);
                stages.push(Stage { node, years: law.years, steps: law.steps, before });
            }
        }
        if stages.is_empty() {
            let message =
                format!("the layer `{layer}` reads no node with op = \"stream-power\", whose steps `grow` draws");
            return Err(Error::new(ErrorKind::Request, message));
        }
        // Labels and flows cannot be blended like heights.
        let drafted = world.kind(layer)? == LayerKind::Height;
        let read = world.layers_read(layer)?;
        Ok(Growth { world, layer: layer.to_string(), window, plan, stages, read, drafted })
    }

    /// Computes every frame in full, which takes several times as long if a recipe has several stages. Each frame then
    /// has the bits of a recipe whose stages have that many steps of the same length.
    #[must_use]
    pub fn in_full(self) -> Growth<'w> {
        Growth { drafted: false, ..self }
    }

    /// Total number of steps of all stages.
    #[must_use]
    pub fn steps(&self) -> u32 {
        self.stages.iter().map(|stage| stage.steps).sum()
    }

    /// Calls `visit` with the layer after each of the steps in `wanted`, in order: 0 is the start, [`Growth::steps`] is
    /// the layer itself.
    ///
    /// Frames of the last stage, and those at the ends of the other stages, have the bits of a recipe whose stages have
    /// that many steps of the same length. The others are approximations: see `draft`.
    ///
    /// # Errors
    /// The errors of [`World::run`] and of `visit`.
    pub fn run(&self, wanted: &BTreeSet<u32>, progress: &Progress, visit: Visit) -> Result<Solves> {
        let before = self.world.solutions_made();
        let solving = self.world.work(&self.plan)?;
        let frame = self.frame_work();
        let drafts = wanted.iter().filter(|step| self.is_drafted(**step)).count();
        let full = (wanted.len() - drafts) as f64;
        progress.expect(solving + frame * (full + DRAFT * drafts as f64));
        let frames = Frames { growth: self, progress, work: frame, solves: AtomicUsize::new(0) };
        // Memory of drafts: a full frame, the difference to its draft, and a frame.
        let samples = if drafts > 0 { 3 * self.window.len() + draft::window(&self.window).len() } else { 0 };
        let _grids = self.world.budget().reserve(4 * samples as u64)?;
        let runs: Vec<usize> = (0..self.stages.len()).filter(|index| self.has_to_run(*index, wanted)).collect();
        let share = solving / runs.len().max(1) as f64;
        let mut waiting = None;
        for index in runs {
            self.settle(index, &progress.part(0.0))?;
            let run = StageRun { stage: self.stages[index], wanted, frames: &frames, visit, waiting };
            waiting = run.run(&progress.part(share))?;
        }
        progress.finish();
        Ok(Solves { shared: self.world.solutions_made() - before, in_frames: frames.solves.into_inner() })
    }

    /// Whether a stage has to run for the wanted frames: for its own, or because drafts of the previous stage need its
    /// first frame.
    fn has_to_run(&self, index: usize, wanted: &BTreeSet<u32>) -> bool {
        let stage = self.stages[index];
        let drafts =
            index > 0 && wanted.range(self.stages[index - 1].before..stage.before).any(|step| self.is_drafted(*step));
        drafts || wanted.range(stage.before..=stage.end()).next().is_some()
    }

    /// Whether the frame after a step is made from a draft: not at the end of a stage, and not in the last stage.
    fn is_drafted(&self, step: u32) -> bool {
        let last = self.stages.last().map_or(0, |stage| stage.before);
        self.drafted && step < last && (step == 0 || self.stages.iter().all(|stage| stage.before != step))
    }

    /// The recipe after this many steps.
    fn recipe(&self, step: u32) -> Recipe {
        let mut recipe = self.world.recipe().clone();
        let mut nodes = (0..).map(NodeId::new);
        recipe.change(|changed| {
            let node = nodes.next();
            let stage = self.stages.iter().find(|stage| Some(stage.node) == node);
            let (Some(stage), Node::StreamPower(law)) = (stage, changed) else { return };
            let done = step.saturating_sub(stage.before).min(stage.steps);
            if done < stage.steps {
                // A stage that has not started runs for zero years: water is still routed.
                law.years = stage.years / f64::from(stage.steps) * f64::from(done);
                law.steps = done.max(1);
            }
        });
        recipe
    }

    /// The solvers that the stages from index `from` affect, including those stages.
    fn is_changed(&self, from: usize) -> BTreeSet<NodeId> {
        let mut changed: BTreeSet<NodeId> = self.stages[from..].iter().map(|stage| stage.node).collect();
        // In a plan, sources come first.
        for solve in &self.plan.solves {
            if solve.reads.iter().any(|read| changed.contains(read)) {
                changed.insert(solve.node);
            }
        }
        changed
    }

    /// Solves the nodes that no stage from this index affects, once for all steps.
    fn settle(&self, stage: usize, progress: &Progress) -> Result<()> {
        let changed = self.is_changed(stage);
        let steady: Vec<NodeId> =
            self.plan.solves.iter().map(|solve| solve.node).filter(|node| !changed.contains(node)).collect();
        if !steady.is_empty() {
            self.world.run_exactly(&self.world.plan_to_solve(&steady)?, progress)?;
        }
        Ok(())
    }

    /// The work of the nodes downstream of the stages, including the final work of each stage.
    fn frame_work(&self) -> f64 {
        let changed = self.is_changed(0);
        let of_stage = |node: NodeId| self.stages.iter().find(|stage| stage.node == node);
        let solves = self.plan.solves.iter().filter(|solve| changed.contains(&solve.node));
        let solving = solves.map(|solve| match of_stage(solve.node) {
            Some(stage) => solve.own_work * 2.0 / f64::from(stage.steps.max(1)),
            None => solve.work(),
        });
        solving.sum::<f64>() + self.world.steps_work(&self.plan)
    }

    /// The spool for frames that wait for the end of their stage.
    fn spool(&self) -> Result<FrameSpool> {
        let folder = self.world.scratch();
        fs::create_dir_all(folder).map_err(|cause| Error::file("work in", folder, &cause))?;
        Ok(FrameSpool::new(Spool::beside(&folder.join("drafts")), draft::window(&self.window)))
    }

    /// The error for a failure of the spool.
    fn lost(&self, cause: &io::Error) -> Error {
        Error::file("work in", self.world.scratch(), cause)
    }
}

/// The work of a draft relative to a frame.
const DRAFT: f64 = 0.1;

/// Computes the layer after a step.
struct Frames<'a> {
    growth: &'a Growth<'a>,
    progress: &'a Progress,
    /// The work of a frame.
    work: f64,
    /// Number of computed solutions.
    solves: AtomicUsize,
}

impl Frames<'_> {
    /// A full frame, from the solution of the stage after the step.
    fn full(&self, step: u32, solved: Option<Solved>) -> Result<Grid> {
        self.make(self.growth.recipe(step), &self.growth.window, solved, self.work)
    }

    /// A draft of the frame after a step, from the solution of the stage; `None` at the start.
    fn draft(&self, step: u32, solved: Option<Solved>) -> Result<Grid> {
        let growth = self.growth;
        let given = solved.as_ref().map(|(node, _)| *node);
        let from = growth.stages.iter().position(|stage| Some(stage.node) == given).map_or(0, |index| index + 1);
        let later = growth.stages[from..].iter().map(|stage| stage.node).collect();
        let recipe = draft::recipe(growth.recipe(step), &later, &growth.window);
        self.make(recipe, &draft::window(&growth.window), solved, self.work * DRAFT)
    }

    fn make(&self, recipe: Recipe, window: &Window, solved: Option<Solved>, work: f64) -> Result<Grid> {
        let growth = self.growth;
        let part = self.progress.part(work);
        let graph = Graph::resolve(&recipe).map_err(Graph::error)?;
        let keys = keys(&recipe, &graph);
        let given = solved.as_ref().map(|(node, _)| *node);
        let from = growth.stages.iter().position(|stage| Some(stage.node) == given).unwrap_or_default();
        let changed = growth.is_changed(from);
        let mut known = BTreeMap::new();
        for solve in &growth.plan.solves {
            let key = keys[solve.node];
            if !changed.contains(&solve.node) {
                // Solutions computed so far, at any cell.
                if let Some(solution) = growth.world.solution(&solve.key, solve.on_disk)? {
                    known.insert(key, solution);
                }
            }
        }
        if let Some((node, solution)) = solved {
            known.insert(keys[node], solution);
        }
        let world = growth.world.variant(recipe, known.into_iter().collect())?;
        let grid = world.grid_beside(&growth.layer, window, 0, &part)?;
        self.solves.fetch_add(world.solutions_made(), Ordering::Relaxed);
        part.finish();
        Ok(grid)
    }
}

/// Drafts of a stage that wait for the frame at its end, which is the first of the next stage.
struct Waiting {
    stage: Stage,
    drafts: Mutex<FrameSpool>,
    /// The draft of that frame.
    end: Grid,
}

/// A running stage and its frames.
struct StageRun<'a> {
    stage: Stage,
    wanted: &'a BTreeSet<u32>,
    frames: &'a Frames<'a>,
    visit: Visit<'a>,
    /// The waiting drafts of the previous stage.
    waiting: Option<Waiting>,
}

impl StageRun<'_> {
    /// Runs the stage and shows its frames, or returns their drafts.
    fn run(&self, progress: &Progress) -> Result<Option<Waiting>> {
        let (growth, stage) = (self.frames.growth, self.stage);
        let drafted = growth.drafted && growth.stages.last().is_some_and(|last| last.node != stage.node);
        let drafts = if drafted { growth.spool()? } else { FrameSpool::new(Spool::in_memory(), growth.window) };
        let drafts = Mutex::new(drafts);
        let keep = |step: u32, draft: &Grid| {
            let mut drafts = drafts.lock().unwrap_or_else(PoisonError::into_inner);
            drafts.put(step, draft).map_err(|cause| growth.lost(&cause))
        };
        if growth.is_drafted(stage.before) && self.wanted.contains(&stage.before) {
            keep(stage.before, &self.frames.draft(stage.before, None)?)?;
        }
        let solved = self.observed(progress, &|step, solved| match drafted && step > stage.before {
            true => keep(step, &self.frames.draft(step, Some(solved))?),
            false => self.show(step, &self.frames.full(step, Some(solved))?),
        })?;
        if drafted {
            let end = self.frames.draft(stage.end(), Some(solved))?;
            return Ok(Some(Waiting { stage, drafts, end }));
        }
        // If another stage follows, it shows this stage's last frame.
        let is_last = growth.steps() == stage.end();
        if is_last && self.wanted.contains(&stage.end()) {
            self.show(stage.end(), &self.frames.full(stage.end(), Some(solved))?)?;
        }
        Ok(None)
    }

    /// Shows a frame; before the first one of the stage, the waiting frames.
    fn show(&self, step: u32, frame: &Grid) -> Result<()> {
        if let Some(waiting) = self.waiting.as_ref().filter(|_| step == self.stage.before) {
            self.show_waiting(waiting, frame)?;
        }
        if self.wanted.contains(&step) { (self.visit)(step, frame) } else { Ok(()) }
    }

    fn show_waiting(&self, Waiting { stage, drafts, end }: &Waiting, frame: &Grid) -> Result<()> {
        let growth = self.frames.growth;
        let lacking = draft::lacking(end, frame);
        let mut drafts = drafts.lock().unwrap_or_else(PoisonError::into_inner);
        for &step in self.wanted.range(stage.before..stage.end()).filter(|step| growth.is_drafted(**step)) {
            self.frames.progress.check()?;
            let share = f64::from(step - stage.before) / f64::from(stage.steps);
            let draft = drafts.get(step).map_err(|cause| growth.lost(&cause))?;
            (self.visit)(step, &draft::frame(&draft, &lacking, draft::share(share)))?;
        }
        Ok(())
    }

    /// Whether the layer after a step is computed: as a frame, as a draft, or for waiting drafts.
    fn makes(&self, step: u32) -> bool {
        let begins = step == self.stage.before;
        if begins && self.waiting.is_some() {
            return true;
        }
        self.wanted.contains(&step) && !(begins && self.frames.growth.is_drafted(step))
    }

    /// Runs the stage; `take` receives its solutions after the steps before the last. Returns the last one.
    fn observed(&self, progress: &Progress, take: &(dyn Fn(u32, Solved) -> Result<()> + Sync)) -> Result<Solved> {
        let growth = self.frames.growth;
        let node = self.stage.node;
        let plan = growth.world.plan_to_solve(&[node])?;
        growth.world.run_observed(&plan, progress, node, &StageObserver { run: self, take })?;
        let solve = plan.solves.iter().find(|solve| solve.node == node);
        let solution = solve.map(|solve| growth.world.solution(&solve.key, solve.on_disk)).transpose()?.flatten();
        let lost = || Error::new(ErrorKind::Request, "a stage's solution was not kept");
        Ok((node, solution.ok_or_else(lost)?))
    }
}

/// Passes on the solutions of a stage after the wanted steps.
struct StageObserver<'a> {
    run: &'a StageRun<'a>,
    take: &'a (dyn Fn(u32, Solved) -> Result<()> + Sync),
}

impl StepObserver for StageObserver<'_> {
    fn wants(&self, step: u32) -> bool {
        self.run.makes(self.run.stage.before + step)
    }

    fn reads(&self, layer: usize) -> bool {
        self.run.frames.growth.read.contains(&LayerRef { node: self.run.stage.node, layer })
    }

    fn take(&self, step: u32, solution: Solution) -> Result<()> {
        (self.take)(self.run.stage.before + step, (self.run.stage.node, Arc::new(solution)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    /// Coarse rivers, then fine ones on the result; `land` does not depend on them, `filled` depends on both.
    const STAGES: &str = r#"
        orogen = 1
        [world]
        size = [6000, 4000]
        cell = 100.0
        [nodes.noise]
        op = "fbm"
        wavelength = 3000
        [nodes.land]
        op = "normalise"
        source = "noise"
        low = 50
        high = 400
        [nodes.coarse]
        op = "stream-power"
        source = "land"
        cell = 200.0
        years = 400000
        steps = 4
        [nodes.fine]
        op = "stream-power"
        source = "coarse"
        years = 40000
        steps = 2
        [nodes.filled]
        op = "fill"
        source = "fine"
        [outputs]
        height = "filled"
    "#;

    #[test]
    fn every_step_has_the_bits_of_a_run_of_its_own() {
        let recipe = Recipe::parse(STAGES, "stages").unwrap();
        let world = World::open(recipe.clone()).unwrap();
        let window = Window::new(60, 40, 100.0);
        let growth = Growth::new(&world, "height", window).unwrap().in_full();
        assert_eq!(growth.steps(), 6);
        let seen = Mutex::new(Vec::new());
        let shares = Arc::new(Mutex::new(Vec::new()));
        let heard = Arc::clone(&shares);
        let progress = Progress::new(move |share| heard.lock().unwrap().push(share));
        let wanted = BTreeSet::from([0, 1, 3, 4, 5, 6]);
        let visit = |step: u32, grid: &Grid| {
            seen.lock().unwrap().push((step, grid.clone()));
            Ok(())
        };
        growth.run(&wanted, &progress, &visit).unwrap();
        let seen = seen.into_inner().unwrap();
        assert_eq!(seen.iter().map(|(step, _)| *step).collect::<Vec<_>>(), wanted.into_iter().collect::<Vec<_>>());
        // For both nodes: years and steps.
        let runs = [(0, [0, 0]), (1, [1, 0]), (3, [3, 0]), (4, [4, 0]), (5, [4, 1]), (6, [4, 2])];
        for ((step, grid), (expect, done)) in seen.iter().zip(runs) {
            let mut recipe = recipe.clone();
            let mut names = recipe.nodes().iter().map(|named| named.name.clone()).collect::<Vec<_>>().into_iter();
            recipe.change(|node| {
                let name = names.next();
                let Node::StreamPower(law) = node else { return };
                let coarse = name.as_deref() == Some("coarse");
                let (done, years) = if coarse { (done[0], 100_000.0) } else { (done[1], 20_000.0) };
                (law.years, law.steps) = (years * f64::from(done), u32::max(done as u32, 1));
            });
            let alone = World::open(recipe).unwrap().window("height", &window).unwrap();
            assert!(*step == expect && alone == *grid, "step {step}");
        }
        assert_eq!(seen[5].1, world.window("height", &window).unwrap());
        let shares = shares.lock().unwrap();
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]) && shares.last() == Some(&1.0));
    }

    /// The requested frames, and the number of solutions made for them.
    fn frames(growth: &Growth, wanted: &[u32]) -> (BTreeMap<u32, Grid>, Solves) {
        let seen = Mutex::new(BTreeMap::new());
        let visit = |step: u32, grid: &Grid| {
            let mut seen = seen.lock().unwrap();
            assert!(seen.keys().all(|before| *before < step), "in order");
            seen.insert(step, grid.clone());
            Ok(())
        };
        let solves = growth.run(&wanted.iter().copied().collect(), &Progress::none(), &visit).unwrap();
        (seen.into_inner().unwrap(), solves)
    }

    fn growth(world: &World, window: Window) -> Growth<'_> {
        Growth::new(world, "height", window).unwrap()
    }

    fn mean_difference(one: &Grid, other: &Grid) -> f32 {
        let sum: f32 = one.data().iter().zip(other.data()).map(|(one, other)| (one - other).abs()).sum();
        sum / one.data().len() as f32
    }

    #[test]
    fn drafts_are_near_what_they_stand_for_and_ends_are_exact() {
        let open = || World::open(Recipe::parse(STAGES, "stages").unwrap()).unwrap();
        for window in [Window::new(60, 40, 100.0), Window::new(61, 41, 100.0), Window::new(33, 27, 75.0).at(5, 11)] {
            let (worlds, all) = ([open(), open()], [0, 1, 2, 3, 4, 5, 6]);
            let (drafted, _) = frames(&growth(&worlds[0], window), &all);
            let (full, _) = frames(&growth(&worlds[1], window).in_full(), &all);
            assert_eq!(drafted.len(), all.len());
            let grown = mean_difference(&full[&0], &full[&4]);
            for step in all {
                let apart = mean_difference(&drafted[&step], &full[&step]);
                match step {
                    4.. => assert!(drafted[&step] == full[&step], "step {step}"),
                    _ => assert!(apart > 0.0 && apart < 0.1 * grown, "step {step}: {apart} of {grown} m"),
                }
            }
            // A frame does not depend on which others are requested.
            let (some, _) = frames(&growth(&open(), window), &[2, 5]);
            assert!(some[&2] == drafted[&2] && some[&5] == drafted[&5]);
        }
    }

    #[test]
    fn frames_share_the_steps_of_every_stage() {
        let open = || World::open(Recipe::parse(STAGES, "stages").unwrap()).unwrap();
        let window = Window::new(60, 40, 100.0);
        let all = [0, 1, 2, 3, 4, 5, 6];
        // Both stages and the land before them, once; and `filled` in each frame. The end of the first stage is also
        // computed as a draft.
        let (_, solves) = frames(&growth(&open(), window), &all);
        assert_eq!(solves, Solves { shared: 3, in_frames: 7 + 1 });
        // In a full run the second stage follows every frame of the first.
        let (_, solves) = frames(&growth(&open(), window).in_full(), &all);
        assert_eq!(solves, Solves { shared: 3, in_frames: 7 + 4 });
    }

    #[test]
    fn what_does_not_go_step_by_step_does_not_grow() {
        let world = World::open(Recipe::parse(STAGES, "stages").unwrap()).unwrap();
        let error = Growth::new(&world, "land", Window::new(9, 9, 100.0)).err().unwrap();
        assert!(error.to_string().contains("stream-power"), "{error}");
    }

    #[test]
    fn it_stops_when_asked() {
        let world = World::open(Recipe::parse(STAGES, "stages").unwrap()).unwrap();
        let growth = Growth::new(&world, "height", Window::new(60, 40, 100.0)).unwrap();
        let progress = Progress::none();
        let visit = |_: u32, _: &Grid| {
            progress.cancel();
            Ok(())
        };
        let error = growth.run(&BTreeSet::from([1, 2, 3]), &progress, &visit).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled);
    }
}
