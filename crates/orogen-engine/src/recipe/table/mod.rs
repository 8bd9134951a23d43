//! Tables such as `[world]` and `[[scatter]]`, by declaration: a key is declared once, and is read, written and
//! described from that.
//!
//! - `macros`: `key!`, which declares a key, and `table!`, which declares an entry of a list with its keys and defaults
//! - [`key`]: the declaration of a key
//! - [`part`]: parts of tables, and what types of values do with a key
//! - [`types`]: the types that several tables have
//! - [`keys`]: the keys of a table
//! - [`list`]: a list of tables
//! - [`reader`]: reading of values, with diagnostics at their keys

#[macro_use]
mod macros;

pub(crate) mod key;
pub(crate) mod keys;
pub(crate) mod list;
pub(crate) mod part;
pub(crate) mod reader;
pub(crate) mod types;
