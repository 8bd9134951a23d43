//! Pictures of a noise by itself, one sample a pixel.

pub mod look;
pub mod slice;
pub mod texture;
