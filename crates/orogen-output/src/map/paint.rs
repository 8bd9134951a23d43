//! The relief map: a tint multiplied by relief shading.

use std::io::{self, Write};
use std::ops::Range;

use orogen_grid::parallel;

use super::shade::{Shade, UNDER_WATER};
use orogen_grid::analysis::slope::{beyond, extend_row, gradients_between};
use orogen_grid::grid::Grid;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::palette::color::{Encoder, Rgb, decode};
use orogen_io::palette::tint::Tint;

/// Color of lakes at the shore, and in deep water.
pub const LAKES: Rgb = [170, 211, 233];
const DEEP_LAKES: Rgb = [92, 152, 200];

/// Depth in metres at which the color is the mean of the two.
const HALF_DEPTH: f32 = 60.0;

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

    /// A painter with this tint and shading that is fitted to the heights of `grid`, in metres.
    #[must_use]
    pub fn with_tint(tint: Tint, grid: &Grid, sea_level: f64) -> Painter {
        Painter::new(tint, Shade::fit(grid, sea_level as f32))
    }

    /// Shades colors that were computed separately: four sRGB bytes for each sample of a whole grid of heights, of
    /// which the first three are changed. Where the tint shows water, the shading is weak.
    pub fn shade(&self, grid: &Grid, bytes: &mut [u8]) {
        let width = grid.width();
        let table: Vec<f32> = (0..=u8::MAX).map(decode).collect();
        parallel::for_each_init(
            bytes.chunks_exact_mut(4 * width).enumerate(),
            || vec![0.0; 3 * (width + 2)],
            |wide, (j, bytes)| {
                gradients_between(around(grid, j, wide), grid.window().cell, |i, gradient| {
                    let shade = self.shade.on(gradient);
                    let strength = self.strength(grid.row(j)[i]);
                    if strength > 0.0 {
                        let pixel = &mut bytes[4 * i..4 * i + 3];
                        let lit =
                            std::array::from_fn(|c| table[usize::from(pixel[c])] * (1.0 + (shade[c] - 1.0) * strength));
                        pixel.copy_from_slice(&self.encoder.bytes(lit));
                    }
                });
            },
        );
    }

    /// Strength of the shading at a height. Samples that are not finite are not shaded; their gradient may be NaN.
    fn strength(&self, height: f32) -> f32 {
        match height.is_finite() {
            true if self.tint.is_sea(height) => UNDER_WATER,
            true => 1.0,
            false => 0.0,
        }
    }

    /// Paints a row in sRGB bytes. `rows` are the heights of the row above, the row itself and the row below, each
    /// extended by one sample at both ends.
    pub fn row(&self, rows: [&[f32]; 3], cell: f64, out: &mut [u8]) {
        let here = rows[1];
        gradients_between(rows, cell, |i, gradient| {
            let height = here[i + 1];
            let color = self.tint.at(height);
            let shade = self.shade.on(gradient);
            let strength = self.strength(height);
            let lit = match strength {
                0.0 => color,
                _ => std::array::from_fn(|c| color[c] * (1.0 + (shade[c] - 1.0) * strength)),
            };
            out[3 * i..3 * i + 3].copy_from_slice(&self.encoder.bytes(lit));
        });
    }

    /// Writes the map of a whole grid as an RGB PNG, one pixel per sample. Lakes are drawn where `lakes`, their depth
    /// in metres over the same window, is above 0. Heights beyond the edges are extrapolated linearly.
    pub fn write_png(
        &self,
        out: &mut dyn Write,
        grid: &Grid,
        lakes: Option<&Grid>,
        notes: &[(&str, &str)],
    ) -> io::Result<()> {
        let (width, height) = (grid.width(), grid.height());
        let picture = Picture::new(width, height, Pixel::Rgb8).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            self.paint(grid, rows.clone(), bytes);
            if let Some(lakes) = lakes {
                self.paint_lakes(lakes, rows, bytes);
            }
            Ok(())
        })
    }

    /// Paints lakes over some painted rows, from their depth in metres.
    fn paint_lakes(&self, lakes: &Grid, rows: Range<usize>, bytes: &mut [u8]) {
        let [shallow, deep] = [LAKES, DEEP_LAKES].map(|color| color.map(decode));
        for (row, bytes) in rows.zip(bytes.chunks_exact_mut(3 * lakes.width())) {
            for (&depth, pixel) in lakes.row(row).iter().zip(bytes.as_chunks_mut::<3>().0) {
                if depth > 0.0 {
                    let share = depth.min(1e6) / (depth.min(1e6) + HALF_DEPTH);
                    *pixel = self.encoder.bytes(std::array::from_fn(|c| shallow[c] + share * (deep[c] - shallow[c])));
                }
            }
        }
    }

    /// Paints some rows of a whole grid in sRGB bytes, three per sample. Heights beyond the edges are extrapolated
    /// linearly.
    pub fn paint(&self, grid: &Grid, rows: Range<usize>, bytes: &mut [u8]) {
        let width = grid.width();
        parallel::for_each_init(
            bytes.chunks_exact_mut(3 * width).zip(rows),
            || vec![0.0; 3 * (width + 2)],
            |wide, (bytes, j)| self.row(around(grid, j, wide), grid.window().cell, bytes),
        );
    }
}

