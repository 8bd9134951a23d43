//! The relief map: a tint multiplied by relief shading.

use std::io::{self, Write};
use std::ops::Range;

use rayon::prelude::*;

use super::shade::Shade;
use orogen_grid::analysis::slope::{beyond, extend_row, gradients_between};
use orogen_grid::grid::Grid;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::palette::color::Encoder;
use orogen_io::palette::tint::Tint;

/// Strength of the shading of the sea floor relative to land.
const UNDER_WATER: f32 = 0.35;

/// The style of a relief map: fitted to a world once, then the same for every window of it.
#[derive(Debug, Clone)]
pub struct Painter {
    tint: Tint,
    shade: Shade,
    encoder: Encoder,
}

impl Painter {
    /// A painter with this tint and shading.
    #[must_use]
    pub fn new(tint: Tint, shade: Shade) -> Painter {
        Painter { tint, shade, encoder: Encoder::new() }
    }

    /// The painter fitted to the heights of `grid`, in metres.
    #[must_use]
    pub fn fit(grid: &Grid, sea_level: f64) -> Painter {
        let sea_level = sea_level as f32;
        Painter::new(Tint::fit(grid, sea_level), Shade::fit(grid, sea_level))
    }

    /// Paints a row in sRGB bytes. `rows` are the heights of the row above, the row itself and the row below, each
    /// extended by one sample at both ends.
    pub fn row(&self, rows: [&[f32]; 3], cell: f64, out: &mut [u8]) {
        let here = rows[1];
        gradients_between(rows, cell, |i, gradient| {
            let height = here[i + 1];
            let color = self.tint.at(height);
            let shade = self.shade.on(gradient);
            let strength = match height.is_finite() {
                true if self.tint.is_sea(height) => UNDER_WATER,
                true => 1.0,
                false => 0.0,
            };
            // Samples that are not finite are not shaded; their gradient may be NaN.
            let lit = match strength {
                0.0 => color,
                _ => std::array::from_fn(|c| color[c] * (1.0 + (shade[c] - 1.0) * strength)),
            };
            out[3 * i..3 * i + 3].copy_from_slice(&self.encoder.bytes(lit));
        });
    }

    /// Writes the map of a whole grid as an RGB PNG, one pixel per sample. Beyond its edges heights are extrapolated
    /// linearly.
    pub fn write_png(&self, out: &mut dyn Write, grid: &Grid, notes: &[(&str, &str)]) -> io::Result<()> {
        let (width, height) = (grid.width(), grid.height());
        let picture = Picture::new(width, height, Pixel::Rgb8).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            self.paint(grid, rows, bytes);
            Ok(())
        })
    }

    /// Paints some rows of a whole grid in sRGB bytes, three per sample. Beyond its edges heights are extrapolated
    /// linearly.
    pub fn paint(&self, grid: &Grid, rows: Range<usize>, bytes: &mut [u8]) {
        let (width, height) = (grid.width(), grid.height());
        bytes.par_chunks_exact_mut(3 * width).zip(rows).for_each_init(
            || vec![0.0; 3 * (width + 2)],
            |wide, (bytes, j)| {
                let (above, rest) = wide.split_at_mut(width + 2);
                let (here, below) = rest.split_at_mut(width + 2);
                extend_row(grid.row(j), here);
                neighbour(grid, j, j.checked_sub(1), here, above);
                neighbour(grid, j, (j + 1 < height).then_some(j + 1), here, below);
                self.row([above, here, below], grid.window().cell, bytes);
            },
        );
    }
}

/// Row `there` of the grid, extended; if there is none, extrapolated from row `j` (extended in `here`) and its other
/// neighbour.
fn neighbour(grid: &Grid, j: usize, there: Option<usize>, here: &[f32], out: &mut [f32]) {
    match there {
        Some(there) => extend_row(grid.row(there), out),
        None => {
            let other = if j == 0 { 1.min(grid.height() - 1) } else { j - 1 };
            extend_row(grid.row(other), out);
            for (out, &last) in out.iter_mut().zip(here) {
                *out = beyond(last, *out);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::analysis::slope::extended;
    use orogen_grid::grid::Window;
    use orogen_io::palette::palette::NO_DATA;

    fn hill(width: usize, height: usize) -> Grid {
        let window = Window::new(width, height, 30.0);
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..height {
            for i in 0..width {
                let (x, y) = (i as f64 / width as f64 - 0.4, j as f64 / height as f64 - 0.6);
                grid.row_mut(j)[i] = (900.0 - 4000.0 * (x * x + y * y)) as f32;
            }
        }
        grid
    }

    fn decode(bytes: &[u8]) -> Vec<u8> {
        let mut reader = ::png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        data
    }

    #[test]
    fn the_streamed_map_is_the_extended_grid_painted() {
        for (width, height) in [(33, 21), (1, 1), (1, 5), (5, 1), (2, 2), (900, 700)] {
            let grid = hill(width, height);
            let painter = Painter::fit(&grid, 200.0);
            let mut bytes = Vec::new();
            painter.write_png(&mut bytes, &grid, &[]).unwrap();
            let wide = extended(&grid);
            let mut expect = vec![0; 3 * width * height];
            for (j, row) in expect.chunks_exact_mut(3 * width).enumerate() {
                painter.row([wide.row(j), wide.row(j + 1), wide.row(j + 2)], 30.0, row);
            }
            assert!(decode(&bytes) == expect, "{width} x {height}");
        }
    }

    #[test]
    fn land_is_lit_from_the_north_west_and_the_sea_is_blue() {
        let grid = hill(101, 101);
        let mut bytes = Vec::new();
        Painter::fit(&grid, 200.0).write_png(&mut bytes, &grid, &[]).unwrap();
        let data = decode(&bytes);
        let pixel = |i: usize, j: usize| [0, 1, 2].map(|c| u32::from(data[3 * (j * 101 + i) + c]));
        let light = |[r, g, b]: [u32; 3]| r + g + b;
        // The same height on both sides of the summit at (40, 60).
        assert!(light(pixel(30, 50)) > light(pixel(50, 70)) + 30);
        let [r, _, b] = pixel(100, 0);
        assert!(b > r + 30);
    }

    #[test]
    fn holes_are_grey_and_do_not_spoil_a_map() {
        let mut grid = hill(20, 20);
        let holes = [(0, 0, f32::INFINITY), (4, 3, f32::NAN), (9, 9, f32::NEG_INFINITY)];
        for (i, j, value) in holes {
            grid.row_mut(j)[i] = value;
        }
        for sea_level in [0.0, 500.0] {
            let mut bytes = Vec::new();
            Painter::fit(&grid, sea_level).write_png(&mut bytes, &grid, &[]).unwrap();
            let bytes = decode(&bytes);
            let is_grey: Vec<bool> = bytes.chunks_exact(3).map(|pixel| *pixel == NO_DATA).collect();
            let expect: Vec<bool> = (0..400).map(|at| holes.iter().any(|hole| hole.0 + 20 * hole.1 == at)).collect();
            assert_eq!(is_grey, expect, "sea level {sea_level}");
        }
    }
}
