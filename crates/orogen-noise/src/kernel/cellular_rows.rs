//! Cellular noise on lattices of samples: each cell is hashed once.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::{Distance, Feature};
use crate::kernel::blocks::Blocks;
use crate::kernel::cell::{Cell, clamp};
use crate::kernel::outputs::Outputs;
use crate::kernel::sites::{FAR, Field, NEAR, Nearest, Site, Sites, evaluate, search_shells, spread};
use crate::kernel::source::{Hashed, Lattice};
use crate::points::{Depth, Points};
use crate::program::{self, Octave, Program};
use orogen_simd::{Body, F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};

/// Columns per strip.
const WIDTH: usize = 256;
/// Maximum number of cells of a strip whose points are kept.
const SPAN: usize = WIDTH + 48;
/// Maximum number of lanes.
const MAX_LANES: usize = 16;

/// Number of rows per band if columns are processed in runs. All rows of a band lie in one line of cells.
const BAND: usize = 8;
/// Maximum length of a run, in columns. In a shorter run fewer points can be the nearest.
const RUN: usize = 64;

/// Consecutive columns in one cell.
#[derive(Clone, Copy)]
struct Run {
    start: usize,
    end: usize,
    /// The index of the cell, relative to the first cell of the strip.
    cell: usize,
    /// The range of the fractions of the columns.
    range: [f32; 2],
}

/// The points of the cells along three lattice lines (at three depths in 3D), and the columns of the strip.
#[repr(C, align(64))]
struct Strip {
    /// Positions of the points in their cells.
    places: [[[f32; SPAN]; 3]; 9],
    hashes: [[u32; SPAN]; 9],
    /// The keys of the cells, starting one cell before the first of the strip.
    keys: [u32; SPAN],
    /// Fractions of the columns. The last register of the last run reads past the end of the columns.
    t: [f32; WIDTH + MAX_LANES],
    /// The cell numbers of the columns.
    wholes: [f64; WIDTH],
    /// The cells of the columns, relative to the first of their register.
    index: [u32; WIDTH],
    /// The first cell of each register, relative to the first of the strip.
    first: [u32; WIDTH / 4],
    /// Whether a register lies within one cell.
    alone: [bool; WIDTH / 4],
    /// The line of cells that each third of the tables holds.
    held: [Option<f64>; 3],
    /// Number of cells of the strip.
    cells: usize,
    /// The cell number of the first column.
    origin: f64,
    /// The runs of columns. Empty if runs are too short to be faster.
    runs: Vec<Run>,
    /// Whether the cells of a register fit into one register of the tables.
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
        t: [0.0; WIDTH + MAX_LANES],
        wholes: [0.0; WIDTH],
        index: [0; WIDTH],
        first: [0; WIDTH / 4],
        alone: [false; WIDTH / 4],
        held: [None; 3],
        cells: 0,
        origin: 0.0,
        runs: Vec::new(),
        dense: false,
    });
    let plain = matches!((cellular.feature, cellular.distance), (Feature::F1, Distance::Euclidean));
    let job = Job { limit: program.limit, octave, cellular, z };
    for (s, columns) in xs.chunks(WIDTH).enumerate() {
        simd.run(Columns { job, strip: &mut strip, xs: columns });
        if const { DIMS == 2 } && plain && strip.dense && !strip.runs.is_empty() {
            let (mut r, stride) = (0, xs.len());
            while r < ys.len() {
                let to = &mut outputs.value[r * stride + s * WIDTH..];
                r += simd.run(Band { job, strip: &mut strip, ys: &ys[r..], to, stride, columns: columns.len() });
            }
            continue;
        }
        for (r, y) in ys.iter().enumerate() {
            let start = r * xs.len() + s * WIDTH;
            let target = outputs.part(start, columns.len());
            if strip.dense {
                let (y, to) = (*y, target.value);
                if plain {
                    simd.run(Row::<DIMS, true> { job, strip: &mut strip, y, to });
                } else {
                    simd.run(Row::<DIMS, false> { job, strip: &mut strip, y, to });
                }
            } else {
                let points = Points::Lattice { xs: columns, ys: std::slice::from_ref(y) };
                let depths = &[Depth::Slice(z)][..DIMS - 2];
                simd.run(Blocks::<DIMS> { program, points, depths, outputs: target });
            }
        }
    }
}

