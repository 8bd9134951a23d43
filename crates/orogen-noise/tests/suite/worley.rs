//! Tests of cellular noise against an exhaustive search in f64, and of its bounds.

use crate::rng::Rng;
use crate::twins::hash;
use orogen_noise::internals::{Cellular, Octave, Source, program};
use orogen_noise::{Depth, Distance, Feature, Points, Worley};

const DISTANCES: [Distance; 3] = [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev];
const FEATURES: [Feature; 6] =
    [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge];

fn measure(distance: Distance, way: &[f64]) -> f64 {
    let sizes = way.iter().map(|x| x.abs());
    match distance {
        Distance::Euclidean => way.iter().map(|x| x * x).sum::<f64>().sqrt(),
        Distance::Manhattan => sizes.sum(),
        Distance::Chebyshev => sizes.fold(0.0, f64::max),
        _ => unreachable!("{distance:?} has no reference implementation"),
    }
}

/// Every offset of at most `radius` along each axis.
fn window(axes: usize, radius: i32) -> Vec<Vec<f64>> {
    let side = 2 * radius + 1;
    (0..side.pow(axes as u32))
        .map(|k| (0..axes).map(|axis| f64::from(k / side.pow(axis as u32) % side - radius)).collect())
        .collect()
}

/// The vector from a position in cell coordinates to the point of a cell, and the hash of the cell.
fn site(octave: &Octave, jitter: f64, at: &[f64], offset: &[f64]) -> (Vec<f64>, u32) {
    let cell: Vec<f64> = at.iter().zip(offset).map(|(u, o)| u.floor() + o).collect();
    let first = hash(Source::Perlin, octave, &cell);
    let second = (first ^ first >> 16).wrapping_mul(0x93D7_65DD);
    let third = (second ^ second >> 15).wrapping_mul(0x915F_77F5);
    let words = [first, second, third, (third ^ third >> 16).wrapping_mul(0xADB4_A92D)];
    let place = |axis: usize| f64::from(words[axis] >> 8) / 16_777_216.0 * jitter + 0.5 - 0.5 * jitter;
    ((0..at.len()).map(|axis| cell[axis] + place(axis) - at[axis]).collect(), first)
}

