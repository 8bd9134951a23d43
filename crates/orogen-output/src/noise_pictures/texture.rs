//! Textbook textures made of noise.
//!
//! K. Perlin, "An Image Synthesizer" (SIGGRAPH 1985) for marble; D. Ebert and others, "Texturing and Modeling" for all
//! three.

use std::f32::consts::TAU;
use std::ops::Range;

use orogen_grid::parallel;
use orogen_io::palette::color::Encoder;
use orogen_io::palette::ramp::Ramp;
use orogen_noise::{Fractal, Kind};

use super::slice::Slice;

/// A material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texture {
    /// White clouds in a blue sky.
    Clouds,
    /// Veined stone.
    Marble,
    /// Wood with its rings.
    Wood,
}

impl Texture {
    /// All textures.
    pub const ALL: [Texture; 3] = [Texture::Clouds, Texture::Marble, Texture::Wood];

    /// The name, as on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Texture::Clouds => "clouds",
            Texture::Marble => "marble",
            Texture::Wood => "wood",
        }
    }

    /// A short description of how it is made.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Texture::Clouds => {
                "Clouds: fBm mapped to blue sky below a threshold and to increasingly dense white above it"
            }
            Texture::Marble => "Marble: a sine wave distorted by turbulence, the sum of the octaves' absolute values",
            Texture::Wood => {
                "Wood: rings from the fractional part of a multiplied and stretched noise, with a fine grain"
            }
        }
    }

    /// The default number of octaves.
    #[must_use]
    pub fn octaves(self) -> u32 {
        match self {
            Texture::Clouds => 8,
            Texture::Marble => 7,
            Texture::Wood => 1,
        }
    }

    /// The default wavelength for a picture of 512 samples.
    #[must_use]
    pub fn wavelength(self) -> f64 {
        match self {
            Texture::Clouds => 200.0,
            Texture::Marble => 150.0,
            Texture::Wood => 128.0,
        }
    }

    /// The noise of the texture, which determines how octaves are summed.
    #[must_use]
    pub fn made_of(self, slice: &Slice) -> Slice {
        let (kind, stretch) = match self {
            Texture::Clouds => (Kind::Fbm, 1.0),
            Texture::Marble => (Kind::Billow, 1.0),
            Texture::Wood => (Kind::Fbm, 1.0 / STRETCH),
        };
        Slice { noise: slice.noise.with_kind(kind), stretch, ..*slice }
    }
}

/// The threshold of clouds, and the range over which they turn white.
const COVER: f32 = -0.05;
const DENSITY: f32 = 5.0;

/// Displacement of marble's sine wave by turbulence, in wavelengths.
const TURBULENCE: f32 = 1.5;

/// Number of rings for a noise from 0 to 1, and their ratio of length to width.
const RINGS: f32 = 9.0;
const STRETCH: f64 = 6.0;

const SKY: [(f32, [u8; 3]); 4] =
    [(0.0, [56, 112, 184]), (0.35, [132, 174, 220]), (0.7, [216, 229, 243]), (1.0, [255, 255, 255])];

const STONE: [(f32, [u8; 3]); 6] = [
    (0.0, [66, 74, 84]),
    (0.05, [112, 121, 131]),
    (0.16, [176, 181, 186]),
    (0.4, [219, 219, 217]),
    (0.75, [240, 238, 233]),
    (1.0, [249, 247, 242]),
];

const TIMBER: [(f32, [u8; 3]); 5] = [
    (0.0, [214, 165, 108]),
    (0.45, [201, 147, 90]),
    (0.8, [164, 106, 58]),
    (0.94, [122, 73, 37]),
    (1.0, [190, 138, 84]),
];

/// Paints textures.
#[derive(Debug)]
pub struct Painter {
    sky: Ramp,
    stone: Ramp,
    timber: Ramp,
    encoder: Encoder,
}

impl Default for Painter {
    fn default() -> Painter {
        Painter { sky: Ramp::new(&SKY), stone: Ramp::new(&STONE), timber: Ramp::new(&TIMBER), encoder: Encoder::new() }
    }
}

impl Painter {
    /// Paints some rows of a texture made of a slice's noise.
    pub fn paint(&self, texture: Texture, slice: &Slice, rows: Range<usize>, bytes: &mut [u8]) {
        let made_of = texture.made_of(slice);
        let mut value = vec![0.0; rows.len() * slice.width];
        made_of.fill(rows.clone(), &mut value);
        let [wavelength, _] = made_of.fit().wavelengths(slice.noise.wavelength);
        let grain = match texture {
            Texture::Wood => grain(slice, rows),
            _ => Vec::new(),
        };
        let paint = |k: usize, value: f32, pixel: &mut [u8]| {
            let color = match texture {
                Texture::Clouds => self.sky.at(1.0 - libm::expf(-DENSITY * (value - COVER).max(0.0))),
                Texture::Marble => {
                    // In f64 until it is reduced to one wave, so that a wide picture has the same veins at its far end.
                    let waves = (k % slice.width) as f64 / wavelength;
                    let turns = (waves - waves.floor()) as f32 + TURBULENCE * (value + 1.0) / 2.0;
                    self.stone.at(0.5 + 0.5 * libm::sinf(TAU * (turns - turns.floor())))
                }
                Texture::Wood => {
                    let rings = RINGS * (value + 1.0) / 2.0;
                    let grain = grain.get(k).copied().unwrap_or(0.0);
                    self.timber.at(rings - rings.floor()).map(|light| light * (1.0 + grain))
                }
            };
            pixel.copy_from_slice(&self.encoder.bytes(color));
        };
        let rows = bytes.chunks_mut((3 * slice.width).max(1)).zip(value.chunks(slice.width.max(1))).enumerate();
        parallel::for_each(rows, |(j, (pixels, values))| {
            for (i, (pixel, value)) in pixels.chunks_exact_mut(3).zip(values).enumerate() {
                paint(j * slice.width + i, *value, pixel);
            }
        });
    }
}

/// The fibres of wood: the brightness of each sample, mostly constant along y.
fn grain(slice: &Slice, rows: Range<usize>) -> Vec<f32> {
    let noise = Fractal::new(slice.noise.seed ^ 1, 3.0).with_kind(Kind::Fbm).with_octaves(2);
    let mut fibres = vec![0.0; rows.len() * slice.width];
    Slice { noise, stretch: 1.0 / 40.0, ..*slice }.fill(rows, &mut fibres);
    fibres.iter_mut().for_each(|fibre| *fibre *= 0.25);
    fibres
}
