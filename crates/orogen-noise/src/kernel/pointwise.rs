//! Octaves asked sample by sample: what every noise can do.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::basis::{Basis, Coefficients, Rows, Weights};
use crate::kernel::cell::Cell;
use crate::kernel::combine::Sample;
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// One octave of a noise at a register of samples.
pub(crate) trait Pointwise<S: Simd>: Copy {
    /// A coordinate along one axis, split as the noise needs it.
    type Coordinate: Copy;

    /// The noise as the octave needs it.
    fn new(simd: S, source: Source, octave: &Octave) -> Self;
    /// Splits a coordinate in cells.
    fn split(simd: S, coordinate: S::F64) -> Self::Coordinate;
    /// Adds the octave's value and (with `SLOPES`) slopes, scaled, to a sample.
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[Self::Coordinate; 4], sum: &mut Sample<S>);
}

/// A low-rank basis, sample by sample: the very operations of the lattice, in their order.
#[derive(Clone, Copy)]
pub(crate) struct LowRank<B>(B);

impl<S: Simd, B: Basis<S>> Pointwise<S> for LowRank<B> {
    type Coordinate = Cell<S>;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(B::new(simd, source, octave))
    }

    #[inline(always)]
    fn split(simd: S, coordinate: S::F64) -> Cell<S> {
        Cell::of(simd, coordinate)
    }

    #[inline(always)]
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[Cell<S>; 4], sum: &mut Sample<S>) {
        let basis = self.0;
        let [x, y, z, w] = at;
        let depths = basis.depths(simd, &[*z, *w]);
        let (columns, lines) = (basis.keys(simd, 0, x), basis.keys(simd, 1, y));
        let (amplitude, slope) = (simd.f32(octave.amplitude), simd.f32(octave.slope));
        if B::FLAT {
            let number = basis.point::<SLOPES>(simd, columns[0], lines[0], &depths)[0];
            sum[0] = amplitude.mul_add(number, sum[0]);
            return;
        }
        let column = Weights::new(simd, x.t, basis.fade(simd, x.t));
        let row = Weights::new(simd, y.t, basis.fade(simd, y.t));
        let mut rows = [[simd.f32(0.0); 8]; 2];
        for line in 0..2 {
            let left = basis.point::<SLOPES>(simd, columns[0], lines[line], &depths);
            let right = basis.point::<SLOPES>(simd, columns[1], lines[line], &depths);
            rows[line] = basis.rows::<SLOPES>(simd, &left, &right, &column);
        }
        let coefficients = basis.coefficients(simd, &row, amplitude, slope);
        accumulate::<S, B, SLOPES>(&coefficients, &rows, sum);
    }
}

/// Adds the octave's value (and slopes) to a sample: the order of these additions is the order of the lattice path.
#[inline(always)]
fn accumulate<S: Simd, B: Basis<S>, const SLOPES: bool>(
    coefficients: &Coefficients<S>,
    lines: &[Rows<S>; 2],
    sum: &mut Sample<S>,
) {
    for line in 0..2 {
        let rows = &lines[line];
        for vector in 0..B::RANK {
            let place = 2 * line + vector;
            sum[0] = coefficients.value[place].mul_add(rows[vector], sum[0]);
            if SLOPES {
                sum[1] = coefficients.along[place].mul_add(rows[2 + vector], sum[1]);
                sum[2] = coefficients.across[place].mul_add(rows[vector], sum[2]);
                for axis in 2..B::DIMS {
                    sum[1 + axis] = coefficients.along[place].mul_add(rows[2 * axis + vector], sum[1 + axis]);
                }
            }
        }
    }
}
