//! Quantized-mesh 1.0: tiles of terrain for globes such as Cesium.
//!
//! Cesium, "quantized-mesh-1.0 terrain format". A tile is an [adaptive](super::adaptive) mesh over a square of samples.
//! The vertices along an edge depend only on the samples of that edge, and heights are multiples of a step, so that
//! tiles fit along their edges.

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

use super::adaptive::adaptive_with;
use super::globe::{self, Vector};

/// Number of cells along each side of a tile.
pub const CELLS: usize = 256;

/// The largest quantized number.
const MOST: usize = 32_767;

/// Numbers of steps between the lowest and the highest height at which each step is a whole quantized number: divisors
/// of 32767.
const STEPS: [usize; 7] = [7, 31, 151, 217, 1057, 4681, MOST];

/// Identifiers of extensions.
const NORMALS: u8 = 1;
const METADATA: u8 = 4;

/// A tile: samples with one more on each side, and how they become a mesh.
#[derive(Debug, Clone, Copy)]
pub struct QuantizedTile<'a> {
    /// West, south, east and north, in degrees.
    pub bounds: [f64; 4],
    /// [`CELLS`] + 3 samples a side, from one beyond the north-west corner; all finite.
    pub samples: &'a [f32],
    /// Maximum vertical error of the mesh at the samples, in metres.
    pub max_error: f64,
    /// Heights are multiples of this power of two, in metres; of a larger one if the tile needs it.
    pub step: f64,
    /// Whether the tile has normals of its vertices, the extension `octvertexnormals`.
    pub has_normals: bool,
    /// The extension `metadata`, JSON.
    pub metadata: Option<&'a str>,
}

/// The side of [`QuantizedTile::samples`].
pub const SIDE: usize = CELLS + 3;

/// The quantized position of a column from the west or a row from the south.
fn position(cell: usize) -> u16 {
    ((cell * MOST + CELLS / 2) / CELLS) as u16
}

/// The heights of a tile as quantized numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Heights {
    low: f64,
    step: f64,
    /// Steps from the lowest to the highest height.
    steps: usize,
}

impl Heights {
    fn of(samples: impl Iterator<Item = f32> + Clone, step: f64) -> Heights {
        let low = f64::from(samples.clone().fold(f32::INFINITY, f32::min));
        let high = f64::from(samples.fold(f32::NEG_INFINITY, f32::max));
        let mut step = step;
        loop {
            let (first, last) = ((low / step).floor(), (high / step).ceil());
            if let Some(steps) = STEPS.into_iter().find(|steps| last - first <= *steps as f64) {
                return Heights { low: first * step, step, steps };
            }
            step *= 2.0;
        }
    }

    fn high(&self) -> f64 {
        self.low + self.step * self.steps as f64
    }

    /// A height as a number of steps.
    fn steps_of(&self, height: f32) -> usize {
        ((f64::from(height) - self.low) / self.step).round().clamp(0.0, self.steps as f64) as usize
    }

    /// A height as a quantized number.
    fn quantized(&self, height: f32) -> u16 {
        (self.steps_of(height) * (MOST / self.steps)) as u16
    }

    /// The height that a reader of the tile finds.
    fn read(&self, height: f32) -> f64 {
        self.low + self.step * self.steps_of(height) as f64
    }
}

