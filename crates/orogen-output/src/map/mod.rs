//! Maps: pictures of grids.

#[doc(hidden)]
pub mod canvas;
#[doc(hidden)]
pub mod contact;
#[doc(hidden)]
pub mod paint;
#[doc(hidden)]
pub mod shade;
#[doc(hidden)]
pub mod surface_blend;
#[doc(hidden)]
pub mod surface_picture;
#[doc(hidden)]
pub mod swatches;
#[doc(hidden)]
pub mod text;
#[doc(hidden)]
pub mod tile;

pub use contact::{Sheet, Variant};
pub use paint::Painter;
pub use text::BuiltinFont;
