//! Statistics over many samples of every noise: mean and range, independence of seeds and lattice points, isotropy,
//! slopes, and smoothness far away.
//!
//! `cargo test --release -p orogen-noise --test suite statistics -- --ignored --nocapture` uses a hundred times as many
//! samples.

use crate::noises::{Ask, Noise, Slope, bases, endless, fractals, singles};
use orogen_noise::{Depth, Fractal, Points, White};

/// Number of samples per side of a window.
const SIDE: usize = 1000;

fn axis(start: f64, cell: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| start + i as f64 * cell).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for x in values {
        sum += x;
        count += 1.0;
    }
    sum / count
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    mean(values.map(|x| x * x)).sqrt()
}

#[test]
fn means_are_zero_and_ranges_within_bounds() {
    check_means(1);
}

#[test]
#[ignore = "long: a hundred million samples of every noise, in the plane and in space"]
fn means_of_many_samples_are_zero_and_ranges_within_bounds() {
    check_means(100);
}

/// Checks means and ranges of `windows` windows with a million samples each.
fn check_means(windows: usize) {
    for (place, name) in ["in the plane", "in space"].into_iter().enumerate() {
        for (number, noise) in endless(11, 1.0).iter().enumerate() {
            let (mut sum, mut low, mut high) = (0.0, f32::MAX, f32::MIN);
            for window in 0..windows {
                // Slightly more than a third of a cell apart, so that all parts of cells are sampled. In space, each
                // window has a different depth.
                let start = -60.0 + window as f64 * 377.17;
                let (xs, ys) = (axis(start, 0.371, SIDE), axis(-start * 0.7, 0.371, SIDE));
                let depth = (place == 1).then_some(Depth::Slice(0.43 + window as f64 * 1.37));
                let ask = Ask { points: Points::Lattice { xs: &xs, ys: &ys }, depth, slopes: false };
                let [values, ..] = noise.ask(&ask).unwrap();
                sum += values.iter().map(|&x| f64::from(x)).sum::<f64>();
                low = values.iter().fold(low, |low, &x| low.min(x));
                high = values.iter().fold(high, |high, &x| high.max(x));
                assert!(values.iter().all(|x| x.is_finite()), "{}", noise.name);
            }
            let samples = windows * SIDE * SIDE;
            let mean = sum / samples as f64;
            if windows > 1 {
                println!("{number:3} {} {name}: mean {mean:.5}, {low:.4} to {high:.4}", noise.name);
            }
            let bound = noise.bounds()[place];
            assert!(low >= -bound && high <= bound, "{} {name}: {low} to {high}", noise.name);
            assert!(high - low > 0.5, "{} {name}: only {low} to {high}", noise.name);
            assert!(!noise.centered || mean.abs() < 0.01, "{} {name}: mean {mean}", noise.name);
        }
    }
}

fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let of = |values: &[f32]| mean(values.iter().map(|&x| f64::from(x)));
    let (ma, mb) = (of(a), of(b));
    let pairs = || a.iter().zip(b).map(|(&a, &b)| (f64::from(a) - ma, f64::from(b) - mb));
    let covariance = mean(pairs().map(|(a, b)| a * b));
    covariance / (rms(pairs().map(|(a, _)| a)) * rms(pairs().map(|(_, b)| b)))
}

#[test]
fn neighboring_seeds_are_strangers() {
    // One position in every third cell of every octave. If absolute values or distances are greater on average in one
    // part of a cell, this says nothing about seeds.
    let side = axis(-299.629, 3.0, 500);
    let points = Points::Lattice { xs: &side, ys: &side };
    let ask = |seed: u64| -> Vec<(String, Vec<f32>)> {
        let mut list = bases(seed, 1.0);
        list.extend(fractals(Fractal::new(seed, 1.0).with_octaves(4)));
        list.extend(singles(seed, 1.0));
        list.into_iter().map(|noise| (noise.name.clone(), noise.values(&points))).collect()
    };
    let origin = ask(0);
    for (from, pairs) in [(&origin, vec![1, u64::MAX, 1 << 32, 1 << 63]), (&ask(255), vec![256])] {
        for to in pairs {
            for ((name, a), (_, b)) in from.iter().zip(ask(to)) {
                // Samples are at different positions in each simplex, and one-sided noises have this pattern in common.
                if name.contains(" over simplex") && !matches!(&name[..3], "Fbm" | "Wei") {
                    continue;
                }
                let found = correlation(a, &b);
                // The 2002 table repeats after 65 536 cells. Unrelated numbers have a correlation of .004 there, and
                // sometimes three times as much.
                let most = if name.contains("classic") { 0.015 } else { 0.01 };
                assert!(found.abs() < most, "{name}, seed {to} and its neighbor: {found}");
            }
        }
    }
}

