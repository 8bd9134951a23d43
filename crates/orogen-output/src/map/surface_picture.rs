//! A picture of surfaces in their colors, row by row: packed until the range of the heights is known, then painted.

use super::shade::{PRINTED, PROBES, Shade, UNDER_WATER};
use orogen_grid::analysis::slope::Gradient;
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_io::palette::color::{Encoder, Rgb, decode};
use orogen_io::palette::tint::Tint;

/// Share of the depth tint in the color of ground below the sea.
const WATER: f32 = 0.93;

/// Bytes of a packed sample: an sRGB color, a gradient and a height.
pub const SAMPLE: usize = 15;

/// Packs rows of samples and collects what the painter is fitted to.
pub struct SurfacePacker {
    encoder: Encoder,
    range: [f32; 2],
    /// Steepness and height of the samples of some rows.
    probes: Vec<(f32, f32)>,
    every: usize,
    row: usize,
}

impl SurfacePacker {
    /// A packer for a picture of this many rows.
    #[must_use]
    pub fn new(rows: usize) -> SurfacePacker {
        let every = rows.div_ceil(PROBES).max(1);
        SurfacePacker { encoder: Encoder::new(), range: NO_SAMPLES, probes: Vec::new(), every, row: 0 }
    }

    /// Packs the next row: its albedo in linear light, its gradients to the east and north, and its heights.
    #[must_use]
    pub fn pack(&mut self, [red, green, blue, east, north, heights]: [&[f32]; 6]) -> Vec<u8> {
        self.range = extremes(self.range, heights);
        let mut bytes = Vec::with_capacity(SAMPLE * heights.len());
        for (i, height) in heights.iter().enumerate() {
            let gradient = Gradient { east: east[i], north: north[i] };
            bytes.extend(self.encoder.bytes([red[i], green[i], blue[i]]));
            [gradient.east, gradient.north, *height].iter().for_each(|part| bytes.extend(part.to_le_bytes()));
            if self.row.is_multiple_of(self.every) {
                self.probes.push((gradient.steepness(), *height));
            }
        }
        self.row += 1;
        bytes
    }

    /// The painter of the packed rows; call it after the last row.
    #[must_use]
    pub fn painter(self, sea_level: f32) -> SurfacePainter {
        let tint = Tint::hypsometric(self.range[0], self.range[1], sea_level);
        SurfacePainter { tint, shade: Shade::fit_samples(&self.probes, sea_level), encoder: self.encoder }
    }
}

/// Paints samples like a map in the colors of its surfaces, but leaves the ground below the sea visible.
pub struct SurfacePainter {
    tint: Tint,
    shade: Shade,
    encoder: Encoder,
}

impl SurfacePainter {
    /// Converts a packed row to sRGB pixels.
    pub fn paint(&self, row: &[u8], pixels: &mut [u8]) {
        for (pixel, sample) in pixels.chunks_exact_mut(3).zip(row.as_chunks::<SAMPLE>().0) {
            pixel.copy_from_slice(&self.pixel(sample));
        }
    }

    fn pixel(&self, bytes: &[u8; SAMPLE]) -> Rgb {
        let number = |at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        let (color, height) = ([bytes[0], bytes[1], bytes[2]], number(11));
        if !height.is_finite() {
            return color;
        }
        let ground = color.map(|part| (decode(part) * PRINTED).min(1.0));
        let factor = self.shade.on(Gradient { east: number(3), north: number(7) });
        let (color, strength) = match self.tint.is_sea(height) {
            true => {
                let water = self.tint.at(height);
                (std::array::from_fn(|c| ground[c] + (water[c] - ground[c]) * WATER), UNDER_WATER)
            }
            false => (ground, 1.0),
        };
        self.encoder.bytes(std::array::from_fn(|c| color[c] * (1.0 + (factor[c] - 1.0) * strength)))
    }
}
