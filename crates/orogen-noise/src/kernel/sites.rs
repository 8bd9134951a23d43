//! The points of cellular noise, one per cell, and the search for the nearest one.
//!
//! The search starts with the cells around the sample's own cell and continues with shells of cells farther out. With
//! all three distances, any point beyond shell r is at least r + m away, where m is the distance of the sample from the
//! side of its cell. The search ends when the result is smaller than that. Skipped points cannot change the result, so
//! the bits do not depend on how far neighboring lanes extend the search.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::{Distance, Feature};
use crate::kernel::cell::Cell;
use crate::kernel::source::{Hashed, Lattice, value};
use crate::program::Cellular;
use orogen_simd::{F32Lanes, MaskLanes, Simd, U32Lanes};

/// Maximum number of shells. With one point per cell, the two nearest points are at most 3 away in the worst case (3D,
/// manhattan). Points that determine an edge are at most as far away as the nearest point plus twice the distance of
/// the edge, which is 5 in total.
const SHELLS: i32 = 5;
/// Rounding errors of distances and of their bounds stay well below this share.
const MARGIN: f32 = 1.0 - 1e-6;
/// The same share for distances of edges, which are computed from differences.
const EDGE_MARGIN: f32 = 1.0 - 1e-5;

/// A distance larger than any other.
pub(crate) const FAR: f32 = 1e9;

/// If the squared distance of the nearest point is less than this, no point beyond the neighboring cells is nearer. The
/// bound of the first shell is at least 1 at any position in the cell.
pub(crate) const NEAR: f32 = MARGIN * MARGIN;

/// A point: its position in its cell, and the hash of its cell.
pub(crate) type Site<S> = ([<S as Simd>::F32; 4], <S as Simd>::U32);

/// A source of the points in the cells next to a sample's cell.
pub(crate) trait Sites<S: Simd> {
    /// The point of the cell at this offset from the sample's own cell. Each component is -1, 0 or 1.
    fn near(&self, simd: S, offset: [i32; 4]) -> Site<S>;
}

/// One octave of cellular noise.
#[derive(Clone, Copy)]
pub(crate) struct Field<S: Simd> {
    pub lattice: Hashed<S>,
    pub cellular: Cellular,
}

impl<S: Simd> Field<S> {
    /// The point of the cell with these keys. Its coordinates are successive rounds of the hash.
    #[inline(always)]
    pub(crate) fn site<const DIMS: usize>(&self, simd: S, keys: [S::U32; 4]) -> Site<S> {
        const ROUNDS: [(u32, u32); 4] = [(0, 0), (16, 0x93D7_65DD), (15, 0x915F_77F5), (16, 0xADB4_A92D)];
        let hash = self.lattice.hash::<DIMS>(simd, keys);
        let (jitter, rest) = (simd.f32(self.cellular.jitter), simd.f32(0.5 - 0.5 * self.cellular.jitter));
        let (mut place, mut word) = ([simd.f32(0.0); 4], hash);
        for axis in 0..DIMS {
            if axis > 0 {
                word = (word ^ word.shr(ROUNDS[axis].0)) * simd.u32(ROUNDS[axis].1);
            }
            let unit = word.shr(8).i32_to_f32() * simd.f32(1.0 / 16_777_216.0);
            place[axis] = unit.mul_add(jitter, rest);
        }
        (place, hash)
    }

    /// The key of the cell that is `offset` cells further along an axis.
    #[inline(always)]
    pub(crate) fn key(&self, simd: S, axis: usize, cell: &Cell<S>, offset: i32) -> S::U32 {
        let at = Cell::at(simd, cell.whole + simd.f64(f64::from(offset)));
        self.lattice.keys(simd, axis, &at)[0]
    }
}

/// Computes the points for each sample.
pub(crate) struct HashedSites<S: Simd, const DIMS: usize> {
    field: Field<S>,
    keys: [[S::U32; 3]; 4],
}

impl<S: Simd, const DIMS: usize> HashedSites<S, DIMS> {
    #[inline(always)]
    pub(crate) fn new(simd: S, field: Field<S>, cells: &[Cell<S>; 4]) -> HashedSites<S, DIMS> {
        let mut keys = [[simd.u32(0); 3]; 4];
        for axis in 0..DIMS {
            for step in 0..3 {
                keys[axis][step] = field.key(simd, axis, &cells[axis], step as i32 - 1);
            }
        }
        HashedSites { field, keys }
    }
}

impl<S: Simd, const DIMS: usize> Sites<S> for HashedSites<S, DIMS> {
    #[inline(always)]
    fn near(&self, simd: S, offset: [i32; 4]) -> Site<S> {
        let mut keys = [simd.u32(0); 4];
        for axis in 0..DIMS {
            keys[axis] = self.keys[axis][(offset[axis] + 1) as usize % 3];
        }
        self.field.site::<DIMS>(simd, keys)
    }
}

