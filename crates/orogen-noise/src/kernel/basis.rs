//! One octave of a basis in low-rank form: a few row vectors along x, and a few coefficients along y.
//!
//! For a row of samples at fixed y, let t be the fraction of x in its cell, u the fade of t, and (gx, gy) the gradients
//! of one line of the lattice. Then
//!
//! ```text
//! X(x) = (1 - u) t gx[c] + u (t - 1) gx[c + 1]
//! Y(x) = (1 - u)   gy[c] + u         gy[c + 1]
//! noise = (1 - v) (X0 + s Y0) + v (X1 + (s - 1) Y1)
//! ```
//!
//! where 0 and 1 are the lattice lines above and below, s is the fraction of y and v its fade. X and Y are the same for
//! all samples between two lattice lines, so a sample costs four fused multiply-adds. Value noise has one vector per
//! line instead of two. In 3D a slice at fixed z is noise of the same form, after the numbers of each lattice point
//! were interpolated along z.
//!
//! Scattered points are evaluated with the same functions, so their bits are the same.

use crate::kernel::cell::Cell;
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd};

/// The numbers of a lattice point: those of the value, then as many for the slope along z, then for the slope along w.
pub(crate) type Numbers<S> = [<S as Simd>::F32; 9];
/// The row vectors of one lattice line: two for the value, two for the slope along x, two each for those along z and w.
pub(crate) type Rows<S> = [<S as Simd>::F32; 8];

/// Contributions of one axis: fractions and fades. Computed per column for rows, and per row for coefficients.
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
    /// The compiler removes fields that are not used.
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

/// Coefficients of the row vectors of the first line, then of the second. Bases with one vector use every other slot.
#[derive(Clone, Copy)]
pub(crate) struct Coefficients<S: Simd> {
    /// Coefficients of the value.
    pub value: [S::F32; 4],
    /// Coefficients of the slopes along x, z and w, which have separate row vectors.
    pub along: [S::F32; 4],
    /// Coefficients of the slope along y, which uses the row vectors of the value.
    pub across: [S::F32; 4],
}

/// One octave of a basis.
pub(crate) trait Basis<S: Simd>: Copy {
    /// Whether a sample is the number of the lower corner of its cell, without interpolation and slope.
    const FLAT: bool = false;
    /// Number of row vectors per line.
    const RANK: usize;
    /// Number of numbers per lattice point, without the slopes along z and w, which follow.
    const NUMBERS: usize;
    /// Number of axes: 2, 3 or 4.
    const DIMS: usize;

    /// The basis for an octave.
    fn new(simd: S, source: Source, octave: &Octave) -> Self;
    /// The same basis with other keys, for keys that are stored (see [`crate::kernel::source::Lattice::folded`]).
    #[inline(always)]
    fn folded(self) -> Self {
        self
    }
    /// The keys of a cell and of the next cell along an axis.
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2];
    /// The numbers of a lattice point; with `SLOPES`, also their slopes along z and w.
    fn point<const SLOPES: bool>(self, simd: S, x: S::U32, y: S::U32, depths: &Depths<S>) -> Numbers<S>;
    /// The fade of a fraction and its slope.
    fn fade(self, simd: S, t: S::F32) -> [S::F32; 2];
    /// The row vectors between two lattice points of a line.
    fn rows<const SLOPES: bool>(self, simd: S, left: &Numbers<S>, right: &Numbers<S>, column: &Weights<S>) -> Rows<S>;
    /// The coefficients of a row of samples.
    fn coefficients(self, simd: S, row: &Weights<S>, amplitude: S::F32, slope: S::F32) -> Coefficients<S>;
    /// Contributions of the axes beyond the plane, in their cells.
    #[inline(always)]
    fn depths(self, simd: S, cells: &[Cell<S>; 2]) -> Depths<S> {
        let none = simd.f32(0.0);
        let nothing = DepthPart { keys: [simd.u32(0); 2], weights: Weights::new(simd, none, [none; 2]) };
        let mut depths = [nothing; 2];
        for axis in 2..Self::DIMS {
            let cell = &cells[axis - 2];
            let weights = Weights::new(simd, cell.t, self.fade(simd, cell.t));
            depths[axis - 2] = DepthPart { keys: self.keys(simd, axis, cell), weights };
        }
        depths
    }
}

/// Work that is generic over the basis.
pub(crate) trait Visit<S: Simd> {
    /// The work.
    fn visit<B: Basis<S>>(self, simd: S);
}

/// Contributions of the axes beyond the plane: z and w.
pub(crate) type Depths<S> = [DepthPart<S>; 2];

/// Contributions of one axis beyond the plane.
#[derive(Clone, Copy)]
pub(crate) struct DepthPart<S: Simd> {
    pub keys: [S::U32; 2],
    pub weights: Weights<S>,
}

/// Interpolation between two numbers with their weights.
#[inline(always)]
pub(crate) fn blend<S: Simd>(weights: [S::F32; 2], left: S::F32, right: S::F32) -> S::F32 {
    weights[1].mul_add(right, weights[0] * left)
}
