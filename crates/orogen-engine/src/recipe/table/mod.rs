//! Lists of tables such as `[[scatter]]`, by declaration: a key is declared once, and is read, written and described
//! from that.
//!
//! - `macros`: `table!`, which declares an entry with its keys and their defaults
//! - [`key`]: a key, and what types of values do with it
//! - [`types`]: the types that several tables have
//! - [`list`]: the list of the tables
//! - [`reader`]: reading of values, with diagnostics at their keys

#[macro_use]
mod macros;

pub(crate) mod key;
pub(crate) mod list;
pub(crate) mod reader;
pub(crate) mod types;