/// Values that are common to all strips.
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
            // Small numbers are exact. Large numbers become huge and fail the tests below.
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
        strip.origin = origin;
        strip.find_runs(xs.len().min(WIDTH), S::LANES);
        // One more cell on each side.
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

impl Strip {
    /// Lists the runs. The list stays empty if runs are shorter than two registers on average.
    fn find_runs(&mut self, columns: usize, lanes: usize) {
        self.runs.clear();
        let cell = |column: usize| (self.first[column / lanes] + self.index[column]) as usize;
        let mut start = 0;
        while start < columns {
            let mut end = start + 1;
            while end < columns && cell(end) == cell(start) {
                end += 1;
            }
            // Pieces of about equal length. All but the last one consist of whole registers.
            let pieces = (end - start).div_ceil(RUN);
            let length = (end - start).div_ceil(pieces).next_multiple_of(lanes);
            for from in (start..end).step_by(length) {
                let to = (from + length).min(end);
                let mut range = [f32::MAX, f32::MIN];
                for t in &self.t[from..to] {
                    range = [range[0].min(*t), range[1].max(*t)];
                }
                self.runs.push(Run { start: from, end: to, cell: cell(start), range });
            }
            start = end;
        }
        if columns < 2 * self.runs.len() * lanes {
            self.runs.clear();
        }
    }
}

/// The rows of a strip that lie in one line of cells, at most [`BAND`], for F1 with euclidean distance in the plane.
/// Returns their number. The samples of a run in these rows are in the same cell. Of its nine neighbors, only those
/// whose points can be the nearest to one of the samples are read.
struct Band<'a> {
    job: Job<'a>,
    strip: &'a mut Strip,
    /// y of the rows, from the first row of the band on.
    ys: &'a [f64],
    /// The results, from the first column of the first row on.
    to: &'a mut [f32],
    /// Distance from one row to the next, in samples.
    stride: usize,
    columns: usize,
}

/// Points that can be the nearest, relative to the cell of the samples.
struct Candidates {
    x: [f32; 9],
    y: [f32; 9],
    count: usize,
}

impl Body for Band<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> usize {
        let Band { job, strip, ys, to, stride, columns } = self;
        let Some(&first) = ys.first() else { return 0 };
        let mut cellular = job.cellular;
        (cellular.feature, cellular.distance) = (Feature::F1, Distance::Euclidean);
        let field = Field { lattice: Hashed::new(simd, job.octave), cellular };
        let cell = Cell::split(simd, job.octave, 1, clamp(simd, simd.load_f64_partial(ys, first), job.limit));
        let (mut wholes, mut t) = ([0.0; MAX_LANES], [0.0; MAX_LANES]);
        cell.whole.store(&mut wholes);
        cell.t.store(&mut t);
        let bound = cellular.bound(2);
        let mut rows = 1;
        while rows < ys.len().min(BAND).min(S::LANES) && wholes[rows] == wholes[0] {
            rows += 1;
        }
        let thirds = hold::<S, 2>(simd, &field, strip, simd.f64(wholes[0]), &cell);
        let mut range = [t[0], t[0]];
        for row in 1..rows {
            range = [range[0].min(t[row]), range[1].max(t[row])];
        }
        for number in 0..strip.runs.len() {
            let run = strip.runs[number];
            let near = candidates(simd, strip, thirds, &run, range);
            for row in 0..rows {
                let place = RunSamples {
                    field: &field,
                    octave: job.octave,
                    near: &near,
                    whole: [strip.origin + run.cell as f64, wholes[0]],
                    y: t[row],
                    bound,
                };
                let to = &mut to[row * stride..][..columns];
                let mut at = run.start;
                while run.end - at >= 4 * S::LANES {
                    nearest::<S, 4>(simd, &place, &strip.t, to, at, None);
                    at += 4 * S::LANES;
                }
                if run.end - at >= 2 * S::LANES {
                    nearest::<S, 2>(simd, &place, &strip.t, to, at, None);
                    at += 2 * S::LANES;
                }
                if run.end - at >= S::LANES {
                    nearest::<S, 1>(simd, &place, &strip.t, to, at, None);
                    at += S::LANES;
                }
                if at == run.end {
                    continue;
                }
                if run.end - run.start >= S::LANES {
                    // This computes some columns twice.
                    nearest::<S, 1>(simd, &place, &strip.t, to, run.end - S::LANES, None);
                } else {
                    // This writes wrong values into some columns of the next run, which overwrites them.
                    nearest::<S, 1>(simd, &place, &strip.t, to, at, Some(run.range));
                }
            }
        }
        rows
    }
}

