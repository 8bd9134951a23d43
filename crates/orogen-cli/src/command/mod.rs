//! The commands, one per file.

pub mod analyze;
pub mod blocks;
pub mod build;
pub mod cache;
pub mod check;
pub mod compare;
pub mod completions;
pub mod devices;
pub mod explain;
pub mod export;
pub mod fit;
pub mod generate;
pub mod graph;
pub mod grow;
pub mod map;
pub mod new;
pub mod noise;
pub mod ops;
pub mod palettes;
pub mod presets;
pub mod refine;
pub mod render;
pub mod schema;
pub mod studio;
pub mod tilemap;
pub mod variants;
