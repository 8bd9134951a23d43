//! Scatter: objects such as trees, rocks and houses, and the conditions for their positions.
//!
//! - [`document`]: a kind of object, with its keys
//! - `list`: the list of `[[scatter]]` tables, and types of their values
//! - [`expand`]: expansion to nodes that compute densities

#[doc(hidden)]
pub mod document;
#[doc(hidden)]
pub mod expand;
pub(crate) mod list;

pub use document::{Scatter, Turn};

#[cfg(test)]
mod tests;
