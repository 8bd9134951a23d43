//! The grids of a plan while its steps run.

use crate::device::{Computed, Device, DeviceGrid, PlanGrid};
use crate::plan::steps::Plan;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;
use orogen_ops::ids::{GridId, IndexVec, StepId};

/// The grids of a plan that steps have made and that later ones or the results need.
pub struct Grids {
    slots: IndexVec<GridId, Option<PlanGrid>>,
}

impl Grids {
    /// An empty slot for each grid of the plan.
    pub fn before(plan: &Plan) -> Grids {
        Grids { slots: plan.grids.iter().map(|_| None).collect() }
    }

    /// A grid, in memory or on the device.
    pub fn find(&self, slot: GridId) -> Option<&PlanGrid> {
        self.slots.find(slot)?.as_ref()
    }

    /// A grid in memory.
    pub fn memory(&self, slot: GridId) -> Option<&Grid> {
        self.find(slot)?.memory()
    }

    /// Whether a grid is only on the device.
    pub fn is_away(&self, slot: GridId) -> bool {
        self.find(slot).is_some_and(|grid| grid.memory().is_none())
    }

    /// Takes a grid out of memory.
    pub fn take(&mut self, slot: GridId) -> Option<Grid> {
        self.slots[slot].take()?.into_memory()
    }

    /// Puts grids into slots.
    pub fn put(&mut self, slots: &[GridId], grids: impl IntoIterator<Item = PlanGrid>) {
        for (&slot, grid) in slots.iter().zip(grids) {
            self.slots[slot] = Some(grid);
        }
    }

    /// Drops the grids that no later step reads.
    pub fn drop_after(&mut self, at: StepId, plan: &Plan) {
        for (slot, planned) in plan.grids.entries() {
            if planned.last_use.is_some_and(|last| last <= at) {
                self.slots[slot] = None;
            }
        }
    }

    /// Copies the grids that are only on the device to memory. Returns whether all of them are in memory: a device may
    /// have been lost with its grids.
    pub fn fetch(&mut self, slots: &[GridId], device: Option<&dyn Device>, progress: &Progress) -> Result<bool> {
        let mut away: Vec<GridId> = slots.iter().filter(|slot| self.is_away(**slot)).copied().collect();
        away.sort_unstable();
        away.dedup();
        if away.is_empty() {
            return Ok(true);
        }
        let Some(device) = device else { return Ok(false) };
        let grids: Vec<&DeviceGrid> = away.iter().filter_map(|slot| self.find(*slot)?.on_device()).collect();
        let Computed::Done(read) = device.read(&grids, progress)? else { return Ok(false) };
        if read.len() != away.len() {
            return Err(missing("a grid of a device"));
        }
        for (slot, grid) in away.into_iter().zip(read) {
            self.slots[slot] = self.slots[slot].take().map(|held| held.with_memory(grid));
        }
        Ok(true)
    }
}

/// The error for a grid that an earlier step should have computed.
pub fn missing(what: &str) -> Error {
    Error::new(ErrorKind::Internal, format!("{what} was not computed"))
}
