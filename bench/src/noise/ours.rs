//! What we offer.

use crate::measure::Job;
use crate::noise::cases::{Case, Work};

/// The SIMD level in use.
pub fn level() -> String {
    "?".to_owned()
}

/// Our job for the case; none if it is not built yet.
pub fn job(case: &Case) -> Option<Job> {
    (case.work != Work::White || std::env::var_os("OROGEN_BENCH_PEERS").is_some()).then(|| {
        Job::new("ours", |out| {
            out.iter_mut().enumerate().for_each(|(i, v)| *v = i as f32);
        })
    })
}
