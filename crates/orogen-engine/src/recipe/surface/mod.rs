//! Surfaces: what covers the ground, where, and how it looks.
//!
//! - [`document`]: a surface in memory, and as TOML
//! - `read`: `[[surface]]` tables to surfaces, with every diagnostic at its own key
//! - [`standard`]: the surfaces of a recipe that lists none
//! - [`expand`]: surfaces to nodes that compute their shares
//! - `schema`: their part of the JSON Schema

pub mod document;
pub mod expand;
pub(crate) mod read;
pub(crate) mod schema;
pub mod standard;

#[cfg(test)]
mod tests;
