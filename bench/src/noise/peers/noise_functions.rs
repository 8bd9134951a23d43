//! noise-functions: static types and one call per sample, f32.

use noise_functions::modifiers::Frequency;
use noise_functions::{CellDistance, Constant, Noise, OpenSimplex2, Perlin, Sample, Value};

use super::by_sample::by_sample;
use crate::measure::Job;
use crate::noise::cases::{Case, OCTAVES, SEED, SLICE, WARP, Work, scattered};

const NAME: &str = "noise-functions";

/// The job of noise-functions for a case.
pub fn job(case: &Case) -> Option<Job> {
    let octaves = OCTAVES as u32;
    let frequency = (1.0 / case.wavelength) as f32;
    Some(match case.work {
        Work::Value => plane(Value.frequency(frequency)),
        Work::Perlin => plane(Perlin.frequency(frequency)),
        Work::PerlinSlice => slice(Perlin.frequency(frequency)),
        Work::PerlinScattered | Work::PerlinAround => points(Perlin.frequency(frequency)),
        Work::Fbm => plane(Perlin.fbm(octaves, 0.5, 2.0).frequency(frequency)),
        Work::Ridged => plane(Perlin.ridged().fbm(octaves, 0.5, 2.0).frequency(frequency)),
        Work::WarpedFbm => warped(Perlin.fbm(octaves, 0.5, 2.0).frequency(frequency), case.wavelength),
        Work::Simplex => plane(OpenSimplex2.frequency(frequency)),
        Work::SimplexSlice => slice(OpenSimplex2.frequency(frequency)),
        Work::Worley => plane(CellDistance::default().frequency(frequency)),
        Work::White | Work::WeightedFbm => return None,
    })
}

fn plane<N: Sample<2> + 'static>(noise: Frequency<N, Constant>) -> Job {
    let noise = noise.seed(SEED);
    Job::new(NAME, move |out| by_sample(out, |x, y| noise.sample2([x as f32, y as f32])))
}

fn slice<N: Sample<3> + 'static>(noise: Frequency<N, Constant>) -> Job {
    let noise = noise.seed(SEED);
    Job::new(NAME, move |out| by_sample(out, |x, y| noise.sample3([x as f32, y as f32, SLICE as f32])))
}

fn points<N: Sample<2> + 'static>(noise: Frequency<N, Constant>) -> Job {
    let noise = noise.seed(SEED);
    let (xs, ys) = scattered();
    let points: Vec<[f32; 2]> = xs.iter().zip(&ys).map(|(&x, &y)| [x as f32, y as f32]).collect();
    Job::new(NAME, move |out| {
        for (value, &point) in out.iter_mut().zip(&points) {
            *value = noise.sample2(point);
        }
    })
}

/// The textbook warp: fBm at a position displaced by two other fBm.
fn warped<N: Sample<2> + 'static>(noise: Frequency<N, Constant>, wavelength: f64) -> Job {
    let reach = (WARP * wavelength) as f32;
    Job::new(NAME, move |out| {
        by_sample(out, |x, y| {
            let (x, y) = (x as f32, y as f32);
            let dx = noise.sample_with_seed([x, y], SEED + 1);
            let dy = noise.sample_with_seed([x, y], SEED + 2);
            noise.sample_with_seed([x + reach * dx, y + reach * dy], SEED)
        });
    })
}
