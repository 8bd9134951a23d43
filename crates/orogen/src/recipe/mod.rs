//! Recipes: the document that describes a world.

pub mod document;
pub mod graph;
mod json;
mod parse;
pub mod presets;
pub mod schema;
mod text;
mod toml;
