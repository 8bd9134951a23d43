//! Levelled ops: each level from a finite halo of the next coarser one.

// The list below is written by `cargo xtask codegen`.
mod amplify;
mod continents;
pub(crate) mod drained;
pub(crate) mod layer_passes;
pub(crate) mod passes;

pub use amplify::Amplify;
pub use continents::Continents;