impl QuantizedTile<'_> {
    /// The sample at a column and a row of the tile.
    fn sample(&self, column: usize, row: usize) -> f32 {
        self.samples[(row + 1) * SIDE + column + 1]
    }

    /// The place of a column and a row, in radians. Neighboring tiles compute the same for their common edge.
    fn place(&self, column: usize, row: usize) -> [f64; 2] {
        let [west, south, east, north] = self.bounds;
        let share = |cell: usize| cell as f64 / CELLS as f64;
        [west + share(column) * (east - west), north - share(row) * (north - south)].map(f64::to_radians)
    }

    /// The normal of the land at a column and a row.
    fn normal(&self, column: usize, row: usize) -> Vector {
        let [west, south, east, north] = self.bounds;
        let place = self.place(column, row);
        let [along, up] = [east - west, north - south].map(|side| (side / CELLS as f64).to_radians());
        let radius = globe::length(globe::point(place, 0.0));
        // Toward the poles columns meet.
        let across = (along * libm::cos(place[1]) * radius).max(1e-3);
        let at = |i: usize, j: usize| f64::from(self.samples[j * SIDE + i]);
        let rise = [
            (at(column + 2, row + 1) - at(column, row + 1)) / (2.0 * across),
            (at(column + 1, row) - at(column + 1, row + 2)) / (2.0 * up * radius),
        ];
        let axes = globe::axes(place);
        let normal: Vector = std::array::from_fn(|i| axes[2][i] - rise[0] * axes[0][i] - rise[1] * axes[1][i]);
        let length = globe::length(normal);
        normal.map(|part| part / length)
    }

    /// The bytes of the tile.
    ///
    /// # Errors
    /// If samples are missing or not finite, and the errors of [`adaptive_with`].
    pub fn to_bytes(&self, progress: &Progress) -> Result<Vec<u8>> {
        let side = CELLS + 1;
        if self.samples.len() != SIDE * SIDE || !self.samples.iter().all(|sample| sample.is_finite()) {
            let message = format!("a tile of a mesh needs {SIDE} x {SIDE} finite samples");
            return Err(Error::new(ErrorKind::Request, message));
        }
        let inner: Vec<f32> = (0..side).flat_map(|row| (0..side).map(move |column| self.sample(column, row))).collect();
        let Some(grid) = Grid::from_data(Window::new(side, side, 1.0), inner) else {
            return Err(Error::new(ErrorKind::Internal, "the samples of a tile have another size"));
        };
        let heights = Heights::of(grid.data().iter().copied(), self.step);
        let shape = adaptive_with(&grid, (self.max_error - heights.step / 2.0).max(0.0), progress)?;
        // Vertices in the order of their first use, as the encoding of indices requires.
        let mut numbers = vec![u32::MAX; shape.corners()];
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for piece in 0..shape.pieces() {
            shape.piece(&grid, piece, |triangle| {
                for corner in triangle {
                    let number = &mut numbers[corner as usize];
                    if *number == u32::MAX {
                        *number = vertices.len() as u32;
                        vertices.push(shape.sample(corner));
                    }
                    indices.push(*number);
                }
            });
        }
        let mut out = Vec::new();
        self.header(&heights, &grid, &vertices, &mut out);
        let [u, v, h]: [Vec<u16>; 3] = [
            vertices.iter().map(|[column, _]| position(*column)).collect(),
            vertices.iter().map(|[_, row]| position(CELLS - row)).collect(),
            vertices.iter().map(|[column, row]| heights.quantized(grid[(*column, *row)])).collect(),
        ];
        put_u32(vertices.len(), &mut out);
        [u, v, h].iter().for_each(|numbers| put_differences(numbers, &mut out));
        let is_wide = vertices.len() > 1 << 16;
        while is_wide && !out.len().is_multiple_of(4) {
            out.push(0);
        }
        let put = |index: u32, out: &mut Vec<u8>| match is_wide {
            true => out.extend(index.to_le_bytes()),
            false => out.extend((index as u16).to_le_bytes()),
        };
        put_u32(indices.len() / 3, &mut out);
        let mut next = 0;
        for index in &indices {
            put(next - index, &mut out);
            next += u32::from(*index == next);
        }
        // West, south, east, north.
        let edges: [fn([usize; 2]) -> bool; 4] =
            [|[column, _]| column == 0, |[_, row]| row == CELLS, |[column, _]| column == CELLS, |[_, row]| row == 0];
        for is_on in edges {
            let mut edge: Vec<u32> = (0..vertices.len() as u32).filter(|k| is_on(vertices[*k as usize])).collect();
            edge.sort_by_key(|k| vertices[*k as usize]);
            put_u32(edge.len(), &mut out);
            edge.iter().for_each(|index| put(*index, &mut out));
        }
        if self.has_normals {
            out.push(NORMALS);
            put_u32(2 * vertices.len(), &mut out);
            vertices.iter().for_each(|[column, row]| out.extend(oct(self.normal(*column, *row))));
        }
        if let Some(metadata) = self.metadata {
            out.push(METADATA);
            put_u32(4 + metadata.len(), &mut out);
            put_u32(metadata.len(), &mut out);
            out.extend(metadata.as_bytes());
        }
        Ok(out)
    }

    /// Appends the header: the center, the heights, the bounding sphere and the occlusion point.
    fn header(&self, heights: &Heights, grid: &Grid, vertices: &[[usize; 2]], out: &mut Vec<u8>) {
        let at =
            |[column, row]: &[usize; 2]| globe::point(self.place(*column, *row), heights.read(grid[(*column, *row)]));
        let center = globe::point(self.place(CELLS / 2, CELLS / 2), (heights.low + heights.high()) / 2.0);
        let radius = vertices.iter().map(|vertex| globe::length(globe::minus(at(vertex), center))).fold(0.0, f64::max);
        let occlusion = globe::occlusion(center, vertices.iter().map(at));
        let mut put = |numbers: &[f64]| numbers.iter().for_each(|number| out.extend(number.to_le_bytes()));
        put(&center);
        [heights.low, heights.high()].iter().for_each(|height| out.extend((*height as f32).to_le_bytes()));
        let mut put = |numbers: &[f64]| numbers.iter().for_each(|number| out.extend(number.to_le_bytes()));
        put(&center);
        put(&[radius]);
        put(&occlusion);
    }
}

fn put_u32(number: usize, out: &mut Vec<u8>) {
    out.extend((number as u32).to_le_bytes());
}

/// Appends differences of numbers, with their sign in the lowest bit.
fn put_differences(numbers: &[u16], out: &mut Vec<u8>) {
    let mut before = 0;
    for number in numbers {
        let difference = i32::from(*number) - before;
        out.extend((((difference << 1) ^ (difference >> 31)) as u16).to_le_bytes());
        before = i32::from(*number);
    }
}

/// A unit vector in two bytes (Z. H. Cigolle et al., "A Survey of Efficient Representations for Independent Unit
/// Vectors", 2014).
fn oct([x, y, z]: Vector) -> [u8; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    let (x, y, z) = (x / sum, y / sum, z / sum);
    let sign = |part: f64| if part < 0.0 { -1.0 } else { 1.0 };
    let [u, v] = if z < 0.0 { [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)] } else { [x, y] };
    [u, v].map(|part| ((part * 0.5 + 0.5) * 255.0).round().clamp(0.0, 255.0) as u8)
}

#[cfg(test)]
#[path = "quantized_tests.rs"]
mod tests;
