//! The list of bases: from a source's name to its kernels.

use crate::choices::Fade;
use crate::kernel::basis::Visit;
use crate::kernel::gradient::{Gradient2, Gradient3};
use crate::kernel::source::{ClassicSource, PerlinSource};
use crate::kernel::value::{Flat2, Flat3, Value2, Value3};
use crate::program::Source;
use orogen_simd::Simd;

/// Does the work with the basis the source names, in the plane or (`DEEP`) in space.
#[inline(always)]
pub(crate) fn with_basis<S: Simd, V: Visit<S>, const DEEP: bool>(simd: S, source: Source, work: V) {
    match (source, DEEP) {
        (Source::Value(Fade::Step), false) => work.visit::<Flat2<S>>(simd),
        (Source::Value(Fade::Step), true) => work.visit::<Flat3<S>>(simd),
        (Source::Value(_), false) => work.visit::<Value2<S>>(simd),
        (Source::Value(_), true) => work.visit::<Value3<S>>(simd),
        (Source::Perlin, false) => work.visit::<Gradient2<PerlinSource<S>>>(simd),
        (Source::Perlin, true) => work.visit::<Gradient3<PerlinSource<S>>>(simd),
        // Cellular noise has kernels of its own.
        (Source::Worley(_), _) => {}
        (Source::Classic(_), false) => work.visit::<Gradient2<ClassicSource<S>>>(simd),
        (Source::Classic(_), true) => work.visit::<Gradient3<ClassicSource<S>>>(simd),
    }
}
