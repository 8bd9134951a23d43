//! simdnoise: whole pictures by SIMD up to AVX2, f32, always a new buffer. Its only basis is simplex: beside our Perlin
//! fractals it stands under that name, and no target is measured against it.

use simdnoise::{CellReturnType, NoiseBuilder};

use crate::measure::Job;
use crate::noise::cases::{Case, OCTAVES, SEED, SIZE, Work};

/// What simdnoise offers for the case.
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
