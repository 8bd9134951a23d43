//! A picture larger than the caches: one octave compared with the plain fill.

use orogen_noise::{Perlin, Points};

use super::cases::SEED;
use crate::measure::{self, Clock, Job, PLAIN};
use crate::options::Options;
use crate::rows::{Row, Target};

/// Samples per side: 1 GiB in total.
const SIDE: usize = 16_384;
const CASE: &str = "Perlin 2D, 16384 x 16384";
const TARGET: Target = Target { peer: "plain fill", ratio: 0.8, or_rate: None };

/// Measures the case if it is selected.
pub fn rows(options: &Options) -> Result<Vec<Row>, String> {
    if !CASE.contains(&options.case) {
        return Ok(Vec::new());
    }
    eprintln!("{CASE} ...");
    let noise = Perlin::new(SEED as u64, 100.0);
    let axis: Vec<f64> = (0..SIDE).map(|i| i as f64).collect();
    let mut jobs = [
        // On an error no sample is written, and the check before the timings fails.
        Job::new("orogen", move |out| _ = noise.fill(&Points::Lattice { xs: &axis, ys: &axis }, out)),
        Job::new(TARGET.peer, |out| out.fill(PLAIN)),
    ];
    let rates = measure::rates(Clock::Thread, &mut jobs, SIDE * SIDE, options.repetitions)?;
    let [ours, plain] = [0, 1].map(|i| rates.get(i).map_or(0.0, |rate| rate / 1e6));
    let peer = Some((TARGET.peer, plain));
    Ok(vec![Row { case: CASE.to_owned(), ours: Some(ours), peer, target: Some(TARGET) }])
}
