//! What the tests of this crate compare with reference implementations.
//!
//! They are integration tests, because unit tests would compile the kernels once more. For the same reason nothing here
//! is generic: a test that calls `orogen_simd::dispatch_at` itself would contain the kernels, too.

pub use crate::methods::fill_at;
use crate::prepared::PreparedIn;
pub use crate::program::{Cellular, Combine, Octave, Program, Shape, Source};
pub use crate::tables::{directions, reference};

/// The input of the kernels.
#[must_use]
pub fn program(noise: PreparedIn) -> Program {
    noise.0
}
