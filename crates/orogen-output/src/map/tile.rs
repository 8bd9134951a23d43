//! Tiles of a map: colors of heights, of another layer or of surfaces, with relief shading, transparent where there is
//! nothing.

use std::ops::Range;

use orogen_grid::error::Result;

use super::shade::{ON_LAYER, PRINTED, Shade, UNDER_WATER};
use crate::sheet::ramp::Ramp;
use crate::sheet::{Layer, relief};
use orogen_grid::analysis::slope::{Gradient, gradients_between};
use orogen_io::palette::Palette;
use orogen_io::palette::color::{Encoder, Light, Rgb, decode};
use orogen_io::palette::tint::Tint;

/// Intervals between the stops of a legend.
const STOPS: usize = 96;

/// What colors the pixels.
enum Colors {
    /// The heights.
    Heights(Tint),
    /// The values of another layer.
    Layer(Ramp),
    /// The color of each class; the sea has the tint of its depths.
    Classes(Tint, Vec<Light>),
    /// Red, green and blue in linear light; the sea has the tint of its depths.
    Albedo(Tint),
    /// Unit vectors: east, north and up.
    Vectors,
}

/// Paints tiles in colors that are fitted to a world once, so that neighbors fit together.
pub struct TilePainter {
    colors: Colors,
    encoder: Encoder,
}

/// The samples of a tile.
pub struct TileSamples<'a> {
    /// Pixels on a side.
    pub side: usize,
    /// Distance between samples, in metres.
    pub cell: f64,
    /// The heights with a margin of one pixel on each side, if there are any.
    pub heights: Option<&'a [f32]>,
    /// The channels of the layer, without a margin; none for the heights themselves.
    pub values: &'a [Vec<f32>],
    /// The columns and rows that are in the world; the others are transparent.
    pub covered: [Range<usize>; 2],
}

impl TilePainter {
    /// A painter of heights.
    #[must_use]
    pub fn of_heights(tint: Tint) -> TilePainter {
        TilePainter::new(Colors::Heights(tint))
    }

    /// A painter of another layer, fitted to these samples of it.
    ///
    /// # Errors
    /// If the palette or the scale does not suit the layer.
    pub fn of_layer(layer: &Layer, palette: &Palette) -> Result<TilePainter> {
        Ok(TilePainter::new(Colors::Layer(Ramp::new(layer, palette)?)))
    }

    /// A painter of ground of numbered classes, from 0, with these colors; the sea has the tint of its depths.
    #[must_use]
    pub fn of_classes(tint: Tint, colors: &[Rgb]) -> TilePainter {
        TilePainter::new(Colors::Classes(tint, colors.iter().map(|color| color.map(decode)).collect()))
    }

    /// A painter of ground whose color in linear light is the layer; the sea has the tint of its depths.
    #[must_use]
    pub fn of_albedo(tint: Tint) -> TilePainter {
        TilePainter::new(Colors::Albedo(tint))
    }

    /// A painter of unit vectors: each component from -1 to 1 as 0 to 255.
    #[must_use]
    pub fn of_vectors() -> TilePainter {
        TilePainter::new(Colors::Vectors)
    }

    fn new(colors: Colors) -> TilePainter {
        TilePainter { colors, encoder: Encoder::new() }
    }

    /// Values and their colors in ascending order, for legends: heights over this range, and those of another layer
    /// over its own; none if the color does not depend on one number.
    #[must_use]
    pub fn stops(&self, [low, high]: [f32; 2]) -> Vec<(f32, Rgb)> {
        let color = |light: Light| self.encoder.bytes(light);
        match &self.colors {
            Colors::Heights(tint) => {
                let step = (high - low) / STOPS as f32;
                let mut heights: Vec<f32> = (0..=STOPS).map(|k| low + k as f32 * step).collect();
                let sea_level = tint.sea_level();
                if sea_level >= low && sea_level < high {
                    // The shore is a hard step.
                    heights.extend([sea_level, sea_level.next_up()]);
                    heights.sort_by(f32::total_cmp);
                    heights.dedup();
                }
                heights.into_iter().map(|height| (height, color(tint.at(height)))).collect()
            }
            Colors::Layer(ramp) => ramp.values(STOPS).into_iter().map(|value| (value, color(ramp.at(value)))).collect(),
            Colors::Classes(..) | Colors::Albedo(_) | Colors::Vectors => Vec::new(),
        }
    }

