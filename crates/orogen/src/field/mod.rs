//! Fields: ops that look at one position and the seed.

// The list below is written by `cargo xtask codegen`.
pub mod add;
pub mod basis;
pub mod billow;
pub mod clamp;
pub mod classic;
pub mod constant;
pub mod curve;
pub mod edge;
pub mod fbm;
pub mod max;
pub mod min;
pub mod mix;
pub mod multiply;
pub mod perlin;
pub mod positions;
pub mod radial;
pub mod ramp;
pub mod remap;
pub mod ridged;
pub mod seam;
pub mod terrace;
pub mod transform;
pub mod value;
pub mod warp;
pub mod weighted_fbm;
pub mod white;
