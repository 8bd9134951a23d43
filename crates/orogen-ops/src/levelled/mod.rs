//! Levelled ops: each level from a finite halo of the next coarser one.
//!
//! All of them make drained land: `drained_op` is their one implementation, `drained` the land by the parameters of an
//! op, and `layers` what is read from it. `passes` and `layer_passes` are the same for graphics cards.

// The list below is written by `cargo xtask codegen`.
mod amplify;
mod continents;
pub(crate) mod drained;
pub(crate) mod drained_op;
pub(crate) mod layer_passes;
pub(crate) mod layers;
pub(crate) mod passes;

pub use amplify::Amplify;
pub use continents::Continents;
