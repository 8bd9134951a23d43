//! Running the steps of a plan.

use super::exactness::Exactness;
use super::grids::{Grids, missing};
use super::preview::Preview;
use crate::device::{Computed, PlanGrid};
use crate::plan::cost;
use crate::plan::resolved::ResolvedRecipe;
use crate::plan::steps::{Plan, Step, wanted};
use crate::store::grids::{EXPENSIVE, GridKey, GridStore};
use crate::store::kept::Kept;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_ops::budget::Budget;
use orogen_ops::ids::{GridId, Id, IndexVec, NodeId, StepId};
use orogen_ops::interpreter::{Bindings, Evaluators, Interpreter};
use orogen_ops::op::{Context, Field, Filter, GridInputs, Op, Solution, Solver, StepObserver};
use orogen_ops::pool::Pool;
use orogen_ops::program::{BLOCK_HEIGHT, BLOCK_WIDTH, Program};
use std::collections::HashMap;
use std::sync::Arc;

/// Runs plans of one recipe.
#[derive(Clone, Copy)]
pub struct Engine<'a> {
    pub resolved: &'a ResolvedRecipe,
    /// Results that are kept for later requests.
    pub kept: &'a Kept,
    /// Whether grids of expensive filters are kept and reused.
    pub keeps_grids: bool,
    pub budget: &'a Budget,
    /// The thread pool. Waiting happens only on the calling thread.
    pub pool: &'a Pool,
    pub progress: &'a Progress,
    /// The device that computes in place of the processor, where exact bits are not needed.
    pub preview: Option<&'a Preview<'a>>,
    /// The observer of a solver's steps, with the node. That node is solved even if its solution is stored.
    pub observer: Option<(NodeId, &'a (dyn StepObserver + Sync))>,
}

/// Maximum time of a block on one core, in nanoseconds: cancellation is checked between blocks.
const BLOCK_TIME: f64 = 1e8;

/// Columns and rows of a block of a program that takes `cost` nanoseconds per sample, at most `rows` rows.
fn block_of(cost: f64, rows: usize) -> (usize, usize) {
    let samples = (BLOCK_TIME / cost.max(1.0)) as usize;
    (BLOCK_WIDTH.min(samples.max(8)), rows.min((samples / BLOCK_WIDTH).max(1)))
}

/// A program to be run over a window.
struct Filling<'a> {
    program: &'a Program,
    window: &'a Window,
    outputs: usize,
}

/// Solutions by node.
pub type Solutions = HashMap<NodeId, Arc<Solution>>;

impl<'a> Engine<'a> {
    /// Computes the output grids of a plan.
    pub fn run(&self, plan: &Plan) -> Result<Vec<Grid>> {
        let work = cost::steps(plan, &self.resolved.recipe);
        self.progress.expect(work);
        let solutions = self.solve(plan)?;
        let part = self.progress.part(work);
        let run = || self.steps(plan, &solutions, &part);
        // The calling thread may wait for tiles of levels; without them it is quicker to enter the pool once.
        let has_levels = plan.steps.iter().any(|step| matches!(step, Step::Refine { .. }));
        let grids = if has_levels { run() } else { self.pool.install(run) }?;
        self.progress.finish();
        Ok(grids)
    }

    /// Computes the output grids of a plan, with all its solvers solved.
    pub(super) fn steps(&self, plan: &Plan, solutions: &Solutions, progress: &Progress) -> Result<Vec<Grid>> {
        progress.expect(cost::steps(plan, &self.resolved.recipe));
        if let Computed::Done(made) = self.steps_once(plan, solutions, progress)? {
            return Ok(made);
        }
        // The device has lost grids that steps had made: all steps run again without it.
        self.lose_device();
        self.steps_once(plan, solutions, progress)?.done().ok_or_else(|| missing("a grid of a step"))
    }

    fn steps_once(&self, plan: &Plan, solutions: &Solutions, progress: &Progress) -> Result<Computed<Vec<Grid>>> {
        let mut grids = Grids::before(plan);
        let mut exactness = Exactness::of(self.resolved, self.preview, plan);
        let needed = self.kept_grids(plan, &mut grids, &mut exactness);
        for (at, step) in plan.steps.entries() {
            progress.check()?;
            if !needed[at] {
                progress.advance(cost::step(step, plan, &self.resolved.recipe));
                continue;
            }
            let part = progress.part(cost::step(step, plan, &self.resolved.recipe));
            let mut on_device = false;
            let made = self.execute(!exactness.is_required(step), |executor| {
                on_device = executor.is_device();
                executor.step(step, solutions, &mut grids, &part)
            })?;
            let Computed::Done(made) = made else { return Ok(Computed::Lost) };
            let is_exact = exactness.ran(step, on_device);
            self.keep_grids(step, &made, is_exact);
            grids.put(&step.writes(), made);
            part.finish();
            grids.drop_after(at, plan);
        }
        if !grids.fetch(&plan.outputs, self.device(), progress)? {
            return Ok(Computed::Lost);
        }
        // Each output has its own slot, so a grid is an output only once.
        let outputs = plan.outputs.iter().map(|&slot| grids.take(slot).ok_or_else(|| missing("an output")));
        outputs.collect::<Result<_>>().map(Computed::Done)
    }

