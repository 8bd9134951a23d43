//! The input of the kernels: a noise as a list of octaves. Every public noise is compiled to this form.

use crate::choices::{ClassicVariant, Distance, Fade, Falloff, Feature, Kind, Smoothness};
use crate::seed;
use std::f32::consts::SQRT_2;
use std::fmt;

/// Maximum number of octaves of a fractal; more are ignored. Thirty-two octaves with lacunarity 2 span a factor of four
/// billion in wavelength, which exceeds the precision of a sum in f32.
pub const MAX_OCTAVES: u32 = 32;

/// Positions are clamped to this many cells of the finest octave, where f64 still resolves a quarter of a cell. Cell
/// numbers are then exact and results finite, also for NaN and infinite positions.
const FARTHEST: f64 = 1_125_899_906_842_624.0;

/// The same limit on lattices of simplices, where the skew adds up to as many cells again along each axis.
const FARTHEST_SLANTED: f64 = FARTHEST / 8.0;

/// The same limit for lattices that repeat. Up to here, coordinates can be rounded to 2^-24 of a cell.
const FARTHEST_TILED: f64 = 134_217_727.0;

/// Maximum period in cells, in any octave. Twice this number is within the limit.
pub(crate) const MAX_PERIOD: f64 = 67_108_864.0;

/// Maximum absolute value of slope factors, so that the slopes of all octaves have a finite sum.
const STEEPEST: f32 = 1e36;

/// The same limit where slopes damp octaves: the square of the sum of slopes must be finite, and so must its product
/// with another factor.
const STEEPEST_WEIGHTED: f32 = 1e16;

/// The source of the numbers at lattice points.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// Interpolated values.
    Value(Fade),
    /// Hashed gradients.
    Perlin,
    /// Gradients from the 2002 table.
    Classic(ClassicVariant),
    /// Cellular noise with one point per cell.
    Worley(Cellular),
    /// Gradients on the corners of simplices.
    Simplex,
    /// The lattice of `Simplex` with other kernels and gradients.
    OpenSimplex2(Smoothness),
}

impl Source {
    /// Whether an octave is a sum of few products of a column's and a row's numbers (see kernel/basis.rs).
    pub(crate) fn low_rank(self) -> bool {
        matches!(self, Source::Value(_) | Source::Perlin | Source::Classic(_))
    }

    /// Whether the noise has slopes; otherwise they are zero.
    pub(crate) const fn sloped(self) -> bool {
        !matches!(self, Source::Value(Fade::Step) | Source::Worley(_))
    }

    /// Whether the lattice can repeat along the axes.
    pub(crate) const fn repeats(self) -> bool {
        !matches!(self, Source::Simplex | Source::OpenSimplex2(_))
    }
}

/// The parameters of cellular noise.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cellular {
    /// The distance that is used.
    pub distance: Distance,
    /// The computed value.
    pub feature: Feature,
    /// Share of its cell in which a point is placed, along each axis.
    pub jitter: f32,
}

impl Cellular {
    /// Maximum value of the feature, in cells.
    ///
    /// Let the nearest lattice corner of a sample be x, y (and z) away, each at most 1/2. The point of its own cell is
    /// within (1 - x, 1 - y), and the point of the neighbor across the nearest side is within 2 min(x, y) more along
    /// one axis. The maxima of these over all positions bound the nearest and the second nearest distance, and points
    /// in the farthest corners reach them. The distance of an edge is at most sqrt 2 (sqrt 3, 2) minus the nearest
    /// distance, because a position farther away would have no point. It is also at most half the sum of the two
    /// nearest distances. Together this is less than 1 (2 / sqrt 3, 4 / 3).
    #[inline]
    #[must_use]
    pub fn bound(self, dims: usize) -> f32 {
        let pick = |bounds: [f32; 3]| bounds[dims.clamp(2, 4) - 2];
        let second = match self.distance {
            Distance::Euclidean => pick([1.581_138_8, 1.732_050_8, 2.0]),
            Distance::Manhattan => pick([2.0, 3.0, 4.0]),
            Distance::Chebyshev => 1.5,
        };
        match (self.feature, self.distance) {
            (Feature::F1, Distance::Euclidean) => pick([SQRT_2, 1.732_050_8, 2.0]),
            (Feature::F1, Distance::Manhattan) => pick([2.0, 3.0, 4.0]),
            (Feature::F1 | Feature::Product, Distance::Chebyshev) => 1.0,
            (Feature::F2 | Feature::Difference, _) => second,
            (Feature::Product, Distance::Euclidean) => pick([2.0, 3.0, 4.0]),
            (Feature::Product, Distance::Manhattan) => pick([4.0, 9.0, 16.0]),
            (Feature::Value, _) => 1.0,
            (Feature::Edge, Distance::Euclidean) => pick([1.0, 1.154_700_5, 1.333_333_4]),
            (Feature::Edge, _) => second * 0.5,
        }
    }
}