/// The points that can be the nearest in a run. `y` is the range of the fractions of its rows.
#[inline(always)]
fn candidates<S: Simd>(simd: S, strip: &Strip, thirds: [usize; 3], run: &Run, y: [f32; 2]) -> Candidates {
    /// Rounding errors of squared distances are far below this.
    const CLEAR: f32 = 1e-4;
    let (mut xs, mut ys) = ([FAR.sqrt(); MAX_LANES], [0.0; MAX_LANES]);
    for number in 0..9 {
        let (x, y) = (number % 3, number / 3);
        let at = (run.cell + x).min(SPAN - 1);
        let places = &strip.places[(3 + thirds[y]).min(8)];
        xs[number] = places[0][at] + (x as f32 - 1.0);
        ys[number] = places[1][at] + (y as f32 - 1.0);
    }
    // Squared distances from the four corners of the samples' box. The difference of two squared distances is linear
    // over the box, so a point that is farther than another from all four corners is farther from every sample.
    let mut corners = [[0.0; MAX_LANES]; 4];
    for at in (0..9).step_by(S::LANES) {
        let (x, height) = (simd.load(&xs[at..]), simd.load(&ys[at..]));
        for corner in 0..4 {
            let (x, y) = (x - simd.f32(run.range[corner & 1]), height - simd.f32(y[corner >> 1]));
            (x * x + y * y).store(&mut corners[corner][at..]);
        }
    }
    let mut left = 0;
    for at in (0..9).step_by(S::LANES) {
        let own = [
            simd.load(&corners[0][at..]) - simd.f32(CLEAR),
            simd.load(&corners[1][at..]) - simd.f32(CLEAR),
            simd.load(&corners[2][at..]) - simd.f32(CLEAR),
            simd.load(&corners[3][at..]) - simd.f32(CLEAR),
        ];
        let mut farther = own[0].lt(own[0]);
        for other in 0..9 {
            let mut all = simd.f32(corners[0][other]).lt(own[0]);
            for corner in 1..4 {
                all = all & simd.f32(corners[corner][other]).lt(own[corner]);
            }
            farther = farther | all;
        }
        left |= (!farther).to_bits() << at;
    }
    left &= 511;
    let mut near = Candidates { x: [0.0; 9], y: [0.0; 9], count: 0 };
    while left != 0 {
        let number = left.trailing_zeros() as usize % MAX_LANES;
        near.x[near.count % 9] = xs[number];
        near.y[near.count % 9] = ys[number];
        near.count += 1;
        left &= left - 1;
    }
    near
}

/// Values that are common to the samples of a row and run.
struct RunSamples<'a, S: Simd> {
    field: &'a Field<S>,
    octave: &'a Octave,
    near: &'a Candidates,
    /// The cell of the samples.
    whole: [f64; 2],
    /// The fraction of y of the samples.
    y: f32,
    /// Maximum distance.
    bound: f32,
}

