//! The `orogen` command: terrains from recipes.
//!
//! A library only so that it compiles while those it stands on are still being optimised: a binary waits for all of them.
//! Programs that make terrain use the crate `orogen`.
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
mod folder;
mod format;
mod graph;
mod interrupt;
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
