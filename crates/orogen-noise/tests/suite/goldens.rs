//! The bits of every noise, as hashes in a file. A change of a hash changes every terrain that uses the noise.
//!
//! `OROGEN_BLESS=1 cargo test -p orogen-noise --test suite goldens` rewrites the file.

use crate::noises::at_each_level;
use orogen_noise::{
    Basis, Classic, ClassicVariant, Depth, Distance, Fade, Falloff, Feature, Fractal, Kind, OpenSimplex2, Perlin,
    Points, Simplex, Smoothness, Value, White, Worley,
};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/goldens.txt");

/// FNV-1a over the bit patterns.
fn hash(values: &[f32]) -> u64 {
    values
        .iter()
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}

/// Hashes of value and gradient, in the plane and in space, for a window that crosses the origin and a window far away.
macro_rules! golden {
    ($list:expr, $name:expr, $noise:expr) => {{
        let noise = $noise;
        let mut bits = Vec::new();
        for start in [-150.0, 3e8] {
            let xs: Vec<f64> = (0..67).map(|i| start + f64::from(i) * 7.3).collect();
            let ys: Vec<f64> = (0..19).map(|i| f64::from(i) * 10.24 - start).collect();
            let points = Points::Lattice { xs: &xs, ys: &ys };
            let mut out = [0; 7].map(|_| vec![0.0_f32; points.len()]);
            let [a, b, c, d, e, f, g] = &mut out;
            noise.fill_with_gradient(&points, a, b, c).unwrap();
            noise.fill3_with_gradient(&points, &Depth::Slice(start * 0.3), d, [e, f, g]).unwrap();
            bits.extend(out.concat());
        }
        $list.push(format!("{} {:016x}", $name, hash(&bits)));
    }};
}

/// The same hashes for a noise without slopes.
macro_rules! golden_values {
    ($list:expr, $name:expr, $noise:expr) => {{
        let noise = $noise;
        let mut bits = Vec::new();
        for start in [-150.0, 3e8] {
            let xs: Vec<f64> = (0..67).map(|i| start + f64::from(i) * 7.3).collect();
            let ys: Vec<f64> = (0..19).map(|i| f64::from(i) * 10.24 - start).collect();
            let points = Points::Lattice { xs: &xs, ys: &ys };
            let (mut plane, mut space) = (vec![0.0_f32; points.len()], vec![0.0_f32; points.len()]);
            noise.fill(&points, &mut plane).unwrap();
            noise.fill3(&points, &Depth::Slice(start * 0.3), &mut space).unwrap();
            bits.extend(plane);
            bits.extend(space);
        }
        $list.push(format!("{} {:016x}", $name, hash(&bits)));
    }};
}

/// The same hashes in four dimensions.
macro_rules! golden_time {
    ($list:expr, $name:expr, $noise:expr) => {{
        let noise = $noise;
        let mut bits = Vec::new();
        for start in [-150.0, 3e8] {
            let xs: Vec<f64> = (0..37).map(|i| start + f64::from(i) * 7.3).collect();
            let ys: Vec<f64> = (0..5).map(|i| f64::from(i) * 10.24 - start).collect();
            let points = Points::Lattice { xs: &xs, ys: &ys };
            let mut out = [0; 5].map(|_| vec![0.0_f32; points.len()]);
            let [value, slopes @ ..] = &mut out;
            let depths = [Depth::Slice(start * 0.3), Depth::Slice(start * 0.7)];
            noise.fill4_with_gradient(&points, &depths, value, slopes.each_mut().map(|s| &mut s[..])).unwrap();
            bits.extend(out.concat());
        }
        $list.push(format!("{} {:016x}", $name, hash(&bits)));
    }};
}

fn goldens() -> Vec<String> {
    let mut list = Vec::new();
    golden!(list, "white", White::new(11, 20.0));
    for fade in [Fade::Linear, Fade::Cubic, Fade::Quintic] {
        golden!(list, format!("value {fade:?}"), Value::new(11, 90.0).with_fade(fade));
    }
    golden!(list, "perlin", Perlin::new(11, 90.0));
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        golden!(list, format!("classic {variant:?}"), Classic::new(11, 90.0).with_variant(variant));
    }
    let fractal = Fractal::new(11, 300.0);
    for &basis in Basis::all() {
        golden!(list, format!("fbm {}", basis.name()), fractal.with_basis(basis));
    }
    golden!(list, "fbm odd", fractal.with_lacunarity(1.87).with_gain(0.62).with_octaves(9));
    golden!(list, "ridged perlin", fractal.with_kind(Kind::Ridged));
    golden!(list, "billow perlin", fractal.with_kind(Kind::Billow));
    for falloff in [Falloff::Reciprocal, Falloff::Exponential, Falloff::SquareRoot, Falloff::Smoothstep] {
        let kind = Kind::Weighted { k: 1.3, falloff };
        golden!(list, format!("weighted {falloff:?} perlin"), fractal.with_kind(kind));
        golden!(list, format!("weighted {falloff:?} value"), fractal.with_kind(kind).with_basis(Basis::Value));
    }
    golden!(list, "simplex", Simplex::new(11, 90.0));
    for smoothness in [Smoothness::Fast, Smoothness::Smooth] {
        golden!(list, format!("opensimplex2 {smoothness:?}"), OpenSimplex2::new(11, 90.0).with_smoothness(smoothness));
    }
    for kind in [
        Kind::PingPong { strength: 2.0 },
        Kind::Hybrid { offset: 0.7 },
        Kind::Hetero { offset: 0.7 },
        Kind::Swiss { warp: 0.15 },
        Kind::Jordan { warp: 0.35, damp: 0.8 },
    ] {
        for basis in [Basis::Perlin, Basis::Simplex] {
            golden!(list, format!("{kind:?} {}", basis.name()), fractal.with_kind(kind).with_basis(basis));
        }
    }
    for &basis in Basis::all() {
        golden_time!(list, format!("4D fbm {}", basis.name()), fractal.with_basis(basis).with_octaves(2));
    }
    if let Ok(tiled) = fractal.with_octaves(4).tiled([3, 2, 5]) {
        golden!(list, "tiled fbm perlin", tiled);
    }
    if let Ok(tiled) = White::new(11, 20.0).tiled([7, 6, 5]) {
        golden!(list, "tiled white", tiled);
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let noise = Worley::new(11, 90.0).with_distance(distance).with_feature(feature);
            golden_values!(list, format!("worley {feature:?} {distance:?}"), noise);
        }
    }
    list
}

/// Whether the tests write the file instead of comparing with it (`OROGEN_BLESS=1`).
fn bless() -> bool {
    let value = std::env::var_os("OROGEN_BLESS");
    assert!(
        value.as_ref().is_none_or(|value| value == "1"),
        "only OROGEN_BLESS=1 rewrites the committed files: set it to that, or unset it to compare with them"
    );
    value.is_some()
}

#[test]
fn the_bits_are_the_committed_ones_at_every_level() {
    at_each_level(|level| {
        let found = goldens().join("\n") + "\n";
        if bless() {
            std::fs::write(FILE, &found).unwrap();
        }
        let expected = std::fs::read_to_string(FILE).unwrap_or_default();
        assert_eq!(expected, found, "level {level}");
    });
}
