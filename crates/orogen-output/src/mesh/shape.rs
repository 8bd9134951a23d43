//! The vertices and triangles of a mesh over a grid.

use std::ops::Range;

use orogen_grid::parallel;

use super::packed::{PIECE, PackedTriangles};
use super::sample_set::{SampleSet, Word, columns, count};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_grid::triangles::falls;

/// Triangles over the samples of a grid.
///
/// Vertices are numbered from 0, row by row, each row from west to east. Triangles are triples of vertices,
/// counter-clockwise seen from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// All vertices of a lattice, and two triangles for each of its cells.
    Lattice { columns: Vec<u32>, rows: Vec<u32> },
    /// Listed samples (column, row), in order, and any triangles.
    Listed { samples: Vec<[u32; 2]>, triangles: Vec<[u32; 3]> },
    /// A set of samples, and triangles by parts; a piece is some triangles of a part.
    Joined { samples: SampleSet, parts: Vec<Part>, pieces: Vec<[u32; 2]>, triangles: usize },
}

/// Triangles over the samples of a part of a grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    /// The part's first column and row.
    pub corner: [usize; 2],
    /// Triples of its samples, counter-clockwise seen from above.
    pub triangles: PackedTriangles,
}

impl Part {
    /// Calls `each` with each triangle of a piece, its vertices as columns and rows of the grid.
    fn piece(&self, piece: usize, mut each: impl FnMut([[usize; 2]; 3])) {
        let [left, top] = self.corner;
        self.triangles.piece(piece, |triangle| {
            each(triangle.map(|[column, row]| [left + column as usize, top + row as usize]));
        });
    }
}

impl Shape {
    /// Every `step`-th column and row of a grid and always the last ones, with two triangles for each cell between
    /// them, split along the diagonal with the smaller difference in height. With a step of 1, every sample.
    ///
    /// Triangles that touch a sample that is not finite are omitted, and so are vertices without triangles.
    ///
    /// # Errors
    /// The grid has fewer than two columns or rows, more vertices than a mesh can number (2^32 - 1), or no triangle
    /// remains.
    pub fn lattice(grid: &Grid, step: usize) -> Result<Shape> {
        let [columns, rows] = [grid.width(), grid.height()].map(|samples| steps(samples, step));
        enough(grid)?;
        numbered(columns.len() as u64 * rows.len() as u64)?;
        let whole = rows.iter().all(|&j| columns.iter().all(|&i| grid[(i as usize, j as usize)].is_finite()));
        let lattice = Shape { kind: Kind::Lattice { columns, rows } };
        if whole { Ok(lattice) } else { lattice.without_holes(grid) }
    }

    /// Joins parts of a grid of this width and height. They may share samples along their edges.
    pub(super) fn joined(size: [usize; 2], parts: Vec<Part>) -> Shape {
        let mut samples = SampleSet::empty(size);
        let mut pieces = Vec::new();
        for (p, part) in parts.iter().enumerate() {
            for k in 0..part.triangles.pieces() {
                part.piece(k, |triangle| triangle.into_iter().for_each(|sample| samples.insert(sample)));
                pieces.push([p as u32, k as u32]);
            }
        }
        samples.number_all();
        let triangles = parts.iter().map(|part| part.triangles.count()).sum();
        Shape { kind: Kind::Joined { samples, parts, pieces, triangles } }
    }

    /// The triangles of a lattice without missing vertices.
    fn without_holes(&self, grid: &Grid) -> Result<Shape> {
        let Kind::Lattice { columns, rows } = &self.kind else { return Ok(self.clone()) };
        let mut number = vec![u32::MAX; columns.len()];
        let mut numbers: [Vec<u32>; 2] = [number.clone(), number.clone()];
        let (mut samples, mut triangles) = (Vec::new(), Vec::new());
        // A row's vertices are numbered when the cells above or below need them, but always row by row: first all
        // vertices that the cells around a row use are marked, then they are numbered.
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
                "the mesh would be empty: no three neighboring samples are finite",
            ));
        }
        Ok(Shape { kind: Kind::Listed { samples, triangles } })
    }

    /// Number of vertices.
    #[must_use]
    pub fn corners(&self) -> usize {
        match &self.kind {
            Kind::Lattice { columns, rows } => columns.len() * rows.len(),
            Kind::Listed { samples, .. } => samples.len(),
            Kind::Joined { samples, .. } => samples.len(),
        }
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        match &self.kind {
            Kind::Lattice { columns, rows } => 2 * (columns.len() - 1) * (rows.len() - 1),
            Kind::Listed { triangles, .. } => triangles.len(),
            Kind::Joined { triangles, .. } => *triangles,
        }
    }

    /// The column and row of a vertex.
    #[must_use]
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

    /// The rows that have vertices, in order.
    pub(crate) fn rows(&self) -> Vec<CornerRow<'_>> {
        match &self.kind {
            Kind::Lattice { columns, rows } => {
                rows.iter().map(|&row| CornerRow { row: row as usize, corners: Corners::Columns(columns) }).collect()
            }
            Kind::Joined { samples, .. } => samples
                .rows()
                .enumerate()
                .map(|(row, words)| CornerRow { row, corners: Corners::Words(words) })
                .filter(|corners| corners.len() > 0)
                .collect(),
            Kind::Listed { samples, .. } => samples
                .chunk_by(|a, b| a[1] == b[1])
                .map(|corners| CornerRow { row: corners[0][1] as usize, corners: Corners::Samples(corners) })
                .collect(),
        }
    }

    /// Number of pieces of the triangles.
    pub(crate) fn pieces(&self) -> usize {
        match &self.kind {
            Kind::Lattice { rows, .. } => rows.len() - 1,
            Kind::Listed { triangles, .. } => triangles.len().div_ceil(PIECE),
            Kind::Joined { pieces, .. } => pieces.len(),
        }
    }

    /// Calls `each` with each triangle of a piece, in order. `grid` must be the grid that the shape was made for.
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
            Kind::Joined { samples, parts, pieces, .. } => {
                let [part, k] = pieces[piece].map(|k| k as usize);
                parts[part].piece(k, |triangle| each(triangle.map(|sample| samples.number(sample))));
            }
        }
    }

    /// The maximum vertical distance of a finite sample from the surface, in metres. Samples that are not covered by a
    /// triangle are ignored.
    pub fn deviation(&self, grid: &Grid) -> f64 {
        let pieces = parallel::map(0..self.pieces(), |piece| {
            let mut worst: f64 = 0.0;
            self.piece(grid, piece, |triangle| worst = worst.max(distance(grid, triangle.map(|c| self.sample(c)))));
            worst
        });
        pieces.into_iter().fold(0.0, f64::max)
    }
}

