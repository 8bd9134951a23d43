//! What is said of samples that are NaN or infinite.

use orogen::analysis::finite::FiniteCount;
use orogen::{Error, Grid};

use crate::say;

/// Refuses a layer without a finite sample, and warns of one with some that are not.
pub fn check(layer: &str, grid: &Grid) -> Result<(), Error> {
    tell(layer, FiniteCount::of(grid.data()))
}

/// The same of samples that were counted.
pub fn tell(layer: &str, count: FiniteCount) -> Result<(), Error> {
    if let Some(note) = count.check(&format!("the layer `{layer}`"))? {
        say::error(&format!("warning: {note}"));
    }
    Ok(())
}
