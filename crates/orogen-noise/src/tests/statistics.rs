//! Tests of the independence of lattice points, of chunks, and of errors for wrong lengths. Statistics of the public
//! API are in tests/suite/statistics.rs.

use crate::{Basis, Depth, Falloff, Fractal, Kind, LengthMismatch, Perlin, Points, White};

fn axis(start: f64, cell: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| start + i as f64 * cell).collect()
}

fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let moment = |f: &dyn Fn(f64, f64) -> f64| {
        a.iter().zip(b).map(|(&a, &b)| f(f64::from(a), f64::from(b))).sum::<f64>() / a.len() as f64
    };
    let (ma, mb) = (moment(&|a, _| a), moment(&|_, b| b));
    let covariance = moment(&|a, b| (a - ma) * (b - mb));
    covariance / (moment(&|a, _| (a - ma) * (a - ma)) * moment(&|_, b| (b - mb) * (b - mb))).sqrt()
}

#[test]
fn neighbors_on_the_lattice_are_strangers() {
    // One sample per cell, compared along, across, diagonally and mirrored.
    let side = 500;
    let at = axis(0.5, 1.0, side);
    let mut white = vec![0.0; side * side];
    White { seed: 9, wavelength: 1.0 }.fill(&Points::Lattice { xs: &at, ys: &at }, &mut white).unwrap();
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

#[test]
fn chunks_join_without_a_seam() {
    let noise = Fractal {
        kind: Kind::Weighted { k: 1.0, falloff: Falloff::SquareRoot },
        wavelength: 31.0,
        ..Default::default()
    };
    let (xs, ys) = (axis(-1234.5, 1.0 / 3.0, 300), axis(77.0, 0.1, 40));
    let mut whole = vec![0.0; xs.len() * ys.len()];
    noise.fill(&Points::Lattice { xs: &xs, ys: &ys }, &mut whole).unwrap();
    for (x, y, width, height) in [(0, 0, 300, 1), (13, 5, 1, 30), (255, 0, 45, 40), (100, 39, 17, 1), (1, 1, 280, 33)] {
        let mut part = vec![0.0; width * height];
        noise.fill(&Points::Lattice { xs: &xs[x..x + width], ys: &ys[y..y + height] }, &mut part).unwrap();
        for (k, &value) in part.iter().enumerate() {
            assert_eq!(value.to_bits(), whole[(y + k / width) * xs.len() + x + k % width].to_bits());
        }
    }
}

#[test]
fn wrong_lengths_are_named() {
    let noise = Perlin::default();
    let points = Points::Lattice { xs: &[0.0, 1.0, 2.0], ys: &[0.0, 1.0] };
    let wrong = |slice, length| Err(LengthMismatch { slice, length, expected: 6 });
    assert_eq!(noise.fill(&points, &mut [0.0; 5]), wrong("value", 5));
    assert_eq!(noise.fill_with_gradient(&points, &mut [0.0; 6], &mut [0.0; 7], &mut [0.0; 6]), wrong("dx", 7));
    assert_eq!(noise.fill3(&points, &Depth::Each(&[0.0]), &mut [0.0; 6]), wrong("z", 1));
    let displaced = Points::Displaced { xs: &[0.0, 1.0, 2.0], ys: &[0.0, 1.0], dx: &[0.0; 6], dy: &[0.0; 4] };
    assert_eq!(noise.fill(&displaced, &mut [0.0; 6]), wrong("dy", 4));
    let none = Points::Lattice { xs: &[], ys: &[0.0] };
    assert_eq!((noise.fill(&none, &mut []), none.position(0), none.is_empty()), (Ok(()), None, true));
    assert_eq!(points.position(5), Some((2.0, 1.0)));
    assert_eq!(points.position(6), None);
}

#[test]
fn names_go_both_ways() {
    for &basis in Basis::all() {
        assert_eq!(Basis::from_name(basis.name()), Some(basis));
    }
    assert_eq!(Basis::from_name("perl"), None);
}
