//! Messages about samples that are NaN or infinite.

use orogen::grid::analysis::FiniteCount;
use orogen::{Error, Grid};

use crate::say;

/// Fails if no sample of a layer is finite, and warns if some are not.
pub fn check(layer: &str, grid: &Grid) -> Result<(), Error> {
    tell(layer, FiniteCount::of(grid.data()))
}

/// [`check`] for counted samples.
pub fn tell(layer: &str, count: FiniteCount) -> Result<(), Error> {
    if let Some(note) = count.check(&format!("the layer `{layer}`"))? {
        say::error(&format!("warning: {note}"));
    }
    Ok(())
}
