//! Cellular noise.

use crate::builder::noise_builder;
use crate::choices::{Distance, Feature};
use crate::methods::value_methods;
use crate::prepared::preparable;
use crate::program::{Cellular, Program, Source};
use crate::tiled::tileable;

/// Worley's cellular noise: a lattice with one random point per cell. The value of a sample is computed from the points
/// nearest to it.
///
/// The search covers all cells that can contain a nearest point. The usual search of 3 x 3 cells misses some, which
/// causes discontinuities.
///
/// Range: -1 ..= 1. A distance d becomes 2 d / bound - 1, where the bound is the maximum in wavelengths:
///
/// | | euclidean | manhattan | chebyshev |
/// |---|---|---|---|
/// | F1 | sqrt 2, sqrt 3, 2 | 2, 3, 4 | 1 |
/// | F2, F2 - F1 | sqrt 5/2, sqrt 3, 2 | 2, 3, 4 | 1.5 |
/// | F1 * F2 | 2, 3, 4 | 4, 9, 16 | 1 |
/// | edge | 1, 2 / sqrt 3, 4 / 3 (upper bounds that are not reached) | 1, 1.5, 2 | 0.75 |
///
/// in two, three and four dimensions. Its gradient is not implemented.
///
/// S. Worley, "A cellular texture basis function", SIGGRAPH 1996.
///
/// ```
/// use orogen_noise::{Feature, Worley};
///
/// let cracks = Worley::new(7, 100.0).with_feature(Feature::Edge);
/// assert!(cracks.sample(12.5, -3.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Worley {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of a cell, in metres. Default 1.
    pub wavelength: f64,
    /// The distance that is used. Default [`Distance::Euclidean`].
    pub distance: Distance,
    /// The computed value. Default [`Feature::F1`].
    pub feature: Feature,
    /// Share of the cell in which the point is placed, along each axis, from 0 (the center) to 1 (anywhere); clamped.
    /// Default 1.
    pub jitter: f64,
}

impl Default for Worley {
    fn default() -> Worley {
        Worley { seed: 0, wavelength: 1.0, distance: Distance::Euclidean, feature: Feature::F1, jitter: 1.0 }
    }
}

noise_builder!(Worley: with_distance(distance: Distance), with_feature(feature: Feature), with_jitter(jitter: f64));

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
preparable!(Worley);
tileable!(Worley);
