//! AVX2 compared with AVX-512, on machines that use AVX-512.

use orogen_simd::Level;

use super::cases::Case;
use super::ours;
use crate::measure::Job;
use crate::rows::{Row, Target};

/// Half the width must give at least half the rate.
const TARGET: Target = Target { peer: "orogen at avx512", ratio: 0.5, or_rate: None };

/// Our job at AVX2, if that is the level below the current one.
pub fn below(case: &Case) -> Option<Job> {
    if Level::current() != Level::Avx512 {
        return None;
    }
    let mut job = ours::job(case);
    Some(Job::new("orogen at avx2", move |out| {
        // A level that cannot be forced writes nothing, and the check before the timings fails.
        if Level::force(Level::Avx2).is_ok() {
            (job.fill)(out);
        }
        _ = Level::force(Level::Avx512);
    }))
}

/// The row of that job.
pub fn row(case: &Case, rate: f64, full: Option<f64>) -> Row {
    let peer = full.map(|full| (TARGET.peer, full));
    Row { case: format!("{} at AVX2", case.name), ours: Some(rate), peer, target: Some(TARGET) }
}
