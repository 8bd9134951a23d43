//! Maps: pictures of grids.

pub mod canvas;
pub mod contact;
pub mod paint;
#[doc(hidden)]
pub mod shade;
#[doc(hidden)]
pub mod surface_blend;
#[doc(hidden)]
pub mod surface_picture;
pub mod swatches;
pub mod text;
