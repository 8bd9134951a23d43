//! The `orogen` command: terrains from recipes.
//!
//! It is a library to shorten the build: Cargo compiles a library as soon as the metadata of its dependencies exists,
//! but a binary only after all of them are finished. Programs should use the crate `orogen` instead.
#![forbid(unsafe_code)]
// The denied macros panic if the other end of a pipe is closed; the functions of `say` do not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod bar;
mod cli;
mod command;
mod declared;
mod device;
mod disk;
mod failure;
mod finite;
mod graph;
mod interrupt;
mod layer_file;
mod memory;
mod moving;
mod options;
mod pictures;
mod replace;
mod report;
mod say;
mod sink;
mod source;
mod usage;
mod values;
mod view;
mod watch;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

/// Runs the command with the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    run_with(std::env::args_os())
}

/// Runs the command with these words; the first is the name of the program.
#[must_use]
pub fn run_with(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitCode {
    #[cfg(feature = "remote")]
    orogen::remote::mount();
    match cli::Cli::try_parse_from(words).map_or_else(usage::answer, cli::Cli::run) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::report(&failure);
            failure.code()
        }
    }
}
