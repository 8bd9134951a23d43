//! Simplex noise: gradients at the corners of simplices, and the parts that OpenSimplex2 shares.
//!
//! The plane is divided into triangles (space into tetrahedra, and so on) by a lattice of cubes that is compressed
//! along its main diagonal. A coordinate u_i with cell and fraction w_i + t_i is skewed to u_i + F sum u_j. Each F u_j
//! is split into an integer and a fraction, so that a sample adds only small fractions and integers at any position.
//! The order of the fractions determines the simplex of a sample. A corner at distance d contributes (r^2 - d^2)^4 g .
//! d if r^2 > d^2.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::Cell;
use crate::kernel::combine::Sample;
use crate::kernel::pointwise::Pointwise;
use crate::kernel::source::{Gradients, Lattice, PerlinSource};
use crate::program::{Octave, Source};
use orogen_simd::{F32Lanes, Simd, U32Lanes};

/// A coordinate and its share of the skew.
#[derive(Clone, Copy)]
pub(crate) struct Slanted<S: Simd> {
    /// The cell number.
    pub whole: S::F64,
    /// The fraction.
    pub t: S::F32,
    /// Integer part of F times the coordinate.
    pub skew: S::F64,
    /// Fraction of F times the coordinate.
    pub rest: S::F32,
}

/// (sqrt(n + 1) - 1) / n: factor of the skew for n = 2, 3, 4.
pub(crate) const SKEW: [f64; 3] = [0.366_025_403_784_438_65, 1.0 / 3.0, 0.309_016_994_374_947_45];
/// (1 - 1 / sqrt(n + 1)) / n: factor of the inverse skew.
pub(crate) const UNSKEW: [f32; 3] = [0.211_324_87, 1.0 / 6.0, 0.138_196_6];

/// Splits a coordinate.
#[inline(always)]
pub(crate) fn slanted<S: Simd, const DIMS: usize>(simd: S, coordinate: S::F64) -> Slanted<S> {
    let here = Cell::of(simd, coordinate);
    let skew = Cell::of(simd, coordinate * simd.f64(SKEW[DIMS - 2]));
    Slanted { whole: here.whole, t: here.t, skew: skew.whole, rest: skew.t }
}

/// A sample in the skewed lattice: the number of its cube, and its fractions from 0 to 1.
pub(crate) struct SkewedPoint<S: Simd> {
    pub whole: [S::F64; 4],
    pub t: [S::F32; 4],
}

/// Combines the coordinates.
#[inline(always)]
pub(crate) fn place<S: Simd, const DIMS: usize>(simd: S, at: &[Slanted<S>; 4]) -> SkewedPoint<S> {
    // The axes beyond x come first, because they are common to all samples of a row.
    let (rest, skew) = beyond_x::<S, DIMS>(at);
    let (carry, rest) = wrapped(simd, at[0].rest + rest);
    let skew = at[0].skew + skew + carry.widen();
    let mut place = SkewedPoint { whole: [skew; 4], t: [rest; 4] };
    for axis in 0..DIMS {
        let (carry, t) = wrapped(simd, at[axis].t + rest);
        place.whole[axis] = at[axis].whole + skew + carry.widen();
        place.t[axis] = t;
    }
    place
}

/// The skew of the axes beyond x: its fraction and its integer part.
#[inline(always)]
pub(crate) fn beyond_x<S: Simd, const DIMS: usize>(at: &[Slanted<S>; 4]) -> (S::F32, S::F64) {
    let (mut rest, mut skew) = (at[1].rest, at[1].skew);
    for axis in 2..DIMS {
        rest = rest + at[axis].rest;
        skew = skew + at[axis].skew;
    }
    if DIMS > 2 {
        let carry = rest.floor();
        rest = rest - carry;
        skew = skew + carry.widen();
    }
    (rest, skew)
}

/// Splits a number from 0 to 2 into an integer (0 or 1) and the remainder.
#[inline(always)]
pub(crate) fn wrapped<S: Simd>(simd: S, t: S::F32) -> (S::F32, S::F32) {
    let one = simd.f32(1.0);
    let carry = simd.f32(0.0).select(t.lt(one), one);
    (carry, t - carry)
}

