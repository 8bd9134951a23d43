//! Grids that jobs read, in memory or on the card.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Job, Part};
use crate::resident::Resident;
use crate::tiles::index;
use orogen_engine::device::PlanGrid;
use orogen_grid::grid::{Grid, Window};

/// A grid that a job reads.
#[derive(Clone, Copy)]
pub(crate) enum Source<'a> {
    Memory(&'a Grid),
    Resident(&'a Resident),
}

impl<'a> Source<'a> {
    /// A grid of a plan: on this card, or in memory.
    ///
    /// # Errors
    /// If it is only on another card.
    pub fn of(gpu: &Gpu, grid: &'a PlanGrid) -> Result<Source<'a>, Failure> {
        let resident = grid.on_device().and_then(|grid| grid.samples::<Resident>());
        match (resident.filter(|resident| resident.gpu.is(gpu)), grid.memory()) {
            (Some(resident), _) => Ok(Source::Resident(resident)),
            (None, Some(grid)) => Ok(Source::Memory(grid)),
            (None, None) => Err(Failure::Input("a grid is on another card".to_string())),
        }
    }

    /// Adds a part of it to the inputs of a job, row after row from a sample on.
    ///
    /// # Errors
    /// If it does not cover the part.
    pub fn add_to(self, job: &mut Job<'a>, part: &Window, at: usize) -> Result<(), Failure> {
        match self {
            Source::Memory(grid) if grid.window() == part => job.uploads.push((at, grid.data().into())),
            Source::Memory(grid) => {
                let part = grid.crop(part).ok_or_else(uncovered)?;
                job.uploads.push((at, part.into_data().into()));
            }
            Source::Resident(resident) if resident.window.contains(part) => {
                let (first, size) = (index(&resident.window, part), [part.width, part.height]);
                job.loads.push(Part { resident, first, at, stride: part.width, size });
            }
            Source::Resident(_) => return Err(uncovered()),
        }
        Ok(())
    }

    /// Its window.
    pub fn window(&self) -> &'a Window {
        match self {
            Source::Memory(grid) => grid.window(),
            Source::Resident(resident) => &resident.window,
        }
    }
}

fn uncovered() -> Failure {
    Failure::Input("an input does not cover what is read of it".to_string())
}
