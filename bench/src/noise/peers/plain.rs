//! The plain fill: the maximum speed of writing the picture.

use crate::measure::{Job, PLAIN};
use crate::noise::cases::{Case, Work};

/// The physical limit of the cheapest noise.
pub fn job(case: &Case) -> Option<Job> {
    (case.work == Work::White).then(|| Job::new("plain fill", |out| out.fill(PLAIN)))
}
