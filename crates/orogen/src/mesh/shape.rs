//! Which samples of a grid are corners, and of which triangles.

use std::ops::Range;

use rayon::prelude::*;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::Grid;

/// Triangles over the samples of a grid.
///
/// Corners are numbered from 0 in the order of rows, in each from west to east. Triangles are triples of them, counter-clockwise
/// seen from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// Every corner of a lattice, and two triangles for each of its cells.
    Lattice { columns: Vec<u32>, rows: Vec<u32> },
    /// Some samples (column, row), in order, and any triangles.
    Listed { samples: Vec<[u32; 2]>, triangles: Vec<[u32; 3]> },
    /// Some samples, and triangles part by part; a piece is some triangles of a part.
    Joined { samples: ByRow, parts: Vec<Numbered>, pieces: Vec<[u32; 2]>, triangles: usize },
}

/// Some samples of a grid, row by row.
#[derive(Debug, Clone, PartialEq)]
struct ByRow {
    /// Their columns, in each row in order.
    columns: Vec<u32>,
    /// Where each row begins among them, and where the last one ends.
    starts: Vec<u32>,
}

impl ByRow {
    /// The samples of all parts, each once.
    fn of(parts: &[Part]) -> ByRow {
        let places = || parts.iter().flat_map(Part::places);
        let rows = places().map(|[_, row]| row as usize + 1).max().unwrap_or(0);
        let mut starts = vec![0u32; rows + 1];
        places().for_each(|[_, row]| starts[row as usize + 1] += 1);
        (0..rows).for_each(|row| starts[row + 1] += starts[row]);
        let mut columns = vec![0u32; starts[rows] as usize];
        let mut next = starts.clone();
        for [column, row] in places() {
            columns[next[row as usize] as usize] = column;
            next[row as usize] += 1;
        }
        drop(next);
        // Parts share what lies along their edges.
        let mut kept = 0;
        for row in 0..rows {
            let (first, end) = (starts[row] as usize, starts[row + 1] as usize);
            columns[first..end].sort_unstable();
            starts[row] = kept as u32;
            for k in first..end {
                if kept == starts[row] as usize || columns[kept - 1] != columns[k] {
                    columns[kept] = columns[k];
                    kept += 1;
                }
            }
        }
        starts[rows] = kept as u32;
        columns.truncate(kept);
        ByRow { columns, starts }
    }

    /// The columns of a row.
    fn row(&self, row: usize) -> &[u32] {
        &self.columns[self.starts[row] as usize..self.starts[row + 1] as usize]
    }

    /// The number of a sample that is one of them.
    fn number(&self, [column, row]: [u32; 2]) -> u32 {
        let row = row as usize;
        self.starts[row] + self.row(row).partition_point(|other| *other < column) as u32
    }

    /// The column and row of a number.
    fn sample(&self, number: u32) -> [usize; 2] {
        let row = self.starts.partition_point(|start| *start <= number) - 1;
        [self.columns[number as usize] as usize, row]
    }
}

/// Triangles of corners that are numbered within a part.
#[derive(Debug, Clone, PartialEq)]
struct Numbered {
    /// The numbers in the shape.
    numbers: Box<[u32]>,
    triangles: Box<[Packed]>,
}

/// Three numbers of fewer than 21 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Packed(u64);

impl Packed {
    /// Bits of a number.
    const BITS: u32 = 21;

    /// The numbers must be below 2^21.
    pub fn new([a, b, c]: [u32; 3]) -> Packed {
        Packed(u64::from(a) | u64::from(b) << Packed::BITS | u64::from(c) << (2 * Packed::BITS))
    }

    fn get(self) -> [u32; 3] {
        [0, 1, 2].map(|k| (self.0 >> (k * Packed::BITS)) as u32 & ((1 << Packed::BITS) - 1))
    }
}

/// Some triangles over samples of a part of a grid.
pub(super) struct Part {
    /// The part's first column and row.
    pub corner: [u32; 2],
    /// Columns, and above these 16 bits rows, from there: fewer than 2^21 samples.
    pub samples: Box<[u32]>,
    /// Triples of them, counter-clockwise seen from above.
    pub triangles: Box<[Packed]>,
}

impl Part {
    /// The samples' columns and rows in the grid.
    fn places(&self) -> impl Iterator<Item = [u32; 2]> {
        self.samples.iter().map(|sample| self.place(*sample))
    }

