//! Gradient noise as a basis, in the plane and in space, over any lattice that has gradients.

use crate::kernel::basis::{Basis, Coefficients, DepthPart, Numbers, Rows, Weights, blend};
use crate::kernel::cell::Cell;
use crate::kernel::fade::quintic;
use crate::kernel::source::Gradients;
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// Gradient noise in the plane.
#[derive(Clone, Copy)]
pub(crate) struct Gradient2<G>(pub G);
/// Gradient noise in space.
#[derive(Clone, Copy)]
pub(crate) struct Gradient3<G>(pub G);
/// The row vector X in space: the ramps along x, then what the ramps along z left.
#[inline(always)]
fn ramp_in_space<S: Simd>(
    column: &Weights<S>,
    left: S::F32,
    left_rest: S::F32,
    right: S::F32,
    right_rest: S::F32,
) -> S::F32 {
    let across = blend::<S>(column.ramp, left, right);
    column.u[1].mul_add(right_rest, column.u[0].mul_add(left_rest, across))
}

#[inline(always)]
fn scaled_ramps<S: Simd>(row: &Weights<S>, factor: S::F32) -> [S::F32; 4] {
    let (a, c) = (row.u[0] * factor, row.u[1] * factor);
    [a, a * row.t[0], c, c * row.t[1]]
}

#[inline(always)]
fn gradient_coefficients<S: Simd>(row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
    let steep = row.du * slope;
    Coefficients {
        value: scaled_ramps(row, amplitude),
        along: scaled_ramps(row, slope),
        across: [-steep, row.dramp[0] * slope, steep, row.dramp[1] * slope],
    }
}

impl<S: Simd, G: Gradients<S>> Basis<S> for Gradient2<G> {
    const RANK: usize = 2;
    const NUMBERS: usize = 2;
    const DEEP: bool = false;
    type Depth = ();

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(G::new(simd, source, octave))
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn depth(self, _: S, _: &Cell<S>) {}
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, (): &()) -> Numbers<S> {
        let [gx, gy] = self.0.gradient2(simd, self.0.hash2(simd, x, y));
        let none = simd.f32(0.0);
        [gx, gy, none, none, none, none]
    }
    #[inline(always)]
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2] {
        quintic(simd, t)
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S> {
        let none = simd.f32(0.0);
        [
            blend::<S>(column.ramp, left[0], right[0]),
            blend::<S>(column.u, left[1], right[1]),
            blend::<S>(column.dramp, left[0], right[0]),
            column.du * (right[1] - left[1]),
            none,
            none,
        ]
    }
    #[inline(always)]
    fn coefficients(self, _: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        gradient_coefficients(row, amplitude, slope)
    }
}

impl<S: Simd, G: Gradients<S>> Basis<S> for Gradient3<G> {
    const RANK: usize = 2;
    const NUMBERS: usize = 3;
    const DEEP: bool = true;
    type Depth = DepthPart<S>;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(G::new(simd, source, octave))
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn depth(self, simd: S, cell: &Cell<S>) -> DepthPart<S> {
        DepthPart { keys: self.0.keys(simd, 2, cell), weights: Weights::new(simd, cell.t, quintic(simd, cell.t)) }
    }
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depth: &DepthPart<S>) -> Numbers<S> {
        let near = self.0.gradient3(simd, self.0.hash3(simd, x, y, depth.keys[0]));
        let far = self.0.gradient3(simd, self.0.hash3(simd, x, y, depth.keys[1]));
        let weights = &depth.weights;
        [
            blend::<S>(weights.u, near[0], far[0]),
            blend::<S>(weights.u, near[1], far[1]),
            blend::<S>(weights.ramp, near[2], far[2]),
            weights.du * (far[0] - near[0]),
            weights.du * (far[1] - near[1]),
            blend::<S>(weights.dramp, near[2], far[2]),
        ]
    }
    #[inline(always)]
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2] {
        quintic(simd, t)
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, _: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S> {
        let slope = blend::<S>(column.dramp, left[0], right[0]);
        [
            ramp_in_space::<S>(column, left[0], left[2], right[0], right[2]),
            blend::<S>(column.u, left[1], right[1]),
            column.du.mul_add(right[2] - left[2], slope),
            column.du * (right[1] - left[1]),
            ramp_in_space::<S>(column, left[3], left[5], right[3], right[5]),
            blend::<S>(column.u, left[4], right[4]),
        ]
    }
    #[inline(always)]
    fn coefficients(self, _: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        gradient_coefficients(row, amplitude, slope)
    }
}
