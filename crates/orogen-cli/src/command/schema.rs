//! `orogen schema`.

use crate::failure::Failure;
use crate::say;

/// Prints the JSON Schema.
pub fn run() -> Result<(), Failure> {
    say::out(&format!("{:#}\n", orogen::recipe::schema::json_schema()))
}
