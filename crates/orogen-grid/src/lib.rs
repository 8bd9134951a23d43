//! Grids of heights, and algorithms on them.
#![forbid(unsafe_code)]

pub mod aggregate;
pub mod analysis;
pub mod contour;
pub mod erosion;
pub mod error;
pub mod grid;
pub mod hydrography;
pub mod hydrology;
pub mod progress;
pub mod resample;
pub mod words;
