//! Filters: ops that look at a finite halo.

// The list below is written by `cargo xtask codegen`.
pub mod blur;
pub mod slope;
