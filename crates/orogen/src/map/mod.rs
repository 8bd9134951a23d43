//! Maps: pictures of grids for people.

pub mod paint;
pub mod shade;
