//! fastnoise-lite: a settings struct and one call per sample, f32.

use fastnoise_lite::{CellularDistanceFunction, CellularReturnType, FastNoiseLite, FractalType, NoiseType};

use super::by_sample::by_sample;
use crate::measure::Job;
use crate::noise::cases::{Case, OCTAVES, PLAIN_FBM, SEED, SLICE, Work, scattered};

/// The job of fastnoise-lite for a case.
pub fn job(case: &Case) -> Option<Job> {
    let (noise_type, fractal) = match case.work {
        Work::Value => (NoiseType::Value, FractalType::None),
        Work::Perlin | Work::PerlinSlice | Work::PerlinScattered | Work::PerlinAround => {
            (NoiseType::Perlin, FractalType::None)
        }
        Work::Fbm | Work::WeightedFbm => (NoiseType::Perlin, FractalType::FBm),
        Work::Ridged => (NoiseType::Perlin, FractalType::Ridged),
        Work::Simplex | Work::SimplexSlice => (NoiseType::OpenSimplex2, FractalType::None),
        Work::Worley => (NoiseType::Cellular, FractalType::None),
        // Its warp uses one cheap gradient lookup per octave, which is not the same work.
        Work::White | Work::WarpedFbm => return None,
    };
    let mut noise = FastNoiseLite::with_seed(SEED);
    noise.set_noise_type(Some(noise_type));
    noise.set_frequency(Some((1.0 / case.wavelength) as f32));
    noise.set_fractal_type(Some(fractal));
    noise.set_fractal_octaves(Some(OCTAVES as i32));
    noise.set_fractal_lacunarity(Some(2.0));
    noise.set_fractal_gain(Some(0.5));
    noise.set_cellular_return_type(Some(CellularReturnType::Distance));
    noise.set_cellular_distance_function(Some(CellularDistanceFunction::Euclidean));
    let name = if case.work == Work::WeightedFbm { PLAIN_FBM } else { "fastnoise-lite" };
    Some(match case.work {
        Work::PerlinSlice | Work::SimplexSlice => Job::new(name, move |out| {
            by_sample(out, |x, y| noise.get_noise_3d(x as f32, y as f32, SLICE as f32));
        }),
        Work::PerlinScattered | Work::PerlinAround => {
            let (xs, ys) = scattered();
            let points: Vec<(f32, f32)> = xs.iter().zip(&ys).map(|(&x, &y)| (x as f32, y as f32)).collect();
            Job::new(name, move |out| {
                for (value, &(x, y)) in out.iter_mut().zip(&points) {
                    *value = noise.get_noise_2d(x, y);
                }
            })
        }
        _ => Job::new(name, move |out| by_sample(out, |x, y| noise.get_noise_2d(x as f32, y as f32))),
    })
}
