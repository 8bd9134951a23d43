//! noise: function objects and one call per sample, f64.

use noise::core::worley::ReturnType;
use noise::{Fbm, MultiFractal, NoiseFn, Perlin, RidgedMulti, Simplex, Value, Worley};

use super::by_sample::by_sample;
use crate::measure::Job;
use crate::noise::cases::{Case, OCTAVES, SEED, SLICE, Work, scattered};

const NAME: &str = "noise";

/// The job of noise for a case.
pub fn job(case: &Case) -> Option<Job> {
    let seed = SEED as u32;
    let frequency = 1.0 / case.wavelength;
    Some(match case.work {
        Work::Value => plane(Value::new(seed), frequency),
        Work::Perlin => plane(Perlin::new(seed), frequency),
        Work::PerlinSlice => slice(Perlin::new(seed), frequency),
        Work::PerlinScattered | Work::PerlinAround => points(Perlin::new(seed), frequency),
        Work::Fbm => {
            let fbm = Fbm::<Perlin>::new(seed).set_octaves(OCTAVES).set_lacunarity(2.0).set_persistence(0.5);
            plane(fbm, frequency)
        }
        Work::Ridged => plane(RidgedMulti::<Perlin>::new(seed).set_octaves(OCTAVES).set_lacunarity(2.0), frequency),
        Work::Simplex => plane(Simplex::new(seed), frequency),
        Work::SimplexSlice => slice(Simplex::new(seed), frequency),
        Work::Worley => plane(Worley::new(seed).set_return_type(ReturnType::Distance), frequency),
        Work::White | Work::WeightedFbm | Work::WarpedFbm => return None,
    })
}

fn plane(noise: impl NoiseFn<f64, 2> + 'static, frequency: f64) -> Job {
    Job::new(NAME, move |out| by_sample(out, |x, y| noise.get([x * frequency, y * frequency]) as f32))
}

fn slice(noise: impl NoiseFn<f64, 3> + 'static, frequency: f64) -> Job {
    let z = SLICE * frequency;
    Job::new(NAME, move |out| by_sample(out, |x, y| noise.get([x * frequency, y * frequency, z]) as f32))
}

fn points(noise: impl NoiseFn<f64, 2> + 'static, frequency: f64) -> Job {
    let (xs, ys) = scattered();
    Job::new(NAME, move |out| {
        for ((value, &x), &y) in out.iter_mut().zip(&xs).zip(&ys) {
            *value = noise.get([x * frequency, y * frequency]) as f32;
        }
    })
}