    /// Takes kept grids of expensive filters from earlier requests; grids on the device only if it is still in use.
    /// Returns which steps are still needed: those whose grids are results or are read by needed steps.
    fn kept_grids(&self, plan: &Plan, grids: &mut Grids, exactness: &mut Exactness) -> IndexVec<StepId, bool> {
        let mut needed: IndexVec<StepId, bool> = vec![true; plan.steps.len()].into();
        let Some(store) = self.grid_store() else { return needed };
        let mut read: IndexVec<GridId, bool> = plan.grids.iter().map(|slot| slot.last_use.is_none()).collect();
        for (at, step) in plan.steps.entries().rev() {
            let writes = step.writes();
            // A program for points writes no grid.
            needed[at] = writes.is_empty() || writes.iter().any(|&slot| read[slot]);
            if let Some(keys) = needed[at].then(|| self.grid_keys(step)).flatten() {
                let exact = store.find(&keys);
                let approximate = || {
                    let preview = self.preview.filter(|_| !exactness.is_required(step))?;
                    let found: Vec<PlanGrid> = preview.kept.grids.find(&keys)?;
                    (self.device().is_some() || found.iter().all(|grid| grid.memory().is_some())).then_some(found)
                };
                let found: Option<Vec<PlanGrid>> = match exact {
                    Some(exact) => Some(exact),
                    None => approximate().inspect(|_| exactness.found(step)),
                };
                if let Some(found) = found {
                    grids.put(&writes, found);
                    needed[at] = false;
                }
            }
            if needed[at] {
                step.reads().into_iter().for_each(|slot| read[slot] = true);
            }
        }
        needed
    }

    /// The keys of a step's grids; `None` if they are not worth keeping.
    fn grid_keys(&self, step: &Step) -> Option<Vec<GridKey>> {
        let (Step::Apply { node, window, out, .. } | Step::Refine { node, window, out, .. }) = step else {
            return None;
        };
        let is_expensive = match self.resolved.recipe.nodes().get(node.index())?.node.op() {
            Op::Filter(filter) => filter.cost(window.cell) >= EXPENSIVE,
            Op::Levelled(_) => true,
            _ => false,
        };
        let layers = out.iter().enumerate().filter_map(|(layer, slot)| slot.map(|_| layer));
        is_expensive.then(|| layers.map(|layer| GridKey::new(self.resolved.keys[*node], layer, window)).collect())
    }

    /// Computes the values of a scattered plan at points, one output after the other.
    pub fn run_points(&self, plan: &Plan, x: &[f64], y: &[f64]) -> Result<Vec<Vec<f32>>> {
        let (solutions, grids) = self.before_points(plan)?;
        let Some(program) = plan.asked() else { return Ok(Vec::new()) };
        self.pool.install(|| self.at_points(program, x, y, &solutions, &grids))
    }

    /// Computes everything that a scattered plan needs before its points.
    pub fn before_points(&self, plan: &Plan) -> Result<(Solutions, Grids)> {
        let solutions = self.solve(plan)?;
        let mut grids = Grids::before(plan);
        let mut exactness = Exactness::of(self.resolved, self.preview, plan);
        let needed = self.kept_grids(plan, &mut grids, &mut exactness);
        for (at, step) in plan.steps.entries() {
            if matches!(step, Step::Fill { out, .. } if out.is_empty()) || !needed[at] {
                continue;
            }
            let made = self.step(step, &solutions, &grids, self.progress)?;
            let is_exact = exactness.ran(step, false);
            self.keep_grids(step, &made, is_exact);
            grids.put(&step.writes(), made);
            grids.drop_after(at, plan);
        }
        Ok((solutions, grids))
    }