/// The two nearest points found so far.
pub(crate) struct Nearest<S: Simd> {
    /// Distances; squared for the euclidean distance.
    pub first: S::F32,
    second: S::F32,
    /// Vector from the sample to the nearest point, and the hash of that point's cell.
    way: [S::F32; 4],
    hash: S::U32,
}

impl<S: Simd> Nearest<S> {
    /// A search result with a single point at the distance `first`.
    #[inline(always)]
    pub(crate) fn at(simd: S, first: S::F32) -> Nearest<S> {
        let far = simd.f32(FAR);
        Nearest { first, second: far, way: [far; 4], hash: simd.u32(0) }
    }
}

/// The length of a vector; squared for the euclidean distance.
#[inline(always)]
fn measure<S: Simd, const DIMS: usize>(distance: Distance, way: &[S::F32; 4]) -> S::F32 {
    match distance {
        Distance::Euclidean => {
            let mut sum = way[0] * way[0];
            for axis in 1..DIMS {
                sum = way[axis].mul_add(way[axis], sum);
            }
            sum
        }
        Distance::Manhattan => {
            let mut sum = way[0].abs();
            for axis in 1..DIMS {
                sum = sum + way[axis].abs();
            }
            sum
        }
        Distance::Chebyshev => {
            let mut most = way[0].abs();
            for axis in 1..DIMS {
                most = most.max(way[axis].abs());
            }
            most
        }
    }
}

/// The vector from the sample at fraction `t` to a point in the cell at `offset`.
#[inline(always)]
fn way<S: Simd, const DIMS: usize>(simd: S, place: &[S::F32; 4], t: &[S::F32; 4], offset: [i32; 4]) -> [S::F32; 4] {
    let mut way = [simd.f32(0.0); 4];
    for axis in 0..DIMS {
        way[axis] = (place[axis] + simd.f32(offset[axis] as f32)) - t[axis];
    }
    way
}

/// Updates the search result with a point. Computes only the parts that the feature needs.
#[inline(always)]
fn keep<S: Simd, const DIMS: usize>(field: &Field<S>, nearest: &mut Nearest<S>, way: [S::F32; 4], hash: S::U32) {
    let Cellular { distance, feature, .. } = field.cellular;
    let d = measure::<S, DIMS>(distance, &way);
    if feature == Feature::F1 {
        nearest.first = nearest.first.min(d);
        return;
    }
    let closer = d.lt(nearest.first);
    nearest.second = nearest.second.min(nearest.first.max(d));
    nearest.first = nearest.first.min(d);
    if matches!(feature, Feature::Value | Feature::Edge) {
        nearest.hash = hash.select(closer, nearest.hash);
        for axis in 0..DIMS {
            nearest.way[axis] = way[axis].select(closer, nearest.way[axis]);
        }
    }
}

/// The distance of the sample from the nearest side of its cell.
#[inline(always)]
fn side<S: Simd, const DIMS: usize>(simd: S, t: &[S::F32; 4]) -> S::F32 {
    let mut side = t[0].min(simd.f32(1.0) - t[0]);
    for axis in 1..DIMS {
        side = side.min(t[axis].min(simd.f32(1.0) - t[axis]));
    }
    side
}

/// The offset of a neighboring cell by its number. The cell itself is one of them.
#[inline(always)]
fn neighbor<const DIMS: usize>(number: usize) -> [i32; 4] {
    let (mut offset, mut rest) = ([0; 4], number);
    for axis in 0..DIMS {
        offset[axis] = (rest % 3) as i32 - 1;
        rest /= 3;
    }
    offset
}

/// The noise for one register of samples, in -1 ..= 1. `cells` are the cells of the samples.
#[inline(always)]
pub(crate) fn evaluate<S: Simd, P: Sites<S>, const DIMS: usize>(
    simd: S,
    field: &Field<S>,
    sites: &P,
    cells: &[Cell<S>; 4],
) -> S::F32 {
    let t = [cells[0].t, cells[1].t, cells[2].t, cells[3].t];
    let mut nearest = Nearest::at(simd, simd.f32(FAR));
    for number in 0..3_usize.pow(DIMS as u32) {
        let offset = neighbor::<DIMS>(number);
        let (place, hash) = sites.near(simd, offset);
        keep::<S, DIMS>(field, &mut nearest, way::<S, DIMS>(simd, &place, &t, offset), hash);
    }
    let side = search_shells::<S, DIMS>(simd, field, cells, &mut nearest);
    let Cellular { distance, feature, .. } = field.cellular;
    let squared = distance == Distance::Euclidean;
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
        Feature::Edge if squared => edge::<S, P, DIMS>(simd, field, sites, cells, (&nearest, first, side)),
        Feature::Edge => (second - first) * simd.f32(0.5),
    };
    spread(simd, raw, field.cellular.bound(DIMS))
}

/// Maps the value of a feature to -1 ..= 1.
#[inline(always)]
pub(crate) fn spread<S: Simd>(simd: S, raw: S::F32, bound: f32) -> S::F32 {
    raw.mul_add(simd.f32(2.0 / bound), simd.f32(-1.0)).min(simd.f32(1.0))
}

