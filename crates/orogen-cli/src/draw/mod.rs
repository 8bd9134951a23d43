//! Pictures of a noise by itself, one sample a pixel.

pub mod fit;
pub mod look;
pub mod slice;
pub mod sum;
pub mod texture;
