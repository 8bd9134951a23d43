//! The formats, one per file. Every file that declares `pub static FORMAT: Format` is included in the registry.

// The list below is written by `cargo xtask codegen`.
pub mod asc;
pub mod csv;
pub mod exr;
pub mod fgb;
pub mod geojson;
pub mod glb;
pub mod gpkg;
pub mod hgt;
pub mod json;
pub mod npy;
pub mod obj;
pub mod pgm;
pub mod ply;
pub mod png;
pub mod r16;
pub mod r32;
pub mod stl;
pub mod svg;
pub mod three_mf;
pub mod tif;
pub mod tres;
