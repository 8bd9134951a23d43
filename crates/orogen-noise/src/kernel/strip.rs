//! A strip of lattice columns, octave by octave: values that depend only on x, and the row vectors of two lattice
//! lines.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::bases::with_basis;
use crate::kernel::basis::{Basis, Numbers, Visit, Weights};
use crate::kernel::cell::{Cell, clamp};
use crate::program::{Octave, Source};
use orogen_simd::{Body, F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};

/// Number of columns per strip. At this width, the row vectors of six octaves fill half of a first-level cache.
pub(crate) const WIDTH: usize = 256;
/// Maximum number of lattice points of a strip that are hashed only once.
const SPAN: usize = WIDTH + 32;
/// Maximum number of lanes.
pub(crate) const MAX_LANES: usize = 16;

/// One octave over the strip. Each array starts at a cache line, because a register that straddles two cache lines
/// costs twice as much.
#[repr(C, align(64))]
pub(crate) struct StripOctave {
    /// The row vectors of two lattice lines, next to each other. Vectors of values are read most often and lie in one
    /// page, so that octaves do not evict each other from the cache.
    lines: [[[f32; WIDTH]; 2]; 8],
    /// For each row: coefficients of the value, of the slopes along x (and z and w), and of the slope along y; four
    /// each.
    pub coefficients: [[[f32; MAX_LANES]; 4]; 3],
    /// Fractions and fades for each column: (1 - u) t, u (t - 1), 1 - u, u, then the slopes of the first two and of u.
    weights: [[f32; WIDTH]; 7],
    /// If dense: the lattice point of each column, relative to the first of its register.
    index: [u32; WIDTH],
    /// If dense, the keys of the lattice points. Otherwise the keys of each column's cell and of the next cell.
    keys: [[u32; SPAN]; 2],
    /// For each row, the keys of the lattice lines above and below.
    line_keys: [[u32; MAX_LANES]; 2],
    /// For each row, its row of cells.
    cells: [u64; MAX_LANES],
    /// If dense: the first lattice point of each register, relative to the first of the strip.
    first: [u32; WIDTH / 4],
    /// If dense: the number of lattice points.
    points: usize,
    /// Whether the lattice points of each register fit into one register.
    dense: bool,
    /// The index of the upper line.
    upper: usize,
    /// The row of cells between the lines.
    held: Option<u64>,
}

impl StripOctave {
    pub(crate) const fn new() -> StripOctave {
        StripOctave {
            weights: [[0.0; WIDTH]; 7],
            dense: false,
            index: [0; WIDTH],
            first: [0; WIDTH / 4],
            points: 0,
            keys: [[0; SPAN]; 2],
            lines: [[[0.0; WIDTH]; 2]; 8],
            upper: 0,
            held: None,
            cells: [0; MAX_LANES],
            line_keys: [[0; MAX_LANES]; 2],
            coefficients: [[[0.0; MAX_LANES]; 4]; 3],
        }
    }

    /// A row vector of the upper (0) or lower (1) line.
    #[inline(always)]
    pub(crate) fn row(&self, line: usize, vector: usize) -> &[f32; WIDTH] {
        &self.lines[vector & 7][(self.upper ^ line) & 1]
    }

    /// Sets the lines to those around row `r` of the group. Only changes are computed: successive rows mostly have the
    /// same two lines, and the next row of cells shares one line.
    #[inline(always)]
    pub(crate) fn hold<S: Simd>(&mut self, simd: S, job: &Job, octave: &Octave, points: &mut Points, r: usize) {
        let cell = self.cells[r];
        if self.held == Some(cell) {
            return;
        }
        let [above, below] = [self.line_keys[0][r], self.line_keys[1][r]];
        let held = self.held.replace(cell);
        if held.map(|held| held.wrapping_add(1)) == Some(cell) {
            self.upper ^= 1;
            self.build(simd, (job, octave), points, 1, below);
        } else if held.map(|held| held.wrapping_sub(1)) == Some(cell) {
            self.upper ^= 1;
            self.build(simd, (job, octave), points, 0, above);
        } else {
            self.build(simd, (job, octave), points, 0, above);
            self.build(simd, (job, octave), points, 1, below);
        }
    }

    #[inline(always)]
    fn build<S: Simd>(&mut self, simd: S, (job, octave): (&Job, &Octave), points: &mut Points, line: usize, key: u32) {
        let strip = self;
        match (job.dims, job.slopes) {
            (2, false) => simd.run(Line::<2, false> { job, octave, strip, points, line, key }),
            (2, true) => simd.run(Line::<2, true> { job, octave, strip, points, line, key }),
            (3, false) => simd.run(Line::<3, false> { job, octave, strip, points, line, key }),
            (3, true) => simd.run(Line::<3, true> { job, octave, strip, points, line, key }),
            (_, _) => simd.run(Line::<4, false> { job, octave, strip, points, line, key }),
        }
    }
}

