//! Surfaces: the materials of the ground, their conditions and appearance.
//!
//! - [`document`]: a surface, with its keys
//! - `coloring`: the color, gradient or picture of a surface, with its keys
//! - `list`: the list of `[[surface]]` tables
//! - [`standard`]: the surfaces of a recipe without any
//! - [`expand`]: expansion of surfaces to nodes that compute their shares

pub(crate) mod coloring;
#[doc(hidden)]
pub mod document;
#[doc(hidden)]
pub mod expand;
pub(crate) mod list;
#[doc(hidden)]
pub mod standard;

pub use document::{Along, Coloring, Surface};

#[cfg(test)]
mod tests;
