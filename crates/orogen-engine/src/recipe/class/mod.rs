//! Terrain classes: water, sand, grass and others, each with the conditions of where it is, as an output with the number of each sample's class.
//!
//! - [`document`]: a class in memory, and as TOML
//! - `read`: conversion of `[[class]]` tables, with diagnostics at their keys
//! - [`standard`]: those of a recipe that has none of its own; [`named`]: their numbers by their names
//! - [`expand`]: expansion to nodes that compute the output
//! - `schema`: their part of the JSON Schema

pub mod document;
pub mod expand;
pub mod named;
pub(crate) mod read;
pub(crate) mod schema;
pub mod standard;

#[cfg(test)]
mod tests;