/// Searches the shells beyond the neighboring cells as far as necessary. Returns the distance of the sample from the
/// nearest side of its cell.
#[inline(always)]
pub(crate) fn search_shells<S: Simd, const DIMS: usize>(
    simd: S,
    field: &Field<S>,
    cells: &[Cell<S>; 4],
    nearest: &mut Nearest<S>,
) -> S::F32 {
    let Cellular { distance, feature, .. } = field.cellular;
    let squared = distance == Distance::Euclidean;
    let t = [cells[0].t, cells[1].t, cells[2].t, cells[3].t];
    let side = side::<S, DIMS>(simd, &t);
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
        let mut at = Shell::<DIMS>::new(shell + 1);
        while let Some(offset) = at.advance() {
            let (place, hash) = distant::<S, DIMS>(simd, field, cells, offset);
            keep::<S, DIMS>(field, nearest, way::<S, DIMS>(simd, &place, &t, offset), hash);
        }
    }
    side
}

/// The distance to the nearest edge, which is the nearest plane midway between the nearest point and another one.
#[inline(always)]
fn edge<S: Simd, P: Sites<S>, const DIMS: usize>(
    simd: S,
    field: &Field<S>,
    sites: &P,
    cells: &[Cell<S>; 4],
    (nearest, first, side): (&Nearest<S>, S::F32, S::F32),
) -> S::F32 {
    let t = [cells[0].t, cells[1].t, cells[2].t, cells[3].t];
    let mut least = simd.f32(FAR);
    for number in 0..3_usize.pow(DIMS as u32) {
        let offset = neighbor::<DIMS>(number);
        let (place, _) = sites.near(simd, offset);
        let way = way::<S, DIMS>(simd, &place, &t, offset);
        least = least.min(midway::<S, DIMS>(simd, &nearest.way, &way));
    }
    for shell in 1..SHELLS {
        // The plane of a point at distance R is at least (R - first) / 2 away.
        let reach = (side + simd.f32(shell as f32)) * simd.f32(EDGE_MARGIN);
        if !reach.lt(least.mul_add(simd.f32(2.0), first)).any() {
            break;
        }
        let mut at = Shell::<DIMS>::new(shell + 1);
        while let Some(offset) = at.advance() {
            let (place, _) = distant::<S, DIMS>(simd, field, cells, offset);
            let way = way::<S, DIMS>(simd, &place, &t, offset);
            least = least.min(midway::<S, DIMS>(simd, &nearest.way, &way));
        }
    }
    least
}

/// The distance from the sample to the plane midway between two points; very large if they are the same.
#[inline(always)]
fn midway<S: Simd, const DIMS: usize>(simd: S, near: &[S::F32; 4], other: &[S::F32; 4]) -> S::F32 {
    let (mut along, mut apart) = (simd.f32(0.0), simd.f32(0.0));
    for axis in 0..DIMS {
        let between = other[axis] - near[axis];
        along = (other[axis] + near[axis]).mul_add(between, along);
        apart = between.mul_add(between, apart);
    }
    let distance = (along * simd.f32(0.5) / apart.sqrt()).max(simd.f32(0.0));
    distance.select(simd.f32(1e-12).lt(apart), simd.f32(FAR))
}

/// The point of a cell that is not next to the sample's cell.
#[inline(always)]
fn distant<S: Simd, const DIMS: usize>(simd: S, field: &Field<S>, cells: &[Cell<S>; 4], offset: [i32; 4]) -> Site<S> {
    let mut keys = [simd.u32(0); 4];
    for axis in 0..DIMS {
        keys[axis] = field.key(simd, axis, &cells[axis], offset[axis]);
    }
    field.site::<DIMS>(simd, keys)
}

/// The cells at this distance, in a fixed order.
struct Shell<const DIMS: usize> {
    radius: i32,
    next: [i32; 4],
}

impl<const DIMS: usize> Shell<DIMS> {
    #[inline(always)]
    fn new(radius: i32) -> Shell<DIMS> {
        let mut next = [0; 4];
        for axis in 0..DIMS {
            next[axis] = -radius;
        }
        Shell { radius, next }
    }

    /// The next cell. This is not an iterator because of inlining (see kernel/mod.rs).
    #[inline(always)]
    fn advance(&mut self) -> Option<[i32; 4]> {
        let radius = self.radius;
        let here = self.next;
        if here[DIMS - 1] > radius {
            return None;
        }
        // Inside the square (or cube) of the shell, only the two ends of a row belong to the shell.
        let mut whole = false;
        for axis in 1..DIMS {
            whole |= here[axis].abs() == radius;
        }
        self.next[0] += if whole { 1 } else { 2 * radius };
        for axis in 0..DIMS - 1 {
            if self.next[axis] > radius {
                self.next[axis] = -radius;
                self.next[axis + 1] += 1;
            }
        }
        Some(here)
    }
}
