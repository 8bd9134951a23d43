//! The engine's programs and filters as compute shaders, for live previews and fast builds where exact bits are not needed.
//!
//! The processor stays the reference: a graphics card may fuse and reorder operations, so its results are never stored under the key of a solution, nor
//! called equal. What it cannot compute, the engine computes as always: see [`Gpu`].
#![forbid(unsafe_code)]

pub mod adapters;
pub mod failure;
pub mod filters;
#[doc(hidden)]
pub mod job;
mod pipelines;

pub mod gpu;

pub use adapters::{Adapter, Choice, adapters};
pub use failure::Failure;
pub use gpu::Gpu;
