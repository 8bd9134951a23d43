//! Terrain after each of its erosion steps, from a single run.

pub(crate) mod draft;
#[doc(hidden)]
pub mod frame_spool;
#[doc(hidden)]
pub mod run;

#[doc(hidden)]
pub use frame_spool::FrameSpool;
pub use run::{Growth, Visit};
