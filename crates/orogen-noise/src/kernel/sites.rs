//! The points that cellular noise is made of, one in each cell, and the search for the nearest.
//!
//! The search looks at the cells around the sample's own, then at shells of cells ever farther out. Whatever lies beyond shell r is
//! at least r + m away, in all three distances, where m is how far the sample is from the side of its cell; so the search is over
//! once what is sought is nearer than that. What is skipped could not have changed the result: the bits do not depend on how far
//! the neighbouring lanes made the search go.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::{Distance, Feature};
use crate::kernel::cell::Cell;
use crate::kernel::source::{Hashed, Lattice, value};
use crate::program::Cellular;
use orogen_simd::{F32Lanes, MaskLanes, Simd, U32Lanes};

/// Shells searched at most. With a point in every cell the nearest two are at most 3 away even in the widest case (3D, manhattan),
/// and nothing that decides an edge is farther than the nearest plus twice the edge's distance, 5 in all.
const SHELLS: i32 = 5;
/// Rounding of distances and of what they are compared with stays well below this share.
const MARGIN: f32 = 1.0 - 1e-6;
/// The same where distances of edges are compared, which come from differences.
const EDGE_MARGIN: f32 = 1.0 - 1e-5;

/// A point: its place in its cell, and its cell's hash.
pub(crate) type Site<S> = ([<S as Simd>::F32; 3], <S as Simd>::U32);

/// Where the points of the cells next to a sample's come from.
pub(crate) trait Sites<S: Simd> {
    /// The point of the cell that many cells on from the sample's own; each offset is -1, 0 or 1.
    fn near(&self, simd: S, offset: [i32; 3]) -> Site<S>;
}

/// The numbers of one octave of cellular noise.
#[derive(Clone, Copy)]
pub(crate) struct Field<S: Simd> {
    pub lattice: Hashed<S>,
    pub cellular: Cellular,
}

impl<S: Simd> Field<S> {
    /// The point of the cell with those keys. Coordinates are successive rounds of the hash's own mixing.
    #[inline(always)]
    pub(crate) fn site(&self, simd: S, deep: bool, [x, y, z]: [S::U32; 3]) -> Site<S> {
        let hash = if deep { self.lattice.hash3(simd, x, y, z) } else { self.lattice.hash2(simd, x, y) };
        let second = (hash ^ hash.shr(16)) * simd.u32(0x93D7_65DD);
        let (jitter, rest) = (simd.f32(self.cellular.jitter), simd.f32(0.5 - 0.5 * self.cellular.jitter));
        let third = if deep { (second ^ second.shr(15)) * simd.u32(0x915F_77F5) } else { second };
        let mut place = [simd.f32(0.0); 3];
        let words = [hash, second, third];
        for axis in 0..if deep { 3 } else { 2 } {
            let unit = words[axis].shr(8).i32_to_f32() * simd.f32(1.0 / 16_777_216.0);
            place[axis] = unit.mul_add(jitter, rest);
        }
        (place, hash)
    }

    /// The key of the cell `offset` cells on along an axis.
    #[inline(always)]
    pub(crate) fn key(&self, simd: S, axis: usize, cell: &Cell<S>, offset: i32) -> S::U32 {
        let at = Cell::at(simd, cell.whole + simd.f64(f64::from(offset)));
        self.lattice.keys(simd, axis, &at)[0]
    }
}

/// Points hashed for each sample.
pub(crate) struct HashedSites<S: Simd> {
    field: Field<S>,
    deep: bool,
    keys: [[S::U32; 3]; 3],
}

impl<S: Simd> HashedSites<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, field: Field<S>, cells: &[Cell<S>; 3], deep: bool) -> HashedSites<S> {
        let mut keys = [[simd.u32(0); 3]; 3];
        for axis in 0..if deep { 3 } else { 2 } {
            for step in 0..3 {
                keys[axis][step] = field.key(simd, axis, &cells[axis], step as i32 - 1);
            }
        }
        HashedSites { field, deep, keys }
    }
}

impl<S: Simd> Sites<S> for HashedSites<S> {
    #[inline(always)]
    fn near(&self, simd: S, [x, y, z]: [i32; 3]) -> Site<S> {
        let [columns, rows, depths] = &self.keys;
        let keys = [columns[(x + 1) as usize % 3], rows[(y + 1) as usize % 3], depths[(z + 1) as usize % 3]];
        self.field.site(simd, self.deep, keys)
    }
}

/// The two nearest points so far.
struct Nearest<S: Simd> {
    /// Distances; of the euclidean one, the squares.
    first: S::F32,
    second: S::F32,
    /// From the sample to the nearest point, and the hash of its cell.
    way: [S::F32; 3],
    hash: S::U32,
}

