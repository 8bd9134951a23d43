//! Terrain around a moving viewer, in chunks with levels of detail.

#[doc(hidden)]
pub mod id;
#[doc(hidden)]
pub mod lod;
#[doc(hidden)]
pub mod seam;
#[doc(hidden)]
pub mod stream;

pub use id::ChunkId;
pub use lod::LodConfig;
pub use seam::{Sides, stitch};
pub use stream::{ChunkStep, Chunks};