#[test]
fn neighbors_on_the_lattice_are_strangers() {
    // One sample per cell, compared along, across, diagonally and mirrored.
    let side = 500;
    let at = axis(0.5, 1.0, side);
    let mut white = vec![0.0; side * side];
    White::new(9, 1.0).fill(&Points::Lattice { xs: &at, ys: &at }, &mut white).unwrap();
    for (dx, dy) in [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (7, 3), (64, 0), (0, 64), (256, 0), (0, 256)] {
        let n = (side - dx) * (side - dy);
        let pick = |ox: usize, oy: usize| -> Vec<f32> {
            (0..n).map(|k| white[(k / (side - dx) + oy) * side + k % (side - dx) + ox]).collect()
        };
        let found = correlation(&pick(0, 0), &pick(dx, dy));
        // Four standard deviations of unrelated numbers.
        assert!(found.abs() < 4.0 / (n as f64).sqrt(), "({dx}, {dy}): {found}");
    }
    let mirrored: Vec<f32> = (0..side * side).map(|k| white[k % side * side + k / side]).collect();
    assert!(correlation(&white, &mirrored).abs() < 0.02);
}

/// The maximum dependence on direction, in percent, of the mean squared difference of two samples at a distance.
fn anisotropy(noise: &Noise, distance: f64) -> f64 {
    const DIRECTIONS: usize = 16;
    let side = axis(-811.0, 1.037, 700);
    let (x, y): (Vec<f64>, Vec<f64>) = side.iter().flat_map(|&y| side.iter().map(move |&x| (x, y))).unzip();
    let here = noise.values(&Points::Scattered { x: &x, y: &y });
    let powers: Vec<f64> = (0..DIRECTIONS)
        .map(|i| {
            let angle = i as f64 * std::f64::consts::PI / DIRECTIONS as f64;
            let shift = [distance * libm::cos(angle), distance * libm::sin(angle)];
            let moved = |values: &[f64], by: f64| values.iter().map(|v| v + by).collect::<Vec<f64>>();
            let (x, y) = (moved(&x, shift[0]), moved(&y, shift[1]));
            let there = noise.values(&Points::Scattered { x: &x, y: &y });
            mean(here.iter().zip(&there).map(|(a, b)| f64::from(a - b) * f64::from(a - b)))
        })
        .collect();
    let middle = mean(powers.iter().copied());
    powers.iter().fold(0.0, |most, power| f64::max(most, (power / middle - 1.0).abs())) * 100.0
}

/// The expected maximum, in percent. White noise consists of squares; the 2002 table has few directions and repeats.
fn stated_anisotropy(name: &str) -> f64 {
    match name {
        "white" => 18.0,
        "value" | "perlin" | "classic-diagonal" => 2.5,
        "classic-eight" => 4.0,
        "simplex" | "opensimplex2" | "opensimplex2-smooth" => 1.0,
        // A cell is based on a square, which is visible in its edges.
        "worley-edge" => 7.0,
        _ => 5.0,
    }
}

#[test]
fn directions_are_alike() {
    for noise in bases(21, 1.0) {
        for distance in [0.25, 0.5, 1.0, 1.5] {
            let (found, stated) = (anisotropy(&noise, distance), stated_anisotropy(&noise.name));
            println!("{}: {distance} cells apart, directions differ by {found:.2} %", noise.name);
            assert!(found < stated, "{}, {distance} cells apart: {found} %", noise.name);
        }
    }
}