/// The noise, and the difference between the nearest two distances.
fn twin(octave: &Octave, cellular: Cellular, at: &[f64]) -> (f64, f64) {
    let sites: Vec<(Vec<f64>, u32)> =
        window(at.len(), 4).iter().map(|o| site(octave, f64::from(cellular.jitter), at, o)).collect();
    let mut ranked: Vec<(f64, usize)> =
        sites.iter().enumerate().map(|(i, (way, _))| (measure(cellular.distance, way), i)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ((first, nearest), (second, _)) = (ranked[0], ranked[1]);
    let raw = match cellular.feature {
        Feature::F1 => first,
        Feature::F2 => second,
        Feature::Difference => second - first,
        Feature::Product => first * second,
        Feature::Value => {
            let hash = sites[nearest].1;
            let word = (hash ^ hash >> 16).wrapping_mul(0xADB4_A92D);
            return (f64::from(word as i32) / 2_147_483_648.0 * (1.0 - 1.0 / 1_048_576.0), second - first);
        }
        Feature::Edge if cellular.distance == Distance::Euclidean => {
            let near = &sites[nearest].0;
            let others = sites.iter().enumerate().filter(|(i, _)| *i != nearest);
            others
                .map(|(_, (way, _))| {
                    let apart: Vec<f64> = way.iter().zip(near).map(|(a, b)| a - b).collect();
                    let along: f64 = way.iter().zip(near).zip(&apart).map(|((a, b), d)| 0.5 * (a + b) * d).sum();
                    along / measure(Distance::Euclidean, &apart)
                })
                .fold(f64::MAX, f64::min)
        }
        Feature::Edge => (second - first) / 2.0,
        feature => unreachable!("{feature:?} has no reference implementation"),
    };
    (raw * 2.0 / f64::from(cellular.bound(at.len())) - 1.0, second - first)
}

#[test]
fn no_nearer_point_is_ever_missed() {
    for dims in 2..=4 {
        for distance in DISTANCES {
            for feature in FEATURES {
                for jitter in [1.0, 0.6] {
                    let noise = Worley::new(5, 37.0).with_distance(distance).with_feature(feature).with_jitter(jitter);
                    let program = program(noise.prepare_in(dims));
                    let Source::Worley(cellular) = program.source else { unreachable!() };
                    let mut rng = Rng(8);
                    let n = [500, 80, 8][dims - 2];
                    let mut axis = || (0..n).map(|_| rng.between(-2000.0, 2000.0)).collect::<Vec<f64>>();
                    let (x, y, z, w) = (axis(), axis(), axis(), axis());
                    let (points, mut out) = (Points::Scattered { x: &x, y: &y }, vec![0.0; n]);
                    match dims {
                        2 => noise.fill(&points, &mut out).unwrap(),
                        3 => noise.fill3(&points, &Depth::Each(&z), &mut out).unwrap(),
                        _ => noise.fill4(&points, &[Depth::Each(&z), Depth::Each(&w)], &mut out).unwrap(),
                    }
                    for k in 0..n {
                        let position = [x[k], y[k], z[k], w[k]].map(|x| x * program.all[0].frequency);
                        let (expected, lead) = twin(&program.all[0], cellular, &position[..dims]);
                        if feature == Feature::Value && lead < 1e-5 {
                            continue;
                        }
                        let found = f64::from(out[k]);
                        assert!((found - expected).abs() < 2e-5, "{noise:?} at {position:?}: {found}, {expected}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_stated_bounds_are_the_true_ones() {
    for axes in 2..=4 {
        for distance in DISTANCES {
            let (mut first, mut second, mut product) = (0.0_f64, 0.0_f64, 0.0_f64);
            // For all positions in a cell: the distances to the nearest two points if each point is as far away as
            // possible.
            let steps = [40_i32, 12, 4][axes - 2];
            for k in 0..(steps + 1).pow(axes as u32) {
                let at: Vec<f64> = (0..axes)
                    .map(|axis| f64::from(k / (steps + 1).pow(axis as u32) % (steps + 1)) / f64::from(steps))
                    .collect();
                let mut far: Vec<f64> = window(axes, 2)
                    .iter()
                    .map(|offset| {
                        let way: Vec<f64> =
                            at.iter().zip(offset).map(|(t, o)| (o - t).abs().max((o + 1.0 - t).abs())).collect();
                        measure(distance, &way)
                    })
                    .collect();
                far.sort_by(f64::total_cmp);
                first = first.max(far[0]);
                second = second.max(far[1]);
                product = product.max(far[0] * far[1]);
            }
            for (feature, found) in [(Feature::F1, first), (Feature::F2, second), (Feature::Product, product)] {
                let stated = f64::from(Cellular { distance, feature, jitter: 1.0 }.bound(axes));
                assert!((found - stated).abs() < 1e-6, "{feature:?} {distance:?} {axes}: {found} is not {stated}");
            }
        }
    }
}

#[test]
fn values_fill_the_range_and_average_out() {
    let side: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.37).collect();
    let points = Points::Lattice { xs: &side, ys: &side };
    let mut out = vec![f32::NAN; points.len()];
    for distance in DISTANCES {
        for feature in FEATURES {
            let noise = Worley::default().with_distance(distance).with_feature(feature).with_seed(9);
            noise.fill(&points, &mut out).unwrap();
            assert!(out.iter().all(|x| x.abs() <= 1.0), "{noise:?}");
            let spread = out.iter().fold((1.0_f32, -1.0_f32), |(low, high), &x| (low.min(x), high.max(x)));
            assert!(spread.1 - spread.0 > 0.7, "{noise:?}: {spread:?}");
            if feature == Feature::Value {
                let mean = out.iter().map(|&x| f64::from(x)).sum::<f64>() / out.len() as f64;
                assert!(mean.abs() < 0.02, "{mean}");
            }
        }
    }
}
