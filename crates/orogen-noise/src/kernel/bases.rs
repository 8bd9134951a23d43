//! The kernels of low-rank bases, by source.

use crate::choices::Fade;
use crate::kernel::basis::Visit;
use crate::kernel::gradient::Gradient;
use crate::kernel::source::{ClassicSource, PerlinSource};
use crate::kernel::value::{Blended, Flat};
use crate::program::Source;
use orogen_simd::Simd;

/// Runs the work with the basis for the source, in `DIMS` dimensions.
#[inline(always)]
pub(crate) fn with_basis<S: Simd, V: Visit<S>, const DIMS: usize>(simd: S, source: Source, work: V) {
    match source {
        Source::Value(Fade::Step) => work.visit::<Flat<S, DIMS>>(simd),
        Source::Value(_) => work.visit::<Blended<S, DIMS>>(simd),
        Source::Perlin => work.visit::<Gradient<PerlinSource<S>, DIMS>>(simd),
        Source::Classic(_) => work.visit::<Gradient<ClassicSource<S>, DIMS>>(simd),
        // These have separate kernels.
        Source::Worley(_) | Source::Simplex | Source::OpenSimplex2(_) => {}
    }
}
