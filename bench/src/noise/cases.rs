//! What is measured, and what has to be reached.

use crate::rows::Target;

/// The picture's side.
pub const SIZE: usize = 1024;
/// Octaves of every fractal; their frequencies double and their amplitudes halve.
pub const OCTAVES: usize = 6;
/// Where a slice of 3D noise is cut, in samples.
pub const SLICE: f64 = 37.5;
/// How far a warp displaces, in wavelengths per unit of noise.
pub const WARP: f64 = 0.5;
/// The seed of every job.
pub const SEED: i32 = 1337;

/// The kinds of work.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// A hash for every sample.
    White,
    /// Value noise.
    Value,
    /// Perlin noise.
    Perlin,
    /// A plane of 3D Perlin noise.
    PerlinSlice,
    /// Perlin noise at points in no order.
    PerlinScattered,
    /// The same points in f32, seen from the middle of the picture.
    PerlinAround,
    /// Fractal sum of Perlin noise.
    Fbm,
    /// Fractal sum of creased Perlin noise.
    Ridged,
    /// fBm whose octaves fade where the sum of the coarser ones is steep.
    WeightedFbm,
    /// fBm displaced by two others.
    WarpedFbm,
    /// Simplex noise.
    Simplex,
    /// A plane of 3D simplex noise.
    SimplexSlice,
    /// Distance to the nearest of scattered points.
    Worley,
}

/// One line of the table.
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// What is done.
    pub work: Work,
    /// Samples in one period of the coarsest octave.
    pub wavelength: f64,
    /// What has to be reached.
    pub target: Option<Target>,
}

const fn case(name: &'static str, work: Work, peer: &'static str, ratio: f64) -> Case {
    Case { name, work, wavelength: 100.0, target: Some(Target { peer, ratio, or_rate: None }) }
}

/// The name under which a peer that offers no weighted fBm shows its plain one.
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

/// Points in no order over the picture, the same for everybody.
pub fn scattered() -> (Vec<f64>, Vec<f64>) {
    let mut state = 1u64;
    let mut next = || {
        // Knuth's MMIX constants; the high bits are good enough for positions.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64 * SIZE as f64
    };
    (0..SIZE * SIZE).map(|_| (next(), next())).unzip()
}
