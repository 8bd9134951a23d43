//! Lattices of samples of cellular noise: each cell is hashed once.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::{Distance, Feature};
use crate::kernel::cell::{Cell, clamp};
use crate::kernel::families::with_family;
use crate::kernel::outputs::Outputs;
use crate::kernel::scattered::Call;
use crate::kernel::sites::{Field, Site, Sites, evaluate};
use crate::kernel::source::{Hashed, Lattice};
use crate::program::{self, Octave, Program};
use orogen_simd::{Body, F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};

/// Columns worked on at a time.
const WIDTH: usize = 256;
/// Cells a strip may span and still have its points kept.
const SPAN: usize = WIDTH + 48;
/// The most lanes of any level.
const MAX_LANES: usize = 16;

/// The points of the cells along three lines of the lattice (times three depths), and the columns over them.
#[repr(C, align(64))]
struct Strip {
    /// Places in their cells.
    places: [[[f32; SPAN]; 3]; 9],
    hashes: [[u32; SPAN]; 9],
    /// The keys of the cells, from the one before the strip's first on.
    keys: [u32; SPAN],
    /// Fractions of the columns.
    t: [f32; WIDTH],
    /// Their cells' numbers.
    wholes: [f64; WIDTH],
    /// Their cells, counted from their register's first.
    index: [u32; WIDTH],
    /// Each register's first cell, counted from the strip's first.
    first: [u32; WIDTH / 4],
    /// Whether a register lies within one cell.
    alone: [bool; WIDTH / 4],
    /// The line of cells each third of the tables holds.
    held: [Option<f64>; 3],
    /// How many cells there are.
    cells: usize,
    /// Whether cells follow so closely that those of a register fit one.
    dense: bool,
}

/// Fills a lattice; `z` is the depth of the slice in space.
#[inline(always)]
pub(crate) fn fill<S: Simd, const DIMS: usize>(
    simd: S,
    (program, octave, cellular): (&Program, &Octave, program::Cellular),
    (xs, ys): (&[f64], &[f64]),
    z: f64,
    outputs: &mut Outputs,
) {
    let mut strip = Box::new(Strip {
        places: [[[0.0; SPAN]; 3]; 9],
        hashes: [[0; SPAN]; 9],
        keys: [0; SPAN],
        t: [0.0; WIDTH],
        wholes: [0.0; WIDTH],
        index: [0; WIDTH],
        first: [0; WIDTH / 4],
        alone: [false; WIDTH / 4],
        held: [None; 3],
        cells: 0,
        dense: false,
    });
    let job = Job { limit: program.limit, octave, cellular, z };
    for (s, columns) in xs.chunks(WIDTH).enumerate() {
        simd.run(Columns { job, strip: &mut strip, xs: columns });
        for (r, y) in ys.iter().enumerate() {
            let start = r * xs.len() + s * WIDTH;
            let target = outputs.part(start, columns.len());
            if strip.dense {
                let (y, to) = (*y, target.value);
                if matches!((cellular.feature, cellular.distance), (Feature::F1, Distance::Euclidean)) {
                    simd.run(Row::<DIMS, true> { job, strip: &mut strip, y, to });
                } else {
                    simd.run(Row::<DIMS, false> { job, strip: &mut strip, y, to });
                }
            } else {
                let (rows, depths) = ([*y; WIDTH], [z; WIDTH]);
                let at = [columns, &rows[..columns.len()], &depths[..columns.len()], &[]];
                with_family::<_, DIMS>(program.source, Call::<S, DIMS> { simd, program, at, target });
            }
        }
    }
}

/// What is the same for all strips.
#[derive(Clone, Copy)]
struct Job<'a> {
    limit: f64,
    octave: &'a Octave,
    cellular: program::Cellular,
    z: f64,
}

/// Prepares the columns of a strip.
struct Columns<'a> {
    job: Job<'a>,
    strip: &'a mut Strip,
    xs: &'a [f64],
}

impl Body for Columns<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Columns { job, strip, xs } = self;
        strip.held = [None; 3];
        let Some(&last) = xs.last() else { return };
        let mut lanes = [0.0; MAX_LANES];
        let (mut origin, mut reach, mut farthest) = (0.0, simd.u32(0), 0);
        for v in 0..xs.len().div_ceil(S::LANES).min(WIDTH / S::LANES) {
            let at = v * S::LANES;
            let held = clamp(simd, simd.load_f64_partial(&xs[at..], last), job.limit);
            let cell = Cell::split(simd, job.octave, 0, held);
            cell.whole.store(&mut lanes);
            if v == 0 {
                origin = lanes[0];
            }
            cell.t.store(&mut strip.t[at..]);
            cell.whole.store(&mut strip.wholes[at..]);
            // Exact while small; what is not turns into a huge number and fails the tests below.
            let place = (cell.whole - simd.f64(origin)).narrow().to_i32();
            let mut places = [0; MAX_LANES];
            place.store(&mut places);
            let index = place - simd.u32(places[0]);
            index.store(&mut strip.index[at..]);
            strip.first[v] = places[0];
            strip.alone[v] = !(!index.eq(simd.u32(0))).any();
            reach = reach | index;
            farthest = farthest.max(places[0]);
        }
        let spread = !reach.shr(S::LANES.trailing_zeros()).eq(simd.u32(0));
        strip.dense = !spread.any() && (farthest as usize) <= SPAN - 2 * S::LANES - 2;
        if !strip.dense {
            return;
        }
        // One cell more on either side.
        strip.cells = (farthest as usize + S::LANES + 2).next_multiple_of(S::LANES).min(SPAN);
        const COUNT: [f64; MAX_LANES] =
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
        let lattice = Hashed::new(simd, job.octave);
        for p in (0..strip.cells).step_by(S::LANES) {
            let cell = Cell::at(simd, simd.f64(origin - 1.0 + p as f64) + simd.load_f64(&COUNT));
            lattice.keys(simd, 0, &cell)[0].store(&mut strip.keys[p..]);
        }
    }
}

