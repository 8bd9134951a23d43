//! OpenSimplex2: the lattice of Simplex noise with more gradients. The smooth variant has wider kernels. In space the
//! lattice is rotated so that horizontal planes have the least visible structure. Its corners form two lattices of
//! cubes, each at the centers of the cubes of the other. A sample is rotated so that their common diagonal is the z
//! axis, and the nearest corners are found in each lattice separately.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::Cell;
use crate::kernel::combine::Sample;
use crate::kernel::pointwise::Pointwise;
use crate::kernel::simplex::{Corners, REACH, Slanted, UNSKEW, corner, place, scaled, slanted};
use crate::kernel::source::{Gradients, Hashed, Lattice};
use crate::program::{Octave, Source};
use crate::tables::directions;
use orogen_simd::{F32Lanes, MaskLanes, Simd, U32Lanes};

/// The hashed lattice with the gradients of OpenSimplex2.
#[derive(Clone, Copy)]
pub(crate) struct OpenSource<S: Simd> {
    lattice: Hashed<S>,
    plane: [S::Table16; 2],
    space: [S::Table16; 3],
    time: [S::Table16; 4],
}

impl<S: Simd> Lattice<S> for OpenSource<S> {
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.lattice.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn hash<const DIMS: usize>(self, simd: S, keys: [S::U32; 4]) -> S::U32 {
        self.lattice.hash::<DIMS>(simd, keys)
    }
    #[inline(always)]
    fn folded(self) -> Self {
        OpenSource { lattice: self.lattice.folded(), ..self }
    }
}

impl<S: Simd> Gradients<S> for OpenSource<S> {
    #[inline(always)]
    fn new(simd: S, _: Source, octave: &Octave) -> OpenSource<S> {
        OpenSource {
            lattice: Hashed::new(simd, octave),
            plane: [simd.table16(&directions::OPEN_X_2D), simd.table16(&directions::OPEN_Y_2D)],
            space: [
                simd.table16(&directions::OPEN_X_3D),
                simd.table16(&directions::OPEN_Y_3D),
                simd.table16(&directions::OPEN_Z_3D),
            ],
            time: [
                simd.table16(&directions::X_4D),
                simd.table16(&directions::Y_4D),
                simd.table16(&directions::Z_4D),
                simd.table16(&directions::W_4D),
            ],
        }
    }
    #[inline(always)]
    fn gradient<const DIMS: usize>(self, simd: S, hash: S::U32) -> [S::F32; 4] {
        let mut gradient = [simd.f32(0.0); 4];
        let top = simd.u32(0x8000_0000);
        if DIMS == 4 {
            for axis in 0..DIMS {
                let upper = simd.lookup16(self.time[axis], hash.shr(27));
                gradient[axis] = (upper.bits() ^ (hash & top)).as_f32();
            }
            return gradient;
        }
        // A number below 12 from the upper half of the hash, and the signs from the remaining bits.
        let twelfths = hash.shr(16) * simd.u32(12);
        for axis in 0..DIMS {
            let (table, sign) =
                if DIMS == 2 { (self.plane[axis & 1], 16) } else { (self.space[axis % 3], 16 + axis as u32) };
            let size = simd.lookup16(table, twelfths.shr(16));
            gradient[axis] = (size.bits() ^ (twelfths.shl(sign) & top)).as_f32();
        }
        gradient
    }
}

/// OpenSimplex2 in the plane and in four dimensions, as noise on the corners of simplices.
#[derive(Clone, Copy)]
pub(crate) struct Open;

impl Corners for Open {
    type Lattice<S: Simd> = OpenSource<S>;
    const SCALE: [f32; 3] = [99.836_6, 1.0, 96.463_1];
}

/// Smooth OpenSimplex2 in the plane and in four dimensions.
#[derive(Clone, Copy)]
pub(crate) struct Wide<S: Simd, const DIMS: usize>(OpenSource<S>);

/// Squared radius of a corner's kernel. In the plane it is the distance to the next corner, in four dimensions slightly
/// less.
pub(crate) const WIDE_REACH: [f32; 3] = [2.0 / 3.0, 0.75, 0.8];
pub(crate) const WIDE_SCALE: [f32; 3] = [18.241_9, 11.867_1, 8.491_0];

