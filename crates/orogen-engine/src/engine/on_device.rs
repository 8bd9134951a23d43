//! Steps of a plan on a device, and which of them need exact bits.

use super::run::{Engine, Solutions, missing, with_inputs};
use crate::device::{Device, FilterExtent};
use crate::ids::{GridId, IndexVec};
use crate::lower::Lowering;
use crate::plan::program::Instruction;
use crate::plan::split::split;
use crate::plan::steps::{Plan, Step, wanted};
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;

/// The steps of a plan that a device computes.
pub struct OnDevice<'a> {
    device: Option<&'a dyn Device>,
    /// The grids whose bits must be those of the processor: what levelled ops read, because their tiles are kept.
    must_be_exact: IndexVec<GridId, bool>,
    /// The grids that were made by the device, or from such grids.
    approximate: IndexVec<GridId, bool>,
}

impl<'a> OnDevice<'a> {
    pub fn of(plan: &Plan, device: Option<&'a dyn Device>) -> OnDevice<'a> {
        let none = || -> IndexVec<GridId, bool> { vec![false; plan.grids.len()].into() };
        let (mut must_be_exact, approximate) = (none(), none());
        if device.is_some() {
            for (_, step) in plan.steps.entries().rev() {
                if matches!(step, Step::Refine { .. }) || step.writes().iter().any(|grid| must_be_exact[*grid]) {
                    step.reads().into_iter().for_each(|grid| must_be_exact[grid] = true);
                }
            }
        }
        OnDevice { device, must_be_exact, approximate }
    }

    /// Whether the processor gives a step the same bits as without a device.
    pub fn is_exact(&mut self, step: &Step) -> bool {
        let is_exact = !step.reads().iter().any(|grid| self.approximate[*grid]);
        self.mark(step, !is_exact);
        is_exact
    }

    fn mark(&mut self, step: &Step, approximate: bool) {
        step.writes().into_iter().for_each(|grid| self.approximate[grid] = approximate);
    }

    /// Computes a step on the device; `None` if the processor is to do it.
    pub fn step(
        &mut self,
        engine: &Engine,
        step: &Step,
        solutions: &Solutions,
        grids: &IndexVec<GridId, Option<Grid>>,
        progress: &Progress,
    ) -> Result<Option<Vec<Grid>>> {
        let Some(device) = self.device else { return Ok(None) };
        if step.writes().iter().any(|grid| self.must_be_exact[*grid]) {
            return Ok(None);
        }
        let made = match step {
            Step::Fill { .. } => fill(engine, device, step, solutions, grids, progress)?,
            Step::Apply { .. } => apply(engine, device, step, grids, progress)?,
            Step::Refine { .. } => None,
        };
        if made.is_some() {
            self.mark(step, true);
        }
        Ok(made)
    }
}

fn fill(
    engine: &Engine,
    device: &dyn Device,
    step: &Step,
    solutions: &Solutions,
    grids: &IndexVec<GridId, Option<Grid>>,
    progress: &Progress,
) -> Result<Option<Vec<Grid>>> {
    let Step::Fill { program, window, .. } = step else { return Ok(None) };
    if window.is_empty() {
        return Ok(None);
    }
    let lower = |instruction: &Instruction| {
        let lowering = match instruction {
            Instruction::Field { node, layer, .. } => engine.field(*node)?.lower(*layer, engine.world_params),
            Instruction::Solved { node, layer, .. } => {
                let (solver, solution) = engine.solver(*node, solutions)?;
                solver.lower_read(*layer, &solution)
            }
            _ => return None,
        };
        match lowering {
            Lowering::Shader(shader) => Some(shader),
            Lowering::Processor(_) | Lowering::Missing => None,
        }
    };
    let Some(split) = split(program, lower)? else { return Ok(None) };
    let handed = match &split.processor {
        Some(program) => engine.fill_part(program, window, solutions, grids, &Progress::none())?,
        None => Vec::new(),
    };
    let mut read = Vec::with_capacity(split.grids.len() + handed.len());
    for grid in &split.grids {
        read.push(grids[*grid].as_ref().ok_or_else(|| missing("a grid of a program"))?);
    }
    read.extend(&handed);
    device.fill(&split.device, window, &read, progress)
}

fn apply(
    engine: &Engine,
    device: &dyn Device,
    step: &Step,
    grids: &IndexVec<GridId, Option<Grid>>,
    progress: &Progress,
) -> Result<Option<Vec<Grid>>> {
    let Step::Apply { node, window, halo, out, .. } = step else { return Ok(None) };
    if window.is_empty() {
        return Ok(None);
    }
    let Lowering::Shader(passes) = engine.filter(*node)?.lower(window.cell, engine.world_params) else {
        return Ok(None);
    };
    let extent = FilterExtent { window: *window, halo: *halo, wanted: wanted(out) };
    let made = with_inputs(step, grids, |given| device.apply(&passes, given, &extent, progress))?;
    Ok(made.map(|made| made.into_iter().flatten().collect()))
}