/// Adds a corner's contribution to value and slopes (in cells). `way` is the vector from the corner to the sample.
#[inline(always)]
pub(crate) fn corner<S: Simd, const DIMS: usize, const SLOPES: bool>(
    simd: S,
    reach: f32,
    gradient: &[S::F32; 4],
    way: &[S::F32; 4],
    sum: &mut Sample<S>,
) {
    let mut left = simd.f32(reach);
    let mut ramp = gradient[0] * way[0];
    for axis in 0..DIMS {
        left = way[axis].neg_mul_add(way[axis], left);
    }
    for axis in 1..DIMS {
        ramp = gradient[axis].mul_add(way[axis], ramp);
    }
    let left = left.max(simd.f32(0.0));
    let squared = left * left;
    let weight = squared * squared;
    sum[0] = weight.mul_add(ramp, sum[0]);
    if SLOPES {
        let steep = squared * left * ramp * simd.f32(8.0);
        for axis in 0..DIMS {
            let slope = steep.neg_mul_add(way[axis], sum[1 + axis]);
            sum[1 + axis] = weight.mul_add(gradient[axis], slope);
        }
    }
}

/// Adds an octave's raw value and slopes, scaled, to a sample.
#[inline(always)]
pub(crate) fn scaled<S: Simd, const DIMS: usize, const SLOPES: bool>(
    simd: S,
    octave: &Octave,
    scale: f32,
    raw: &Sample<S>,
    sum: &mut Sample<S>,
) {
    sum[0] = simd.f32(octave.amplitude * scale).mul_add(raw[0], sum[0]);
    if SLOPES {
        let slope = simd.f32(octave.slope * scale);
        for axis in 1..=DIMS {
            sum[axis] = slope.mul_add(raw[axis], sum[axis]);
        }
    }
}

/// The parameters of a noise on corners of simplices.
pub(crate) trait Corners: Copy {
    /// The lattice and its gradients.
    type Lattice<S: Simd>: Gradients<S>;
    /// Reciprocal of the maximum raw value in two, three and four dimensions.
    const SCALE: [f32; 3];
}

/// Noise on corners of simplices.
#[derive(Clone, Copy)]
pub(crate) struct Simplices<S: Simd, C: Corners, const DIMS: usize>(pub C::Lattice<S>);

/// A source of gradients at the corners of a simplex.
pub(crate) trait CornerGradients<S: Simd> {
    /// The gradient of corner `number`, counted from the lower corner of the cube. `waits` are the axes along which the
    /// corner has not stepped; it is undefined for the first and the last corner.
    fn gradient(&self, simd: S, number: usize, waits: &[S::Mask; 4]) -> [S::F32; 4];
}

/// Gradients that are computed for each sample, from the keys of its cube and of the next cube along each axis.
struct HashedCorners<'a, S: Simd, G, const DIMS: usize> {
    lattice: G,
    keys: &'a [[S::U32; 2]; 4],
}

impl<S: Simd, G: Gradients<S>, const DIMS: usize> CornerGradients<S> for HashedCorners<'_, S, G, DIMS> {
    #[inline(always)]
    fn gradient(&self, simd: S, number: usize, waits: &[S::Mask; 4]) -> [S::F32; 4] {
        let mut key = [self.keys[0][0]; 4];
        for axis in 0..DIMS {
            let [here, next] = self.keys[axis];
            key[axis] = if number == 0 {
                here
            } else if number == DIMS {
                next
            } else {
                here.select(waits[axis], next)
            };
        }
        self.lattice.gradient::<DIMS>(simd, self.lattice.hash::<DIMS>(simd, key))
    }
}

/// Squared radius of a corner's kernel: the distance to the opposite face.
pub(crate) const REACH: f32 = 0.5;

impl<S: Simd, C: Corners, const DIMS: usize> Simplices<S, C, DIMS> {
    /// The raw value and slopes at a position in the skewed lattice, with the keys of its cube and of the next cube
    /// along each axis.
    #[inline(always)]
    pub(crate) fn raw<const SLOPES: bool>(self, simd: S, t: &[S::F32; 4], keys: &[[S::U32; 2]; 4]) -> Sample<S> {
        raw::<S, _, DIMS, SLOPES>(simd, t, &HashedCorners::<S, _, DIMS> { lattice: self.0, keys })
    }
}

