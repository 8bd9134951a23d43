//! Worlds of blocks: columns of soil, stone, ore and water, as files for block games and voxel editors.
//!
//! [`land::Land`] holds the columns of a window. [`land::Land::blocks`] computes the blocks of any part of it, and
//! [`volume::BlockVolume`] holds all of them; [`vox`], [`schem`], [`luanti`], [`picture`] and [`section`] write them.
//! [`caves`] adds caves to any recipe. [`mesh`] makes a smooth surface of a land.

#[doc(hidden)]
pub mod caves;
#[doc(hidden)]
pub mod chunk;
#[doc(hidden)]
pub mod cover;
#[doc(hidden)]
pub mod density;
mod hash;
#[doc(hidden)]
pub mod kind;
#[doc(hidden)]
pub mod land;
#[doc(hidden)]
pub mod levels;
mod light;
#[doc(hidden)]
pub mod luanti;
#[doc(hidden)]
pub mod mesh;
#[doc(hidden)]
pub mod minecraft;
#[doc(hidden)]
pub mod picture;
mod reach;
#[doc(hidden)]
pub mod schem;
#[doc(hidden)]
pub mod section;
mod solid;
#[doc(hidden)]
pub mod trees;
#[doc(hidden)]
pub mod volume;
#[doc(hidden)]
pub mod vox;

pub use kind::{Block, BlockKind};
pub use land::Land;
pub use levels::{Extent, Levels};
pub use mesh::BlockMesh;
pub use picture::Isometric;
pub use section::Section;
pub use volume::BlockVolume;

#[cfg(test)]
mod tests;
