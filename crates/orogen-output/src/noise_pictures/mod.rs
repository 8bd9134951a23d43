//! Pictures of noise without a recipe: one noise, one pixel per sample, and the page that compares all noises.

mod fit;
pub mod look;
pub mod page;
mod panel;
pub mod row;
pub mod slice;
pub mod texture;
