//! Outputs.
#![forbid(unsafe_code)]

pub mod builder;
pub mod export;
pub mod fit;
pub mod map;
pub mod mesh;
pub mod render;
pub mod sheet;
pub mod survey;
