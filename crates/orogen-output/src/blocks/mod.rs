//! Worlds of blocks: columns of soil, stone, ore and water, as files for block games and voxel editors.
//!
//! [`land::Land`] has the columns of a window, from which [`land::Land::blocks`] makes the blocks of any part, and
//! [`volume::BlockVolume`] all of them; [`vox`], [`schem`], [`luanti`], [`picture`] and [`section`] write these.
//! [`caves`] carves caves into any land. [`mesh`] makes a smooth surface of a land.

pub mod caves;
pub mod chunk;
pub mod cover;
pub mod density;
mod hash;
pub mod kind;
pub mod land;
pub mod levels;
mod light;
pub mod luanti;
pub mod mesh;
pub mod picture;
mod reach;
pub mod schem;
pub mod section;
mod solid;
pub mod trees;
pub mod volume;
pub mod vox;

#[cfg(test)]
mod tests;
