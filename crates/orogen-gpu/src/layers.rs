//! The layers of a window that is computed tile by tile.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Job, Part};
use crate::resident::Resident;
use crate::tiles::{index, offset};
use orogen_engine::device::PlanGrid;
use orogen_grid::grid::{Grid, Window};

/// The layers of a window: on the card, or in memory if they are larger than its buffers.
pub(crate) enum Layers {
    Resident(Vec<Resident>),
    Memory(Vec<Grid>),
}

impl Layers {
    /// Empty layers over a window, to be filled tile by tile.
    ///
    /// # Errors
    /// If the device was lost or has too little memory.
    pub fn new(gpu: &Gpu, window: &Window, count: usize) -> Result<Layers, Failure> {
        match 4 * window.len() as u64 <= gpu.buffer_limit() {
            true => Ok(Layers::Resident((0..count).map(|_| Resident::new(gpu, window)).collect::<Result<_, _>>()?)),
            false => Ok(Layers::in_memory(window, count)),
        }
    }

    /// Empty layers over a window in memory.
    pub fn in_memory(window: &Window, count: usize) -> Layers {
        Layers::Memory((0..count).map(|_| Grid::filled(*window, 0.0f32)).collect())
    }

    /// Runs the job of a tile. In the job, the layers start at the given samples and have rows of `stride` samples.
    /// Returns `false` if the work was cancelled.
    ///
    /// # Errors
    /// The errors of [`Job::run`].
    pub fn run(
        &mut self,
        gpu: &Gpu,
        job: Job,
        tile: &Window,
        (firsts, stride): (&[usize], usize),
        is_cancelled: &impl Fn() -> bool,
    ) -> Result<bool, Failure> {
        match self {
            Layers::Resident(residents) => {
                let parts = residents.iter().zip(firsts).map(|(resident, &at)| {
                    let first = index(&resident.window, tile);
                    Part { resident, first, at, stride, size: [tile.width, tile.height] }
                });
                Ok(Job { stores: parts.collect(), ..job }.run(gpu, is_cancelled)?.is_some())
            }
            Layers::Memory(grids) => {
                // Whole rows, except the last one, of which only the tile's samples are read.
                let count = (tile.height - 1) * stride + tile.width;
                let job = Job { downloads: firsts.iter().map(|&first| (first, count)).collect(), ..job };
                let Some(back) = job.run(gpu, is_cancelled)? else { return Ok(false) };
                for (grid, rows) in grids.iter_mut().zip(back) {
                    let (left, top) = offset(grid.window(), tile);
                    for (j, row) in rows.chunks(stride).enumerate() {
                        grid.row_mut(top + j)[left..left + tile.width].copy_from_slice(&row[..tile.width]);
                    }
                }
                Ok(true)
            }
        }
    }

    /// The layers, if they are in memory.
    pub fn into_memory(self) -> Option<Vec<Grid>> {
        match self {
            Layers::Resident(_) => None,
            Layers::Memory(grids) => Some(grids),
        }
    }

    /// The layers, on the card or in memory.
    pub fn into_grids(self) -> Vec<PlanGrid> {
        match self {
            Layers::Resident(residents) => residents.into_iter().map(PlanGrid::from).collect(),
            Layers::Memory(grids) => grids.into_iter().map(PlanGrid::from).collect(),
        }
    }
}
