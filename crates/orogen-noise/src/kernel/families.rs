//! The kernels that evaluate each noise sample by sample, selected by source.

use crate::choices::{Fade, Smoothness};
use crate::kernel::cellular::Cellular;
use crate::kernel::gradient::Gradient;
use crate::kernel::open_simplex::{Cubes, Open, Wide};
use crate::kernel::pointwise::{LowRank, Pointwise};
use crate::kernel::simplex::{Plain, Simplices};
use crate::kernel::source::{ClassicSource, PerlinSource};
use crate::kernel::value::{Blended, Flat};
use crate::program::Source;
use orogen_simd::Simd;

/// A noise that is generic over the SIMD level: the [`Pointwise`] noise of a source.
pub(crate) trait Family {
    /// The noise at a SIMD level.
    type At<S: Simd>: Pointwise<S>;
    /// Whether the noise has slopes; otherwise they are zero.
    const SLOPED: bool = true;
    /// Whether plain sums are faster with two registers of points at a time. They are not if a single point needs all
    /// registers.
    const PAIRED: bool = false;
}

/// Work that is generic over the noise.
pub(crate) trait VisitFamily {
    /// The work.
    fn visit<F: Family>(self);
}

/// Runs the work with the noise for the source, in `DIMS` dimensions.
#[inline(always)]
pub(crate) fn with_family<V: VisitFamily, const DIMS: usize>(source: Source, work: V) {
    match source {
        Source::Value(Fade::Step) => work.visit::<FlatFamily<DIMS>>(),
        Source::Value(_) => work.visit::<ValueFamily<DIMS>>(),
        Source::Perlin => work.visit::<PerlinFamily<DIMS>>(),
        Source::Classic(_) => work.visit::<ClassicFamily<DIMS>>(),
        Source::Worley(_) => work.visit::<WorleyFamily<DIMS>>(),
        Source::Simplex => work.visit::<SimplexFamily<DIMS>>(),
        Source::OpenSimplex2(Smoothness::Fast) if const { DIMS == 3 } => work.visit::<CubesFamily<false>>(),
        Source::OpenSimplex2(Smoothness::Fast) => work.visit::<OpenFamily<DIMS>>(),
        Source::OpenSimplex2(Smoothness::Smooth) if const { DIMS == 3 } => work.visit::<CubesFamily<true>>(),
        Source::OpenSimplex2(Smoothness::Smooth) => work.visit::<WideFamily<DIMS>>(),
    }
}

struct FlatFamily<const DIMS: usize>;
struct ValueFamily<const DIMS: usize>;
struct PerlinFamily<const DIMS: usize>;
struct ClassicFamily<const DIMS: usize>;
struct WorleyFamily<const DIMS: usize>;
struct SimplexFamily<const DIMS: usize>;
struct OpenFamily<const DIMS: usize>;
struct WideFamily<const DIMS: usize>;
struct CubesFamily<const SMOOTH: bool>;

impl<const DIMS: usize> Family for FlatFamily<DIMS> {
    type At<S: Simd> = LowRank<Flat<S, DIMS>>;
    const SLOPED: bool = false;
    const PAIRED: bool = true;
}
impl<const DIMS: usize> Family for ValueFamily<DIMS> {
    type At<S: Simd> = LowRank<Blended<S, DIMS>>;
    const PAIRED: bool = DIMS < 4;
}
impl<const DIMS: usize> Family for PerlinFamily<DIMS> {
    type At<S: Simd> = LowRank<Gradient<PerlinSource<S>, DIMS>>;
    const PAIRED: bool = DIMS == 2;
}
impl<const DIMS: usize> Family for ClassicFamily<DIMS> {
    type At<S: Simd> = LowRank<Gradient<ClassicSource<S>, DIMS>>;
    const PAIRED: bool = DIMS == 2;
}
impl<const DIMS: usize> Family for WorleyFamily<DIMS> {
    type At<S: Simd> = Cellular<S, DIMS>;
    const SLOPED: bool = false;
}
impl<const DIMS: usize> Family for SimplexFamily<DIMS> {
    type At<S: Simd> = Simplices<S, Plain, DIMS>;
    const PAIRED: bool = DIMS == 2;
}
impl<const DIMS: usize> Family for OpenFamily<DIMS> {
    type At<S: Simd> = Simplices<S, Open, DIMS>;
    const PAIRED: bool = DIMS == 2;
}
impl<const DIMS: usize> Family for WideFamily<DIMS> {
    type At<S: Simd> = Wide<S, DIMS>;
}
impl<const SMOOTH: bool> Family for CubesFamily<SMOOTH> {
    type At<S: Simd> = Cubes<S, SMOOTH>;
}
