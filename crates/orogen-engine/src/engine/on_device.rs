//! Steps of a plan on a device.

use super::grids::{Grids, missing};
use super::run::{Engine, Solutions};
use crate::device::{Device, FilterExtent, PlanGrid};
use crate::plan::split::split;
use crate::plan::steps::{Step, wanted};
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;
use orogen_ops::ids::GridId;
use orogen_ops::lower::Lowering;
use orogen_ops::program::Instruction;

impl Engine<'_> {
    /// Computes a step on a device; `None` if the processor is to do it.
    pub(super) fn on_device(
        &self,
        device: &dyn Device,
        step: &Step,
        solutions: &Solutions,
        grids: &mut Grids,
        progress: &Progress,
    ) -> Result<Option<Vec<PlanGrid>>> {
        match step {
            Step::Fill { .. } => fill(self, device, step, solutions, grids, progress),
            Step::Apply { .. } => apply(self, device, step, grids, progress),
            Step::Refine { .. } => Ok(None),
        }
    }
}

fn fill(
    engine: &Engine,
    device: &dyn Device,
    step: &Step,
    solutions: &Solutions,
    grids: &mut Grids,
    progress: &Progress,
) -> Result<Option<Vec<PlanGrid>>> {
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
    let Some(split) = split(program, lower, |grid| grids.is_away(grid))? else { return Ok(None) };
    let handed = match &split.processor {
        Some(program) => {
            if !grids.fetch(&program.reads(), Some(device), progress)? {
                return Ok(None);
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
) -> Result<Option<Vec<PlanGrid>>> {
    let Step::Apply { node, inputs, window, halo, out } = step else { return Ok(None) };
    if window.is_empty() {
        return Ok(None);
    }
    let Lowering::Shader(passes) = engine.filter(*node)?.lower(window.cell, engine.world_params) else {
        return Ok(None);
    };
    let extent = FilterExtent { window: *window, halo: *halo, wanted: wanted(out) };
    let input = |slot: &GridId| grids.find(*slot).ok_or_else(|| missing("an input of a filter"));
    let given: Vec<Option<&PlanGrid>> =
        inputs.iter().map(|slot| slot.as_ref().map(input).transpose()).collect::<Result<_>>()?;
    let made = device.apply(&passes, &given, &extent, progress)?;
    Ok(made.map(|made| made.into_iter().flatten().collect()))
}