/// The numbers of the lattice points of a line.
#[repr(align(64))]
pub(crate) struct Points([[f32; SPAN]; 9]);

/// An empty [`Points`].
pub(crate) const NO_POINTS: Points = Points([[0.0; SPAN]; 9]);

/// Values that are common to all octaves of a strip. Kernels receive a reference, because a struct that is copied field
/// by field is slow to read as a whole.
pub(crate) struct Job {
    pub source: Source,
    pub limit: f64,
    pub slopes: bool,
    /// Number of axes.
    pub dims: usize,
    /// z and w of the slice in metres, if these axes exist.
    pub depths: [f64; 2],
    /// Number of columns of the strip.
    pub columns: usize,
}

impl Job {
    #[inline(always)]
    fn split<S: Simd>(&self, simd: S, octave: &Octave, position: S::F64, axis: usize) -> Cell<S> {
        let held = clamp(simd, position, self.limit);
        Cell::split(simd, octave, axis, held)
    }

    #[inline(always)]
    fn registers<S: Simd>(&self) -> usize {
        self.columns.div_ceil(S::LANES).min(WIDTH / S::LANES)
    }
}

/// The first column of register `v`. The mask lets the compiler omit bounds checks.
#[inline(always)]
fn at<S: Simd>(v: usize) -> usize {
    (v & (WIDTH / S::LANES - 1)) * S::LANES
}

/// Computes the columns of a strip.
pub(crate) struct Columns<'a> {
    pub job: &'a Job,
    pub octave: &'a Octave,
    pub strip: &'a mut StripOctave,
    /// x of the columns in metres; at least one column.
    pub xs: &'a [f64],
}

impl Body for Columns<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        // Values that depend only on x or only on y are the same in all dimensions.
        with_basis::<S, _, 2>(simd, self.job.source, self);
    }
}

impl<S: Simd> Visit<S> for Columns<'_> {
    #[inline(always)]
    fn visit<B: Basis<S>>(self, simd: S) {
        let basis = B::new(simd, self.job.source, self.octave);
        let Columns { job, octave, strip, xs } = self;
        strip.held = None;
        let Some(&last) = xs.last() else { return };
        let registers = job.registers::<S>();
        let mut lanes = [0.0; MAX_LANES];
        job.split(simd, octave, simd.load_f64_partial(xs, last), 0).whole.store(&mut lanes);
        let origin = lanes[0];

        let mut reach = simd.u32(0);
        let mut farthest = 0;
        for v in 0..registers {
            let cell = job.split(simd, octave, simd.load_f64_partial(&xs[v * S::LANES..], last), 0);
            let column = Weights::new(simd, cell.t, basis.fade(simd, cell.t));
            let kept =
                [column.ramp[0], column.ramp[1], column.u[0], column.u[1], column.dramp[0], column.dramp[1], column.du];
            for place in 0..if job.slopes { 7 } else { 4 } {
                kept[place].store(&mut strip.weights[place][at::<S>(v)..]);
            }
            // Cells relative to the first cell of the strip. Small numbers are exact. Large numbers, and cells before
            // the first, become huge and fail the tests below.
            let place = (cell.whole - simd.f64(origin)).narrow().to_i32();
            let mut places = [0; MAX_LANES];
            place.store(&mut places);
            let index = place - simd.u32(places[0]);
            index.store(&mut strip.index[at::<S>(v)..]);
            strip.first[v] = places[0];
            reach = reach | index;
            farthest = farthest.max(places[0]);
        }
        let spread = !reach.shr(S::LANES.trailing_zeros()).eq(simd.u32(0));
        strip.dense = !spread.any() && (farthest as usize) <= SPAN - 2 * S::LANES;

        if strip.dense {
            strip.points = (farthest as usize + S::LANES + 1).next_multiple_of(S::LANES).min(SPAN);
            const COUNT: [f64; MAX_LANES] =
                [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
            for p in (0..strip.points).step_by(S::LANES) {
                let cell = Cell::at(simd, simd.f64(origin + p as f64) + simd.load_f64(&COUNT));
                basis.keys(simd, 0, &cell)[0].store(&mut strip.keys[0][p..]);
            }
        } else {
            for v in 0..registers {
                let cell = job.split(simd, octave, simd.load_f64_partial(&xs[v * S::LANES..], last), 0);
                let [here, next] = basis.keys(simd, 0, &cell);
                here.store(&mut strip.keys[0][at::<S>(v)..]);
                next.store(&mut strip.keys[1][at::<S>(v)..]);
            }
        }
    }
}

/// Computes a group of rows, one per lane.
pub(crate) struct Rows<'a> {
    pub job: &'a Job,
    pub octave: &'a Octave,
    pub strip: &'a mut StripOctave,
    /// y of the rows in metres; at most as many as there are lanes.
    pub ys: &'a [f64],
}

