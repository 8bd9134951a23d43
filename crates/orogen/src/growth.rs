//! A terrain after each of the steps that eroded it, from one run of them.
//!
//! A recipe's `stream-power` nodes are its stages. They run one after the other, in the order in which they read each other: while one goes
//! through its steps, those before it are done and those after it have not begun. What no stage changes is solved once; each stage runs once,
//! observed; and for a step that is asked for only what lies downstream of the stage is made.

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::node::Node;
use crate::op::{Solution, StepObserver};
use crate::plan::key::keys;
use crate::plan::steps::Plan;
use crate::progress::Progress;
use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use crate::world::World;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The steps of a layer of a world over a window.
pub struct Growth<'w> {
    world: &'w World,
    layer: String,
    window: Window,
    plan: Plan,
    stages: Vec<Stage>,
}

/// A node that goes step by step.
#[derive(Debug, Clone, Copy)]
struct Stage {
    node: usize,
    years: f64,
    steps: u32,
    /// Steps of the stages before it.
    before: u32,
}

/// Takes a layer after a step.
pub type Visit<'a> = &'a (dyn Fn(u32, &Grid) -> Result<()> + Sync);

impl<'w> Growth<'w> {
    /// Looks for the stages of a layer.
    ///
    /// # Errors
    /// If there are none, or as [`World::plan`].
    pub fn new(world: &'w World, layer: &str, window: Window) -> Result<Growth<'w>> {
        let plan = world.plan(&[layer], &window)?;
        let solved: BTreeSet<usize> = plan.solves.iter().map(|solve| solve.node).collect();
        let mut stages: Vec<Stage> = Vec::new();
        for &node in world.order().iter().filter(|node| solved.contains(node)) {
            if let Node::StreamPower(law) = &world.recipe().nodes()[node].node {
                let before = stages.last().map_or(0, |stage| stage.before + stage.steps);
                stages.push(Stage { node, years: law.years, steps: law.steps, before });
            }
        }
        if stages.is_empty() {
            let message = format!(
                "nothing grows in the layer `{layer}`: it reads no node with op = \"stream-power\", which lifts land and cuts \
                 rivers into it"
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        Ok(Growth { world, layer: layer.to_string(), window, plan, stages })
    }

    /// How many steps all stages have together.
    pub fn steps(&self) -> u32 {
        self.stages.iter().map(|stage| stage.steps).sum()
    }

    /// Calls `visit` with the layer after each of the steps in `wanted`, in order: 0 is the beginning, [`Growth::steps`] is the layer itself. Each
    /// has the bits of the recipe whose stages have that many steps of the same length.
    ///
    /// # Errors
    /// As [`World::run`], and what `visit` fails with.
    pub fn run(&self, wanted: &BTreeSet<u32>, progress: &Progress, visit: Visit) -> Result<()> {
        let stages: Vec<(Stage, Vec<u32>)> = self
            .stages
            .iter()
            .map(|stage| {
                let last = stage.before + stage.steps;
                let own = wanted.range(stage.before + 1..=last).map(|step| step - stage.before).collect();
                (*stage, own)
            })
            .filter(|(_, own): &(Stage, Vec<u32>)| !own.is_empty())
            .collect();
        let solving = self.world.work(&self.plan);
        let frame = self.frame_work();
        progress.expect(solving + frame * wanted.len() as f64);
        let share = solving / stages.len().max(1) as f64;
        let frames = Frames { growth: self, progress, work: frame, visit };
        if wanted.contains(&0) {
            self.settle(0, &progress.part(0.0))?;
            frames.make(0, None)?;
        }
        for (index, (stage, own)) in stages.into_iter().enumerate() {
            self.settle(index, &progress.part(0.0))?;
            let last = own.last() == Some(&stage.steps);
            let observer = StageObserver { stage, steps: own.into_iter().collect(), frames: &frames };
            let plan = self.world.plan_to_solve(&[stage.node])?;
            self.world.run_observed(&plan, &progress.part(share), stage.node, &observer)?;
            if last {
                let key = plan.solves.iter().find(|solve| solve.node == stage.node);
                let solution = key.map(|solve| self.world.solution(&solve.key, solve.on_disk)).transpose()?.flatten();
                frames.make(stage.before + stage.steps, solution.map(|solution| (stage.node, solution)))?;
            }
        }
        progress.finish();
        Ok(())
    }

    /// The recipe after so many steps.
    fn recipe(&self, step: u32) -> Recipe {
        let mut recipe = self.world.recipe().clone();
        let mut node = 0;
        recipe.change(|changed| {
            let stage = self.stages.iter().find(|stage| stage.node == node);
            node += 1;
            let (Some(stage), Node::StreamPower(law)) = (stage, changed) else { return };
            let done = step.saturating_sub(stage.before).min(stage.steps);
            if done < stage.steps {
                // What has not begun runs for no time: water still finds its way.
                law.years = stage.years / f64::from(stage.steps) * f64::from(done);
                law.steps = done.max(1);
            }
        });
        recipe
    }

    /// The solvers that the stages from one on change, those stages among them.
    fn is_changed(&self, from: usize) -> BTreeSet<usize> {
        let mut changed: BTreeSet<usize> = self.stages[from..].iter().map(|stage| stage.node).collect();
        // Sources come first in a plan.
        for solve in &self.plan.solves {
            if solve.reads.iter().any(|read| changed.contains(read)) {
                changed.insert(solve.node);
            }
        }
        changed
    }

    /// Solves what no stage from one on changes, once for all steps.
    fn settle(&self, stage: usize, progress: &Progress) -> Result<()> {
        let changed = self.is_changed(stage);
        let steady: Vec<usize> =
            self.plan.solves.iter().map(|solve| solve.node).filter(|node| !changed.contains(node)).collect();
        if !steady.is_empty() {
            self.world.run(&self.world.plan_to_solve(&steady)?, progress)?;
        }
        Ok(())
    }

    /// The work of what lies downstream of the stages, with what each of them does when it ends.
    fn frame_work(&self) -> f64 {
        let changed = self.is_changed(0);
        let of_stage = |node: usize| self.stages.iter().find(|stage| stage.node == node);
        let solves = self.plan.solves.iter().filter(|solve| changed.contains(&solve.node));
        let solving = solves.map(|solve| match of_stage(solve.node) {
            Some(stage) => solve.own_work * 2.0 / f64::from(stage.steps.max(1)),
            None => solve.work(),
        });
        solving.sum::<f64>() + self.world.steps_work(&self.plan)
    }
}

/// What makes the layer after a step.
struct Frames<'a> {
    growth: &'a Growth<'a>,
    progress: &'a Progress,
    /// The work of one.
    work: f64,
    visit: Visit<'a>,
}

impl Frames<'_> {
    /// Makes it, given the solution of the stage that has done the step.
    fn make(&self, step: u32, solved: Option<(usize, Arc<Solution>)>) -> Result<()> {
        let growth = self.growth;
        let part = self.progress.part(self.work);
        let recipe = growth.recipe(step);
        let graph = Graph::resolve(&recipe).map_err(Graph::error)?;
        let keys = keys(&recipe, &graph);
        let mut known = BTreeMap::new();
        for solve in &growth.plan.solves {
            let key = keys[solve.node];
            match &solved {
                Some((node, solution)) if *node == solve.node => {
                    known.insert(key, Arc::clone(solution));
                }
                _ => {
                    if let Some(solution) = growth.world.solution(&key, solve.on_disk)? {
                        known.insert(key, solution);
                    }
                }
            }
        }
        let world = growth.world.variant(recipe, known.into_iter().collect())?;
        let mut grids = world.grids(&[&growth.layer], &growth.window, &part)?;
        let grid = grids.pop().ok_or_else(|| Error::new(ErrorKind::Request, "nothing was asked for"))?;
        (self.visit)(step, &grid)
    }
}

/// Makes frames while a stage runs.
struct StageObserver<'a> {
    stage: Stage,
    steps: BTreeSet<u32>,
    frames: &'a Frames<'a>,
}

impl StepObserver for StageObserver<'_> {
    fn wants(&self, step: u32) -> bool {
        self.steps.contains(&step)
    }

    fn take(&self, step: u32, solution: Solution) -> Result<()> {
        self.frames.make(self.stage.before + step, Some((self.stage.node, Arc::new(solution))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    /// Coarse rivers, then fine ones in what these have left; a solver that nothing changes, and one after all.
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
        let growth = Growth::new(&world, "height", window).unwrap();
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
        // Of either node: years and steps.
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
