//! Terrain after each of its erosion steps, from a single run.

pub mod draft;
pub mod frame_spool;
pub mod run;
