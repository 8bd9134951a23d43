//! Terrain classes such as water, sand and grass, each with conditions. They become an output with the number of each
//! sample's class.
//!
//! - [`document`]: a class, with its keys
//! - `list`: the list of `[[class]]` tables, and shares as values
//! - [`standard`]: the classes of a recipe without any; [`named`]: numbers of classes by their names
//! - [`expand`]: expansion to nodes that compute the output

#[doc(hidden)]
pub mod document;
#[doc(hidden)]
pub mod expand;
pub(crate) mod list;
#[doc(hidden)]
pub mod named;
#[doc(hidden)]
pub mod standard;

pub use document::{MAX_CLASSES, TerrainClass};

#[cfg(test)]
mod tests;
