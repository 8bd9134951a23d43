//! Terrain after each of its erosion steps, from a single run.

pub(crate) mod draft;
pub mod frame_spool;
pub mod run;
