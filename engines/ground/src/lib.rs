//! Ground around a viewer for game engines, without the types of any engine: which chunks to make and to drop, and
//! chunks as arrays of vertices, triangles and heights.
//!
//! Axes are those of Bevy and Godot: x east, y up, z south, in metres. Positions of a chunk count from its north-west
//! corner, so they stay exact far from the origin.

mod arrays;
mod colors;
mod stream;

pub use arrays::{ChunkArrays, Winding};
pub use stream::{Ground, GroundError, MadeChunk};
