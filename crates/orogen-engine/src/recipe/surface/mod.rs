//! Surfaces: the materials of the ground, their conditions and appearance.
//!
//! - [`document`]: a surface, with its keys
//! - `list`: the list of `[[surface]]` tables, and colorings as values
//! - [`standard`]: the surfaces of a recipe without any
//! - [`expand`]: expansion of surfaces to nodes that compute their shares

pub mod document;
pub mod expand;
pub(crate) mod list;
pub mod standard;

#[cfg(test)]
mod tests;
