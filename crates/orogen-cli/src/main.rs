//! The `orogen` command. The code is in the library of this package.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    orogen_cli::run()
}