/// A row of the grid with its vertices.
pub(crate) struct CornerRow<'a> {
    /// The row of the grid.
    pub row: usize,
    corners: Corners<'a>,
}

enum Corners<'a> {
    Columns(&'a [u32]),
    Samples(&'a [[u32; 2]]),
    Words(&'a [Word]),
}

impl CornerRow<'_> {
    /// Number of vertices in the row.
    pub fn len(&self) -> usize {
        match self.corners {
            Corners::Columns(columns) => columns.len(),
            Corners::Samples(samples) => samples.len(),
            Corners::Words(words) => count(words),
        }
    }

    /// Calls `each` with the column of each vertex.
    pub fn each(&self, mut each: impl FnMut(usize)) {
        match self.corners {
            Corners::Columns(columns) => columns.iter().for_each(|&column| each(column as usize)),
            Corners::Samples(samples) => samples.iter().for_each(|&[column, _]| each(column as usize)),
            Corners::Words(words) => columns(words, each),
        }
    }
}

/// Every `step`-th of `samples` and the last.
fn steps(samples: usize, step: usize) -> Vec<u32> {
    let last = samples.saturating_sub(1);
    (0..last).step_by(step.max(1)).chain([last]).map(|place| place as u32).collect()
}

/// The triangles of a cell of a lattice without missing vertices, each vertex as (index of column, index of row).
fn cell(grid: &Grid, columns: &[u32], rows: &[u32], [c, r]: [usize; 2]) -> [Option<[[usize; 2]; 3]>; 2] {
    let height = |[c, r]: [usize; 2]| grid[(columns[c] as usize, rows[r] as usize)];
    let [nw, ne, sw, se] = [[c, r], [c + 1, r], [c, r + 1], [c + 1, r + 1]];
    let falling = falls([nw, ne, sw, se].map(height));
    let pair = if falling { [[nw, sw, se], [nw, se, ne]] } else { [[nw, sw, ne], [ne, sw, se]] };
    pair.map(|triangle| triangle.iter().all(|&corner| height(corner).is_finite()).then_some(triangle))
}

/// Checks that a grid has cells.
pub(super) fn enough(grid: &Grid) -> Result<()> {
    match grid.width() < 2 || grid.height() < 2 {
        true => Err(Error::new(
            ErrorKind::Request,
            format!(
                "a mesh needs at least 2 x 2 samples, and there are {} x {}; use a larger window",
                grid.width(),
                grid.height()
            ),
        )),
        false => Ok(()),
    }
}

/// Checks that this many vertices can be numbered in 32 bits.
fn numbered(corners: u64) -> Result<()> {
    match corners >= u64::from(u32::MAX) {
        true => Err(Error::new(
            ErrorKind::Request,
            format!(
                "a mesh holds at most {} vertices, and this one has {corners}; use a smaller window or a larger cell",
                u32::MAX - 1
            ),
        )),
        false => Ok(()),
    }
}

/// The maximum vertical distance of a sample of a triangle from it.
fn distance(grid: &Grid, [a, b, c]: [[usize; 2]; 3]) -> f64 {
    let whole = |[column, row]: [usize; 2]| [column as i64, row as i64];
    let turn = |a: [i64; 2], b: [i64; 2], p: [i64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let height = |[column, row]: [usize; 2]| f64::from(grid[(column, row)]);
    let places = [whole(a), whole(b), whole(c)];
    // For counter-clockwise vertices with y downward: negative.
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
