//! Recipes: the document that describes a world.

pub mod document;
pub mod graph;
mod json;
mod parse;
pub mod presets;
pub mod reference;
pub mod schema;
pub mod surface;
mod text;
mod toml;
