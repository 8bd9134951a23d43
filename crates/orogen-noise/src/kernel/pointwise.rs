//! Octaves evaluated sample by sample, which every noise supports.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::basis::{Basis, Coefficients, Depths, Rows, Weights};
use crate::kernel::cell::Cell;
use crate::kernel::combine::Sample;
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// One octave of a noise for a register of samples.
pub(crate) trait Pointwise<S: Simd>: Copy {
    /// A coordinate along one axis, split into the parts that the noise needs.
    type Coordinate: Copy;

    /// The noise for one octave.
    fn new(simd: S, source: Source, octave: &Octave) -> Self;
    /// Splits a coordinate in cells.
    fn split(simd: S, coordinate: S::F64) -> Self::Coordinate;
    /// Adds the octave's value and (with `SLOPES`) slopes, scaled, to a sample.
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[Self::Coordinate; 4], sum: &mut Sample<S>);

    /// Whether a sample in the plane depends on its cell only through keys along x and y. The two methods below are
    /// only used in this case.
    const KEYED: bool = false;
    /// The keys of a cell and of the next cell along an axis.
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        let _ = (axis, cell);
        [simd.u32(0); 2]
    }
    /// Adds the value of an octave with amplitude 1 to a sample in the plane. `t` are the fractions of the sample,
    /// `keys` the keys of its cell and of the next cell along x and y.
    #[inline(always)]
    fn add_keyed(self, simd: S, t: [S::F32; 2], keys: [[S::U32; 2]; 2], sum: &mut Sample<S>) {
        let _ = (simd, t, keys, sum);
    }
}

/// A low-rank basis, evaluated sample by sample with the operations of the lattice path in the same order.
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
        let keys = [basis.keys(simd, 0, x), basis.keys(simd, 1, y)];
        let factors = [simd.f32(octave.amplitude), simd.f32(octave.slope)];
        add::<S, B, SLOPES>(simd, basis, factors, [x.t, y.t], keys, &depths, sum);
    }

    const KEYED: bool = B::DIMS == 2 && !B::FLAT;

    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.folded().keys(simd, axis, cell)
    }

    #[inline(always)]
    fn add_keyed(self, simd: S, t: [S::F32; 2], keys: [[S::U32; 2]; 2], sum: &mut Sample<S>) {
        let none = Cell::at(simd, simd.f64(0.0));
        let depths = self.0.depths(simd, &[none; 2]);
        add::<S, B, false>(simd, self.0.folded(), [simd.f32(1.0); 2], t, keys, &depths, sum);
    }
}

/// Adds an octave's value (and slopes), times their factors, to a sample. `t` are its fractions, and `keys` belong to
/// its cell.
#[inline(always)]
fn add<S: Simd, B: Basis<S>, const SLOPES: bool>(
    simd: S,
    basis: B,
    [amplitude, slope]: [S::F32; 2],
    t: [S::F32; 2],
    [columns, lines]: [[S::U32; 2]; 2],
    depths: &Depths<S>,
    sum: &mut Sample<S>,
) {
    if B::FLAT {
        let number = basis.point::<SLOPES>(simd, columns[0], lines[0], depths)[0];
        sum[0] = amplitude.mul_add(number, sum[0]);
        return;
    }
    let column = Weights::new(simd, t[0], basis.fade(simd, t[0]));
    let row = Weights::new(simd, t[1], basis.fade(simd, t[1]));
    let mut rows = [[simd.f32(0.0); 8]; 2];
    for line in 0..2 {
        let left = basis.point::<SLOPES>(simd, columns[0], lines[line], depths);
        let right = basis.point::<SLOPES>(simd, columns[1], lines[line], depths);
        rows[line] = basis.rows::<SLOPES>(simd, &left, &right, &column);
    }
    let coefficients = basis.coefficients(simd, &row, amplitude, slope);
    accumulate::<S, B, SLOPES>(&coefficients, &rows, sum);
}

/// Adds the octave's value (and slopes) to a sample. The order of the additions is the same as in the lattice path.
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
