//! A picture that fits no cache: one octave beside the plainest way to write as many samples.

use orogen_noise::{Perlin, Points};

use super::cases::SEED;
use crate::measure::{self, Clock, Job, PLAIN};
use crate::options::Options;
use crate::rows::{Row, Target};

/// Samples a side: a gibibyte.
const SIDE: usize = 16_384;
const CASE: &str = "Perlin 2D, 16384 x 16384";
const TARGET: Target = Target { peer: "plain fill", ratio: 0.8, or_rate: None };

/// Measures it if it is asked for.
pub fn rows(options: &Options) -> Result<Vec<Row>, String> {
    if !CASE.contains(&options.case) {
        return Ok(Vec::new());
    }
    eprintln!("{CASE} ...");
    let noise = Perlin { seed: SEED as u64, wavelength: 100.0 };
    let axis: Vec<f64> = (0..SIDE).map(|i| i as f64).collect();
    let mut jobs = [
        // An error writes no sample; the check before the timings then speaks up.
        Job::new("orogen", move |out| _ = noise.fill(&Points::Lattice { xs: &axis, ys: &axis }, out)),
        Job::new(TARGET.peer, |out| out.fill(PLAIN)),
    ];
    let rates = measure::rates(Clock::Thread, &mut jobs, SIDE * SIDE, options.repetitions)?;
    let [ours, plain] = [0, 1].map(|i| rates.get(i).map_or(0.0, |rate| rate / 1e6));
    let peer = Some((TARGET.peer, plain));
    Ok(vec![Row { case: CASE.to_owned(), ours: Some(ours), peer, target: Some(TARGET) }])
}
