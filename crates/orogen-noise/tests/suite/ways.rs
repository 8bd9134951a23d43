//! Lattices, displaced points and scattered points, whole and in parts, with and without slopes, give the same bits at
//! every level.

use crate::noises::{Ask, Columns, Noise, all, at_each_level, same_bits};
use orogen_noise::{Depth, Falloff, Fractal, Kind, Points};

/// Columns and rows of samples, and a depth.
struct Window {
    xs: Vec<f64>,
    ys: Vec<f64>,
    z: f64,
    wavelength: f64,
}

fn windows() -> Vec<Window> {
    let axis =
        |start: f64, cell: f64, count: usize| (0..count).map(|i| (start + i as f64) * cell).collect::<Vec<f64>>();
    // From many samples per cell to many cells per sample; near, negative and far positions; odd sizes.
    [
        (10.24, 300.0, (-3.0, 2.0), (37, 7)),
        (0.1, 1.1, (-17.0, 5.0), (19, 9)),
        (1.0 / 3.0, 0.26, (1e9, -4e8), (33, 3)),
        (1.0, 100.0, (-150.0, -8.0), (259, 2)),
        (5.0, 0.013, (-4.0, 7.0), (21, 4)),
    ]
    .into_iter()
    .map(|(cell, wavelength, (x, y), (width, height))| Window {
        xs: axis(x, cell, width),
        ys: axis(y, cell, height),
        z: 7.3 * cell,
        wavelength,
    })
    .collect()
}

/// The results of every method for the samples of a window, each with its name. In space, the depth is given once for
/// all samples and once for each.
fn answers(noise: &Noise, window: &Window, deep: bool) -> Vec<(&'static str, Columns)> {
    let (xs, ys) = (&window.xs, &window.ys);
    let lattice = Points::Lattice { xs, ys };
    let none = vec![0.0; lattice.len()];
    let (x, y): (Vec<f64>, Vec<f64>) = (0..lattice.len()).map(|k| lattice.position(k).unwrap()).unzip();
    let scattered = Points::Scattered { x: &x, y: &y };
    let each = vec![window.z; lattice.len()];
    let (slice, each) = (Depth::Slice(window.z), Depth::Each(&each));
    let mut list = Vec::new();
    for (name, points, depth, slopes) in [
        ("scattered", scattered, each, true),
        ("scattered values", scattered, slice, false),
        ("lattice", lattice, slice, true),
        ("lattice values", lattice, slice, false),
        ("lattice of depths", lattice, each, false),
        ("displaced", Points::Displaced { xs, ys, dx: &none, dy: &none }, slice, true),
    ] {
        list.push((name, noise.ask(&Ask { points, depth: deep.then_some(depth), slopes }).unwrap()));
    }
    // The same window in two adjacent parts.
    let (left, right) = xs.split_at(xs.len() / 2 + 1);
    let [left, right] = [left, right].map(|xs| {
        let points = Points::Lattice { xs, ys };
        noise.ask(&Ask { points, depth: deep.then_some(slice), slopes: true }).unwrap()
    });
    let mut joined = Columns::default();
    for ((to, left), right) in joined.iter_mut().zip(&left).zip(&right) {
        for (left, right) in left
            .chunks(left.len() / ys.len() + usize::from(left.is_empty()))
            .zip(right.chunks(right.len() / ys.len() + usize::from(right.is_empty())))
        {
            to.extend(left);
            to.extend(right);
        }
    }
    list.push(("two lattices", joined));
    list
}

#[test]
fn every_way_of_asking_gives_the_same_bits_at_every_level() {
    let windows = windows();
    // The first result of the first level is the reference for all others.
    let mut expected: Vec<Columns> = Vec::new();
    at_each_level(|level| {
        let mut number = 0;
        for window in &windows {
            for noise in all(3, window.wavelength) {
                for deep in [false, true] {
                    for (way, found) in answers(&noise, window, deep) {
                        if expected.len() == number {
                            expected.push(found.clone());
                        }
                        let expected = &expected[number];
                        assert!(
                            same_bits(&found, expected) && found[0].len() == window.xs.len() * window.ys.len(),
                            "{} differs: {way} at level {level}, deep {deep}, wavelength {}: {:?} and {:?}",
                            noise.name,
                            window.wavelength,
                            found.each_ref().map(|column| column.first()),
                            expected.each_ref().map(|column| column.first()),
                        );
                    }
                    number += 1;
                }
            }
        }
    });
    assert!(expected.iter().flat_map(|columns| &columns[0]).all(|x| x.abs() <= 1.0));
}

#[test]
fn chunks_join_without_a_seam() {
    let noise = Fractal::new(0, 31.0).with_kind(Kind::Weighted { k: 1.0, falloff: Falloff::SquareRoot });
    let axis = |start: f64, cell: f64, count: usize| (0..count).map(|i| start + i as f64 * cell).collect::<Vec<f64>>();
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

/// Windows larger than the caches are stored past them, in whole registers from an aligned address on. The result
/// equals the same part of a small window, independent of the alignment of the window and its rows.
#[test]
fn huge_windows_are_what_small_ones_are() {
    let noise = Fractal::new(5, 90.0).with_octaves(2);
    for (width, begin) in [(4112, 0), (4112, 5), (4099, 3)] {
        let height = (1_usize << 24).div_ceil(width);
        let axis = |count: usize| (0..count).map(|i| i as f64 - 1000.0).collect::<Vec<f64>>();
        let (xs, ys) = (axis(width), axis(height));
        let mut memory = vec![9.0; begin + width * height + 1];
        noise.fill(&Points::Lattice { xs: &xs, ys: &ys }, &mut memory[begin..begin + width * height]).unwrap();
        assert!(memory[..begin].iter().chain(&memory[begin + width * height..]).all(|&around| around == 9.0));
        for row in [0, 1, 63, 64, height / 2, height - 1] {
            let mut alone = vec![0.0; width];
            noise.fill(&Points::Lattice { xs: &xs, ys: &ys[row..=row] }, &mut alone).unwrap();
            let found = &memory[begin + row * width..][..width];
            assert!(found.iter().zip(&alone).all(|(a, b)| a.to_bits() == b.to_bits()), "row {row} of {width} columns");
        }
    }
}
