//! Points anywhere: register by register, all octaves at once.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::bases::with_basis;
use crate::kernel::basis::{Basis, Coefficients, Rows, Visit, Weights};
use crate::kernel::cell::{Cell, clamp};
use crate::kernel::combine::{Sample, add_size, add_weighted, finish_sizes};
use crate::kernel::outputs::Outputs;
use crate::program::{Combine, Octave, Program};
use orogen_simd::{Body, F32Lanes, Simd};

/// Evaluates a program at points, in the plane or (`DEEP`) in space; slopes are made with `SLOPES`. A function of its own for each
/// level.
pub(crate) struct Scatter<'a, const DEEP: bool, const SLOPES: bool> {
    pub program: &'a Program,
    /// x, y and (in space) z of the points, metres: as many of each as there are results.
    pub at: [&'a [f64]; 3],
    pub target: Outputs<'a>,
}

impl<const DEEP: bool, const SLOPES: bool> Body for Scatter<'_, DEEP, SLOPES> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        with_basis::<S, _, DEEP>(simd, self.program.source, self);
    }
}

impl<S: Simd, const DEEP: bool, const SLOPES: bool> Visit<S> for Scatter<'_, DEEP, SLOPES> {
    #[inline(always)]
    fn visit<B: Basis<S>>(self, simd: S) {
        let Scatter { program, at, mut target } = self;
        let none = simd.f32(0.0);
        let axes = if DEEP { 3 } else { 2 };
        let kept = if SLOPES { axes } else { 0 };
        let mut start = 0;
        while start < target.value.len() {
            let mut position = [simd.f64(0.0); 3];
            for axis in 0..axes {
                let from = at[axis].get(start..).unwrap_or_default();
                position[axis] = clamp(simd, simd.load_f64_partial(from, 0.0), program.limit);
            }
            let (mut sum, mut slope): (Sample<S>, Sample<S>) = ([none; 4], [none; 4]);
            for octave in program.octaves() {
                let basis = B::new(simd, program.source, octave);
                // A plain sum runs on from octave to octave. One call for all: it is inlined, and long.
                let mut one = if matches!(program.combine, Combine::Sum) { sum } else { [none; 4] };
                add_octave::<S, B, SLOPES>(simd, basis, octave, &position, &mut one);
                match program.combine {
                    Combine::Sum => sum = one,
                    Combine::Sizes { .. } => add_size(simd, &mut sum, &one, kept),
                    Combine::Weighted { k, falloff, .. } => {
                        add_weighted::<S, SLOPES>(simd, &mut sum, &mut slope, &one, (k, falloff), axes);
                    }
                }
            }
            match program.combine {
                Combine::Sum => {}
                Combine::Sizes { sign } => finish_sizes(simd, &mut sum, sign, kept),
                Combine::Weighted { gradient, .. } => {
                    for axis in 1..4 {
                        sum[axis] = sum[axis] * simd.f32(gradient);
                    }
                }
            }
            sum[0].store_partial(&mut target.value[start..]);
            if let (true, Some(slopes)) = (SLOPES, &mut target.slopes) {
                for axis in 0..axes {
                    sum[1 + axis].store_partial(slopes[axis].get_mut(start..).unwrap_or_default());
                }
            }
            start += S::LANES;
        }
    }
}

/// Adds one octave's value (and slopes) to a sample.
#[inline(always)]
fn add_octave<S: Simd, B: Basis<S>, const SLOPES: bool>(
    simd: S,
    basis: B,
    octave: &Octave,
    position: &[S::F64; 3],
    sum: &mut Sample<S>,
) {
    let (x, y) = (Cell::split(simd, octave, 0, position[0]), Cell::split(simd, octave, 1, position[1]));
    let z = if B::DEEP { Cell::split(simd, octave, 2, position[2]) } else { x };
    let depth = basis.depth(simd, &z);
    let (columns, lines) = (basis.keys(simd, 0, &x), basis.keys(simd, 1, &y));
    let (amplitude, slope) = (simd.f32(octave.amplitude), simd.f32(octave.slope));
    if B::FLAT {
        let number = basis.point::<SLOPES>(simd, columns[0], lines[0], &depth)[0];
        sum[0] = amplitude.mul_add(number, sum[0]);
        return;
    }
    let column = Weights::new(simd, x.t, basis.fade(simd, x.t));
    let row = Weights::new(simd, y.t, basis.fade(simd, y.t));
    let rows = [
        line::<S, B, SLOPES>(simd, basis, columns, lines[0], &depth, &column),
        line::<S, B, SLOPES>(simd, basis, columns, lines[1], &depth, &column),
    ];
    let coefficients = basis.coefficients(simd, &row, amplitude, slope);
    accumulate::<S, B, SLOPES>(&coefficients, &rows, sum);
}

/// The row vectors between a point's two lattice columns, on the line with that key.
#[inline(always)]
fn line<S: Simd, B: Basis<S>, const SLOPES: bool>(
    simd: S,
    basis: B,
    columns: [S::U32; 2],
    key: S::U32,
    depth: &B::Depth,
    column: &Weights<S>,
) -> Rows<S> {
    let left = basis.point::<SLOPES>(simd, columns[0], key, depth);
    let right = basis.point::<SLOPES>(simd, columns[1], key, depth);
    basis.rows::<SLOPES>(simd, &left, &right, column)
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
                if B::DEEP {
                    sum[3] = coefficients.along[place].mul_add(rows[4 + vector], sum[3]);
                }
            }
        }
    }
}
