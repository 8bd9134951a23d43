//! Map sheets: heights with contours, rivers, lakes and other map elements, as a display list ([`scene`]), and the
//! output of that list as pixels ([`raster`]), SVG ([`vector`]) and PDF ([`pdf`]).

mod contour_lines;
#[doc(hidden)]
pub mod draw;
#[doc(hidden)]
pub mod font_set;
#[doc(hidden)]
pub mod furniture;
#[doc(hidden)]
pub mod geometry;
mod grid_lines;
pub(crate) mod ground;
pub(crate) mod inks;
pub(crate) mod labels;
pub(crate) mod layout;
pub(crate) mod lines;
#[doc(hidden)]
pub mod linework;
pub(crate) mod marks;
pub(crate) mod names;
#[doc(hidden)]
pub mod options;
mod overlay;
#[doc(hidden)]
pub mod paper;
#[doc(hidden)]
pub mod pdf;
mod profile;
pub(crate) mod ramp;
#[doc(hidden)]
pub mod raster;
pub(crate) mod relief;
#[doc(hidden)]
pub mod roads;
#[doc(hidden)]
pub mod scene;
mod symbols;
mod taken;
pub(crate) mod ticks;
#[doc(hidden)]
pub mod vector;
#[doc(hidden)]
pub mod water;

pub use draw::{Sheet, draw};
#[doc(hidden)]
pub use geometry::{Affine, Point, Rect, Size};
pub use options::{
    Coloring, GridStep, Labels, Layer, LineName, Page, PageColors, Parts, PlaceKind, PlaceName, Resolution, Scale,
    Shading, SheetOptions, SurfaceCover, SurfaceEntry,
};

#[cfg(test)]
mod tests;
