//! The engine's programs, filters and levels as compute shaders, for live previews and fast builds where exact bits are
//! not needed.
//!
//! The processor is the reference. A graphics card may fuse and reorder operations, so its results are not bit-equal
//! and are never stored under the key of a solution. The processor computes everything that the card cannot: see
//! [`Gpu`].
#![forbid(unsafe_code)]

pub mod adapters;
mod device;
pub mod failure;
pub mod gpu;
#[doc(hidden)]
pub mod job;
mod layers;
#[doc(hidden)]
pub mod passes;
mod pipelines;
mod program;
pub mod render;
mod resident;
mod session;
mod source;
mod tiles;

pub use adapters::{Adapter, Choice, adapters};
pub use failure::Failure;
pub use gpu::Gpu;
pub use session::WithGpu;