/// One octave in the form of the kernels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Octave {
    /// Cells per metre.
    pub frequency: f64,
    /// Offset that is added to position times frequency, in cells.
    pub offset: [f64; 4],
    /// The words of the lattice hash, per axis.
    pub words: [[u32; 2]; 4],
    /// Factor of the value.
    pub amplitude: f32,
    /// Factor of the gradient with respect to cell coordinates.
    pub slope: f32,
    /// Weight in combinations that are not plain sums.
    pub gain: f32,
    /// Ratio of the octave's frequency to that of the first one.
    pub ratio: f64,
    /// Whether coordinates are rounded so that both sides of a seam agree.
    pub tiled: bool,
    /// Period of the lattice in cells, per axis; 0 for none.
    pub period: [f64; 4],
}

/// The parameters of a fractal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Octaves {
    pub source: Source,
    /// Maximum absolute value of the source.
    pub bound: f64,
    pub kind: Kind,
    pub seed: u64,
    /// Wavelength of the first octave, in metres.
    pub wavelength: f64,
    pub count: u32,
    pub lacunarity: f64,
    pub gain: f64,
}

/// How octaves are combined.
#[derive(Clone, Copy, Debug)]
pub enum Combine {
    /// The plain sum.
    Sum,
    /// `start + sign * sum of absolute values`.
    Sizes {
        /// +1 (billow) or -1 (ridged). The sum starts at minus this number.
        sign: f32,
    },
    /// The sum, each octave damped by the slope of the previous ones.
    Weighted {
        /// Strength of the damping.
        k: f32,
        /// The shape of the damping.
        falloff: Falloff,
        /// Factor from the kernels' gradient unit to 1 / metre of the normalized sum.
        gradient: f32,
    },
    /// Other combinations. Octaves are numbers in -1 ..= 1, with slopes per first wavelength.
    Shaped {
        /// The shape.
        shape: Shape,
        /// Factor from the range of the shape to -1 ..= 1.
        scale: f32,
        /// Factor from the kernels' gradient unit to 1 / metre of the result.
        gradient: f32,
    },
}

/// Combinations that are not plain sums, with the parameters of their [`Kind`].
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "fields are those of `Kind`")]
pub enum Shape {
    /// The sum of folded values.
    PingPong { strength: f32 },
    /// Each octave is weighted with the product of the previous ones.
    Hybrid { offset: f32 },
    /// Each octave is scaled with the sum so far.
    Hetero { offset: f32 },
    /// Ridges that displace later octaves.
    Swiss { warp: f32 },
    /// Squares that displace and damp later octaves.
    Jordan { warp: f32, damp: f32 },
}

impl Combine {
    /// Whether octaves displace the positions of later ones. Rows of samples then have no common values.
    #[must_use]
    pub fn moves(self) -> bool {
        matches!(self, Combine::Shaped { shape: Shape::Swiss { .. } | Shape::Jordan { .. }, .. })
    }

    /// Whether slopes are needed even if they are not requested.
    pub(crate) fn needs_slopes(self) -> bool {
        matches!(self, Combine::Weighted { .. }) || self.moves()
    }
}

/// A noise for the kernels.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// The source of the numbers at lattice points.
    pub source: Source,
    /// How octaves are combined.
    pub combine: Combine,
    /// Maximum absolute value of positions, in metres; others are clamped.
    pub limit: f64,
    /// The number of octaves.
    pub count: usize,
    /// The octaves, and then unused entries.
    pub all: [Octave; MAX_OCTAVES as usize],
}

/// The reason why a noise cannot repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TileError {
    /// An octave does not have an integer number of cells in the period.
    Octave {
        /// The octave, counted from 0.
        octave: usize,
        /// The axis: 0 for x, 1 for y, 2 for z, 3 for w.
        axis: usize,
        /// The number of its cells in one period: the number of the first octave times a power of the lacunarity.
        cells: f64,
    },
    /// The noise uses a lattice of simplices, which can only repeat along its skewed axes.
    Slanted,
}

