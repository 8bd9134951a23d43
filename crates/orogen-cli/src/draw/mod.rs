//! Drawings of a single noise, one pixel per sample.

pub mod fit;
pub mod look;
pub mod slice;
pub mod sum;
pub mod texture;
