//! No noise at all: how fast the picture can be written.

use crate::measure::Job;
use crate::noise::cases::{Case, Work};

/// What it writes.
pub const PLAIN: f32 = 0.123;

/// A physical limit for the cheapest noise.
pub fn job(case: &Case) -> Option<Job> {
    (case.work == Work::White).then(|| Job::new("plain fill", |out| out.fill(PLAIN)))
}