    /// Paints a tile: four sRGB bytes a pixel, of which the last is the opacity. Without heights or a shade there is no
    /// shading.
    #[must_use]
    pub fn paint(&self, tile: &TileSamples, shade: Option<&Shade>) -> Vec<u8> {
        let (side, wide) = (tile.side, tile.side + 2);
        let mut bytes = vec![0u8; 4 * side * side];
        let [columns, rows] = &tile.covered;
        for (j, out) in bytes.chunks_exact_mut(4 * side).enumerate().filter(|(j, _)| rows.contains(j)) {
            let mut pixel = |i: usize, height: f32, gradient: Option<Gradient>| {
                if columns.contains(&i)
                    && let Some(color) = self.pixel(tile, j * side + i, height, gradient.zip(shade))
                {
                    out[4 * i..4 * i + 3].copy_from_slice(&color);
                    out[4 * i + 3] = u8::MAX;
                }
            };
            match tile.heights {
                Some(heights) => {
                    let row = |k: usize| &heights[(j + k) * wide..(j + k + 1) * wide];
                    gradients_between([row(0), row(1), row(2)], tile.cell, |i, gradient| {
                        pixel(i, row(1)[i + 1], Some(gradient));
                    });
                }
                None => (0..side).for_each(|i| pixel(i, f32::NAN, None)),
            }
        }
        bytes
    }

