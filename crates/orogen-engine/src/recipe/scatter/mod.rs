//! Scatter: objects such as trees, rocks and houses, and the conditions of where they stand.
//!
//! - [`document`]: a kind of object in memory, and as TOML
//! - `read`: conversion of `[[scatter]]` tables, with diagnostics at their keys
//! - [`expand`]: expansion to nodes that compute densities
//! - `schema`: their part of the JSON Schema

pub mod document;
pub mod expand;
pub(crate) mod read;
pub(crate) mod schema;

#[cfg(test)]
mod tests;
