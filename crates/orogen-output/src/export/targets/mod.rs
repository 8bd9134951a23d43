//! Engines as targets of exports: one file each; [`list`] names them.

pub mod frame;
pub(crate) mod hterrain;
pub mod list;
pub mod run;
pub mod target;
pub(crate) mod terrain3d;
pub(crate) mod unity;
pub(crate) mod unreal;