/// Row `j` of a grid between its neighbors, each extended by one sample at both ends, in `wide`.
fn around<'a>(grid: &Grid, j: usize, wide: &'a mut [f32]) -> [&'a [f32]; 3] {
    let width = grid.width();
    let (above, rest) = wide.split_at_mut(width + 2);
    let (here, below) = rest.split_at_mut(width + 2);
    extend_row(grid.row(j), here);
    neighbor(grid, j, j.checked_sub(1), here, above);
    neighbor(grid, j, (j + 1 < grid.height()).then_some(j + 1), here, below);
    [above, here, below]
}

/// Row `there` of the grid, extended; if there is none, extrapolated from row `j` (extended in `here`) and its other
/// neighbor.
fn neighbor(grid: &Grid, j: usize, there: Option<usize>, here: &[f32], out: &mut [f32]) {
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
            painter.write_png(&mut bytes, &grid, None, &[]).unwrap();
            let wide = extended(&grid);
            let mut expect = vec![0; 3 * width * height];
            for (j, row) in expect.chunks_exact_mut(3 * width).enumerate() {
                painter.row([wide.row(j), wide.row(j + 1), wide.row(j + 2)], 30.0, row);
            }
            assert!(decode(&bytes) == expect, "{width} x {height}");
        }
    }

    #[test]
    fn shaded_colors_are_those_of_the_map() {
        let grid = hill(40, 30);
        let tint = Tint::fit(&grid, 200.0);
        let painter = Painter::with_tint(tint.clone(), &grid, 200.0);
        let encoder = Encoder::new();
        let mut shaded: Vec<u8> = Vec::new();
        for height in grid.data() {
            shaded.extend(encoder.bytes(tint.at(*height)));
            shaded.push(7);
        }
        painter.shade(&grid, &mut shaded);
        let mut map = vec![0; 3 * grid.data().len()];
        painter.paint(&grid, 0..30, &mut map);
        for (own, map) in shaded.chunks(4).zip(map.chunks(3)) {
            // Colors were already rounded.
            assert!((0..3).all(|c| own[c].abs_diff(map[c]) <= 1) && own[3] == 7, "{own:?} {map:?}");
        }
    }

    #[test]
    fn land_is_lit_from_the_north_west_and_the_sea_is_blue() {
        let grid = hill(101, 101);
        let mut bytes = Vec::new();
        Painter::fit(&grid, 200.0).write_png(&mut bytes, &grid, None, &[]).unwrap();
        let data = decode(&bytes);
        let pixel = |i: usize, j: usize| [0, 1, 2].map(|c| u32::from(data[3 * (j * 101 + i) + c]));
        let light = |[r, g, b]: [u32; 3]| r + g + b;
        // The same height on both sides of the summit at (40, 60).
        assert!(light(pixel(30, 50)) > light(pixel(50, 70)) + 30);
        let [r, _, b] = pixel(100, 0);
        assert!(b > r + 30);
    }

    #[test]
    fn lakes_are_blue_and_darker_where_they_are_deep() {
        let grid = hill(20, 20);
        let mut lakes = Grid::filled(*grid.window(), 0.0);
        lakes.row_mut(3)[4..7].copy_from_slice(&[1e-3, 200.0, f32::NAN]);
        let paint = |lakes: Option<&Grid>| {
            let mut bytes = Vec::new();
            Painter::fit(&grid, 200.0).write_png(&mut bytes, &grid, lakes, &[]).unwrap();
            decode(&bytes)
        };
        let (with, without) = (paint(Some(&lakes)), paint(None));
        let pixel = |picture: &[u8], i: usize| -> [u8; 3] { std::array::from_fn(|c| picture[3 * (3 * 20 + i) + c]) };
        assert_eq!(pixel(&with, 4), LAKES);
        assert!(pixel(&with, 5) < pixel(&with, 4) && pixel(&with, 5)[2] > 150);
        let differ = with.chunks(3).zip(without.chunks(3)).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 2);
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
            Painter::fit(&grid, sea_level).write_png(&mut bytes, &grid, None, &[]).unwrap();
            let bytes = decode(&bytes);
            let is_grey: Vec<bool> = bytes.chunks_exact(3).map(|pixel| *pixel == NO_DATA).collect();
            let expect: Vec<bool> = (0..400).map(|at| holes.iter().any(|hole| hole.0 + 20 * hole.1 == at)).collect();
            assert_eq!(is_grey, expect, "sea level {sea_level}");
        }
    }
}
