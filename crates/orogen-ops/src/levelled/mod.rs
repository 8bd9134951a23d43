//! Levelled ops: each level is computed from a finite halo of the next coarser level.
//!
//! All but `learned` make drained land. `drained_op` is their common implementation, `drained` the land with the
//! parameters of an op, and `layers` computes the layers. `passes` and `layer_passes` do the same on graphics cards.

// The list below is written by `cargo xtask codegen`.
mod amplify;
mod continents;
pub(crate) mod drained;
pub(crate) mod drained_op;
pub(crate) mod layer_passes;
pub(crate) mod layers;
mod learned;
pub(crate) mod passes;

pub use amplify::Amplify;
pub use continents::Continents;
pub use learned::Learned;
