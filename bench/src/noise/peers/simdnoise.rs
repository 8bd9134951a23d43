//! simdnoise: whole pictures with SIMD up to AVX2, f32, always in a new buffer. Its only basis is simplex. It is listed
//! under this name next to our Perlin fractals, and no target refers to it.

use simdnoise::{CellReturnType, NoiseBuilder};

use crate::measure::Job;
use crate::noise::cases::{Case, OCTAVES, SEED, SIZE, Work};

/// The job of simdnoise for a case.
pub fn job(case: &Case) -> Option<Job> {
    let octaves = OCTAVES as u8;
    let frequency = (1.0 / case.wavelength) as f32;
    Some(match case.work {
        Work::Fbm => Job::new("simdnoise (simplex)", move |out| {
            let mut settings = NoiseBuilder::fbm_2d(SIZE, SIZE);
            settings.with_seed(SEED).with_freq(frequency).with_octaves(octaves);
            *out = settings.with_lacunarity(2.0).with_gain(0.5).generate().0;
        }),
        Work::Ridged => Job::new("simdnoise (simplex)", move |out| {
            let mut settings = NoiseBuilder::ridge_2d(SIZE, SIZE);
            settings.with_seed(SEED).with_freq(frequency).with_octaves(octaves);
            *out = settings.with_lacunarity(2.0).with_gain(0.5).generate().0;
        }),
        Work::Simplex => Job::new("simdnoise", move |out| {
            *out = NoiseBuilder::gradient_2d(SIZE, SIZE).with_seed(SEED).with_freq(frequency).generate().0;
        }),
        Work::SimplexSlice => Job::new("simdnoise", move |out| {
            *out = NoiseBuilder::gradient_3d(SIZE, SIZE, 1).with_seed(SEED).with_freq(frequency).generate().0;
        }),
        Work::Worley => Job::new("simdnoise", move |out| {
            let mut settings = NoiseBuilder::cellular_2d(SIZE, SIZE);
            settings.with_seed(SEED).with_freq(frequency).with_return_type(CellReturnType::Distance);
            *out = settings.generate().0;
        }),
        _ => return None,
    })
}
