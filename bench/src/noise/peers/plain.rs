//! No noise at all: how fast the picture can be written.

use crate::measure::{Job, PLAIN};
use crate::noise::cases::{Case, Work};

/// A physical limit for the cheapest noise.
pub fn job(case: &Case) -> Option<Job> {
    (case.work == Work::White).then(|| Job::new("plain fill", |out| out.fill(PLAIN)))
}
