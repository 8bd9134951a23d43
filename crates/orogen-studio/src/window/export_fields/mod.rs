//! The fields of each kind of export.

pub mod engine;
pub mod layer;
pub mod map;
pub mod option_rows;
pub mod render;
pub mod rows;
pub mod tilemap;
