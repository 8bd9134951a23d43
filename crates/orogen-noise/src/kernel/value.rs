//! Value noise as a basis, blended or flat, in the plane and in space.

use crate::choices::Fade;
use crate::kernel::basis::{Basis, Coefficients, DepthPart, Numbers, Rows, Weights, blend};
use crate::kernel::cell::Cell;
use crate::kernel::fade::fade;
use crate::kernel::source::{Hashed, Lattice, value};
use crate::program::{Octave, Source};
use orogen_simd::Simd;

/// Value noise in the plane.
#[derive(Clone, Copy)]
pub(crate) struct Value2<S: Simd>(pub Hashed<S>, pub Fade);
/// Value noise in space.
#[derive(Clone, Copy)]
pub(crate) struct Value3<S: Simd>(pub Hashed<S>, pub Fade);
/// White noise in the plane.
#[derive(Clone, Copy)]
pub(crate) struct Flat2<S: Simd>(Hashed<S>);
/// White noise in space.
#[derive(Clone, Copy)]
pub(crate) struct Flat3<S: Simd>(Hashed<S>);

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

impl<S: Simd> Basis<S> for Value2<S> {
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DEEP: bool = false;
    type Depth = ();

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        let Source::Value(fade) = source else { return Self(Hashed::new(simd, octave), Fade::Quintic) };
        Self(Hashed::new(simd, octave), fade)
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn depth(self, _: S, _: &Cell<S>) {}
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, (): &()) -> Numbers<S> {
        let none = simd.f32(0.0);
        [value(simd, self.0.hash2(simd, x, y)), none, none, none, none, none]
    }
    #[inline(always)]
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2] {
        fade(simd, self.1, t)
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S> {
        let none = simd.f32(0.0);
        [blend::<S>(column.u, left[0], right[0]), none, column.du * (right[0] - left[0]), none, none, none]
    }
    #[inline(always)]
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        value_coefficients(simd, row, amplitude, slope)
    }
}

impl<S: Simd> Basis<S> for Value3<S> {
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DEEP: bool = true;
    type Depth = DepthPart<S>;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        let Source::Value(fade) = source else { return Self(Hashed::new(simd, octave), Fade::Quintic) };
        Self(Hashed::new(simd, octave), fade)
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn depth(self, simd: S, cell: &Cell<S>) -> DepthPart<S> {
        let faded = fade(simd, self.1, cell.t);
        DepthPart { keys: self.0.keys(simd, 2, cell), weights: Weights::new(simd, cell.t, faded) }
    }
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depth: &DepthPart<S>) -> Numbers<S> {
        let none = simd.f32(0.0);
        let near = value(simd, self.0.hash3(simd, x, y, depth.keys[0]));
        let far = value(simd, self.0.hash3(simd, x, y, depth.keys[1]));
        let weights = &depth.weights;
        [blend::<S>(weights.u, near, far), weights.du * (far - near), none, none, none, none]
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
        ]
    }
    #[inline(always)]
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        value_coefficients(simd, row, amplitude, slope)
    }
}

impl<S: Simd> Basis<S> for Flat2<S> {
    const FLAT: bool = true;
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DEEP: bool = false;
    type Depth = ();

    #[inline(always)]
    fn new(simd: S, _: Source, octave: &Octave) -> Self {
        Self(Hashed::new(simd, octave))
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn depth(self, _: S, _: &Cell<S>) {}
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, (): &()) -> Numbers<S> {
        let none = simd.f32(0.0);
        [value(simd, self.0.hash2(simd, x, y)), none, none, none, none, none]
    }
    #[inline(always)]
    fn fade(self, simd: S, _: S::F32) -> [S::F32; 2] {
        [simd.f32(0.0); 2]
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, _: &Numbers<S>, _: &Weights<S>) -> Rows<S> {
        let none = simd.f32(0.0);
        [left[0], none, none, none, none, none]
    }
    #[inline(always)]
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        value_coefficients(simd, row, amplitude, slope)
    }
}

impl<S: Simd> Basis<S> for Flat3<S> {
    const FLAT: bool = true;
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DEEP: bool = true;
    type Depth = S::U32;

    #[inline(always)]
    fn new(simd: S, _: Source, octave: &Octave) -> Self {
        Self(Hashed::new(simd, octave))
    }
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.0.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn depth(self, simd: S, cell: &Cell<S>) -> S::U32 {
        self.0.keys(simd, 2, cell)[0]
    }
    #[inline(always)]
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depth: &S::U32) -> Numbers<S> {
        let none = simd.f32(0.0);
        [value(simd, self.0.hash3(simd, x, y, *depth)), none, none, none, none, none]
    }
    #[inline(always)]
    fn fade(self, simd: S, _: S::F32) -> [S::F32; 2] {
        [simd.f32(0.0); 2]
    }
    #[inline(always)]
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, _: &Numbers<S>, _: &Weights<S>) -> Rows<S> {
        let none = simd.f32(0.0);
        [left[0], none, none, none, none, none]
    }
    #[inline(always)]
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S> {
        value_coefficients(simd, row, amplitude, slope)
    }
}
