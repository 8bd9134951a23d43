//! Map sheets: heights with contours, rivers, lakes and other map elements, as a display list ([`scene`]), and the
//! output of that list as pixels ([`raster`]), SVG ([`vector`]) and PDF ([`pdf`]).

pub mod draw;
pub mod font_set;
pub mod furniture;
pub mod ground;
pub mod inks;
pub mod labels;
pub mod layout;
pub mod lines;
pub mod linework;
pub mod marks;
pub mod options;
mod overlay;
pub mod pdf;
mod profile;
pub mod ramp;
pub mod raster;
pub mod relief;
pub mod scene;
pub mod ticks;
pub mod vector;
pub mod water;

#[cfg(test)]
mod tests;
