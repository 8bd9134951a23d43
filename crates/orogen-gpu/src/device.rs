//! The graphics card as a device of the engine.

use crate::adapters::Kind;
use crate::filters;
use crate::gpu::Gpu;
use crate::level_layers;
use crate::levels;
use crate::program::run;
use crate::resident;
use crate::solvers;
use orogen_engine::device::{Device, DeviceGrid, FilterExtent, LayerStep, LevelStep, LoweredProgram, PlanGrid};
use orogen_engine::lower::Passes;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

impl Device for Gpu {
    fn is_software(&self) -> bool {
        self.adapter().kind == Kind::Software
    }

    fn fill(
        &self,
        program: &LoweredProgram,
        window: &Window,
        grids: &[&PlanGrid],
        progress: &Progress,
    ) -> Result<Option<Vec<PlanGrid>>> {
        let is_cancelled = || progress.check().is_err();
        let made = run::run(self, program, window, grids, self.kernel_weight(), is_cancelled);
        self.outcome(made, progress)
    }

    fn apply(
        &self,
        passes: &Passes,
        inputs: &[Option<&PlanGrid>],
        extent: &FilterExtent,
        progress: &Progress,
    ) -> Result<Option<Vec<Option<PlanGrid>>>> {
        let is_cancelled = || progress.check().is_err();
        self.outcome(filters::apply(self, passes, inputs, extent, is_cancelled), progress)
    }

    fn read(&self, grids: &[&DeviceGrid], progress: &Progress) -> Result<Option<Vec<Grid>>> {
        self.outcome(resident::read(self, grids).map(Some), progress)
    }

    fn refine(&self, levels: &[LevelStep], above: &[Grid], progress: &Progress) -> Result<Option<Vec<Grid>>> {
        let is_cancelled = || progress.check().is_err();
        self.outcome(levels::refine(self, levels, above, is_cancelled), progress)
    }

    fn layers(
        &self,
        levels: &[LevelStep],
        layers: &LayerStep,
        above: &[Grid],
        progress: &Progress,
    ) -> Result<Option<Vec<PlanGrid>>> {
        let is_cancelled = || progress.check().is_err();
        self.outcome(level_layers::layers(self, levels, layers, above, is_cancelled), progress)
    }

    fn solve(
        &self,
        passes: &Passes,
        inputs: &[Option<&Grid>],
        window: &Window,
        progress: &Progress,
    ) -> Result<Option<Vec<Grid>>> {
        let is_cancelled = || progress.check().is_err();
        self.outcome(solvers::solve(self, passes, inputs, window, is_cancelled), progress)
    }
}