    /// The color of a pixel; `None` where the layer has no value.
    fn pixel(&self, tile: &TileSamples, at: usize, height: f32, light: Option<(Gradient, &Shade)>) -> Option<[u8; 3]> {
        let values = || -> Option<Light> {
            let value = |k: usize| tile.values.get(k).map(|values| values[at]).filter(|value| value.is_finite());
            Some([value(0)?, value(1)?, value(2)?])
        };
        let (color, strength) = match &self.colors {
            Colors::Heights(tint) if height.is_finite() => {
                (tint.at(height), if tint.is_sea(height) { UNDER_WATER } else { 1.0 })
            }
            Colors::Heights(_) => return None,
            Colors::Layer(ramp) => {
                let value = *tile.values.first()?.get(at)?;
                (value.is_finite().then(|| ramp.at(value))?, ON_LAYER)
            }
            Colors::Classes(tint, _) | Colors::Albedo(tint) if tint.is_sea(height) => (tint.at(height), UNDER_WATER),
            Colors::Classes(_, colors) => {
                let code = *tile.values.first()?.get(at)?;
                (*code.is_finite().then(|| colors.get(code as usize))??, 1.0)
            }
            Colors::Albedo(_) => (values()?.map(|part| (part * PRINTED).clamp(0.0, 1.0)), 1.0),
            Colors::Vectors => return values().map(|part| part.map(|part| (127.5 * (part + 1.0)).round() as u8)),
        };
        let factor = match light {
            Some((gradient, shade)) if height.is_finite() => shade.on(gradient),
            _ => [1.0; 3],
        };
        Some(self.encoder.bytes(relief::lit(color, factor, strength)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Painter;
    use crate::sheet::Scale;
    use orogen_grid::analysis::slope::extended;
    use orogen_grid::grid::{Grid, Window};
    use orogen_io::palette::named;

    fn hill() -> Grid {
        let mut grid = Grid::filled(Window::new(16, 16, 30.0), 0.0);
        for (k, height) in grid.data_mut().iter_mut().enumerate() {
            let (x, y) = ((k % 16) as f32 - 7.0, (k / 16) as f32 - 9.0);
            *height = 400.0 - 9.0 * (x * x + y * y);
        }
        grid
    }

    #[test]
    fn a_tile_of_heights_is_the_map_of_its_samples() {
        let mut grid = hill();
        grid.row_mut(3)[5] = f32::NAN;
        let (tint, shade) = (Tint::fit(&grid, 100.0), Shade::fit(&grid, 100.0));
        let mut map = vec![0; 3 * 256];
        Painter::new(tint.clone(), shade.clone()).paint(&grid, 0..16, &mut map);
        let wide = extended(&grid);
        let tile =
            TileSamples { side: 16, cell: 30.0, heights: Some(wide.data()), values: &[], covered: [2..16, 0..15] };
        let painted = TilePainter::of_heights(tint).paint(&tile, Some(&shade));
        for (k, (own, map)) in painted.chunks(4).zip(map.chunks(3)).enumerate() {
            let (i, j) = (k % 16, k / 16);
            match i < 2 || j == 15 || (i, j) == (5, 3) {
                true => assert_eq!(own, [0; 4], "{i} {j}"),
                false => assert_eq!((&own[..3], own[3]), (map, 255), "{i} {j}"),
            }
        }
    }

    #[test]
    fn stops_are_the_colors_of_tiles_and_have_the_shore_as_a_step() {
        let grid = hill();
        let painter = TilePainter::of_heights(Tint::fit(&grid, 100.0));
        let stops = painter.stops([-200.0, 400.0]);
        assert!(stops.is_sorted_by(|a, b| a.0 < b.0));
        assert_eq!((stops[0].0, stops[stops.len() - 1].0), (-200.0, 400.0));
        let shore = stops.iter().position(|stop| stop.0 == 100.0).unwrap();
        assert_eq!(stops[shore + 1].0, 100.0f32.next_up());
        assert_ne!(stops[shore].1, stops[shore + 1].1);
        for (value, color) in stops {
            let heights = [value; 9];
            let tile = TileSamples { side: 1, cell: 1.0, heights: Some(&heights), values: &[], covered: [0..1, 0..1] };
            assert_eq!(painter.paint(&tile, None)[..3], color);
        }
        let grid = Grid::from_data(Window::new(3, 1, 1.0), vec![1.0, 10.0, 1000.0]).unwrap();
        let layer = Layer::new("flow", grid).with_scale(Scale::Log);
        let painter = TilePainter::of_layer(&layer, &named::find("grey").unwrap().palette()).unwrap();
        let stops = painter.stops([0.0, 1.0]);
        let middle = stops[stops.len() / 2].0;
        assert!((middle - 31.62).abs() < 0.01 && stops[0].0 == 1.0, "{middle}");
        assert!(TilePainter::of_vectors().stops([0.0, 1.0]).is_empty());
    }

    #[test]
    fn layers_and_vectors_have_their_colors() {
        let values = vec![vec![0.0f32, 0.5, 1.0, f32::NAN]];
        let grid = Grid::from_data(Window::new(4, 1, 1.0), values[0].clone()).unwrap();
        let layer = Layer::new("share", grid).with_scale(Scale::Linear);
        let painter = TilePainter::of_layer(&layer, &named::find("grey").unwrap().palette()).unwrap();
        let tile = |values| TileSamples { side: 2, cell: 1.0, heights: None, values, covered: [0..2, 0..2] };
        let bytes = painter.paint(&tile(&values), None);
        assert_eq!((bytes[3], bytes[11], bytes[15]), (255, 255, 0));
        assert!(bytes[0] < bytes[4] && bytes[4] < bytes[8]);
        let up = [vec![0.0f32; 4], vec![-1.0; 4], vec![1.0; 4]];
        let classes = TilePainter::of_classes(Tint::hypsometric(0.0, 9.0, 0.0), &[[9, 8, 7], [200, 100, 50]]);
        let codes = [vec![1.0, 0.0, 7.0, f32::NAN]];
        let painted = classes.paint(&tile(&codes), None);
        assert_eq!(painted[..8], [200, 100, 50, 255, 9, 8, 7, 255]);
        assert_eq!(painted[8..], [0; 8]);
        assert_eq!(TilePainter::of_vectors().paint(&tile(&up), None)[..4], [128, 0, 255, 255]);
    }
}
