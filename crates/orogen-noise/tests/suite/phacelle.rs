//! Tests of Phacelle noise, with a reference implementation in f64, and of domain warps.

use crate::rng::Rng;
use crate::twins::hash;
use orogen_noise::internals::{Source, program};
use orogen_noise::{Basis, LengthMismatch, Level, Perlin, Phacelle, Points, Warp, WarpKind};
use std::f64::consts::TAU;

/// Cosine and sine as documented, with every pivot within reach, not only those that the kernel reads.
fn twin(noise: &Phacelle, at: [f64; 2], way: [f64; 2]) -> [f64; 2] {
    let program = program(Perlin::new(noise.seed, noise.wavelength * noise.cell).prepare_in(2));
    let octave = &program.all[0];
    let length = libm::hypot(way[0], way[1]);
    let side = [-way[1] / length * noise.cell, way[0] / length * noise.cell];
    let (mut wave, mut weights) = ([0.0; 2], 0.0);
    for number in 0..49 {
        let u = at.map(|x| x * octave.frequency);
        let cells = [u[0].floor() + f64::from(number % 7) - 3.0, u[1].floor() + f64::from(number / 7) - 3.0];
        let first = hash(Source::Perlin, octave, &cells);
        let second = (first ^ first >> 16).wrapping_mul(0x93D7_65DD);
        let third = (second ^ second >> 15).wrapping_mul(0x915F_77F5);
        let unit = |word: u32| f64::from(word >> 8) / 16_777_216.0;
        let v = [u[0] - (cells[0] + unit(first) - 0.5), u[1] - (cells[1] + unit(second) - 0.5)];
        let weight = (libm::exp(-2.0 * (v[0] * v[0] + v[1] * v[1])) - libm::exp(-4.5)).max(0.0);
        let phase = TAU * (v[0] * side[0] + v[1] * side[1] + unit(third));
        wave = [wave[0] + weight * libm::cos(phase), wave[1] + weight * libm::sin(phase)];
        weights += weight;
    }
    let wave = wave.map(|part| part / weights);
    wave.map(|part| part / libm::hypot(wave[0], wave[1]).max(1.0 - noise.normalisation))
}

#[test]
fn stripes_are_those_of_the_twin_at_every_level_and_way_of_asking() {
    let noise = Phacelle::new(3, 37.0);
    let mut rng = Rng(5);
    let (columns, rows) = (61, 9);
    let xs: Vec<f64> = (0..columns).map(|i| f64::from(i) * 10.24 - 300.0).collect();
    let ys: Vec<f64> = (0..rows).map(|i| f64::from(i) / 3.0 + 1e6).collect();
    let lattice = Points::Lattice { xs: &xs, ys: &ys };
    let n = lattice.len();
    let (x, y): (Vec<f64>, Vec<f64>) = (0..n).filter_map(|k| lattice.position(k)).unzip();
    let [dx, dy] = [0; 2].map(|_| (0..n).map(|_| rng.between(-3.0, 3.0) as f32).collect::<Vec<f32>>());
    let none = vec![0.0; n];
    let displaced = Points::Displaced { xs: &xs, ys: &ys, dx: &none, dy: &none };
    let mut first: Option<[Vec<f32>; 2]> = None;
    for level in Level::available() {
        for points in [lattice, Points::Scattered { x: &x, y: &y }, displaced] {
            let [mut cosine, mut sine] = [vec![f32::NAN; n], vec![f32::NAN; n]];
            noise.fill_along_at(level, &points, [&dx, &dy], [&mut cosine, &mut sine]).unwrap().unwrap();
            let found = [cosine, sine];
            let expected = first.get_or_insert_with(|| found.clone());
            assert!(found == *expected, "level {level}");
        }
    }
    let [cosine, sine] = first.unwrap();
    for k in 0..n {
        let [cos, sin] = twin(&noise, [x[k], y[k]], [f64::from(dx[k]), f64::from(dy[k])]);
        assert!((f64::from(cosine[k]) - cos).abs() < 1e-5 && (f64::from(sine[k]) - sin).abs() < 1e-5, "{k}");
    }
}