impl<S: Simd, const DIMS: usize> Wide<S, DIMS> {
    /// Five corners around a triangle: those of its rhombus, and the nearer one of the two next to the triangle.
    #[inline(always)]
    fn plane<const SLOPES: bool>(self, simd: S, at: &[Slanted<S>; 4]) -> Sample<S> {
        let (zero, one) = (simd.f32(0.0), simd.f32(1.0));
        let place = place::<S, 2>(simd, at);
        let t = place.t;
        // (2, 1) or (0, -1) if x is the larger fraction, (1, 2) or (-1, 0) if y is.
        let wide = t[1].lt(t[0]);
        let ahead = one.lt(t[0] + t[1]);
        let (far, near) = (simd.f32(2.0).select(ahead, zero), one.select(ahead, -one));
        let steps = [far.select(wide, near), near.select(wide, far)];
        let mut keys = [[simd.u32(0); 2]; 2];
        let mut extra = [simd.u32(0); 4];
        for axis in 0..2 {
            keys[axis] = self.0.keys(simd, axis, &Cell::at(simd, place.whole[axis]));
            extra[axis] = self.0.keys(simd, axis, &Cell::at(simd, place.whole[axis] + steps[axis].widen()))[0];
        }
        let mut raw = [zero; 5];
        for number in 0..5 {
            let (mut way, mut key, mut offset) = ([zero; 4], extra, [zero; 2]);
            for axis in 0..2 {
                offset[axis] = steps[axis];
                if number < 4 {
                    let step = number >> axis & 1;
                    (offset[axis], key[axis]) = (simd.f32(step as f32), keys[axis][step]);
                }
                way[axis] = t[axis] - offset[axis];
            }
            let total = (way[0] + way[1]) * simd.f32(UNSKEW[0]);
            way = [way[0] - total, way[1] - total, zero, zero];
            let gradient = self.0.gradient::<2>(simd, self.0.hash::<2>(simd, key));
            corner::<S, 2, SLOPES>(simd, WIDE_REACH[0], &gradient, &way, &mut raw);
        }
        raw
    }

    /// All corners whose kernels can reach a cube: from one before it to one after it along each axis.
    #[inline(always)]
    fn time<const SLOPES: bool>(self, simd: S, at: &[Slanted<S>; 4]) -> Sample<S> {
        let zero = simd.f32(0.0);
        let place = place::<S, 4>(simd, at);
        let mut keys = [[simd.u32(0); 4]; 4];
        for axis in 0..4 {
            for step in 0..4 {
                let whole = place.whole[axis] + simd.f64(step as f64 - 1.0);
                keys[axis][step] = self.0.keys(simd, axis, &Cell::at(simd, whole))[0];
            }
        }
        let mut raw = [zero; 5];
        for number in 0..256_usize {
            let (mut way, mut total, mut left) = ([zero; 4], zero, simd.f32(WIDE_REACH[2]));
            for axis in 0..4 {
                way[axis] = place.t[axis] - simd.f32((number >> (2 * axis) & 3) as f32 - 1.0);
                total = total + way[axis];
            }
            total = total * simd.f32(UNSKEW[2]);
            for axis in 0..4 {
                way[axis] = way[axis] - total;
                left = way[axis].neg_mul_add(way[axis], left);
            }
            if !zero.lt(left).any() {
                continue;
            }
            let mut key = [simd.u32(0); 4];
            for axis in 0..4 {
                key[axis] = keys[axis][number >> (2 * axis) & 3];
            }
            let gradient = self.0.gradient::<4>(simd, self.0.hash::<4>(simd, key));
            corner::<S, 4, SLOPES>(simd, WIDE_REACH[2], &gradient, &way, &mut raw);
        }
        raw
    }
}

impl<S: Simd, const DIMS: usize> Pointwise<S> for Wide<S, DIMS> {
    type Coordinate = Slanted<S>;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(OpenSource::new(simd, source, octave))
    }

    #[inline(always)]
    fn split(simd: S, coordinate: S::F64) -> Slanted<S> {
        slanted::<S, DIMS>(simd, coordinate)
    }

    #[inline(always)]
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[Slanted<S>; 4], sum: &mut Sample<S>) {
        let raw = if const { DIMS == 2 } { self.plane::<SLOPES>(simd, at) } else { self.time::<SLOPES>(simd, at) };
        scaled::<S, DIMS, SLOPES>(simd, octave, WIDE_SCALE[DIMS - 2], &raw, sum);
    }
}

/// OpenSimplex2 in space, on two lattices of cubes.
#[derive(Clone, Copy)]
pub(crate) struct Cubes<S: Simd, const SMOOTH: bool>(OpenSource<S>);

/// The seed offset of the second lattice.
const SECOND: u32 = 0x5851_F42D;
const CUBES_SCALE: f32 = 108.291;

// The rotation: factors of (x + y), and of z.
const ACROSS: f64 = -0.211_324_865_405_187_13;
const DOWN: f64 = -0.577_350_269_189_625_8;
const UP: f64 = 0.577_350_269_189_625_8;

