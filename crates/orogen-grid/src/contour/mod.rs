//! Contours: lines of one height through a grid, as geometry.

pub mod band;
pub mod chaikin;
pub mod levels;
pub mod line;
pub mod trace;
