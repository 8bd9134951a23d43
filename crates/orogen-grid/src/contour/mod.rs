//! Contours of a grid, as lines.

pub mod band;
pub mod chaikin;
pub mod levels;
pub mod line;
pub mod trace;
