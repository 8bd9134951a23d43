//! Terrain around a moving viewer, in chunks with levels of detail.

pub mod id;
pub mod lod;
pub mod seam;
pub mod stream;