/// One row of samples within a strip; `PLAIN`: of the usual noise, whose kernel is worth making without the others' choices.
struct Row<'a, const DIMS: usize, const PLAIN: bool> {
    job: Job<'a>,
    strip: &'a mut Strip,
    y: f64,
    to: &'a mut [f32],
}

impl<const DIMS: usize, const PLAIN: bool> Body for Row<'_, DIMS, PLAIN> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Row { job, strip, y, to } = self;
        let mut cellular = job.cellular;
        if PLAIN {
            (cellular.feature, cellular.distance) = (Feature::F1, Distance::Euclidean);
        }
        let field = Field { lattice: Hashed::new(simd, job.octave), cellular };
        let y = Cell::split(simd, job.octave, 1, clamp(simd, simd.f64(y), job.limit));
        let z = Cell::split(simd, job.octave, 2, clamp(simd, simd.f64(job.z), job.limit));
        let mut lanes = [0.0; MAX_LANES];
        y.whole.store(&mut lanes);
        let mut thirds = [0; 3];
        for line in 0..3 {
            let number = lanes[0] + line as f64 - 1.0;
            // Lines take turns, so that the next row of cells needs one new one.
            let third = (number - (number / 3.0).floor() * 3.0) as usize % 3;
            thirds[line] = third;
            if strip.held[third] != Some(number) {
                strip.held[third] = Some(number);
                build::<S, DIMS>(simd, &field, strip, (third, field.key(simd, 1, &y, line as i32 - 1)), &z);
            }
        }
        let mut at = 0;
        while at < to.len().min(WIDTH) {
            let v = at / S::LANES;
            let (t, whole) = (simd.load(&strip.t[at..]), simd.load_f64(&strip.wholes[at..]));
            let cells = [Cell { whole, low: simd.u32(0), high: simd.u32(0), t }, y, z, z];
            let first = (strip.first[v] as usize).min(SPAN - S::LANES - 2);
            let noise = if strip.alone[v] {
                evaluate::<S, _, DIMS>(simd, &field, &LoneSites { strip, thirds, first }, &cells)
            } else {
                let sites = KeptSites::<S> { strip, thirds, first, index: simd.load_u32(&strip.index[at..]) };
                evaluate::<S, _, DIMS>(simd, &field, &sites, &cells)
            };
            // As [`crate::kernel::cellular::Cellular`] adds it.
            let scaled = simd.f32(job.octave.amplitude).mul_add(noise, simd.f32(0.0));
            scaled.store_partial(&mut to[at..]);
            at += S::LANES;
        }
    }
}

/// Makes the points of one line of cells (at three depths).
#[inline(always)]
fn build<S: Simd, const DIMS: usize>(
    simd: S,
    field: &Field<S>,
    strip: &mut Strip,
    (third, row): (usize, S::U32),
    z: &Cell<S>,
) {
    for step in if DIMS > 2 { 0..3 } else { 1..2 } {
        let depth = if DIMS > 2 { field.key(simd, 2, z, step as i32 - 1) } else { simd.u32(0) };
        let table = 3 * step + third;
        for p in (0..strip.cells.min(SPAN)).step_by(S::LANES) {
            let (place, hash) = field.site::<DIMS>(simd, [simd.load_u32(&strip.keys[p..]), row, depth, depth]);
            for axis in 0..DIMS {
                place[axis].store(&mut strip.places[table][axis][p..]);
            }
            hash.store(&mut strip.hashes[table][p..]);
        }
    }
}

/// Points looked up for each register of samples.
struct KeptSites<'a, S: Simd> {
    strip: &'a Strip,
    thirds: [usize; 3],
    first: usize,
    index: S::U32,
}

/// The same for a register within one cell.
struct LoneSites<'a> {
    strip: &'a Strip,
    thirds: [usize; 3],
    first: usize,
}

impl<S: Simd> Sites<S> for LoneSites<'_> {
    #[inline(always)]
    fn near(&self, simd: S, [x, y, z, _]: [i32; 4]) -> Site<S> {
        let table = (3 * (z + 1) as usize + self.thirds[(y + 1) as usize % 3]).min(8);
        let at = (self.first as i32 + 1 + x) as usize;
        let (places, hashes) = (&self.strip.places[table], &self.strip.hashes[table]);
        let mut place = [simd.f32(0.0); 4];
        for axis in 0..3 {
            place[axis] = simd.f32(places[axis][at]);
        }
        (place, simd.u32(hashes[at]))
    }
}

impl<S: Simd> Sites<S> for KeptSites<'_, S> {
    #[inline(always)]
    fn near(&self, simd: S, [x, y, z, _]: [i32; 4]) -> Site<S> {
        let table = (3 * (z + 1) as usize + self.thirds[(y + 1) as usize % 3]).min(8);
        let at = (self.first as i32 + 1 + x) as usize;
        let (places, hashes) = (&self.strip.places[table], &self.strip.hashes[table]);
        let mut place = [simd.f32(0.0); 4];
        for axis in 0..3 {
            place[axis] = simd.load(&places[axis][at..]).permute(self.index);
        }
        (place, simd.load_u32(&hashes[at..]).permute(self.index))
    }
}
