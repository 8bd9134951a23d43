//! Tests of every noise: the bits are the same at every level, with every method, and for every division into calls.

use crate::programs::{programs, run};
use orogen_noise::internals::Program;
use orogen_noise::{Depth, Level, Points};

/// Value and slopes at the points, as bits.
fn bits(level: Level, program: &Program, points: Points, depths: &[Depth], slopes: bool) -> [Vec<u32>; 5] {
    run(level, program, &points, depths, slopes).map(|values| values.into_iter().map(f32::to_bits).collect())
}

fn axis(start: f64, cell: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| (start + i as f64) * cell).collect()
}

#[test]
fn every_machine_and_every_way_of_asking_gives_the_same_bits() {
    // From many samples per cell to many cells per sample; near, negative and far positions; odd sizes.
    let cases = [
        (10.24, 300.0, (-3.0, 2.0), (37, 11)),
        (0.1, 1.1, (-17.0, 5.0), (19, 18)),
        (1.0 / 3.0, 0.26, (1e9, -4e8), (33, 5)),
        (1.0, 100.0, (-150.0, -8.0), (300, 21)),
        (5.0, 0.013, (-4.0, 7.0), (21, 4)),
    ];
    for (cell, wavelength, (x, y), (width, height)) in cases {
        let (xs, ys) = (axis(x, cell, width), axis(y, cell, height));
        let lattice = Points::Lattice { xs: &xs, ys: &ys };
        let none = vec![0.0; width * height];
        let displaced = Points::Displaced { xs: &xs, ys: &ys, dx: &none, dy: &none };
        let (x, y): (Vec<f64>, Vec<f64>) = (0..lattice.len()).map(|k| lattice.position(k).unwrap()).unzip();
        let scattered = Points::Scattered { x: &x, y: &y };
        let (z, w) = (vec![7.3 * cell; width * height], vec![-2.9 * cell; width * height]);
        for dims in 2..=4 {
            let slices = &[Depth::Slice(z[0]), Depth::Slice(w[0])][..dims - 2];
            let each = &[Depth::Each(&z), Depth::Each(&w)][..dims - 2];
            for (name, program) in programs(wavelength, dims) {
                let expected = bits(Level::Scalar, &program, scattered, each, true);
                assert!(
                    expected.iter().take(1 + dims).flatten().all(|&bits| f32::from_bits(bits).is_finite()),
                    "{name}"
                );
                for level in Level::available() {
                    for (points, depths) in
                        [(lattice, slices), (displaced, slices), (scattered, slices), (lattice, each)]
                    {
                        for slopes in [true, false] {
                            let found = bits(level, &program, points, depths, slopes);
                            for place in 0..if slopes { 1 + dims } else { 1 } {
                                assert!(
                                    found[place] == expected[place],
                                    "{name} differs at level {level} at place {place}, {dims} dimensions, {width} x {height}, slopes {slopes}, {:?}: {:?} {:?}",
                                    std::mem::discriminant(&points),
                                    f32::from_bits(found[place][0]),
                                    f32::from_bits(expected[place][0]),
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}
