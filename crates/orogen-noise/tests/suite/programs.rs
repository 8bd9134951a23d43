//! Every noise as a program of the kernels, for tests in two to four dimensions.

use crate::noises::kinds;
use orogen_noise::internals::{Program, fill_at, program};
use orogen_noise::{
    Basis, Classic, ClassicVariant, Depth, Distance, Fade, Feature, Fractal, Kind, Level, OpenSimplex2, Perlin, Points,
    Simplex, Smoothness, Value, White, Worley,
};

/// Every basis and every combination of octaves, in `dims` dimensions.
pub fn programs(wavelength: f64, dims: usize) -> Vec<(String, Program)> {
    let mut list = Vec::new();
    let mut add = |name: String, program: Program| list.push((name, program));
    for fade in [Fade::Step, Fade::Linear, Fade::Cubic, Fade::Quintic] {
        let noise = Value::new(3, wavelength).with_fade(fade);
        add(format!("{noise:?}"), program(noise.prepare_in(dims)));
    }
    let noise = Perlin::new(4, wavelength);
    add(format!("{noise:?}"), program(noise.prepare_in(dims)));
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        let noise = Classic::new(5, wavelength).with_variant(variant);
        add(format!("{noise:?}"), program(noise.prepare_in(dims)));
    }
    for kind in kinds() {
        for basis in [Basis::Value, Basis::Perlin, Basis::Simplex] {
            let noise = Fractal::new(6, wavelength).with_basis(basis).with_kind(kind);
            let noise = noise.with_octaves(4).with_lacunarity(1.9).with_gain(0.6);
            add(format!("{noise:?}"), program(noise.prepare_in(dims)));
        }
    }
    for &basis in Basis::all() {
        let noise = Fractal::new(6, wavelength).with_basis(basis).with_octaves(2).with_lacunarity(1.9);
        add(format!("{noise:?}"), program(noise.prepare_in(dims)));
    }
    let noise = Simplex::new(8, wavelength);
    add(format!("{noise:?}"), program(noise.prepare_in(dims)));
    for smoothness in [Smoothness::Fast, Smoothness::Smooth] {
        let noise = OpenSimplex2::new(8, wavelength).with_smoothness(smoothness);
        add(format!("{noise:?}"), program(noise.prepare_in(dims)));
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let noise = Worley::new(7, wavelength).with_distance(distance).with_feature(feature).with_jitter(0.9);
            add(format!("{noise:?}"), program(noise.prepare_in(dims)));
        }
    }
    let period = [6, 3, 2, 2];
    let tiled = |program: Program| program.tiled(period).unwrap();
    let noise = Perlin::new(4, wavelength);
    add(format!("tiled {noise:?}"), tiled(program(noise.prepare_in(dims))));
    let noise = Worley::new(4, wavelength).with_feature(Feature::Edge);
    add(format!("tiled {noise:?}"), tiled(program(noise.prepare_in(dims))));
    let noise = White::new(4, wavelength);
    add(format!("tiled {noise:?}"), tiled(program(noise.prepare_in(dims))));
    for basis in [Basis::Value, Basis::ClassicEight] {
        let noise = Fractal::new(6, wavelength).with_basis(basis).with_kind(Kind::Ridged).with_octaves(3);
        add(format!("tiled {noise:?}"), tiled(program(noise.prepare_in(dims))));
    }
    list
}

/// Values at the points, then slopes along the axes that exist.
pub fn run(level: Level, program: &Program, points: &Points, depths: &[Depth], slopes: bool) -> [Vec<f32>; 5] {
    let mut out = [0; 5].map(|_| vec![f32::NAN; points.len()]);
    let [value, dx, dy, dz, dw] = &mut out;
    let dz: &mut [f32] = if depths.is_empty() { &mut [] } else { dz };
    let dw: &mut [f32] = if depths.len() < 2 { &mut [] } else { dw };
    fill_at(level, program, points, depths, value, slopes.then_some([dx, dy, dz, dw])).unwrap().unwrap();
    out
}
