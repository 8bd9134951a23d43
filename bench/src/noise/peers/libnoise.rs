//! libnoise: generators composed by types and one call per sample, f64. Its own buffers are filled by the same call
//! through an iterator over coordinates, which is slower than a loop.

use libnoise::{Generator, Source};

use super::by_sample::by_sample;
use crate::measure::Job;
use crate::noise::cases::{Case, OCTAVES, SEED, SLICE, Work, scattered};

const NAME: &str = "libnoise";

/// The job of libnoise for a case.
pub fn job(case: &Case) -> Option<Job> {
    let seed = SEED as u64;
    let octaves = OCTAVES as u32;
    let frequency = 1.0 / case.wavelength;
    Some(match case.work {
        Work::Value => plane(Source::value(seed), frequency),
        Work::Perlin => plane(Source::perlin(seed), frequency),
        Work::PerlinSlice => slice(Source::perlin(seed), frequency),
        Work::PerlinScattered | Work::PerlinAround => points(Source::perlin(seed), frequency),
        Work::Fbm => plane(Source::perlin(seed).fbm(octaves, 1.0, 2.0, 0.5), frequency),
        Work::Ridged => plane(Source::perlin(seed).ridgedmulti(octaves, 1.0, 2.0, 2.0), frequency),
        Work::Simplex => plane(Source::simplex(seed), frequency),
        Work::SimplexSlice => slice(Source::simplex(seed), frequency),
        Work::Worley => plane(Source::worley(seed), frequency),
        Work::White | Work::WeightedFbm | Work::WarpedFbm => return None,
    })
}

fn plane(noise: impl Generator<2> + 'static, frequency: f64) -> Job {
    Job::new(NAME, move |out| by_sample(out, |x, y| noise.sample([x * frequency, y * frequency]) as f32))
}

fn slice(noise: impl Generator<3> + 'static, frequency: f64) -> Job {
    let z = SLICE * frequency;
    Job::new(NAME, move |out| by_sample(out, |x, y| noise.sample([x * frequency, y * frequency, z]) as f32))
}

fn points(noise: impl Generator<2> + 'static, frequency: f64) -> Job {
    let (xs, ys) = scattered();
    Job::new(NAME, move |out| {
        for ((value, &x), &y) in out.iter_mut().zip(&xs).zip(&ys) {
            *value = noise.sample([x * frequency, y * frequency]) as f32;
        }
    })
}
