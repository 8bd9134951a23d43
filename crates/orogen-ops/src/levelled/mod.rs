//! Levelled ops: each level from a finite halo of the next coarser one.

// The list below is written by `cargo xtask codegen`.
pub mod amplify;
pub mod continents;
pub mod drained;
pub mod layer_passes;
pub mod passes;