    /// Runs a step on the threads of the pool. Levels and their layers may be made on a device.
    pub(super) fn step(
        &self,
        step: &Step,
        solutions: &Solutions,
        grids: &Grids,
        progress: &Progress,
    ) -> Result<Vec<PlanGrid>> {
        let made = match step {
            Step::Fill { program, window, out } => {
                let filling = Filling { program, window, outputs: out.len() };
                self.pool.install(|| self.fill(&filling, solutions, grids, progress))?
            }
            Step::Apply { .. } => self.pool.install(|| self.apply(step, grids, progress))?,
            Step::Refine { node, inputs, window, out } => {
                let mut given = Vec::with_capacity(inputs.len());
                for level in inputs {
                    let grid = |slot: &GridId| grids.memory(*slot).ok_or_else(|| missing("an input of a level"));
                    given.push(level.iter().map(|slot| slot.as_ref().map(grid).transpose()).collect::<Result<_>>()?);
                }
                let made = self.refine(*node, given, &wanted(out), window, progress)?;
                return Ok(made.into_iter().flatten().collect());
            }
        };
        Ok(made.into_iter().map(PlanGrid::from).collect())
    }

    /// Keeps the grids of an expensive filter for later requests; approximate ones only for previews.
    fn keep_grids(&self, step: &Step, made: &[PlanGrid], is_exact: bool) {
        let Some(exact) = self.grid_store() else { return };
        for (key, grid) in self.grid_keys(step).into_iter().flatten().zip(made) {
            match self.preview {
                Some(preview) if !is_exact => preview.kept.grids.keep(key, grid, self.room()),
                _ if grid.memory().is_some() => exact.keep(key, grid, self.room()),
                _ => {}
            }
        }
    }

