//! Cases and targets.

use crate::rows::Target;

/// Side of the picture, in samples.
pub const SIZE: usize = 1024;
/// Octaves of every fractal; their frequencies double and their amplitudes halve.
pub const OCTAVES: usize = 6;
/// Depth of a slice of 3D noise, in samples.
pub const SLICE: f64 = 37.5;
/// Displacement of a warp, in wavelengths per unit of noise.
pub const WARP: f64 = 0.5;
/// The seed of every job.
pub const SEED: i32 = 1337;

/// The kinds of work.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// One hash per sample.
    White,
    /// Value noise.
    Value,
    /// Perlin noise.
    Perlin,
    /// A slice of 3D Perlin noise.
    PerlinSlice,
    /// Perlin noise at scattered points.
    PerlinScattered,
    /// Perlin noise at the same points in f32, relative to the middle of the picture.
    PerlinAround,
    /// Fractal sum of Perlin noise.
    Fbm,
    /// Fractal sum of ridged Perlin noise.
    Ridged,
    /// fBm whose octaves are damped where the sum of the coarser ones is steep.
    WeightedFbm,
    /// fBm displaced by two other fBm.
    WarpedFbm,
    /// Simplex noise.
    Simplex,
    /// A slice of 3D simplex noise.
    SimplexSlice,
    /// Distance to the nearest scattered point.
    Worley,
}

/// A line of the table.
pub struct Case {
    /// The name.
    pub name: &'static str,
    /// The kind of work.
    pub work: Work,
    /// Wavelength of the coarsest octave, in samples.
    pub wavelength: f64,
    /// The target.
    pub target: Option<Target>,
}

const fn case(name: &'static str, work: Work, peer: &'static str, ratio: f64) -> Case {
    Case { name, work, wavelength: 100.0, target: Some(Target { peer, ratio, or_rate: None }) }
}

/// The name of a peer without weighted fBm, whose plain fBm is measured.
pub const PLAIN_FBM: &str = "fastnoise-lite (plain fbm)";

/// Every case.
pub const CASES: &[Case] = &[
    Case {
        name: "white",
        work: Work::White,
        wavelength: 1.0,
        target: Some(Target { peer: "plain fill", ratio: 0.8, or_rate: Some(5000.0) }),
    },
    case("value 2D", Work::Value, "fastnoise-lite", 30.0),
    case("Perlin 2D", Work::Perlin, "fastnoise-lite", 42.0),
    case("Perlin 3D slice", Work::PerlinSlice, "fastnoise-lite", 65.0),
    case("Perlin 2D scattered", Work::PerlinScattered, "fastnoise-lite", 10.0),
    case("Perlin 2D scattered around an origin, f32", Work::PerlinAround, "fastnoise-lite", 10.0),
    case("fBm 6 octaves", Work::Fbm, "fastnoise-lite", 125.0),
    Case { wavelength: 50.0, ..case("fBm 6 octaves, wavelength 50", Work::Fbm, "fastnoise-lite", 80.0) },
    case("ridged 6 octaves", Work::Ridged, "fastnoise-lite", 70.0),
    case("weighted fBm 6 octaves", Work::WeightedFbm, PLAIN_FBM, 30.0),
    case("warped fBm 6 octaves", Work::WarpedFbm, "noise-functions", 30.0),
    case("simplex 2D", Work::Simplex, "fastnoise-lite", 14.0),
    case("simplex 3D slice", Work::SimplexSlice, "fastnoise-lite", 17.0),
    case("Worley F1 2D", Work::Worley, "fastnoise-lite", 50.0),
];

/// Scattered points over the picture, the same for all jobs.
pub fn scattered() -> (Vec<f64>, Vec<f64>) {
    let mut state = 1u64;
    let mut next = || {
        // Knuth's MMIX constants; the high bits are good enough for positions.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64 * SIZE as f64
    };
    (0..SIZE * SIZE).map(|_| (next(), next())).unzip()
}
