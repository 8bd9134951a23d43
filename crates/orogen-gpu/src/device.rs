//! The graphics card as a device of the engine.

use crate::adapters::Kind;
use crate::gpu::Gpu;
use crate::program::run;
use crate::{passes, resident};
use orogen_engine::device::{Computed, Device, DeviceGrid, LoweredProgram, PassRun, PlanGrid};
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
    ) -> Result<Computed<Vec<PlanGrid>>> {
        let is_cancelled = || progress.check().is_err();
        let made = run::run(self, program, window, grids, self.kernel_weight(), is_cancelled);
        self.outcome(made, Computed::Declined, progress)
    }

    fn run(&self, run: &PassRun, progress: &Progress) -> Result<Computed<Vec<PlanGrid>>> {
        let is_cancelled = || progress.check().is_err();
        self.outcome(passes::run(self, run, is_cancelled), Computed::Declined, progress)
    }

    fn read(&self, grids: &[&DeviceGrid], progress: &Progress) -> Result<Computed<Vec<Grid>>> {
        self.outcome(resident::read(self, grids).map(Some), Computed::Lost, progress)
    }
}
