//! Scatter: objects such as trees, rocks and houses, and the conditions of where they stand.
//!
//! - [`document`]: a kind of object, with its keys
//! - `list`: the list of `[[scatter]]` tables, and types of their values
//! - [`expand`]: expansion to nodes that compute densities

pub mod document;
pub mod expand;
pub(crate) mod list;

#[cfg(test)]
mod tests;
