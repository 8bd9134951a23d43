//! Map sheets: heights with contours, rivers, lakes and other map elements, as a display list ([`scene`]), and the
//! output of that list as pixels ([`raster`]), SVG ([`vector`]) and PDF ([`pdf`]).

mod contour_lines;
pub mod draw;
pub mod font_set;
#[doc(hidden)]
pub mod furniture;
pub mod geometry;
mod grid_lines;
pub(crate) mod ground;
pub(crate) mod inks;
pub(crate) mod labels;
pub(crate) mod layout;
pub(crate) mod lines;
pub mod linework;
pub(crate) mod marks;
pub(crate) mod names;
pub mod options;
mod overlay;
pub mod paper;
pub mod pdf;
mod profile;
pub(crate) mod ramp;
pub mod raster;
pub(crate) mod relief;
pub mod scene;
mod symbols;
mod taken;
pub(crate) mod ticks;
pub mod vector;
#[doc(hidden)]
pub mod water;

#[cfg(test)]
mod tests;
