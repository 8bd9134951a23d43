//! Cellular noise, evaluated sample by sample.

use crate::kernel::cell::Cell;
use crate::kernel::combine::Sample;
use crate::kernel::pointwise::Pointwise;
use crate::kernel::sites::{Field, HashedSites, evaluate};
use crate::kernel::source::Hashed;
use crate::program::{self, Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// Cellular noise, evaluated sample by sample. It has no slopes.
#[derive(Clone, Copy)]
pub(crate) struct Cellular<S: Simd, const DIMS: usize>(Field<S>);

impl<S: Simd, const DIMS: usize> Pointwise<S> for Cellular<S, DIMS> {
    type Coordinate = Cell<S>;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        let cellular = if let Source::Worley(cellular) = source { cellular } else { program::Cellular::default() };
        Self(Field { lattice: Hashed::new(simd, octave), cellular })
    }

    #[inline(always)]
    fn split(simd: S, coordinate: S::F64) -> Cell<S> {
        Cell::of(simd, coordinate)
    }

    #[inline(always)]
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[Cell<S>; 4], sum: &mut Sample<S>) {
        let sites = HashedSites::<S, DIMS>::new(simd, self.0, at);
        let noise = evaluate::<S, _, DIMS>(simd, &self.0, &sites, at);
        sum[0] = simd.f32(octave.amplitude).mul_add(noise, sum[0]);
    }
}
