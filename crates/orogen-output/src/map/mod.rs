//! Maps: pictures of grids for people.

pub mod canvas;
pub mod paint;
pub(crate) mod shade;
pub mod swatches;
pub mod text;
