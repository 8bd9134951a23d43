//! Conditions on height, slope, curvature, flow, noise and layers, for surfaces, scattered objects and terrain classes.
//!
//! - [`document`]: conditions in memory, and as TOML
//! - `part`: the keys of conditions, `any` and `mask` in a table
//! - `read`: conversion of keys to conditions, with diagnostics
//! - `expand`: expansion of conditions to nodes that compute their share
//! - `schema`: their part of the JSON Schema

#[doc(hidden)]
pub mod document;
pub(crate) mod expand;
pub(crate) mod part;
pub(crate) mod read;
pub(crate) mod schema;

#[doc(hidden)]
pub use document::Noise;
pub use document::{Condition, Quantity};