/// The raw value and slopes at a position in the skewed lattice.
#[inline(always)]
pub(crate) fn raw<S: Simd, G: CornerGradients<S>, const DIMS: usize, const SLOPES: bool>(
    simd: S,
    t: &[S::F32; 4],
    gradients: &G,
) -> Sample<S> {
    let mut total = t[0];
    for axis in 1..DIMS {
        total = total + t[axis];
    }
    let waiting = waiting::<S, DIMS>(simd, t);
    let mut from = [simd.f32(0.0); 4];
    for axis in 0..DIMS {
        from[axis] = total.neg_mul_add(simd.f32(UNSKEW[DIMS - 2]), t[axis]);
    }
    // This is not a loop, because the numbers must be constants.
    let mut raw = [simd.f32(0.0); 5];
    add_corner::<S, G, DIMS, SLOPES>(simd, gradients, 0, &from, &waiting, &mut raw);
    add_corner::<S, G, DIMS, SLOPES>(simd, gradients, 1, &from, &waiting, &mut raw);
    add_corner::<S, G, DIMS, SLOPES>(simd, gradients, 2, &from, &waiting, &mut raw);
    if DIMS > 2 {
        add_corner::<S, G, DIMS, SLOPES>(simd, gradients, 3, &from, &waiting, &mut raw);
    }
    if DIMS > 3 {
        add_corner::<S, G, DIMS, SLOPES>(simd, gradients, 4, &from, &waiting, &mut raw);
    }
    raw
}

/// Adds the contribution of corner `number`. `from` is the vector from the lower corner of the cube to the sample.
#[inline(always)]
fn add_corner<S: Simd, G: CornerGradients<S>, const DIMS: usize, const SLOPES: bool>(
    simd: S,
    gradients: &G,
    number: usize,
    from: &[S::F32; 4],
    waiting: &[[S::Mask; 4]; 5],
    raw: &mut Sample<S>,
) {
    let (back, one) = (simd.f32(number as f32 * UNSKEW[DIMS - 2]), simd.f32(1.0));
    let mut way = *from;
    for axis in 0..DIMS {
        if number == DIMS {
            way[axis] = from[axis] + (back - one);
        } else if number > 0 {
            way[axis] = from[axis] + back.select(waiting[number][axis], back - one);
        }
    }
    let gradient = gradients.gradient(simd, number, &waiting[number]);
    corner::<S, DIMS, SLOPES>(simd, REACH, &gradient, &way, raw);
}

/// The axes along which corner k has not stepped, counted from the lower corner of the cube. It has stepped along the
/// axes with the k largest fractions. Undefined for the first and the last corner.
#[inline(always)]
fn waiting<S: Simd, const DIMS: usize>(simd: S, t: &[S::F32; 4]) -> [[S::Mask; 4]; 5] {
    let (zero, one) = (simd.f32(0.0), simd.f32(1.0));
    let mut waiting = [[zero.lt(zero); 4]; 5];
    if DIMS == 4 {
        // Number of smaller fractions.
        let mut rank = [zero; 4];
        for a in 0..DIMS {
            for b in a + 1..DIMS {
                let behind = t[a].lt(t[b]);
                rank[a] = rank[a] + zero.select(behind, one);
                rank[b] = rank[b] + one.select(behind, zero);
            }
        }
        for number in 1..DIMS {
            for axis in 0..DIMS {
                waiting[number][axis] = rank[axis].lt(simd.f32((DIMS - number) as f32));
            }
        }
        return waiting;
    }
    let behind = t[0].lt(t[1]);
    if DIMS == 2 {
        waiting[1] = [behind, !behind, behind, behind];
        return waiting;
    }
    let (x, y) = (t[0].lt(t[2]), t[1].lt(t[2]));
    waiting[1] = [behind | x, !behind | y, !x | !y, x];
    waiting[2] = [behind & x, !behind & y, !x & !y, x];
    waiting
}

impl<S: Simd, C: Corners, const DIMS: usize> Pointwise<S> for Simplices<S, C, DIMS> {
    type Coordinate = Slanted<S>;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(C::Lattice::<S>::new(simd, source, octave))
    }

    #[inline(always)]
    fn split(simd: S, coordinate: S::F64) -> Slanted<S> {
        slanted::<S, DIMS>(simd, coordinate)
    }

    #[inline(always)]
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[Slanted<S>; 4], sum: &mut Sample<S>) {
        let place = place::<S, DIMS>(simd, at);
        let mut keys = [[simd.u32(0); 2]; 4];
        for axis in 0..DIMS {
            keys[axis] = self.0.keys(simd, axis, &Cell::at(simd, place.whole[axis]));
        }
        let raw = self.raw::<SLOPES>(simd, &place.t, &keys);
        scaled::<S, DIMS, SLOPES>(simd, octave, C::SCALE[DIMS - 2], &raw, sum);
    }
}

/// Simplex noise with the gradients of hashed Perlin noise.
#[derive(Clone, Copy)]
pub(crate) struct Plain;

impl Corners for Plain {
    type Lattice<S: Simd> = PerlinSource<S>;
    const SCALE: [f32; 3] = [69.129_1, 93.230_6, 96.463_1];
}
