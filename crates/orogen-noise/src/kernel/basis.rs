//! One octave of a basis in a form of low rank: along x a few row vectors, along y a few coefficients.
//!
//! For a row of samples at fixed y, with t the fraction of x in its cell, u its fade, and (gx, gy) the gradients of one line of the
//! lattice,
//!
//! ```text
//! X(x) = (1 - u) t gx[c] + u (t - 1) gx[c + 1]
//! Y(x) = (1 - u)   gy[c] + u         gy[c + 1]
//! noise = (1 - v) (X0 + s Y0) + v (X1 + (s - 1) Y1)
//! ```
//!
//! where 0 and 1 are the lattice lines above and below, s is the fraction of y and v its fade. X and Y are the same for all samples
//! between two lattice lines: a sample costs four fused multiply-adds. Value noise has one vector per line instead of two. In
//! 3D a slice at fixed z is noise of the same form, the numbers of each lattice point being blended along z first.
//!
//! Scattered points evaluate the very same functions, so they get the very same bits.

use crate::choices::Fade;
use crate::kernel::cell::Cell;
use crate::kernel::fade::{fade, quintic};
use crate::kernel::source::{ClassicSource, Gradients, Hashed, Lattice, PerlinSource, value};
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// The numbers of a lattice point: those that make values, then (from the third or fourth place on) their slopes along z.
pub(crate) type Numbers<S> = [<S as Simd>::F32; 6];
/// The row vectors of one lattice line: two that make values, two for the slope along x, two for that along z.
pub(crate) type Rows<S> = [<S as Simd>::F32; 6];

/// What one axis contributes: fractions and fades. Made per column for rows, per row for coefficients.
#[derive(Clone, Copy)]
pub(crate) struct Weights<S: Simd> {
    /// Fraction t and t - 1.
    pub t: [S::F32; 2],
    /// 1 - u and u.
    pub u: [S::F32; 2],
    /// Slope of u.
    pub du: S::F32,
    /// (1 - u) t and u (t - 1).
    pub ramp: [S::F32; 2],
    /// Slopes of the ramps.
    pub dramp: [S::F32; 2],
}

impl<S: Simd> Weights<S> {
    /// What is not used costs nothing: the compiler drops it.
    #[inline(always)]
    pub(crate) fn new(simd: S, t: S::F32, [u, du]: [S::F32; 2]) -> Weights<S> {
        let one = simd.f32(1.0);
        let (s, rest) = (t - one, one - u);
        Weights {
            t: [t, s],
            u: [rest, u],
            du,
            ramp: [rest * t, u * s],
            dramp: [du.neg_mul_add(t, rest), du.mul_add(s, u)],
        }
    }
}

/// Coefficients of the row vectors: first line's, then second line's; one-vector bases use every other place.
#[derive(Clone, Copy)]
pub(crate) struct Coefficients<S: Simd> {
    /// Of the value.
    pub value: [S::F32; 4],
    /// Of the slopes along x and z, over their own row vectors.
    pub along: [S::F32; 4],
    /// Of the slope along y, over the value's row vectors.
    pub across: [S::F32; 4],
}

/// One octave of a basis.
pub(crate) trait Basis<S: Simd>: Copy {
    /// Row vectors per line.
    const RANK: usize;
    /// Numbers per lattice point without slopes along z; the slopes come after them.
    const NUMBERS: usize;
    /// Whether there is a third axis.
    const DEEP: bool;

    /// What the third axis contributes.
    type Depth: Copy;

    /// The keys of a cell and the next along an axis (0 or 1).
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2];
    /// The third axis's part.
    fn depth(self, simd: S, cell: &Cell<S>) -> Self::Depth;
    /// The numbers of a lattice point; with `SLOPES`, also their slopes along z.
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depth: &Self::Depth) -> Numbers<S>;
    /// The fade of a fraction and its slope.
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2];
    /// The row vectors between two lattice points of a line.
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S>;
    /// The coefficients of a row of samples.
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S>;
}

/// Work on one octave, whatever its basis.
pub(crate) trait Visit<S: Simd> {
    /// The work.
    fn visit<B: Basis<S>>(self, simd: S, basis: B);
}

/// Does the work with the basis the source names, in the plane or (`DEEP`) in space.
#[inline(always)]
pub(crate) fn with_basis<S: Simd, V: Visit<S>, const DEEP: bool>(simd: S, source: Source, octave: &Octave, work: V) {
    match (source, DEEP) {
        (Source::Value(fade), false) => work.visit(simd, Value2(Hashed::new(simd, octave), fade)),
        (Source::Value(fade), true) => work.visit(simd, Value3(Hashed::new(simd, octave), fade)),
        (Source::Perlin, false) => work.visit(simd, Gradient2(PerlinSource::new(simd, octave))),
        (Source::Perlin, true) => work.visit(simd, Gradient3(PerlinSource::new(simd, octave))),
        (Source::Classic(variant), false) => {
            work.visit(simd, Gradient2(ClassicSource::new(simd, octave, variant)));
        }
        (Source::Classic(variant), true) => {
            work.visit(simd, Gradient3(ClassicSource::new(simd, octave, variant)));
        }
    }
}

/// What the third axis contributes to gradient noise.
#[derive(Clone, Copy)]
pub(crate) struct DepthPart<S: Simd> {
    keys: [S::U32; 2],
    weights: Weights<S>,
}

#[inline(always)]
fn blend<S: Simd>(weights: [S::F32; 2], left: S::F32, right: S::F32) -> S::F32 {
    weights[1].mul_add(right, weights[0] * left)
}

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

/// Gradient noise in the plane.
#[derive(Clone, Copy)]
pub(crate) struct Gradient2<G>(pub G);
/// Gradient noise in space.
#[derive(Clone, Copy)]
pub(crate) struct Gradient3<G>(pub G);
/// Value noise in the plane.
#[derive(Clone, Copy)]
pub(crate) struct Value2<S: Simd>(pub Hashed<S>, pub Fade);
/// Value noise in space.
#[derive(Clone, Copy)]
pub(crate) struct Value3<S: Simd>(pub Hashed<S>, pub Fade);

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

impl<S: Simd, G: Gradients<S>> Basis<S> for Gradient2<G> {
    const RANK: usize = 2;
    const NUMBERS: usize = 2;
    const DEEP: bool = false;
    type Depth = ();

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

impl<S: Simd> Basis<S> for Value2<S> {
    const RANK: usize = 1;
    const NUMBERS: usize = 1;
    const DEEP: bool = false;
    type Depth = ();

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
