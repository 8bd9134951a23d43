//! Prints the time of one call in nanoseconds, with a noise directly and with a prepared noise: for a single point, and
//! for a block of 8 x 8 samples.
//!
//! `cargo run --release -p orogen-noise --example prepared`

use orogen_noise::{Basis, Fractal, LengthMismatch, Perlin, Points, Simplex, Worley};
use std::hint::black_box;
use std::time::Instant;

/// Nanoseconds per call: the minimum of 500 runs of 200 calls. The runs are so short that most of them are not
/// interrupted by other processes.
fn time(mut call: impl FnMut(usize)) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..500 {
        let begun = Instant::now();
        for k in 0..200 {
            call(k);
        }
        least = least.min(begun.elapsed().as_secs_f64() * 1e9 / 200.0);
    }
    least
}

/// The times of a point and of a block, in nanoseconds.
fn times(
    sample: impl Fn(f64, f64) -> f32,
    fill: impl Fn(&Points, &mut [f32]) -> Result<(), LengthMismatch>,
) -> [f64; 2] {
    let mut heights = [0.0; 64];
    let point = time(|k| {
        black_box(sample(black_box(k as f64 * 1.7), 3.0));
    });
    let block = time(|k| {
        let xs = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| (k * 8 + i) as f64);
        // The slices have the same length as the points, so this cannot fail.
        let _ = fill(&Points::Lattice { xs: black_box(&xs), ys: &xs }, &mut heights);
        black_box(&heights);
    });
    [point, block]
}

fn main() {
    println!("ns per call            point  prepared |   8 x 8  prepared");
    macro_rules! row {
        ($name:expr, $noise:expr) => {
            let (noise, prepared) = ($noise, $noise.prepare());
            let direct = times(|x, y| noise.sample(x, y), |at, out| noise.fill(at, out));
            let once = times(|x, y| prepared.sample(x, y), |at, out| prepared.fill(at, out));
            println!("{:20} {:7.0} {:9.0} | {:7.0} {:9.0}", $name, direct[0], once[0], direct[1], once[1]);
        };
    }
    row!("perlin", Perlin::new(7, 100.0));
    row!("simplex", Simplex::new(7, 100.0));
    row!("worley", Worley::new(7, 100.0));
    row!("perlin fbm, 6", Fractal::new(7, 100.0));
    row!("perlin fbm, 12", Fractal::new(7, 100.0).with_octaves(12));
    row!("simplex fbm, 6", Fractal::new(7, 100.0).with_basis(Basis::Simplex));
}
