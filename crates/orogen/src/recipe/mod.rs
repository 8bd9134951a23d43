//! Recipes: the document that describes a world.

pub mod document;
pub mod graph;
mod json;
mod parse;
pub mod presets;
pub mod reference;
pub mod schema;
mod text;
mod toml;