#[test]
fn stripes_run_along_the_direction_and_average_out() {
    let noise = Phacelle::new(9, 10.0).with_direction(30.0).with_normalisation(1.0);
    let side: Vec<f64> = (0..500).map(|i| f64::from(i) * 1.7).collect();
    let mut values = vec![0.0; side.len() * side.len()];
    noise.fill(&Points::Lattice { xs: &side, ys: &side }, &mut values).unwrap();
    let mean = values.iter().map(|&x| f64::from(x)).sum::<f64>() / values.len() as f64;
    assert!(mean.abs() < 0.01, "{mean}");
    assert!(
        values.iter().all(|x| x.abs() <= 1.0) && values.iter().any(|x| *x > 0.99) && values.iter().any(|x| *x < -0.99)
    );
    // A step along the stripes changes the value much less than a step across them.
    let change = |angle: f64| -> f64 {
        let (sin, cos) = (libm::sin(angle.to_radians()), libm::cos(angle.to_radians()));
        let mut rng = Rng(2);
        (0..4000)
            .map(|_| {
                let (x, y) = (rng.between(-900.0, 900.0), rng.between(-900.0, 900.0));
                let d = f64::from(noise.sample(x + 0.5 * cos, y + 0.5 * sin) - noise.sample(x, y));
                d * d
            })
            .sum()
    };
    assert!(change(30.0) * 3.0 < change(120.0), "{} {}", change(30.0), change(120.0));
}

#[test]
fn odd_stripes_are_finite_and_seams_close() {
    let odd = [f64::NAN, f64::INFINITY, -1e300, 0.0, -0.0, 1e9, 5e-324];
    for value in odd {
        for noise in [
            Phacelle::default().with_wavelength(value),
            Phacelle::default().with_cell(value),
            Phacelle::default().with_normalisation(value),
            Phacelle::default().with_direction(value),
        ] {
            for x in odd {
                assert!(noise.sample(x, 1.5).abs() <= 1.0, "{noise:?} at {x}");
            }
            let way = [f32::NAN, 0.0, f32::INFINITY, 1e30, 1e-30];
            let (mut cosine, mut sine) = ([f32::NAN; 5], [f32::NAN; 5]);
            let points = Points::Lattice { xs: &odd[2..7], ys: &[3.0] };
            noise.fill_along(&points, &way, &[1.0; 5], &mut cosine, &mut sine).unwrap();
            assert!(cosine.iter().chain(&sine).all(|x| x.abs() <= 1.0), "{noise:?}: {cosine:?} {sine:?}");
        }
    }
    let noise = Phacelle::new(0, 10.0).with_cell(0.75).with_period([4, 3]).with_direction(20.0);
    for k in 0..200 {
        let (x, y) = (f64::from(k) * 0.25, f64::from(k * k % 97) * 0.125);
        assert_eq!(noise.sample(x, y), noise.sample(x + 30.0, y - 22.5));
    }
    let points = Points::Lattice { xs: &odd[2..4], ys: &[3.0] };
    let found = noise.fill_along(&points, &[1.0; 3], &[1.0; 2], &mut [0.0; 2], &mut [0.0; 2]);
    assert_eq!(found, Err(LengthMismatch { slice: "dx", length: 3, expected: 2 }));
}

#[test]
fn warps_are_the_same_however_they_are_asked_and_keep_their_reach() {
    let xs: Vec<f64> = (0..57).map(|i| f64::from(i) * 10.24 - 100.0).collect();
    let ys: Vec<f64> = (0..13).map(|i| f64::from(i) * 0.1 + 1e9).collect();
    let lattice = Points::Lattice { xs: &xs, ys: &ys };
    let n = lattice.len();
    let (x, y): (Vec<f64>, Vec<f64>) = (0..n).filter_map(|k| lattice.position(k)).unzip();
    for kind in [WarpKind::Independent, WarpKind::Progressive, WarpKind::Gradient] {
        for &basis in Basis::all() {
            let warp = Warp::new(0, 80.0).with_kind(kind).with_basis(basis).with_strength(25.0);
            let ask = |points: Points| {
                let [mut dx, mut dy] = [vec![f32::NAN; n], vec![f32::NAN; n]];
                warp.displace(&points, &mut dx, &mut dy).unwrap();
                [dx, dy]
            };
            let found = ask(lattice);
            assert!(found == ask(Points::Scattered { x: &x, y: &y }), "{warp:?}");
            assert!(kind == WarpKind::Gradient || found.iter().flatten().all(|d| d.abs() <= 25.001), "{warp:?}");
            assert!(kind == WarpKind::Gradient || found[0] != found[1], "{warp:?}");
        }
    }
    // Without octaves there is no displacement.
    let still = Warp::default().with_octaves(0).with_kind(WarpKind::Progressive).with_strength(f64::NAN);
    let (mut dx, mut dy) = (vec![1.0; n], vec![1.0; n]);
    still.displace(&lattice, &mut dx, &mut dy).unwrap();
    assert!(dx.iter().chain(&dy).all(|d| *d == 0.0));
    assert!(still.displace(&lattice, &mut dx, &mut dy[1..]).is_err());
}
