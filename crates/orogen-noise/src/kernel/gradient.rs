//! Gradient noise as a basis, in two to four dimensions, over any lattice that has gradients.

use crate::kernel::basis::{Basis, Coefficients, DepthPart, Depths, Numbers, Rows, Weights, blend};
use crate::kernel::cell::Cell;
use crate::kernel::fade::quintic;
use crate::kernel::source::Gradients;
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// Gradient noise.
#[derive(Clone, Copy)]
pub(crate) struct Gradient<G, const DIMS: usize>(G);

/// The row vector X in space: the ramps along x, then the remainder of the ramps along z (and w).
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

/// A lattice point interpolated along z: gradients along x and y, the remainder of the ramp along z, and the slopes of
/// these along z; then the gradient along w, and its slope along z.
#[inline(always)]
fn along_z<S: Simd, G: Gradients<S>, const DIMS: usize>(
    lattice: G,
    simd: S,
    [x, y]: [S::U32; 2],
    z: &DepthPart<S>,
    w: S::U32,
) -> ([S::F32; 6], [S::F32; 2]) {
    let near = lattice.gradient::<DIMS>(simd, lattice.hash::<DIMS>(simd, [x, y, z.keys[0], w]));
    let far = lattice.gradient::<DIMS>(simd, lattice.hash::<DIMS>(simd, [x, y, z.keys[1], w]));
    let weights = &z.weights;
    (
        [
            blend::<S>(weights.u, near[0], far[0]),
            blend::<S>(weights.u, near[1], far[1]),
            blend::<S>(weights.ramp, near[2], far[2]),
            weights.du * (far[0] - near[0]),
            weights.du * (far[1] - near[1]),
            blend::<S>(weights.dramp, near[2], far[2]),
        ],
        [blend::<S>(weights.u, near[3], far[3]), weights.du * (far[3] - near[3])],
    )
}

impl<S: Simd, G: Gradients<S>, const DIMS: usize> Basis<S> for Gradient<G, DIMS> {
    const RANK: usize = 2;
    const NUMBERS: usize = if DIMS == 2 { 2 } else { 3 };
    const DIMS: usize = DIMS;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(G::new(simd, source, octave))
    }
    #[inline(always)]
    fn folded(self) -> Self {
        Self(self.0.folded())
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depths: &Depths<S>) -> Numbers<S> {
        let none = simd.f32(0.0);
        let mut numbers = [none; 9];
        let [z, w] = depths;
        match DIMS {
            2 => {
                let gradient = self.0.gradient::<DIMS>(simd, self.0.hash::<DIMS>(simd, [x, y, x, x]));
                (numbers[0], numbers[1]) = (gradient[0], gradient[1]);
            }
            3 => {
                let (along, _) = along_z::<S, G, DIMS>(self.0, simd, [x, y], z, x);
                numbers[..6].copy_from_slice(&along);
            }
            _ => {
                let (here, ramp) = along_z::<S, G, DIMS>(self.0, simd, [x, y], z, w.keys[0]);
                let (there, next) = along_z::<S, G, DIMS>(self.0, simd, [x, y], z, w.keys[1]);
                let weights = &w.weights;
                for place in 0..6 {
                    numbers[place] = blend::<S>(weights.u, here[place], there[place]);
                }
                numbers[2] = numbers[2] + blend::<S>(weights.ramp, ramp[0], next[0]);
                numbers[5] = numbers[5] + blend::<S>(weights.ramp, ramp[1], next[1]);
                for place in 0..3 {
                    numbers[6 + place] = weights.du * (there[place] - here[place]);
                }
                numbers[8] = numbers[8] + blend::<S>(weights.dramp, ramp[0], next[0]);
            }
        }
        numbers
    }
    #[inline(always)]
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2] {
        quintic(simd, t)
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S> {
        let mut rows = [simd.f32(0.0); 8];
        let slope = blend::<S>(column.dramp, left[0], right[0]);
        rows[1] = blend::<S>(column.u, left[1], right[1]);
        rows[3] = column.du * (right[1] - left[1]);
        if DIMS == 2 {
            rows[0] = blend::<S>(column.ramp, left[0], right[0]);
            rows[2] = slope;
            return rows;
        }
        rows[0] = ramp_in_space::<S>(column, left[0], left[2], right[0], right[2]);
        rows[2] = column.du.mul_add(right[2] - left[2], slope);
        for axis in 2..DIMS {
            let (place, to) = (3 * (axis - 1), 2 * axis);
            rows[to] = ramp_in_space::<S>(column, left[place], left[place + 2], right[place], right[place + 2]);
            rows[to + 1] = blend::<S>(column.u, left[place + 1], right[place + 1]);
        }
        rows
    }
    #[inline(always)]
    fn coefficients(self, _: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        let steep = row.du * slope;
        Coefficients {
            value: scaled_ramps(row, amplitude),
            along: scaled_ramps(row, slope),
            across: [-steep, row.dramp[0] * slope, steep, row.dramp[1] * slope],
        }
    }
}