/// Computes `N` registers of a row from column `at` on. Fractions outside `range` are clamped to it.
#[inline(always)]
fn nearest<S: Simd, const N: usize>(
    simd: S,
    place: &RunSamples<S>,
    t: &[f32; WIDTH + MAX_LANES],
    to: &mut [f32],
    at: usize,
    range: Option<[f32; 2]>,
) {
    let t = &t[at.min(WIDTH + MAX_LANES - N * S::LANES)..][..N * S::LANES];
    let (mut x, mut first) = ([simd.f32(0.0); N], [simd.f32(FAR); N]);
    for n in 0..N {
        x[n] = simd.load(&t[n * S::LANES..]);
        if let Some([least, most]) = range {
            x[n] = x[n].max(simd.f32(least)).min(simd.f32(most));
        }
    }
    for number in 0..place.near.count.min(9) {
        let (across, along) = (simd.f32(place.near.y[number] - place.y), simd.f32(place.near.x[number]));
        for n in 0..N {
            // The same operations as in [`crate::kernel::sites`].
            let way = along - x[n];
            first[n] = first[n].min(across.mul_add(across, way * way));
        }
    }
    for n in 0..N {
        if (!first[n].lt(simd.f32(NEAR))).any() {
            let (mut ways, mut found) = ([0.0; MAX_LANES], [0.0; MAX_LANES]);
            x[n].store(&mut ways);
            first[n].store(&mut found);
            let RunSamples { octave, whole, y, .. } = *place;
            simd.run(Beyond { cellular: place.field.cellular, octave, whole, x: &ways, y, found: &mut found });
            first[n] = simd.load(&found);
        }
        let noise = spread(simd, first[n].sqrt(), place.bound);
        let scaled = simd.f32(place.octave.amplitude).mul_add(noise, simd.f32(0.0));
        scaled.store_partial(&mut to[at + n * S::LANES..]);
    }
}

/// Searches beyond the neighboring cells for a register of samples, if the nearest point is farther than [`NEAR`].
struct Beyond<'a> {
    cellular: program::Cellular,
    octave: &'a Octave,
    /// The cell of the samples.
    whole: [f64; 2],
    /// The fractions of the samples.
    x: &'a [f32; MAX_LANES],
    y: f32,
    /// Squared distances.
    found: &'a mut [f32; MAX_LANES],
}

impl Body for Beyond<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let field = Field { lattice: Hashed::new(simd, self.octave), cellular: self.cellular };
        let mut x = Cell::at(simd, simd.f64(self.whole[0]));
        let mut y = Cell::at(simd, simd.f64(self.whole[1]));
        (x.t, y.t) = (simd.load(self.x), simd.f32(self.y));
        let mut nearest = Nearest::at(simd, simd.load(self.found));
        search_shells::<S, 2>(simd, &field, &[x, y, y, y], &mut nearest);
        nearest.first.store(self.found);
    }
}

/// One row of samples within a strip. `PLAIN` selects the kernel without branches for F1 with euclidean distance.
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
        let thirds = hold::<S, DIMS>(simd, &field, strip, y.whole, &z);
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
            // The same operations as in [`crate::kernel::cellular::Cellular`].
            let scaled = simd.f32(job.octave.amplitude).mul_add(noise, simd.f32(0.0));
            scaled.store_partial(&mut to[at..]);
            at += S::LANES;
        }
    }
}

/// Computes the missing points of the three lines of cells around the line `y`; returns the indices of the lines.
#[inline(always)]
fn hold<S: Simd, const DIMS: usize>(
    simd: S,
    field: &Field<S>,
    strip: &mut Strip,
    y: S::F64,
    z: &Cell<S>,
) -> [usize; 3] {
    let y = Cell::at(simd, y);
    let mut lanes = [0.0; MAX_LANES];
    y.whole.store(&mut lanes);
    let mut thirds = [0; 3];
    for line in 0..3 {
        let number = lanes[0] + line as f64 - 1.0;
        // Lines rotate, so the next row of cells needs one new line.
        let third = (number - (number / 3.0).floor() * 3.0) as usize % 3;
        thirds[line] = third;
        if strip.held[third] != Some(number) {
            strip.held[third] = Some(number);
            build::<S, DIMS>(simd, field, strip, (third, field.key(simd, 1, &y, line as i32 - 1)), z);
        }
    }
    thirds
}

/// Computes the points of one line of cells (at three depths in 3D).
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

/// Points selected for each register of samples.
struct KeptSites<'a, S: Simd> {
    strip: &'a Strip,
    thirds: [usize; 3],
    first: usize,
    index: S::U32,
}

/// Points selected for a register within one cell.
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
