//! Samples that are NaN or infinite.

use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;

/// Fails if no sample of a layer is finite, and adds a warning if some are not.
pub fn check(layer: &str, grid: &Grid, warnings: &mut Vec<String>) -> Result<()> {
    warnings.extend(FiniteCount::of(grid.data()).check(&format!("the layer `{layer}`"))?);
    Ok(())
}
