//! Fields: ops that look at one position and the seed.

// The list below is written by `cargo xtask codegen`.
pub mod add;
pub mod basis;
pub mod billow;
pub mod clamp;
pub mod classic;
pub mod constant;
pub mod curve;
pub mod dem;
pub mod edge;
pub mod fbm;
pub mod hetero;
pub mod hybrid;
pub mod jordan;
pub mod max;
pub mod min;
pub mod mix;
pub mod multiply;
pub mod open_simplex2;
pub mod perlin;
pub mod ping_pong;
pub mod positions;
pub mod radial;
pub mod ramp;
pub mod remap;
pub mod ridged;
pub mod seam;
pub mod simplex;
pub mod swiss;
pub mod terrace;
pub mod transform;
pub mod value;
pub mod warp;
pub mod weighted_fbm;
pub mod white;
pub mod worley;