    fn place(&self, sample: u32) -> [u32; 2] {
        [self.corner[0] + (sample & 0xffff), self.corner[1] + (sample >> 16)]
    }

    /// The part by the numbers of its samples among all, which take their places.
    fn numbered(mut self, all: &ByRow) -> Numbered {
        let mut numbers = std::mem::take(&mut self.samples);
        numbers.iter_mut().for_each(|sample| *sample = all.number(self.place(*sample)));
        Numbered { numbers, triangles: self.triangles }
    }
}

impl Shape {
    /// Every `step`-th column and row of a grid and always the last ones; two triangles for each cell between them, along the
    /// diagonal whose ends are nearer in height. With a step of 1, every sample.
    ///
    /// Triangles with a corner at a sample that is not finite are left out, and so are corners that no triangle has.
    ///
    /// # Errors
    /// The grid has fewer than two columns or rows, more corners than a mesh can number (2^32 - 1), or no triangle is left.
    pub fn lattice(grid: &Grid, step: usize) -> Result<Shape> {
        let [columns, rows] = [grid.width(), grid.height()].map(|samples| steps(samples, step));
        enough(grid)?;
        numbered(columns.len() as u64 * rows.len() as u64)?;
        let whole = rows.iter().all(|&j| columns.iter().all(|&i| grid.get(i as usize, j as usize).is_finite()));
        let lattice = Shape { kind: Kind::Lattice { columns, rows } };
        if whole { Ok(lattice) } else { lattice.without_holes(grid) }
    }

    /// Parts that share samples along their edges. All samples of a part must be corners of its triangles.
    pub(super) fn joined(parts: Vec<Part>) -> Shape {
        let samples = ByRow::of(&parts);
        let parts: Vec<Numbered> = parts.into_par_iter().map(|part| part.numbered(&samples)).collect();
        let each = |(p, part): (usize, &Numbered)| {
            (0..part.triangles.len().div_ceil(PIECE)).map(move |k| [p as u32, k as u32]).collect::<Vec<_>>()
        };
        let pieces = parts.iter().enumerate().flat_map(each).collect();
        let triangles = parts.iter().map(|part| part.triangles.len()).sum();
        Shape { kind: Kind::Joined { samples, parts, pieces, triangles } }
    }

    /// A lattice's triangles that have all their corners.
    fn without_holes(&self, grid: &Grid) -> Result<Shape> {
        let Kind::Lattice { columns, rows } = &self.kind else { return Ok(self.clone()) };
        let mut number = vec![u32::MAX; columns.len()];
        let mut numbers: [Vec<u32>; 2] = [number.clone(), number.clone()];
        let (mut samples, mut triangles) = (Vec::new(), Vec::new());
        // A row's corners are numbered when the cells above or below it need them, but always in the order of rows: first all
        // that the cells around a row use are marked, then numbered.
        let used = |cell_rows: Range<usize>, out: &mut Vec<u32>, row: usize| {
            out.fill(u32::MAX);
            for r in cell_rows {
                for c in 0..columns.len() - 1 {
                    for triangle in cell(grid, columns, rows, [c, r]).into_iter().flatten() {
                        for [c, at] in triangle {
                            if at == row {
                                out[c] = 0;
                            }
                        }
                    }
                }
            }
        };
        for row in 0..rows.len() {
            used(row.saturating_sub(1)..(row + 1).min(rows.len() - 1), &mut number, row);
            for (c, number) in number.iter_mut().enumerate().filter(|(_, number)| **number == 0) {
                *number = samples.len() as u32;
                samples.push([columns[c], rows[row]]);
            }
            numbers.swap(0, 1);
            numbers[1].copy_from_slice(&number);
            if row > 0 {
                for c in 0..columns.len() - 1 {
                    for triangle in cell(grid, columns, rows, [c, row - 1]).into_iter().flatten() {
                        triangles.push(triangle.map(|[c, at]| numbers[usize::from(at == row)][c]));
                    }
                }
            }
        }
        if triangles.is_empty() {
            return Err(Error::new(
                ErrorKind::Request,
                "no three neighbouring samples are finite, so there is no triangle: nothing to make a mesh of",
            ));
        }
        Ok(Shape { kind: Kind::Listed { samples, triangles } })
    }

    /// How many corners there are.
    pub fn corners(&self) -> usize {
        match &self.kind {
            Kind::Lattice { columns, rows } => columns.len() * rows.len(),
            Kind::Listed { samples, .. } => samples.len(),
            Kind::Joined { samples, .. } => samples.columns.len(),
        }
    }

