//! Prints how many million points per second each noise computes on one thread, at each SIMD level, for 1024 x 1024
//! samples with a wavelength of 100 samples.
//!
//! `cargo run --release -p orogen-noise --example throughput [LEVEL [CASE]]`

use orogen_noise::{Basis, Depth, Falloff, Fractal, Kind, Level, Perlin, Points, Value, White};
use std::time::Instant;

const SIDE: usize = 1024;

/// Fills a value and two slopes.
type Work<'a> = &'a mut dyn FnMut(&mut [f32], &mut [f32], &mut [f32]);

/// Processor time of this thread in seconds, so that other load on the machine does not count. Wall time if the system
/// does not provide it.
fn clock(since: Instant) -> f64 {
    let spent = std::fs::read_to_string("/proc/thread-self/schedstat");
    let nanoseconds = spent.ok().and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |nanoseconds| nanoseconds / 1e9)
}

/// Millions of points per second, measured over about a fifth of a second.
fn speed(mut work: impl FnMut()) -> f64 {
    work();
    let since = Instant::now();
    let (start, mut runs) = (clock(since), 0.0);
    loop {
        work();
        runs += 1.0;
        let spent = clock(since) - start;
        if spent > 0.2 {
            return runs * (SIDE * SIDE) as f64 / spent / 1e6;
        }
    }
}

fn main() {
    let wanted = std::env::args().nth(1);
    let case = std::env::args().nth(2);
    let xs: Vec<f64> = (0..SIDE).map(|i| i as f64).collect();
    let ys = xs.clone();
    let lattice = Points::Lattice { xs: &xs, ys: &ys };
    let (x, y): (Vec<f64>, Vec<f64>) = (0..SIDE * SIDE).map(|k| lattice.position(k).unwrap_or_default()).unzip();
    let scattered = Points::Scattered { x: &x, y: &y };
    let bend: Vec<f32> = (0..SIDE * SIDE).map(|k| (k % 97) as f32 * 0.3).collect();
    let displaced = Points::Displaced { xs: &xs, ys: &ys, dx: &bend, dy: &bend };
    let slice = Depth::Slice(12.3);
    let (mut out, mut dx, mut dy) = (vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE]);
    let fbm = Fractal::new(1, 100.0);
    let perlin = Perlin::new(1, 100.0);
    let value = Value::new(1, 100.0);
    let weighted = fbm.with_kind(Kind::Weighted { k: 1.0, falloff: Falloff::Reciprocal });

    for level in Level::available().into_iter().rev() {
        if wanted.as_deref().is_some_and(|name| name != level.name()) || Level::force(level).is_err() {
            continue;
        }
        let mut row = |name: &str, work: Work| {
            if case.as_deref().is_some_and(|case| case != name) {
                return;
            }
            println!("{:8} {name:28} {:8.0}", level.name(), speed(|| work(&mut out, &mut dx, &mut dy)));
        };
        macro_rules! fill {
            ($name:expr, $noise:expr, $points:expr) => {
                row($name, &mut |out, _, _| assert!($noise.fill(&$points, out).is_ok()));
            };
        }
        row("plain fill", &mut |out, _, _| std::hint::black_box(out).fill(0.0));
        fill!("white, wavelength 1", White::new(1, 1.0), lattice);
        fill!("white, wavelength 100", White::new(1, 100.0), lattice);
        fill!("value", value, lattice);
        fill!("perlin", perlin, lattice);
        row("perlin slice in 3D", &mut |out, _, _| assert!(perlin.fill3(&lattice, &slice, out).is_ok()));
        fill!("perlin scattered", perlin, scattered);
        row("perlin with gradient", &mut |out, dx, dy| {
            assert!(perlin.fill_with_gradient(&lattice, out, dx, dy).is_ok());
        });
        fill!("fbm6", fbm, lattice);
        fill!("fbm6, wavelength 50", fbm.with_wavelength(50.0), lattice);
        fill!("fbm6 value", fbm.with_basis(Basis::Value), lattice);
        row("fbm6 with gradient", &mut |out, dx, dy| {
            assert!(fbm.fill_with_gradient(&lattice, out, dx, dy).is_ok());
        });
        fill!("white scattered", White::new(1, 1.0), scattered);
        fill!("fbm6 displaced", fbm, displaced);
        fill!("fbm6 scattered", fbm, scattered);
        fill!("ridged6", fbm.with_kind(Kind::Ridged), lattice);
        fill!("weighted6", weighted, lattice);
        row("weighted6 with gradient", &mut |out, dx, dy| {
            assert!(weighted.fill_with_gradient(&lattice, out, dx, dy).is_ok());
        });
        fill!("classic diagonal fbm6", fbm.with_basis(Basis::ClassicDiagonal), lattice);
    }
}