impl Body for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        // Values that depend only on x or only on y are the same in all dimensions.
        with_basis::<S, _, 2>(simd, self.job.source, self);
    }
}

impl<S: Simd> Visit<S> for Rows<'_> {
    #[inline(always)]
    fn visit<B: Basis<S>>(self, simd: S) {
        let basis = B::new(simd, self.job.source, self.octave);
        let Rows { job, octave, strip, ys } = self;
        let Some(&last) = ys.last() else { return };
        let cell = job.split(simd, octave, simd.load_f64_partial(ys, last), 1);
        let [above, below] = basis.keys(simd, 1, &cell);
        above.store(&mut strip.line_keys[0]);
        below.store(&mut strip.line_keys[1]);
        let (mut low, mut high) = ([0; MAX_LANES], [0; MAX_LANES]);
        cell.low.store(&mut low);
        cell.high.store(&mut high);
        for ((cell, low), high) in strip.cells.iter_mut().zip(low).zip(high) {
            *cell = u64::from(high) << 32 | u64::from(low);
        }
        let row = Weights::new(simd, cell.t, basis.fade(simd, cell.t));
        let made = basis.coefficients(simd, &row, simd.f32(octave.amplitude), simd.f32(octave.slope));
        for place in 0..4 {
            made.value[place].store(&mut strip.coefficients[0][place]);
            made.along[place].store(&mut strip.coefficients[1][place]);
            made.across[place].store(&mut strip.coefficients[2][place]);
        }
    }
}

/// Computes the row vectors of one lattice line.
struct Line<'a, const DIMS: usize, const SLOPES: bool> {
    job: &'a Job,
    octave: &'a Octave,
    strip: &'a mut StripOctave,
    points: &'a mut Points,
    /// The upper (0) or lower (1) line.
    line: usize,
    key: u32,
}

impl<const DIMS: usize, const SLOPES: bool> Body for Line<'_, DIMS, SLOPES> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        with_basis::<S, _, DIMS>(simd, self.job.source, self);
    }
}

impl<S: Simd, const DIMS: usize, const SLOPES: bool> Visit<S> for Line<'_, DIMS, SLOPES> {
    #[inline(always)]
    fn visit<B: Basis<S>>(self, simd: S) {
        let basis = B::new(simd, self.job.source, self.octave);
        let Line { job, octave, strip, points, line, key } = self;
        let points = &mut points.0;
        let key = simd.u32(key);
        let depths = basis.depths(
            simd,
            &[job.split(simd, octave, simd.f64(job.depths[0]), 2), job.split(simd, octave, simd.f64(job.depths[1]), 3)],
        );
        let numbers = if SLOPES { (B::DIMS - 1) * B::NUMBERS } else { B::NUMBERS };
        let dense = strip.dense;
        if dense {
            for p in (0..strip.points.min(SPAN)).step_by(S::LANES) {
                let made = basis.point::<SLOPES>(simd, simd.load_u32(&strip.keys[0][p..]), key, &depths);
                for place in 0..numbers {
                    made[place].store(&mut points[place][p..]);
                }
            }
        }
        let which = (strip.upper ^ line) & 1;
        for v in 0..job.registers::<S>() {
            let at = at::<S>(v);
            let none = simd.f32(0.0);
            let (mut left, mut right): (Numbers<S>, Numbers<S>) = ([none; 9], [none; 9]);
            if dense {
                let first = (strip.first[v & (WIDTH / 4 - 1)] as usize).min(SPAN - 1 - S::LANES);
                let index = simd.load_u32(&strip.index[at..]);
                for place in 0..numbers {
                    left[place] = simd.load(&points[place][first..]).permute(index);
                    right[place] = simd.load(&points[place][first + 1..]).permute(index);
                }
            } else {
                left = basis.point::<SLOPES>(simd, simd.load_u32(&strip.keys[0][at..]), key, &depths);
                right = basis.point::<SLOPES>(simd, simd.load_u32(&strip.keys[1][at..]), key, &depths);
            }
            let weights = &strip.weights;
            let column = Weights {
                t: [none; 2],
                ramp: [simd.load(&weights[0][at..]), simd.load(&weights[1][at..])],
                u: [simd.load(&weights[2][at..]), simd.load(&weights[3][at..])],
                dramp: if SLOPES { [simd.load(&weights[4][at..]), simd.load(&weights[5][at..])] } else { [none; 2] },
                du: if SLOPES { simd.load(&weights[6][at..]) } else { none },
            };
            let made = basis.rows::<SLOPES>(simd, &left, &right, &column);
            for place in 0..if SLOPES { 2 * B::DIMS } else { 2 } {
                if place % 2 < B::RANK {
                    made[place].store(&mut strip.lines[place][which][at..]);
                }
            }
        }
    }
}
