//! Work of a plan on a device.

use super::executor::{Executor, OnDevice};
use super::grids::{Grids, missing};
use super::refine::{Piece, Refining};
use super::run::{Engine, Solutions};
use super::tiles::Tiles;
use crate::device::{Computed, Device, PassRun, PassStep, PlanGrid};
use crate::plan::levels;
use crate::plan::split::split;
use crate::plan::steps::{Step, wanted};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_ops::declare::InputSpec;
use orogen_ops::ids::GridId;
use orogen_ops::lower::Extent;
use orogen_ops::op::{Solution, Solver, Sources};
use orogen_ops::program::Instruction;
use std::borrow::Cow;

impl Executor for OnDevice<'_> {
    fn is_device(&self) -> bool {
        true
    }

    fn step(
        &self,
        step: &Step,
        solutions: &Solutions,
        grids: &mut Grids,
        progress: &Progress,
    ) -> Result<Computed<Vec<PlanGrid>>> {
        match step {
            Step::Fill { .. } => fill(self.engine, self.device, step, solutions, grids, progress),
            Step::Apply { .. } => apply(self.engine, self.device, step, grids, progress),
            // `levels` and `layers` do the work of this step.
            Step::Refine { .. } => Ok(Computed::Declined),
        }
    }

    fn levels(
        &self,
        refining: &Refining,
        levels: &[(usize, &Window)],
        above: &[Grid],
    ) -> Result<Computed<(Vec<Grid>, usize)>> {
        let mut steps = Vec::new();
        for &(level, window) in levels {
            let Some(step) = refining.level_step(level, window)? else { break };
            steps.push(step);
        }
        let count = steps.len();
        let Some((_, last)) = count.checked_sub(1).and_then(|last| levels.get(last)) else {
            return Ok(Computed::Declined);
        };
        let work = levels.iter().take(count).map(|(level, window)| refining.work(*level, window)).sum();
        let part = refining.progress.part(work);
        let run = PassRun { steps: &steps, above, stays: false };
        let Computed::Done(made) = self.device.run(&run, &part)? else { return Ok(Computed::Declined) };
        part.finish();
        let planes = made.into_iter().filter_map(PlanGrid::into_memory).collect();
        Ok(Computed::Done((refining.checked(planes, last)?, count)))
    }

    fn layers(&self, refining: &Refining, piece: &Piece) -> Result<Computed<Vec<Option<PlanGrid>>>> {
        let (first, level) = (*piece.levels.start(), *piece.levels.end());
        let lowered = refining.op.lower_layers(level, refining.wanted, &self.engine.resolved.world_params).shader();
        let Some(passes) = lowered else { return Ok(Computed::Declined) };
        let windows = levels::windows(refining.op, refining.wanted, first, level, piece.window);
        let mut steps = Vec::new();
        for (level, window) in piece.levels.clone().zip(&windows).skip(1) {
            let Some(step) = refining.level_step(level, window)? else { return Ok(Computed::Declined) };
            steps.push(step);
        }
        let (Some(begin), false) = (windows.first(), steps.is_empty()) else { return Ok(Computed::Declined) };
        steps.push(PassStep { passes, inputs: Vec::new(), window: *piece.window });
        let part = refining.progress.part(refining.work_of_piece(piece.levels.clone(), piece.window));
        let above = refining.mosaic(first, begin, piece.tiles)?;
        let run = PassRun { steps: &steps, above: &above, stays: true };
        let Computed::Done(made) = self.device.run(&run, &part)? else { return Ok(Computed::Declined) };
        part.finish();
        let mut made = made.into_iter();
        let layer = |wanted: &bool| if *wanted { made.next() } else { None };
        Ok(Computed::Done(refining.wanted.iter().map(layer).collect()))
    }

    fn solve(&self, solver: &dyn Solver, tiles: &Tiles, progress: &Progress) -> Result<Computed<Solution>> {
        let (nodes, window, node) = (self.engine.resolved, tiles.order.padded, tiles.order.node);
        let passes = self.engine.preview.and_then(|preview| preview.passes_of(nodes, node, solver));
        let Some(passes) = passes else { return Ok(Computed::Declined) };
        let whole = |input: &InputSpec| {
            let name = input.name;
            tiles.given(name).then(|| tiles.whole(name, &window).map(|grid| Cow::Owned(grid.into()))).transpose()
        };
        let inputs = tiles.spec.inputs.iter().map(whole).collect::<Result<_>>()?;
        let run = PassRun { steps: &[PassStep { passes, inputs, window }], above: &[], stays: false };
        let Computed::Done(made) = self.device.run(&run, progress)? else { return Ok(Computed::Declined) };
        let layers = made.into_iter().filter_map(PlanGrid::into_memory).map(|layer| tiles.keep(layer));
        Ok(Computed::Done(Solution { layers: layers.collect::<Result<_>>()?, scalars: Vec::new() }))
    }
}

fn fill(
    engine: &Engine,
    device: &dyn Device,
    step: &Step,
    solutions: &Solutions,
    grids: &mut Grids,
    progress: &Progress,
) -> Result<Computed<Vec<PlanGrid>>> {
    let Step::Fill { program, window, .. } = step else { return Ok(Computed::Declined) };
    if window.is_empty() {
        return Ok(Computed::Declined);
    }
    let lower = |instruction: &Instruction| {
        let lowering = match instruction {
            Instruction::Field { node, layer, .. } => engine.field(*node)?.lower(*layer, &engine.resolved.world_params),
            Instruction::Solved { node, layer, .. } => {
                let (solver, solution) = engine.solver(*node, solutions)?;
                solver.lower_read(*layer, &solution)
            }
            _ => return None,
        };
        lowering.shader()
    };
    let Some(split) = split(program, lower, |grid| grids.is_away(grid))? else { return Ok(Computed::Declined) };
    let handed = match &split.processor {
        Some(program) => {
            if !grids.fetch(&program.reads(), Some(device), progress)? {
                return Ok(Computed::Lost);
            }
            engine.fill_part(program, window, solutions, grids, &Progress::none())?
        }
        None => Vec::new(),
    };
    let handed: Vec<PlanGrid> = handed.into_iter().map(PlanGrid::from).collect();
    let mut read = Vec::with_capacity(split.grids.len() + handed.len());
    for grid in &split.grids {
        read.push(grids.find(*grid).ok_or_else(|| missing("a grid of a program"))?);
    }
    read.extend(&handed);
    device.fill(&split.device, window, &read, progress)
}

fn apply(
    engine: &Engine,
    device: &dyn Device,
    step: &Step,
    grids: &Grids,
    progress: &Progress,
) -> Result<Computed<Vec<PlanGrid>>> {
    let Step::Apply { node, inputs, window, halo, out } = step else { return Ok(Computed::Declined) };
    let passes = engine.filter(*node)?.lower(window.cell, &engine.resolved.world_params).shader();
    let Some(passes) = passes.filter(|_| !window.is_empty()) else { return Ok(Computed::Declined) };
    let passes = passes.with_planes(Extent::Halo(*halo), inputs.len(), &wanted(out));
    let input = |slot: &GridId| grids.find(*slot).map(Cow::Borrowed).ok_or_else(|| missing("an input of a filter"));
    let inputs = inputs.iter().map(|slot| slot.as_ref().map(input).transpose()).collect::<Result<_>>()?;
    let steps = [PassStep { passes, inputs, window: *window }];
    device.run(&PassRun { steps: &steps, above: &[], stays: true }, progress)
}