impl fmt::Display for TileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            TileError::Octave { octave, axis, cells } => {
                let axis = ["x", "y", "z", "w"].get(axis).unwrap_or(&"?");
                write!(
                    f,
                    "octave {octave} would have to repeat after {cells} cells along {axis}; a period is a whole number of cells from 1 to \
                     {MAX_PERIOD}, so periods times powers of the lacunarity must be such numbers"
                )
            }
            TileError::Slanted => write!(
                f,
                "a lattice of simplices closes along its own slanted axes only, so this noise cannot repeat along x and y; take \
                 Perlin, value or Worley noise, or a ring through the third and fourth dimension"
            ),
        }
    }
}

impl std::error::Error for TileError {}

impl Program {
    /// A noise of one octave, whose lattice has a point at the origin.
    pub(crate) fn single(source: Source, seed: u64, wavelength: f64) -> Program {
        let frequency = defined(1.0 / wavelength);
        let mut all = [Octave::default(); MAX_OCTAVES as usize];
        all[0] = Octave {
            frequency,
            offset: [0.0; 4],
            words: words(source, seed),
            amplitude: 1.0,
            slope: defined32(frequency as f32, STEEPEST),
            gain: 1.0,
            ratio: 1.0,
            ..Octave::default()
        };
        Program { source, combine: Combine::Sum, limit: limit(source, frequency), count: 1, all }
    }

    /// A sum of octaves.
    pub(crate) fn octaves_of(fractal: &Octaves) -> Program {
        let Octaves { source, bound, .. } = *fractal;
        let count = fractal.count.min(MAX_OCTAVES);
        let gain = if fractal.gain.is_finite() { fractal.gain.clamp(-1024.0, 1024.0) } else { 0.0 };
        let base = defined(1.0 / fractal.wavelength);
        let mut all = [Octave::default(); MAX_OCTAVES as usize];
        let (mut amplitude, mut total) = (1.0, 0.0);
        for _ in 0..count {
            total += f64::abs(amplitude);
            amplitude *= gain;
        }
        // Slightly more than the sum, so that rounding in f32 cannot exceed 1.
        total *= bound * (1.0 + 1.0 / 1_048_576.0);
        let shape = shape(fractal.kind);
        let (mut amplitude, mut ratio, mut fastest) = (1.0, 1.0, 0.0_f64);
        for (octave, i) in all.iter_mut().zip(0..count) {
            let seed = seed::octave_seed(fractal.seed, u64::from(i));
            let frequency = defined(base * ratio);
            let turns = if frequency == 0.0 { 0.0 } else { ratio };
            let share = amplitude / total;
            let [value, slope] = match fractal.kind {
                Kind::Fbm => [share, share * frequency],
                Kind::Ridged | Kind::Billow => [2.0 * share, 2.0 * share * frequency],
                // The slope of the sum before normalization, per first wavelength.
                Kind::Weighted { .. } => [share, amplitude * turns],
                _ => [1.0 / bound, turns / bound],
            };
            *octave = Octave {
                frequency,
                offset: [0, 1, 2, 3].map(|axis| seed::offset(seed, axis)),
                words: words(source, seed),
                amplitude: value as f32,
                slope: defined32(
                    slope as f32,
                    match fractal.kind {
                        Kind::Fbm | Kind::Ridged | Kind::Billow => STEEPEST,
                        _ => STEEPEST_WEIGHTED,
                    },
                ),
                gain: defined32(amplitude as f32, STEEPEST_WEIGHTED),
                ratio,
                ..Octave::default()
            };
            fastest = fastest.max(frequency.abs());
            amplitude *= gain;
            ratio *= fractal.lacunarity;
        }
        let combine = match (fractal.kind, shape) {
            (Kind::Ridged, _) => Combine::Sizes { sign: -1.0 },
            (Kind::Billow, _) => Combine::Sizes { sign: 1.0 },
            (Kind::Weighted { k, falloff }, _) => Combine::Weighted {
                // Finite, so that its product with a slope of 0 is 0.
                k: if k >= 0.0 { k.min(f64::from(f32::MAX)) as f32 } else { 0.0 },
                falloff,
                gradient: if count == 0 { 0.0 } else { defined32((base / total) as f32, STEEPEST_WEIGHTED) },
            },
            (_, Some(shape)) => {
                let scale = 1.0 / greatest(shape, gain, count);
                Combine::Shaped {
                    shape,
                    scale: scale as f32,
                    gradient: defined32((base * scale) as f32, STEEPEST_WEIGHTED),
                }
            }
            (_, None) => Combine::Sum,
        };
        Program { source, combine, limit: limit(source, fastest), count: count as usize, all }
    }

