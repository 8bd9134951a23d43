//! Declarations of tables such as `[world]` and `[[scatter]]`: a key is declared once, and the declaration is used for
//! reading, writing and the schema.
//!
//! - `macros`: `key!`, which declares a key, and `table!`, which declares an entry of a list with its keys and defaults
//! - [`key`]: the declaration of a key
//! - [`part`]: parts of tables, and traits of the types of values
//! - [`types`]: types of values that several tables use
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
