//! Filters: ops that look at a finite halo.

// The list below is written by `cargo xtask codegen`.
pub mod blur;
pub mod distance;
pub mod droplets;
pub mod local_stream_power;
pub mod pipes;
pub mod select_aspect;
pub mod select_curvature;
pub mod select_slope;
pub mod slope;
pub mod thermal;
