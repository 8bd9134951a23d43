//! Cellular noise.

use crate::choices::{Distance, Feature};
use crate::methods::value_methods;
use crate::program::{Cellular, Program, Source};
use crate::tiled::tileable;

/// Worley's cellular noise: one point at a random place in each cell of a lattice, and what a sample tells about the points nearest
/// to it.
///
/// The search goes as far as it must: unlike the usual look at 3 x 3 cells, it never misses a nearer point, so there are no breaks along
/// the lattice.
///
/// Range: within [-1, 1]. A distance d becomes 2 d / bound - 1, where the bound is the greatest there can be, in wavelengths:
///
/// | | euclidean | manhattan | chebyshev |
/// |---|---|---|---|
/// | F1 | sqrt 2, sqrt 3, 2 | 2, 3, 4 | 1 |
/// | F2, F2 - F1 | sqrt 5/2, sqrt 3, 2 | 2, 3, 4 | 1.5 |
/// | F1 * F2 | 2, 3, 4 | 4, 9, 16 | 1 |
/// | edge | 1, 2 / sqrt 3, 4 / 3 (never quite reached) | 1, 1.5, 2 | 0.75 |
///
/// in two, three and four dimensions. It has no gradient here.
///
/// S. Worley, "A cellular texture basis function", SIGGRAPH 1996.
///
/// ```
/// use orogen_noise::{Feature, Worley};
///
/// let cracks = Worley { seed: 7, wavelength: 100.0, feature: Feature::Edge, ..Default::default() };
/// assert!(cracks.sample(12.5, -3.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worley {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of a cell, metres. Default 1.
    pub wavelength: f64,
    /// How distance is measured. Default [`Distance::Euclidean`].
    pub distance: Distance,
    /// What is told. Default [`Feature::F1`].
    pub feature: Feature,
    /// How much of its cell a point may be in along each axis, 0 (its middle) to 1 (all); held within. Default 1.
    pub jitter: f64,
}

impl Default for Worley {
    fn default() -> Worley {
        Worley { seed: 0, wavelength: 1.0, distance: Distance::Euclidean, feature: Feature::F1, jitter: 1.0 }
    }
}

impl Worley {
    pub(crate) fn cellular(&self) -> Cellular {
        let jitter = if self.jitter >= 0.0 { self.jitter.min(1.0) as f32 } else { 0.0 };
        Cellular { distance: self.distance, feature: self.feature, jitter }
    }
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Worley(self.cellular()), self.seed, self.wavelength)
    }
}

value_methods!(Worley);
tileable!(Worley);
