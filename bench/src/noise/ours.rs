//! Our jobs.

use orogen_noise::{Depth, Falloff, Fractal, Kind, LengthMismatch, Perlin, Points, Simplex, Value, White, Worley};
use orogen_simd::Level;

use super::cases::{Case, OCTAVES, SEED, SIZE, SLICE, WARP, Work, scattered};
use crate::measure::Job;

/// The SIMD level in use.
pub fn level() -> &'static str {
    Level::current().name()
}

/// Our job for the case.
pub fn job(case: &Case) -> Job {
    let seed = SEED as u64;
    let wavelength = case.wavelength;
    let perlin = Perlin::new(seed, wavelength);
    let fractal = |kind| Fractal::new(seed, wavelength).with_kind(kind).with_octaves(OCTAVES as u32);
    let weighted = Kind::Weighted { k: 1.0, falloff: Falloff::Reciprocal };
    match case.work {
        Work::White => lattice(move |at, out| White::new(seed, wavelength).fill(at, out)),
        Work::Value => lattice(move |at, out| Value::new(seed, wavelength).fill(at, out)),
        Work::Perlin => lattice(move |at, out| perlin.fill(at, out)),
        Work::PerlinSlice => lattice(move |at, out| perlin.fill3(at, &Depth::Slice(SLICE), out)),
        Work::PerlinScattered => {
            let (x, y) = scattered();
            job_of(move |out| perlin.fill(&Points::Scattered { x: &x, y: &y }, out))
        }
        Work::PerlinAround => {
            let middle = SIZE as f64 / 2.0;
            let (x, y) = scattered();
            let [x, y] = [x, y].map(|at| at.iter().map(|at| (at - middle) as f32).collect::<Vec<f32>>());
            job_of(move |out| perlin.fill_around((middle, middle), &x, &y, out))
        }
        Work::Fbm => whole(fractal(Kind::Fbm)),
        Work::Ridged => whole(fractal(Kind::Ridged)),
        Work::WeightedFbm => whole(fractal(weighted)),
        Work::WarpedFbm => warped(fractal(Kind::Fbm), wavelength),
        Work::Worley => lattice(move |at, out| Worley::new(seed, wavelength).fill(at, out)),
        Work::Simplex => lattice(move |at, out| Simplex::new(seed, wavelength).fill(at, out)),
        Work::SimplexSlice => {
            lattice(move |at, out| Simplex::new(seed, wavelength).fill3(at, &Depth::Slice(SLICE), out))
        }
    }
}

/// On an error no sample is written, and the check before the timings fails.
fn job_of(mut fill: impl FnMut(&mut [f32]) -> Result<(), LengthMismatch> + 'static) -> Job {
    Job::new("orogen", move |out| _ = fill(out))
}

fn lattice(fill: impl Fn(&Points, &mut [f32]) -> Result<(), LengthMismatch> + 'static) -> Job {
    let axis = axis();
    job_of(move |out| fill(&Points::Lattice { xs: &axis, ys: &axis }, out))
}

fn whole(fractal: Fractal) -> Job {
    lattice(move |at, out| fractal.fill(at, out))
}

/// Rows of a band, few enough for the displacements of its samples to stay in cache.
const BAND: usize = 64;

/// The textbook warp: fBm at a position displaced by two other fBm, in bands of rows.
fn warped(fractal: Fractal, wavelength: f64) -> Job {
    let axis = axis();
    let reach = (WARP * wavelength) as f32;
    let mut shifts = [1, 2].map(|i| (fractal.with_seed(fractal.seed + i), vec![0.0; BAND * SIZE]));
    job_of(move |out| {
        for (ys, out) in axis.chunks(BAND).zip(out.chunks_mut(BAND * SIZE)) {
            for (shift, values) in &mut shifts {
                let values = &mut values[..out.len()];
                shift.fill(&Points::Lattice { xs: &axis, ys }, values)?;
                values.iter_mut().for_each(|v| *v *= reach);
            }
            let [dx, dy] = shifts.each_ref().map(|(_, values)| &values[..out.len()]);
            fractal.fill(&Points::Displaced { xs: &axis, ys, dx, dy }, out)?;
        }
        Ok(())
    })
}

/// The positions of the picture's columns and rows.
fn axis() -> Vec<f64> {
    (0..SIZE).map(|i| i as f64).collect()
}
