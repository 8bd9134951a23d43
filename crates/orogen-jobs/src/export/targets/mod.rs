//! Engines as targets of exports: one file each; [`list`] names them, and a [`job::EngineJob`] exports for one.

pub mod frame;
pub(crate) mod hterrain;
pub mod job;
pub mod list;
pub(crate) mod objects;
pub(crate) mod run;
pub mod target;
pub(crate) mod terrain3d;
pub(crate) mod unity;
pub(crate) mod unreal;
