//! Maps: pictures of grids.

pub mod canvas;
pub mod contact;
pub mod paint;
pub(crate) mod shade;
pub mod swatches;
pub mod text;