    /// The same noise with a period of `period` cells of the first octave along x, y, z and w; 0 for no period.
    ///
    /// # Errors
    /// If an octave does not have an integer number of cells in the period, or if the lattice cannot repeat.
    pub fn tiled(mut self, period: [u32; 4]) -> Result<Program, TileError> {
        if period == [0; 4] {
            return Ok(self);
        }
        if !self.source.repeats() {
            return Err(TileError::Slanted);
        }
        let mut fastest = 0.0_f64;
        for (number, octave) in self.all.iter_mut().take(self.count).enumerate() {
            octave.tiled = true;
            // Offsets are multiples of the rounding of coordinates.
            octave.offset = octave.offset.map(|offset| (offset * 16_777_216.0).floor() / 16_777_216.0);
            fastest = fastest.max(octave.frequency.abs());
            for (axis, &cells) in period.iter().enumerate() {
                // An octave without a frequency is constant, so it repeats without a change.
                if octave.frequency == 0.0 || cells == 0 {
                    continue;
                }
                let cells = f64::from(cells) * octave.ratio.abs();
                if !(1.0..=MAX_PERIOD).contains(&cells) || cells.floor() != cells {
                    return Err(TileError::Octave { octave: number, axis, cells });
                }
                octave.period[axis] = cells;
            }
        }
        self.limit = self.limit.min(limit_of(FARTHEST_TILED, fastest));
        Ok(self)
    }

    /// The octaves.
    #[must_use]
    pub fn octaves(&self) -> &[Octave] {
        &self.all[..self.count.min(self.all.len())]
    }
}

/// The shape of a kind of fractal. NaN parameters count as 0.
fn shape(kind: Kind) -> Option<Shape> {
    let held = |number: f64, most: f64| if number.is_nan() { 0.0 } else { number.clamp(-most, most) as f32 };
    match kind {
        Kind::Fbm | Kind::Ridged | Kind::Billow | Kind::Weighted { .. } => None,
        Kind::PingPong { strength } => Some(Shape::PingPong { strength: held(strength, 1024.0) }),
        Kind::Hybrid { offset } => Some(Shape::Hybrid { offset: held(offset, 1024.0) }),
        Kind::Hetero { offset } => Some(Shape::Hetero { offset: held(offset, 1024.0) }),
        Kind::Swiss { warp } => Some(Shape::Swiss { warp: held(warp, 1024.0) }),
        Kind::Jordan { warp, damp } => Some(Shape::Jordan { warp: held(warp, 1024.0), damp: held(damp, 1024.0) }),
    }
}

/// Maximum absolute value of a shape before scaling, with a margin so that rounding in f32 cannot exceed 1.
fn greatest(shape: Shape, gain: f64, count: u32) -> f64 {
    let gains = || (0..count).scan(1.0, move |next, _| Some(std::mem::replace(next, *next * gain.abs())));
    let size = match shape {
        Shape::PingPong { .. } | Shape::Swiss { .. } | Shape::Jordan { .. } => gains().sum::<f64>(),
        Shape::Hybrid { offset } => (1.0 + f64::from(offset.abs())) * gains().sum::<f64>(),
        Shape::Hetero { offset } => {
            let one = 1.0 + f64::from(offset.abs());
            gains().skip(1).fold(one, |product, gain| product * (1.0 + one * gain))
        }
    };
    size.max(f64::MIN_POSITIVE) * (1.0 + 1.0 / 1_048_576.0)
}

fn words(source: Source, seed: u64) -> [[u32; 2]; 4] {
    match source {
        Source::Classic(_) => seed::reference_words(seed),
        _ => seed::lattice_words(seed),
    }
}

/// Replaces an invalid frequency with 0, which makes the octave constant.
fn defined(frequency: f64) -> f64 {
    if frequency.is_finite() { frequency } else { 0.0 }
}

/// Replaces an invalid slope factor with 0, and clamps it to `most`.
fn defined32(factor: f32, most: f32) -> f32 {
    if factor.is_finite() { factor.clamp(-most, most) } else { 0.0 }
}

fn limit(source: Source, frequency: f64) -> f64 {
    limit_of(if source.repeats() { FARTHEST } else { FARTHEST_SLANTED }, frequency)
}

fn limit_of(cells: f64, frequency: f64) -> f64 {
    let limit = cells / frequency.abs();
    if limit < f64::MAX { limit } else { f64::MAX }
}
