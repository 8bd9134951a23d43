//! Standard output and standard error, without panics on closed pipes.

use std::io::{self, Write};

/// The program and its version, for the metadata of files.
pub const SOFTWARE: &str = concat!("Orogen ", env!("CARGO_PKG_VERSION"));

use crate::failure::Failure;

/// Writes text to standard output.
pub fn out(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|cause| Failure::stdout(&cause))
}

/// Writes a line to standard error. Failures are ignored, because they cannot be reported.
pub fn error(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
