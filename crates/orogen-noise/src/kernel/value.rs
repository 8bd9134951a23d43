//! Value noise as a basis, interpolated or flat, in two to four dimensions.

use crate::choices::Fade;
use crate::kernel::basis::{Basis, Coefficients, Depths, Numbers, Rows, Weights, blend};
use crate::kernel::cell::Cell;
use crate::kernel::fade::fade;
use crate::kernel::source::{Hashed, Lattice, value};
use crate::program::{Octave, Source};
use orogen_simd::Simd;

/// Value noise.
#[derive(Clone, Copy)]
pub(crate) struct Blended<S: Simd, const DIMS: usize>(Hashed<S>, Fade);
/// White noise.
#[derive(Clone, Copy)]
pub(crate) struct Flat<S: Simd, const DIMS: usize>(Hashed<S>);

#[inline(always)]
fn value_coefficients<S: Simd>(simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
    let none = simd.f32(0.0);
    let steep = row.du * slope;
    Coefficients {
        value: [row.u[0] * amplitude, none, row.u[1] * amplitude, none],
        along: [row.u[0] * slope, none, row.u[1] * slope, none],
        across: [-steep, none, steep, none],
    }
}

impl<S: Simd, const DIMS: usize> Blended<S, DIMS> {
    /// The value of a lattice point interpolated along z, and its slope. `far` selects the side along w.
    #[inline(always)]
    fn along_z(self, simd: S, [x, y]: [S::U32; 2], depths: &Depths<S>, far: usize) -> [S::F32; 2] {
        let [z, w] = depths;
        let here = value(simd, self.0.hash::<DIMS>(simd, [x, y, z.keys[0], w.keys[far]]));
        let there = value(simd, self.0.hash::<DIMS>(simd, [x, y, z.keys[1], w.keys[far]]));
        [blend::<S>(z.weights.u, here, there), z.weights.du * (there - here)]
    }
}

impl<S: Simd, const DIMS: usize> Basis<S> for Blended<S, DIMS> {
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DIMS: usize = DIMS;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        let Source::Value(fade) = source else { return Self(Hashed::new(simd, octave), Fade::Quintic) };
        Self(Hashed::new(simd, octave), fade)
    }
    #[inline(always)]
    fn folded(self) -> Self {
        Self(self.0.folded(), self.1)
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depths: &Depths<S>) -> Numbers<S> {
        let mut numbers = [simd.f32(0.0); 9];
        match DIMS {
            2 => numbers[0] = value(simd, self.0.hash::<DIMS>(simd, [x, y, x, x])),
            3 => [numbers[0], numbers[1]] = self.along_z(simd, [x, y], depths, 0),
            _ => {
                let (here, there) = (self.along_z(simd, [x, y], depths, 0), self.along_z(simd, [x, y], depths, 1));
                let w = &depths[1].weights;
                numbers[0] = blend::<S>(w.u, here[0], there[0]);
                numbers[1] = blend::<S>(w.u, here[1], there[1]);
                numbers[2] = w.du * (there[0] - here[0]);
            }
        }
        numbers
    }
    #[inline(always)]
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2] {
        fade(simd, self.1, t)
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S> {
        let none = simd.f32(0.0);
        [
            blend::<S>(column.u, left[0], right[0]),
            none,
            column.du * (right[0] - left[0]),
            none,
            blend::<S>(column.u, left[1], right[1]),
            none,
            blend::<S>(column.u, left[2], right[2]),
            none,
        ]
    }
    #[inline(always)]
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        value_coefficients(simd, row, amplitude, slope)
    }
}

impl<S: Simd, const DIMS: usize> Basis<S> for Flat<S, DIMS> {
    const FLAT: bool = true;
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DIMS: usize = DIMS;

    #[inline(always)]
    fn new(simd: S, _: Source, octave: &Octave) -> Self {
        Self(Hashed::new(simd, octave))
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depths: &Depths<S>) -> Numbers<S> {
        let mut numbers = [simd.f32(0.0); 9];
        numbers[0] = value(simd, self.0.hash::<DIMS>(simd, [x, y, depths[0].keys[0], depths[1].keys[0]]));
        numbers
    }
    #[inline(always)]
    fn fade(self, simd: S, _: S::F32) -> [S::F32; 2] {
        [simd.f32(0.0); 2]
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, _: &Numbers<S>, _: &Weights<S>) -> Rows<S> {
        let mut rows = [simd.f32(0.0); 8];
        rows[0] = left[0];
        rows
    }
    #[inline(always)]
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        value_coefficients(simd, row, amplitude, slope)
    }
}
