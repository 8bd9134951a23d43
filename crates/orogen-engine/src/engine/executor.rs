//! Executors, which do the work of a plan: a device where possible, otherwise the processor.

use super::grids::Grids;
use super::preview::Preview;
use super::refine::{Piece, Refining};
use super::run::{Engine, Solutions};
use super::tiles::Tiles;
use crate::device::{Computed, Device, PlanGrid};
use crate::plan::steps::Step;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_ops::op::{Context, Solution, Solver};

/// Does work of a plan, or declines it.
pub(super) trait Executor {
    /// Whether it is a device, whose results are close to the processor's but not bit-equal.
    fn is_device(&self) -> bool;

    /// The grids of a program or a filter.
    fn step(
        &self,
        step: &Step,
        solutions: &Solutions,
        grids: &mut Grids,
        progress: &Progress,
    ) -> Result<Computed<Vec<PlanGrid>>>;

    /// Makes the first of these levels, or several of them one from the other. Returns the planes of the last one made,
    /// and the number of levels made.
    fn levels(
        &self,
        refining: &Refining,
        levels: &[(usize, &Window)],
        above: &[Grid],
    ) -> Result<Computed<(Vec<Grid>, usize)>>;

    /// Makes the levels of a piece, and the layers of the last one.
    fn layers(&self, refining: &Refining, piece: &Piece) -> Result<Computed<Vec<Option<PlanGrid>>>>;

    /// The solution of a solver.
    fn solve(&self, solver: &dyn Solver, tiles: &Tiles, progress: &Progress) -> Result<Computed<Solution>>;
}

/// The processor, on the threads of the pool.
pub(super) struct Processor<'a> {
    pub engine: &'a Engine<'a>,
}

/// The device of a preview.
pub(super) struct OnDevice<'a> {
    pub engine: &'a Engine<'a>,
    pub device: &'a dyn Device,
}

impl Engine<'_> {
    /// The device, if there is one and it has lost no grid.
    pub(super) fn device(&self) -> Option<&dyn Device> {
        self.preview.filter(|preview| !preview.has_lost()).map(|preview| preview.device)
    }

    /// Does work on the device if there is one and `may` allows it, otherwise on the processor.
    pub(super) fn execute<T>(
        &self,
        may: bool,
        mut work: impl FnMut(&dyn Executor) -> Result<Computed<T>>,
    ) -> Result<Computed<T>> {
        if let Some(device) = self.device().filter(|_| may) {
            match work(&OnDevice { engine: self, device })? {
                Computed::Done(made) => return Ok(Computed::Done(made)),
                Computed::Lost => self.lose_device(),
                Computed::Declined => {}
            }
        }
        work(&Processor { engine: self })
    }

    /// Records that the device has lost grids. It is not used again for this plan.
    pub(super) fn lose_device(&self) {
        self.preview.into_iter().for_each(Preview::lose);
    }
}

impl Executor for Processor<'_> {
    fn is_device(&self) -> bool {
        false
    }

    fn step(
        &self,
        step: &Step,
        solutions: &Solutions,
        grids: &mut Grids,
        progress: &Progress,
    ) -> Result<Computed<Vec<PlanGrid>>> {
        match grids.fetch(&step.reads(), self.engine.device(), progress)? {
            true => self.engine.step(step, solutions, grids, progress).map(Computed::Done),
            false => Ok(Computed::Lost),
        }
    }

    fn levels(
        &self,
        refining: &Refining,
        levels: &[(usize, &Window)],
        above: &[Grid],
    ) -> Result<Computed<(Vec<Grid>, usize)>> {
        let Some((level, window)) = levels.first() else { return Ok(Computed::Declined) };
        Ok(Computed::Done((refining.refined(*level, above, window)?, 1)))
    }

    fn layers(&self, refining: &Refining, piece: &Piece) -> Result<Computed<Vec<Option<PlanGrid>>>> {
        refining.piece(self.engine, piece).map(Computed::Done)
    }

    fn solve(&self, solver: &dyn Solver, tiles: &Tiles, progress: &Progress) -> Result<Computed<Solution>> {
        let engine = self.engine;
        let observer = engine.observer.and_then(|(node, observer)| (node == tiles.order.node).then_some(observer));
        let context = Context { world_params: &engine.resolved.world_params, progress, observer };
        solver.solve(tiles, &context).map(Computed::Done)
    }
}