/// Slopes along one axis, from five-point differences of the values, in f64.
fn differences(noise: &Noise, at: [&[f64]; 3], along: usize, deep: bool) -> Vec<f64> {
    const STEP: f64 = 0.0625;
    let values = |by: f64| -> Vec<f64> {
        let mut moved = at.map(<[f64]>::to_vec);
        moved[along].iter_mut().for_each(|x| *x += by);
        let [x, y, z] = &moved;
        let ask = Ask { points: Points::Scattered { x, y }, depth: deep.then_some(Depth::Each(z)), slopes: false };
        noise.ask(&ask).unwrap()[0].iter().map(|&x| f64::from(x)).collect()
    };
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|steps| values(steps * STEP));
    (0..a.len()).map(|k| (8.0 * (c[k] - b[k]) - (d[k] - a[k])) / (12.0 * STEP)).collect()
}

/// Noises with creases are compared with reference implementations in f64 instead, which work closer to the creases
/// (twins.rs).
#[test]
fn slopes_are_those_of_the_values() {
    // Positions that f64 represents exactly together with their steps.
    let mut state = 1_u64;
    let mut places = || -> Vec<f64> {
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as f64 / 1_048_576.0 - 2048.0
        };
        (0..10_000).map(|_| next()).collect()
    };
    let (x, y, z) = (places(), places(), places());
    for deep in [false, true] {
        for noise in endless(4, 37.0).iter().filter(|noise| noise.slope == Slope::Exact) {
            let (points, depth) = (Points::Scattered { x: &x, y: &y }, deep.then_some(Depth::Each(&z)));
            let [_, slopes @ ..] = noise.ask(&Ask { points, depth, slopes: true }).unwrap();
            let (mut error, mut size) = (0.0, 0.0);
            for (along, slopes) in slopes.iter().enumerate().take(if deep { 3 } else { 2 }) {
                for (found, expected) in slopes.iter().zip(differences(noise, [&x, &y, &z], along, deep)) {
                    let off = f64::from(*found) - expected;
                    error += off * off;
                    size += expected * expected;
                }
            }
            let relative = (error / size).sqrt();
            println!("{}, deep {deep}: {relative:.1e} of the RMS slope", noise.name);
            assert!(relative < 1e-3, "{}, deep {deep}: {relative}", noise.name);
        }
    }
}

/// Second differences along x: their RMS and their maximum, over 2000 rows of samples, each of five first wavelengths
/// with 10 samples each.
fn bends(noise: &Noise, start: f64) -> [f64; 2] {
    const CELL: f64 = 0.125;
    let (xs, ys) = (axis(start, CELL, 402), axis(start, 17.0, 2000));
    let values = noise.values(&Points::Lattice { xs: &xs, ys: &ys });
    let rows = values.chunks_exact(xs.len());
    let bends = || {
        rows.clone().flat_map(|row| row.windows(3).map(|w| f64::from(w[0]) - 2.0 * f64::from(w[1]) + f64::from(w[2])))
    };
    [rms(bends()), bends().fold(0.0, |most, bend| f64::max(most, bend.abs()))]
}

#[test]
fn far_away_is_as_smooth_as_here() {
    for noise in endless(2, 10.0).iter().filter(|noise| noise.slope == Slope::Exact) {
        let here = bends(noise, 0.0);
        for start in [1e6, 1e9, -1e9] {
            let there = bends(noise, start);
            let [usual, greatest] = [0, 1].map(|i| (there[i] / here[i] - 1.0).abs());
            println!("{} at {start:e}: {usual:.4}, {greatest:.4}", noise.name);
            // The 2002 table repeats, so a strip of five cells contains some of the steepest positions or none.
            // Products of octaves (hetero) have rare large values.
            let rare = noise.name.contains("classic") || noise.name.starts_with("Hetero");
            let most = if rare { 0.25 } else { 0.06 };
            assert!(usual < 0.02 && greatest < most, "{} at {start:e}: {usual}, {greatest}", noise.name);
        }
    }
}
