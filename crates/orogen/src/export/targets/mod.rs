//! Engines as targets of exports: one file each; [`list`] names them.

pub mod frame;
pub mod hterrain;
pub mod list;
pub mod run;
pub mod target;
pub mod terrain3d;
pub mod unity;
pub mod unreal;