/// The distance of a vector; of the euclidean one, its square.
#[inline(always)]
fn measure<S: Simd, const DEEP: bool>(distance: Distance, way: &[S::F32; 3]) -> S::F32 {
    match distance {
        Distance::Euclidean => {
            let flat = way[1].mul_add(way[1], way[0] * way[0]);
            if DEEP { way[2].mul_add(way[2], flat) } else { flat }
        }
        Distance::Manhattan => {
            let flat = way[0].abs() + way[1].abs();
            if DEEP { flat + way[2].abs() } else { flat }
        }
        Distance::Chebyshev => {
            let flat = way[0].abs().max(way[1].abs());
            if DEEP { flat.max(way[2].abs()) } else { flat }
        }
    }
}

/// From the sample, `t` into its cell, to a site in the cell `offset` on.
#[inline(always)]
fn way<S: Simd, const DEEP: bool>(simd: S, place: &[S::F32; 3], t: &[S::F32; 3], offset: [i32; 3]) -> [S::F32; 3] {
    let mut way = [simd.f32(0.0); 3];
    for axis in 0..if DEEP { 3 } else { 2 } {
        way[axis] = (place[axis] + simd.f32(offset[axis] as f32)) - t[axis];
    }
    way
}

/// Takes a point into account, as far as the feature needs it.
#[inline(always)]
fn keep<S: Simd, const DEEP: bool>(field: &Field<S>, nearest: &mut Nearest<S>, way: [S::F32; 3], hash: S::U32) {
    let Cellular { distance, feature, .. } = field.cellular;
    let d = measure::<S, DEEP>(distance, &way);
    if feature == Feature::F1 {
        nearest.first = nearest.first.min(d);
        return;
    }
    let closer = d.lt(nearest.first);
    nearest.second = nearest.second.min(nearest.first.max(d));
    nearest.first = nearest.first.min(d);
    if matches!(feature, Feature::Value | Feature::Edge) {
        nearest.hash = hash.select(closer, nearest.hash);
        for axis in 0..if DEEP { 3 } else { 2 } {
            nearest.way[axis] = way[axis].select(closer, nearest.way[axis]);
        }
    }
}

/// How far the sample is from the nearest side of its cell.
#[inline(always)]
fn side<S: Simd, const DEEP: bool>(simd: S, t: &[S::F32; 3]) -> S::F32 {
    let mut side = t[0].min(simd.f32(1.0) - t[0]);
    for axis in 1..if DEEP { 3 } else { 2 } {
        side = side.min(t[axis].min(simd.f32(1.0) - t[axis]));
    }
    side
}

/// The noise of one register of samples, from -1 to 1. `cells` are the samples' own.
#[inline(always)]
pub(crate) fn evaluate<S: Simd, P: Sites<S>, const DEEP: bool>(
    simd: S,
    field: &Field<S>,
    sites: &P,
    cells: &[Cell<S>; 3],
) -> S::F32 {
    let Cellular { distance, feature, .. } = field.cellular;
    let squared = distance == Distance::Euclidean;
    let t = [cells[0].t, cells[1].t, cells[2].t];
    let far = simd.f32(1e9);
    let mut nearest = Nearest { first: far, second: far, way: [far; 3], hash: simd.u32(0) };
    for z in if DEEP { -1..2 } else { 0..1 } {
        for y in -1..2 {
            for x in -1..2 {
                let (place, hash) = sites.near(simd, [x, y, z]);
                let way = way::<S, DEEP>(simd, &place, &t, [x, y, z]);
                keep::<S, DEEP>(field, &mut nearest, way, hash);
            }
        }
    }
    let side = side::<S, DEEP>(simd, &t);
    let one = match feature {
        Feature::F1 | Feature::Value => true,
        Feature::Edge => squared,
        Feature::F2 | Feature::Difference | Feature::Product => false,
    };
    for shell in 1..SHELLS {
        let reach = (side + simd.f32(shell as f32)) * simd.f32(MARGIN);
        let found = if one { nearest.first } else { nearest.second };
        if !if squared { reach * reach } else { reach }.lt(found).any() {
            break;
        }
        let mut at = Shell::new(shell + 1, DEEP);
        while let Some(offset) = at.advance() {
            let (place, hash) = distant::<S, DEEP>(simd, field, cells, offset);
            keep::<S, DEEP>(field, &mut nearest, way::<S, DEEP>(simd, &place, &t, offset), hash);
        }
    }
    let (mut first, mut second) = (nearest.first, nearest.second);
    if squared {
        (first, second) = (first.sqrt(), second.sqrt());
    }
    let raw = match feature {
        Feature::F1 => first,
        Feature::F2 => second,
        Feature::Difference => second - first,
        Feature::Product => first * second,
        Feature::Value => return value(simd, (nearest.hash ^ nearest.hash.shr(16)) * simd.u32(0xADB4_A92D)),
        Feature::Edge if squared => edge::<S, P, DEEP>(simd, field, sites, cells, (&nearest, first, side)),
        Feature::Edge => (second - first) * simd.f32(0.5),
    };
    raw.mul_add(simd.f32(2.0 / field.cellular.bound(DEEP)), simd.f32(-1.0)).min(simd.f32(1.0))
}

