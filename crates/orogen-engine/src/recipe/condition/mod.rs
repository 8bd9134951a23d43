//! Conditions on height, slope, curvature, flow, noise and layers, for surfaces, scattered objects and terrain classes.
//!
//! - [`document`]: conditions in memory
//! - `kinds`: the kinds of conditions, each with its keys
//! - `part`: the keys of conditions, `any` and `mask` in a table
//! - `expand`: expansion of conditions to nodes that compute their share

#[doc(hidden)]
pub mod document;
pub(crate) mod expand;
pub(crate) mod kinds;
pub(crate) mod part;

#[doc(hidden)]
pub use document::Noise;
pub use document::{Condition, Quantity};
