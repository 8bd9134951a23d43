//! The parameters of unbounded land.

use super::level::invalid;
use super::refinement::Refinement;
use crate::error::Result;

/// Unbounded land: continents with ranges, plains, coasts, inland basins and rivers to the sea.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Continents {
    /// Parameters of the levels. Their seed is also the seed of the geography.
    pub refinement: Refinement,
    /// Share of land, 0.05 to 0.95.
    pub land: f64,
    /// Factor of the size of continents and ranges.
    pub size: f64,
    /// Share of the suitable inner basins that keep a lake without an outlet, 0 to 1. Elsewhere all land drains to the
    /// sea.
    pub basins: f64,
}

impl Default for Continents {
    fn default() -> Continents {
        Continents { refinement: Refinement::default(), land: 0.39, size: 1.0, basins: 0.8 }
    }
}

orogen_noise::builder!(Continents: with_refinement(refinement: Refinement), with_land(land: f64), with_size(size: f64),
    with_basins(basins: f64));

impl Continents {
    /// Land with this seed and the defaults of the other parameters.
    #[must_use]
    pub fn new(seed: u64) -> Continents {
        Continents::default().with_refinement(Refinement::new(seed))
    }

    /// Checks the parameters other than those of the levels.
    pub(super) fn check(&self) -> Result<()> {
        if !(self.size.is_finite() && self.size > 0.0) {
            return Err(invalid("the size of continents must be above 0"));
        }
        if !(0.05..=0.95).contains(&self.land) || !(0.0..=1.0).contains(&self.basins) {
            return Err(invalid("the share of land must be 0.05 to 0.95, that of basins 0 to 1"));
        }
        Ok(())
    }
}