/// The distance to the nearest edge: to the nearest of the planes midway between the nearest point and each other one.
#[inline(always)]
fn edge<S: Simd, P: Sites<S>, const DEEP: bool>(
    simd: S,
    field: &Field<S>,
    sites: &P,
    cells: &[Cell<S>; 3],
    (nearest, first, side): (&Nearest<S>, S::F32, S::F32),
) -> S::F32 {
    let t = [cells[0].t, cells[1].t, cells[2].t];
    let mut least = simd.f32(1e9);
    for z in if DEEP { -1..2 } else { 0..1 } {
        for y in -1..2 {
            for x in -1..2 {
                let (place, _) = sites.near(simd, [x, y, z]);
                let way = way::<S, DEEP>(simd, &place, &t, [x, y, z]);
                least = least.min(midway::<S, DEEP>(simd, &nearest.way, &way));
            }
        }
    }
    for shell in 1..SHELLS {
        // A point R away has its plane at least (R - first) / 2 away.
        let reach = (side + simd.f32(shell as f32)) * simd.f32(EDGE_MARGIN);
        if !reach.lt(least.mul_add(simd.f32(2.0), first)).any() {
            break;
        }
        let mut at = Shell::new(shell + 1, DEEP);
        while let Some(offset) = at.advance() {
            let (place, _) = distant::<S, DEEP>(simd, field, cells, offset);
            let way = way::<S, DEEP>(simd, &place, &t, offset);
            least = least.min(midway::<S, DEEP>(simd, &nearest.way, &way));
        }
    }
    least
}

/// From the sample to the plane midway between two points; far where they are one.
#[inline(always)]
fn midway<S: Simd, const DEEP: bool>(simd: S, near: &[S::F32; 3], other: &[S::F32; 3]) -> S::F32 {
    let (mut along, mut apart) = (simd.f32(0.0), simd.f32(0.0));
    for axis in 0..if DEEP { 3 } else { 2 } {
        let between = other[axis] - near[axis];
        along = (other[axis] + near[axis]).mul_add(between, along);
        apart = between.mul_add(between, apart);
    }
    let distance = (along * simd.f32(0.5) / apart.sqrt()).max(simd.f32(0.0));
    distance.select(simd.f32(1e-12).lt(apart), simd.f32(1e9))
}

/// A point farther than one cell away.
#[inline(always)]
fn distant<S: Simd, const DEEP: bool>(simd: S, field: &Field<S>, cells: &[Cell<S>; 3], offset: [i32; 3]) -> Site<S> {
    let mut keys = [simd.u32(0); 3];
    for axis in 0..if DEEP { 3 } else { 2 } {
        keys[axis] = field.key(simd, axis, &cells[axis], offset[axis]);
    }
    field.site(simd, DEEP, keys)
}

/// The cells that many away, in a fixed order.
struct Shell {
    radius: i32,
    next: [i32; 3],
    deep: bool,
}

impl Shell {
    #[inline(always)]
    fn new(radius: i32, deep: bool) -> Shell {
        Shell { radius, next: [-radius, -radius, if deep { -radius } else { 0 }], deep }
    }

    /// The next cell. (Not an iterator: see kernel/mod.rs.)
    #[inline(always)]
    fn advance(&mut self) -> Option<[i32; 3]> {
        let radius = self.radius;
        let last = if self.deep { radius } else { 0 };
        if self.next[2] > last {
            return None;
        }
        let here = self.next;
        let [x, y, z] = &mut self.next;
        // Inside the square (or cube) of the shell there are only the two ends of a row.
        let whole = y.abs() == radius || z.abs() == radius;
        *x += if whole { 1 } else { 2 * radius };
        if *x > radius {
            (*x, *y) = (-radius, *y + 1);
        }
        if *y > radius {
            (*y, *z) = (-radius, *z + 1);
        }
        Some(here)
    }
}
