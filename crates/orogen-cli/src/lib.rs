//! The `orogen` command: terrains from recipes.
//!
//! It is a library to shorten the build: Cargo compiles a library as soon as the metadata of its dependencies exists, but a
//! binary only after all of them are finished. Programs use the crate `orogen` instead.
#![forbid(unsafe_code)]
// These macros panic if the other end of a pipe is closed; `say` does not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod bar;
mod cli;
mod command;
mod contact;
mod disk;
mod draw;
mod export_options;
mod failure;
mod finite;
mod format;
mod graph;
mod interrupt;
mod layer_file;
mod memory;
mod moving;
mod options;
mod palette;
mod pictures;
mod replace;
mod report;
mod say;
mod sheet;
mod sink;
mod source;
mod values;
mod view;
mod watch;

use clap::Parser;
use std::process::ExitCode;

/// Runs the command with the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    match cli::Cli::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::report(&failure);
            failure.code()
        }
    }
}
