//! Recipes: documents that describe a world.

#[macro_use]
mod table;

pub mod biomes;
pub mod class;
pub mod condition;
pub mod document;
mod draft;
pub mod graph;
mod json;
pub mod network;
pub mod parameters;
mod parse;
pub mod presets;
pub mod reference;
mod refined;
pub mod scatter;
pub mod schema;
mod serialise;
pub mod source;
mod subgraph;
pub mod surface;
mod text;
mod toml;
mod world_spec;
