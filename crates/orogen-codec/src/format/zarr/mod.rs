//! Chunks of Zarr.

pub mod blosc;
pub mod unpack;