    /// How many triangles there are.
    pub fn triangles(&self) -> usize {
        match &self.kind {
            Kind::Lattice { columns, rows } => 2 * (columns.len() - 1) * (rows.len() - 1),
            Kind::Listed { triangles, .. } => triangles.len(),
            Kind::Joined { triangles, .. } => *triangles,
        }
    }

    /// The column and row of a corner's sample.
    pub fn sample(&self, corner: u32) -> [usize; 2] {
        match &self.kind {
            Kind::Lattice { columns, rows } => {
                let corner = corner as usize;
                [columns[corner % columns.len()] as usize, rows[corner / columns.len()] as usize]
            }
            Kind::Listed { samples, .. } => samples[corner as usize].map(|place| place as usize),
            Kind::Joined { samples, .. } => samples.sample(corner),
        }
    }

    /// The rows that have corners, in order.
    pub(crate) fn rows(&self) -> Vec<CornerRow<'_>> {
        match &self.kind {
            Kind::Lattice { columns, rows } => {
                rows.iter().map(|&row| CornerRow { row: row as usize, corners: Corners::Columns(columns) }).collect()
            }
            Kind::Joined { samples, .. } => (0..samples.starts.len() - 1)
                .map(|row| CornerRow { row, corners: Corners::Columns(samples.row(row)) })
                .filter(|corners| corners.len() > 0)
                .collect(),
            Kind::Listed { samples, .. } => samples
                .chunk_by(|a, b| a[1] == b[1])
                .map(|corners| CornerRow { row: corners[0][1] as usize, corners: Corners::Samples(corners) })
                .collect(),
        }
    }

    /// In how many pieces the triangles come.
    pub(crate) fn pieces(&self) -> usize {
        match &self.kind {
            Kind::Lattice { rows, .. } => rows.len() - 1,
            Kind::Listed { triangles, .. } => triangles.len().div_ceil(PIECE),
            Kind::Joined { pieces, .. } => pieces.len(),
        }
    }

    /// Hands each triangle of a piece to `each`, in order. `grid` must be the one that the shape was made for.
    pub(crate) fn piece(&self, grid: &Grid, piece: usize, mut each: impl FnMut([u32; 3])) {
        match &self.kind {
            Kind::Lattice { columns, rows } => {
                let width = columns.len() as u32;
                let first = piece as u32 * width;
                let [north, south] = [rows[piece], rows[piece + 1]].map(|row| grid.row(row as usize));
                for (c, pair) in columns.windows(2).enumerate() {
                    let [west, east] = [pair[0] as usize, pair[1] as usize];
                    let [nw, ne] = [first + c as u32, first + c as u32 + 1];
                    let [sw, se] = [nw + width, ne + width];
                    let falling = (north[west] - south[east]).abs() <= (north[east] - south[west]).abs();
                    let [one, other] =
                        if falling { [[nw, sw, se], [nw, se, ne]] } else { [[nw, sw, ne], [ne, sw, se]] };
                    each(one);
                    each(other);
                }
            }
            Kind::Listed { triangles, .. } => {
                triangles[piece * PIECE..triangles.len().min((piece + 1) * PIECE)].iter().copied().for_each(each);
            }
            Kind::Joined { parts, pieces, .. } => {
                let [part, k] = pieces[piece].map(|k| k as usize);
                let Numbered { numbers, triangles } = &parts[part];
                for triangle in &triangles[k * PIECE..triangles.len().min((k + 1) * PIECE)] {
                    each(triangle.get().map(|corner| numbers[corner as usize]));
                }
            }
        }
    }

    /// The greatest vertical distance of a finite sample from the surface, in metres. (Samples that no triangle lies over count
    /// for nothing.)
    pub fn deviation(&self, grid: &Grid) -> f64 {
        let pieces = (0..self.pieces()).into_par_iter().map(|piece| {
            let mut worst: f64 = 0.0;
            self.piece(grid, piece, |triangle| worst = worst.max(distance(grid, triangle.map(|c| self.sample(c)))));
            worst
        });
        pieces.reduce(|| 0.0, f64::max)
    }
}

/// How many listed triangles make a piece.
const PIECE: usize = 1 << 14;

/// A row of samples and those that are corners.
pub(crate) struct CornerRow<'a> {
    /// The row of the grid.
    pub row: usize,
    corners: Corners<'a>,
}