impl<S: Simd, const SMOOTH: bool> Cubes<S, SMOOTH> {
    /// The corner nearest to a rotated sample, and the next one along the axis with the largest distance. Each
    /// coordinate is that of the cell around the corner.
    #[inline(always)]
    fn two<const SLOPES: bool>(self, simd: S, salt: u32, cells: &[Cell<S>; 3], raw: &mut Sample<S>) {
        let (zero, half) = (simd.f32(0.0), simd.f32(0.5));
        let (mut way, mut key, mut next, mut step) = ([zero; 4], [simd.u32(0); 4], [simd.u32(0); 4], [zero; 3]);
        for axis in 0..3 {
            way[axis] = cells[axis].t - half;
            step[axis] = simd.f32(-1.0).select(way[axis].lt(zero), simd.f32(1.0));
            key[axis] = self.0.keys(simd, axis, &Cell::at(simd, cells[axis].whole))[0];
            next[axis] = self.0.keys(simd, axis, &Cell::at(simd, cells[axis].whole + step[axis].widen()))[0];
        }
        key[0] = key[0] ^ simd.u32(salt);
        next[0] = next[0] ^ simd.u32(salt);
        self.corner::<SLOPES>(simd, REACH, key, &way, raw);
        let size = [way[0].abs(), way[1].abs(), way[2].abs()];
        let x = !(size[0].lt(size[1]) | size[0].lt(size[2]));
        let y = !x & !size[1].lt(size[2]);
        for (axis, farthest) in [x, y, !(x | y)].into_iter().enumerate() {
            way[axis] = (way[axis] - step[axis]).select(farthest, way[axis]);
            key[axis] = next[axis].select(farthest, key[axis]);
        }
        self.corner::<SLOPES>(simd, REACH, key, &way, raw);
    }

    /// The eight corners of the cube that contains a rotated sample.
    #[inline(always)]
    fn eight<const SLOPES: bool>(self, simd: S, salt: u32, cells: &[Cell<S>; 3], raw: &mut Sample<S>) {
        let mut keys = [[simd.u32(0); 2]; 3];
        for axis in 0..3 {
            keys[axis] = self.0.keys(simd, axis, &cells[axis]);
        }
        for number in 0..8 {
            let (mut way, mut key) = ([simd.f32(0.0); 4], [simd.u32(0); 4]);
            for axis in 0..3 {
                let step = number >> axis & 1;
                way[axis] = cells[axis].t - simd.f32(step as f32);
                key[axis] = keys[axis][step];
            }
            key[0] = key[0] ^ simd.u32(salt);
            self.corner::<SLOPES>(simd, WIDE_REACH[1], key, &way, raw);
        }
    }

    #[inline(always)]
    fn corner<const SLOPES: bool>(self, simd: S, reach: f32, key: [S::U32; 4], way: &[S::F32; 4], raw: &mut Sample<S>) {
        let gradient = self.0.gradient::<3>(simd, self.0.hash::<3>(simd, key));
        corner::<S, 3, SLOPES>(simd, reach, &gradient, way, raw);
    }
}

impl<S: Simd, const SMOOTH: bool> Pointwise<S> for Cubes<S, SMOOTH> {
    type Coordinate = S::F64;

    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> Self {
        Self(OpenSource::new(simd, source, octave))
    }

    #[inline(always)]
    fn split(_: S, coordinate: S::F64) -> S::F64 {
        coordinate
    }

    #[inline(always)]
    fn add<const SLOPES: bool>(self, simd: S, octave: &Octave, at: &[S::F64; 4], sum: &mut Sample<S>) {
        let plane = at[0] + at[1];
        let up = at[2] * simd.f64(UP);
        let both = plane * simd.f64(ACROSS) + up;
        let turned = [at[0] + both, at[1] + both, plane * simd.f64(DOWN) + up];
        let half = simd.f64(0.5);
        let zero = simd.f64(0.0);
        let [mut first, mut second] = [[Cell::at(simd, zero); 3]; 2];
        for axis in 0..3 {
            // Corners are at integers in one lattice and at half integers in the other. The smooth variant uses the
            // cube between them, the fast variant the cube around them.
            (first[axis], second[axis]) = if SMOOTH {
                (Cell::of(simd, turned[axis]), Cell::of(simd, turned[axis] + simd.f64(-0.5)))
            } else {
                (Cell::of(simd, turned[axis] + half), Cell::of(simd, turned[axis]))
            };
        }
        let mut raw = [simd.f32(0.0); 5];
        if SMOOTH {
            self.eight::<SLOPES>(simd, 0, &first, &mut raw);
            self.eight::<SLOPES>(simd, SECOND, &second, &mut raw);
        } else {
            self.two::<SLOPES>(simd, 0, &first, &mut raw);
            self.two::<SLOPES>(simd, SECOND, &second, &mut raw);
        }
        if SLOPES {
            // Rotates the slopes back.
            let plane = raw[1] + raw[2];
            let both = plane * simd.f32(ACROSS as f32) + raw[3] * simd.f32(DOWN as f32);
            raw = [raw[0], raw[1] + both, raw[2] + both, (plane + raw[3]) * simd.f32(UP as f32), raw[4]];
        }
        let scale = if SMOOTH { WIDE_SCALE[1] } else { CUBES_SCALE };
        scaled::<S, 3, SLOPES>(simd, octave, scale, &raw, sum);
    }
}
