//! Blocks as a save of Minecraft: Java Edition, in the layout that the game has since 1.18: region files of chunks, and
//! `level.dat`.
//!
//! A block has the coordinates of its sample: x is its column and z its row in the world, so parts of a world that are
//! made separately meet. The game computes light when it loads a chunk.

mod biome;
#[doc(hidden)]
pub mod chunk;
#[doc(hidden)]
pub mod level;
#[doc(hidden)]
pub mod placement;
mod section;
#[doc(hidden)]
pub mod spawn;

/// Files and folders that the game writes when it opens a save.
pub const OPENED: [&str; 3] = ["session.lock", "level.dat_old", "playerdata"];
