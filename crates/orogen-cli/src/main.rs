//! The `orogen` command: terrains from recipes.
#![forbid(unsafe_code)]
// These macros panic if the other end of a pipe is closed; `say` does not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod arguments;
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
mod paper;
mod pictures;
mod region;
mod replace;
mod report;
mod say;
mod seeds;
mod sheet;
mod sink;
mod size;
mod source;
mod view;
mod watch;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match cli::Cli::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::report(&failure);
            failure.code()
        }
    }
}
