//! Helpers that several tests use.

use crate::program::Program;
use crate::{
    Basis, Classic, ClassicVariant, Distance, Fade, Falloff, Feature, Fractal, Kind, OpenSimplex2, Perlin, Simplex,
    Smoothness, Value, White, Worley,
};

/// All kinds of fractals except the weighted ones.
pub(crate) const KINDS: [Kind; 8] = [
    Kind::Fbm,
    Kind::Ridged,
    Kind::Billow,
    Kind::PingPong { strength: 2.0 },
    Kind::Hybrid { offset: 0.7 },
    Kind::Hetero { offset: 0.7 },
    Kind::Swiss { warp: 0.15 },
    Kind::Jordan { warp: 0.35, damp: 0.8 },
];

/// Random numbers for positions (splitmix64).
pub(crate) struct Rng(pub u64);

impl Rng {
    pub(crate) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        crate::seed::mix64(self.0)
    }
    /// A random number between two others.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.word() >> 11) as f64 / 9_007_199_254_740_992.0)
    }
}

/// Every basis and every combination of octaves, in `dims` dimensions.
pub(crate) fn programs(wavelength: f64, dims: usize) -> Vec<(String, Program)> {
    let mut list = Vec::new();
    let mut add = |name: String, program: Program| list.push((name, program));
    for fade in [Fade::Step, Fade::Linear, Fade::Cubic, Fade::Quintic] {
        let noise = Value { seed: 3, wavelength, fade };
        add(format!("{noise:?}"), noise.program(dims));
    }
    let noise = Perlin { seed: 4, wavelength };
    add(format!("{noise:?}"), noise.program(dims));
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        let noise = Classic { seed: 5, wavelength, variant };
        add(format!("{noise:?}"), noise.program(dims));
    }
    let falloffs = [Falloff::Reciprocal, Falloff::Exponential, Falloff::SquareRoot, Falloff::Smoothstep];
    let weighted = falloffs.map(|falloff| Kind::Weighted { k: 1.5, falloff });
    for kind in KINDS.into_iter().chain(weighted) {
        for basis in [Basis::Value, Basis::Perlin, Basis::Simplex] {
            let noise = Fractal { basis, kind, seed: 6, wavelength, octaves: 4, lacunarity: 1.9, gain: 0.6 };
            add(format!("{noise:?}"), noise.program(dims));
        }
    }
    for &basis in Basis::all() {
        let noise = Fractal { basis, seed: 6, wavelength, octaves: 2, lacunarity: 1.9, ..Default::default() };
        add(format!("{noise:?}"), noise.program(dims));
    }
    let noise = Simplex { seed: 8, wavelength };
    add(format!("{noise:?}"), noise.program(dims));
    for smoothness in [Smoothness::Fast, Smoothness::Smooth] {
        let noise = OpenSimplex2 { seed: 8, wavelength, smoothness };
        add(format!("{noise:?}"), noise.program(dims));
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let noise = Worley { seed: 7, wavelength, distance, feature, jitter: 0.9 };
            add(format!("{noise:?}"), noise.program(dims));
        }
    }
    let period = [6, 3, 2, 2];
    let tiled = |program: Program| program.tiled(period).unwrap();
    let noise = Perlin { seed: 4, wavelength };
    add(format!("tiled {noise:?}"), tiled(noise.program(dims)));
    let noise = Worley { seed: 4, wavelength, feature: Feature::Edge, ..Default::default() };
    add(format!("tiled {noise:?}"), tiled(noise.program(dims)));
    let noise = White { seed: 4, wavelength };
    add(format!("tiled {noise:?}"), tiled(noise.program(dims)));
    for basis in [Basis::Value, Basis::ClassicEight] {
        let noise = Fractal { basis, kind: Kind::Ridged, seed: 6, wavelength, octaves: 3, ..Default::default() };
        add(format!("tiled {noise:?}"), tiled(noise.program(dims)));
    }
    list
}