    /// The store of grids of expensive filters, if it is used.
    fn grid_store(&self) -> Option<&'a GridStore<PlanGrid>> {
        Some(&self.kept.grids).filter(|store| self.keeps_grids && store.is_used())
    }

    /// The bytes that kept grids or tiles may take now; `None` for no limit.
    pub(super) fn room(&self) -> Option<u64> {
        self.budget.unused().map(|unused| unused.saturating_sub(self.kept.store.memory()))
    }

    pub(super) fn field(&self, node: NodeId) -> Option<&'a dyn Field> {
        match self.resolved.op(node)? {
            Op::Field(field) => Some(field),
            _ => None,
        }
    }

    pub(super) fn solver(&self, node: NodeId, solutions: &Solutions) -> Option<(&'a dyn Solver, Arc<Solution>)> {
        match self.resolved.op(node)? {
            Op::Solver(solver) => Some((solver, Arc::clone(solutions.get(&node)?))),
            _ => None,
        }
    }

    /// The fields of a program, prepared for many blocks.
    pub(super) fn evaluators(&self, program: &Program) -> Evaluators {
        Evaluators::new(program, &self.resolved.world_params, |node| self.field(node))
    }

    /// Runs `work` with the data that the instructions of a program refer to.
    pub(super) fn bound<T>(
        &self,
        evaluators: &Evaluators,
        solutions: &Solutions,
        grids: &Grids,
        work: impl FnOnce(&Bindings) -> T,
    ) -> T {
        let fields = |node| self.field(node);
        let solvers = |node| self.solver(node, solutions);
        let grids = |slot| grids.memory(slot);
        let world_params = &self.resolved.world_params;
        work(&Bindings { world_params, evaluators, fields: &fields, solvers: &solvers, grids: &grids })
    }

    fn at_points(
        &self,
        program: &Program,
        x: &[f64],
        y: &[f64],
        solutions: &Solutions,
        grids: &Grids,
    ) -> Result<Vec<Vec<f32>>> {
        const POINTS: usize = BLOCK_WIDTH * BLOCK_HEIGHT;
        let mut values = vec![Vec::with_capacity(x.len()); program.outputs.len()];
        let mut interpreter = Interpreter::new(program);
        self.bound(&self.evaluators(program), solutions, grids, |bindings| {
            for (x, y) in x.chunks(POINTS).zip(y.chunks(POINTS)) {
                interpreter.run_points(x, y, bindings)?;
                for (i, values) in values.iter_mut().enumerate() {
                    values.extend_from_slice(interpreter.output(i));
                }
            }
            Ok(values)
        })
    }

    /// Runs a program over a window: bands of rows in parallel, each band block by block.
    fn fill(&self, filling: &Filling, solutions: &Solutions, grids: &Grids, progress: &Progress) -> Result<Vec<Grid>> {
        let Filling { program, window, outputs } = *filling;
        let mut out: Vec<Grid> = (0..outputs).map(|_| Grid::filled(*window, 0.0f32)).collect();
        if window.is_empty() {
            return Ok(out);
        }
        // Enough bands for all threads, but not so thin that rows of noise lattices are computed repeatedly.
        let rows = window.height.div_ceil(2 * parallel::threads()).clamp(8, BLOCK_HEIGHT);
        let (columns, rows) = block_of(cost::program(program, &self.resolved.recipe), rows);
        progress.expect(window.height as f64);
        let mut bands: Vec<Vec<&mut [f32]>> = (0..window.height.div_ceil(rows)).map(|_| Vec::new()).collect();
        for grid in &mut out {
            for (band, samples) in bands.iter_mut().zip(grid.data_mut().chunks_mut(rows * window.width)) {
                band.push(samples);
            }
        }
        self.bound(&self.evaluators(program), solutions, grids, |bindings| {
            parallel::try_for_each_init(
                bands.into_iter().enumerate(),
                || Interpreter::new(program),
                |interpreter, (band, mut out)| {
                    let top = band * rows;
                    let height = rows.min(window.height - top);
                    for left in (0..window.width).step_by(columns) {
                        progress.check()?;
                        let block = Window {
                            x: window.x + left as i64,
                            y: window.y + top as i64,
                            width: columns.min(window.width - left),
                            height,
                            cell: window.cell,
                        };
                        interpreter.run_block(&block, bindings)?;
                        for (i, out) in out.iter_mut().enumerate() {
                            let made = interpreter.output(i).chunks(block.width);
                            for (row, made) in out.chunks_mut(window.width).zip(made) {
                                row[left..left + block.width].copy_from_slice(made);
                            }
                        }
                    }
                    progress.advance(height as f64);
                    Ok::<(), Error>(())
                },
            )
        })?;
        Ok(out)
    }

    /// Runs a part of a program over its window, on the threads of the pool.
    pub(super) fn fill_part(
        &self,
        program: &Program,
        window: &Window,
        solutions: &Solutions,
        grids: &Grids,
        progress: &Progress,
    ) -> Result<Vec<Grid>> {
        let filling = Filling { program, window, outputs: program.outputs.len() };
        self.pool.install(|| self.fill(&filling, solutions, grids, progress))
    }

    /// The filter of a step.
    pub(super) fn filter(&self, node: NodeId) -> Result<&'a dyn Filter> {
        match self.resolved.recipe.nodes()[node.index()].node.op() {
            Op::Filter(filter) => Ok(filter),
            _ => Err(Error::new(ErrorKind::Internal, "a node that is not a filter was to be applied")),
        }
    }

    fn apply(&self, step: &Step, grids: &Grids, progress: &Progress) -> Result<Vec<Grid>> {
        let Step::Apply { node, window, out, .. } = step else { return Ok(Vec::new()) };
        let filter = self.filter(*node)?;
        with_inputs(step, grids, |given| {
            let context = Context { world_params: &self.resolved.world_params, progress, observer: None };
            let mut made: Vec<Option<Grid>> =
                out.iter().map(|wanted| wanted.map(|_| Grid::filled(*window, 0.0f32))).collect();
            filter.apply(&GridInputs::new(filter.spec(), given), window, &mut made, &context)?;
            Ok(made.into_iter().flatten().collect())
        })
    }
}

/// Lends the inputs of a filter, cropped to its window grown by its halo: they may cover more because other steps read
/// them, too.
fn with_inputs<T>(step: &Step, grids: &Grids, work: impl FnOnce(&[Option<&Grid>]) -> Result<T>) -> Result<T> {
    let Step::Apply { inputs, window, halo, .. } = step else { return Err(missing("the filter of a step")) };
    if inputs.iter().flatten().any(|&slot| grids.memory(slot).is_none()) {
        return Err(missing("an input of a filter"));
    }
    let grown = window.grown(*halo);
    let cropped: Vec<Option<Grid>> = inputs
        .iter()
        .map(|input| {
            let grid = input.and_then(|slot| grids.memory(slot))?;
            if *grid.window() == grown { None } else { grid.crop(&grown) }
        })
        .collect();
    let given: Vec<Option<&Grid>> = inputs
        .iter()
        .zip(&cropped)
        .map(|(input, cropped)| cropped.as_ref().or_else(|| input.and_then(|slot| grids.memory(slot))))
        .collect();
    work(&given)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blocks_of_a_slow_program_are_small() {
        for (cost, block) in [(0.0, (256, 64)), (5000.0, (256, 64)), (5e4, (256, 7)), (4e5, (250, 1)), (1e12, (8, 1))] {
            assert_eq!(block_of(cost, 64), block, "{cost}");
        }
        assert_eq!(block_of(100.0, 8), (256, 8));
    }
}
