//! Recipes: documents that describe a world.

#[macro_use]
mod table;

#[doc(hidden)]
pub mod biomes;
pub mod class;
pub mod condition;
#[doc(hidden)]
pub mod document;
mod draft;
#[doc(hidden)]
pub mod graph;
mod json;
mod named_files;
#[doc(hidden)]
pub mod network;
#[doc(hidden)]
pub mod outputs;
#[doc(hidden)]
pub mod parameters;
mod parse;
pub mod presets;
mod read;
#[doc(hidden)]
pub mod reference;
mod refined;
#[doc(hidden)]
pub mod scatter;
pub mod schema;
mod serialize;
#[doc(hidden)]
pub mod source;
mod subgraph;
pub mod surface;
mod text;
mod toml;
#[doc(hidden)]
pub mod values;
mod world_spec;

pub use class::TerrainClass;
pub use condition::{Condition, Quantity};
pub use document::{NamedNode, Recipe, WorldSpec};
#[doc(hidden)]
pub use graph::{Graph, GraphDiagnostic};
pub use parameters::{Parameter, Parameters};
pub use presets::Preset;
pub use refined::Detail;
pub use scatter::Scatter;
pub use source::RecipeSource;
pub use surface::{Coloring, Surface};
