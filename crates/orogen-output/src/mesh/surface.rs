//! A shape over its grid, as formats write it: all vertices, then all triangles.

use std::io::{self, Write};

use orogen_grid::parallel;

use super::shape::Shape;
use crate::map::paint::Painter;
use orogen_grid::analysis::halo::Halo;
use orogen_grid::analysis::slope::{Gradient, gradients_between};
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;

/// The input of a format: a shape over a grid of heights in metres.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    /// The heights.
    pub grid: &'a Grid,
    /// The samples around the grid, for the normals at its border.
    pub halo: &'a Halo,
    /// The triangles.
    pub shape: &'a Shape,
    /// Factor that heights are multiplied by.
    pub exaggeration: f32,
    /// The colors of vertices, on request.
    pub painter: Option<&'a Painter>,
    /// Receives the progress of the triangles, if present.
    pub progress: Option<&'a Progress>,
}

/// A vertex, in metres from the first sample of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Metres east of the first column.
    pub east: f32,
    /// The height, exaggerated.
    pub height: f32,
    /// Metres south of the first row.
    pub south: f32,
    /// The unit normal of the height field: east, up, south. Upward if it was not requested.
    pub normal: [f32; 3],
    /// The center of the sample's pixel in a picture with one pixel per sample: to the right and down, 0 to 1.
    pub texture: [f32; 2],
    /// sRGB; white if it was not requested or there is no painter.
    pub color: [u8; 3],
}

/// The properties of vertices, in addition to their position, that a format needs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Normals.
    pub normals: bool,
    /// Colors.
    pub colors: bool,
}

/// Approximate number of samples that are processed between two writes.
const BAND: usize = 1 << 18;

/// Buffers for making a row.
#[derive(Default)]
struct Scratch {
    wide: Vec<f32>,
    normals: Vec<[f32; 3]>,
    colors: Vec<u8>,
}

impl Surface<'_> {
    /// Writes the bytes that `emit` appends for each vertex, in order.
    pub fn corners(
        &self,
        out: &mut dyn Write,
        wanted: Wanted,
        emit: impl Fn(&Corner, &mut Vec<u8>) + Sync,
    ) -> io::Result<()> {
        let rows = self.shape.rows();
        for band in rows.chunks((BAND / self.grid.width().max(1)).clamp(8, 256)) {
            let mut made = vec![Vec::new(); band.len()];
            parallel::for_each_init(band.iter().zip(&mut made), Scratch::default, |scratch, (corners, bytes)| {
                self.prepare(corners.row, wanted, scratch);
                *bytes = Vec::with_capacity(40 * corners.len());
                corners.each(|column| emit(&self.corner(column, corners.row, scratch), bytes));
            });
            made.iter().try_for_each(|bytes| out.write_all(bytes))?;
        }
        Ok(())
    }

    /// Writes the bytes that `emit` appends for each triangle, in order.
    pub fn triangles(&self, out: &mut dyn Write, emit: impl Fn([u32; 3], &mut Vec<u8>) + Sync) -> io::Result<()> {
        let pieces: Vec<usize> = (0..self.shape.pieces()).collect();
        let each = self.shape.triangles() / pieces.len().max(1);
        let advance = |pieces: usize| self.progress.iter().for_each(|progress| progress.advance(pieces as f64));
        self.progress.iter().for_each(|progress| progress.expect(pieces.len() as f64));
        for band in pieces.chunks((BAND / each.max(1)).clamp(8, 256)) {
            let made: Vec<Vec<u8>> = parallel::map(band, |&piece| {
                let mut bytes = Vec::new();
                self.shape.piece(self.grid, piece, |triangle| emit(triangle, &mut bytes));
                bytes
            });
            made.iter().try_for_each(|bytes| out.write_all(bytes))?;
            advance(band.len());
        }
        Ok(())
    }

    /// The bounds of the vertices: minimum and maximum of east, height and south, in metres.
    #[must_use]
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        let rows = self.shape.rows();
        let none = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        let join = |a: [[f32; 3]; 2], b: [[f32; 3]; 2]| {
            [std::array::from_fn(|i| a[0][i].min(b[0][i])), std::array::from_fn(|i| a[1][i].max(b[1][i]))]
        };
        let of_row = |corners: &super::shape::CornerRow| {
            let mut bounds = none;
            corners.each(|column| {
                let place = self.place(column, corners.row);
                bounds = join(bounds, [place, place]);
            });
            bounds
        };
        parallel::map(&rows, of_row).into_iter().fold(none, join)
    }

    /// East, height and south of a sample, in metres.
    #[must_use]
    pub fn place(&self, column: usize, row: usize) -> [f32; 3] {
        let cell = self.grid.window().cell;
        [(column as f64 * cell) as f32, self.grid[(column, row)] * self.exaggeration, (row as f64 * cell) as f32]
    }

    fn corner(&self, column: usize, row: usize, scratch: &Scratch) -> Corner {
        let [east, height, south] = self.place(column, row);
        let middle = |at: usize, of: usize| ((at as f64 + 0.5) / of as f64) as f32;
        Corner {
            east,
            height,
            south,
            normal: scratch.normals.get(column).copied().unwrap_or([0.0, 1.0, 0.0]),
            texture: [middle(column, self.grid.width()), middle(row, self.grid.height())],
            color: scratch.colors.get(3 * column..3 * column + 3).map_or([255; 3], |rgb| [rgb[0], rgb[1], rgb[2]]),
        }
    }

    /// The unit normal of the exaggerated surface: east, up, south.
    fn normal(&self, gradient: Gradient) -> [f32; 3] {
        let [east, south] = [-gradient.east * self.exaggeration, gradient.north * self.exaggeration];
        let length = (east * east + south * south + 1.0).sqrt();
        match length.is_finite() {
            true => [east / length, 1.0 / length, south / length],
            false => [0.0, 1.0, 0.0],
        }
    }

    /// The unit normals of all samples, row-major.
    pub(super) fn normals(&self) -> Vec<[f32; 3]> {
        let (width, cell) = (self.grid.width(), self.grid.window().cell);
        let mut normals = vec![[0.0; 3]; width * self.grid.height()];
        parallel::for_each_init(normals.chunks_exact_mut(width).enumerate(), Vec::new, |wide, (row, out)| {
            let rows = self.halo.rows(self.grid, row, wide);
            gradients_between(rows, cell, |i, gradient| out[i] = self.normal(gradient));
        });
        normals
    }

    /// Computes the normals and colors of a whole row.
    fn prepare(&self, row: usize, wanted: Wanted, scratch: &mut Scratch) {
        let painter = self.painter.filter(|_| wanted.colors);
        if !wanted.normals && painter.is_none() {
            return;
        }
        let (width, cell) = (self.grid.width(), self.grid.window().cell);
        let rows = self.halo.rows(self.grid, row, &mut scratch.wide);
        if wanted.normals {
            scratch.normals.clear();
            gradients_between(rows, cell, |_, gradient| scratch.normals.push(self.normal(gradient)));
        }
        if let Some(painter) = painter {
            scratch.colors.resize(3 * width, 0);
            painter.row(rows, cell, &mut scratch.colors);
        }
    }
}

/// Appends floats, little-endian.
pub(super) fn push(floats: &[f32], bytes: &mut Vec<u8>) {
    floats.iter().for_each(|float| bytes.extend_from_slice(&float.to_le_bytes()));
}
