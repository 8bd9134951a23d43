//! Filters: ops that read a finite halo.

// The list below is written by `cargo xtask codegen`.
pub mod blur;
pub mod distance;
pub mod droplets;
pub mod flow_direction;
pub mod flow_indices;
pub mod geomorphons;
pub mod local_stream_power;
pub mod pipes;
pub mod ruggedness;
pub mod select_aspect;
pub mod select_curvature;
pub mod select_slope;
pub mod slope;
pub mod soil_depth;
pub mod thermal;
pub mod topographic_position;
