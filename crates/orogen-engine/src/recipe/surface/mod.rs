//! Surfaces: the materials of the ground, their conditions and appearance.
//!
//! - [`document`]: a surface in memory, and as TOML
//! - `read`: conversion of `[[surface]]` tables to surfaces, with diagnostics at their keys
//! - [`standard`]: the surfaces of a recipe without any
//! - [`expand`]: expansion of surfaces to nodes that compute their shares
//! - `schema`: their part of the JSON Schema

pub mod document;
pub mod expand;
pub(crate) mod read;
pub(crate) mod schema;
pub mod standard;

#[cfg(test)]
mod tests;