enum Corners<'a> {
    Columns(&'a [u32]),
    Samples(&'a [[u32; 2]]),
}

impl CornerRow<'_> {
    /// How many corners the row has.
    pub fn len(&self) -> usize {
        match self.corners {
            Corners::Columns(columns) => columns.len(),
            Corners::Samples(samples) => samples.len(),
        }
    }

    /// Hands the column of each corner to `each`.
    pub fn each(&self, mut each: impl FnMut(usize)) {
        match self.corners {
            Corners::Columns(columns) => columns.iter().for_each(|&column| each(column as usize)),
            Corners::Samples(samples) => samples.iter().for_each(|&[column, _]| each(column as usize)),
        }
    }
}

/// Every `step`-th of `samples` and the last.
fn steps(samples: usize, step: usize) -> Vec<u32> {
    let last = samples.saturating_sub(1);
    (0..last).step_by(step.max(1)).chain([last]).map(|place| place as u32).collect()
}

/// The triangles of a cell of a lattice that touch no hole, each corner as (index of column, index of row).
fn cell(grid: &Grid, columns: &[u32], rows: &[u32], [c, r]: [usize; 2]) -> [Option<[[usize; 2]; 3]>; 2] {
    let height = |[c, r]: [usize; 2]| grid.get(columns[c] as usize, rows[r] as usize);
    let [nw, ne, sw, se] = [[c, r], [c + 1, r], [c, r + 1], [c + 1, r + 1]];
    let holes = [nw, ne, sw, se].map(|corner| !height(corner).is_finite());
    let falling = match holes {
        // The diagonal that leaves the triangle of the other three.
        [false, false, true, false] | [false, true, false, false] => true,
        [true, false, false, false] | [false, false, false, true] => false,
        _ => (height(nw) - height(se)).abs() <= (height(ne) - height(sw)).abs(),
    };
    let pair = if falling { [[nw, sw, se], [nw, se, ne]] } else { [[nw, sw, ne], [ne, sw, se]] };
    pair.map(|triangle| triangle.iter().all(|&corner| height(corner).is_finite()).then_some(triangle))
}

/// Whether a grid has cells at all.
pub(super) fn enough(grid: &Grid) -> Result<()> {
    match grid.width() < 2 || grid.height() < 2 {
        true => Err(Error::new(
            ErrorKind::Request,
            format!(
                "a mesh needs at least 2 x 2 samples, and there are {} x {}: ask for a larger window",
                grid.width(),
                grid.height()
            ),
        )),
        false => Ok(()),
    }
}

/// Whether so many corners can be numbered in 32 bits.
fn numbered(corners: u64) -> Result<()> {
    match corners >= u64::from(u32::MAX) {
        true => Err(Error::new(
            ErrorKind::Request,
            format!(
                "a mesh numbers at most {} corners, and this one has {corners}: ask for a smaller window or a larger cell",
                u32::MAX - 1
            ),
        )),
        false => Ok(()),
    }
}

/// The greatest vertical distance of a sample of a triangle from it.
fn distance(grid: &Grid, [a, b, c]: [[usize; 2]; 3]) -> f64 {
    let whole = |[column, row]: [usize; 2]| [column as i64, row as i64];
    let turn = |a: [i64; 2], b: [i64; 2], p: [i64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let height = |[column, row]: [usize; 2]| f64::from(grid.get(column, row));
    let places = [whole(a), whole(b), whole(c)];
    // Of counter-clockwise corners with y down the page: negative.
    let area = turn(places[0], places[1], places[2]) as f64;
    let span = |axis: usize| {
        let ends = [a[axis], b[axis], c[axis]];
        ends.iter().copied().min().unwrap_or(0)..ends.iter().copied().max().unwrap_or(0) + 1
    };
    let mut worst: f64 = 0.0;
    for row in span(1) {
        for column in span(0) {
            let p = whole([column, row]);
            let parts = [
                turn(places[1], places[2], p) as f64 / area,
                turn(places[2], places[0], p) as f64 / area,
                turn(places[0], places[1], p) as f64 / area,
            ];
            let off = parts[0] * height(a) + parts[1] * height(b) + parts[2] * height(c) - height([column, row]);
            if parts.iter().all(|part| *part >= 0.0) && off.is_finite() {
                worst = worst.max(off.abs());
            }
        }
    }
    worst
}
