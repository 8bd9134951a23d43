//! Features in the units of vector tiles: clipped, simplified and rounded, so that the parts in adjacent tiles meet.
//!
//! `frame` puts features into a tile, `simplify` leaves points out, `tile_contours` makes contours of its heights.

pub mod frame;
mod simplify;
pub mod tile_contours;
