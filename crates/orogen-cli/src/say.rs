//! Standard output and standard error, without panics when nobody listens any more.

use std::io::{self, Write};

use crate::failure::Failure;

/// Writes text to standard output, as it is.
pub fn out(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|cause| Failure::stdout(&cause))
}

/// Writes a line to standard error. If that fails there is nobody left to tell.
pub fn error(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
