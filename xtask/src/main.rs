//! The project's tasks, run as `cargo xtask COMMAND`.
#![forbid(unsafe_code)]

mod adding;
mod bench;
mod bless;
mod book;
mod clients;
mod codegen;
mod compiled;
mod failure;
mod front_door;
mod fuzz;
mod gallery;
mod host;
mod licences;
mod links;
mod output;
mod package;
mod pool;
mod resolution;
mod scratch;
mod shell;
mod steps;
mod table;
mod test;
mod translations;
mod web;
mod web_build;
mod words;

use std::process::ExitCode;

use failure::{Failure, Result};

/// A subcommand: its module has these three items.
struct Command {
    name: &'static str,
    /// One line for the list of commands.
    about: &'static str,
    /// The output of `cargo xtask NAME --help`.
    help: &'static str,
    run: fn(&[String]) -> Result,
}

const COMMANDS: &[Command] = &[
    Command { name: "test", about: test::ABOUT, help: test::HELP, run: test::run },
    Command { name: "clients", about: clients::ABOUT, help: clients::HELP, run: clients::run },
    Command { name: "codegen", about: codegen::ABOUT, help: codegen::HELP, run: codegen::run },
    Command { name: "bless", about: bless::ABOUT, help: bless::HELP, run: bless::run },
    Command { name: "gallery", about: gallery::ABOUT, help: gallery::HELP, run: gallery::run },
    Command { name: "book", about: book::ABOUT, help: book::HELP, run: book::run },
    Command { name: "resolution", about: resolution::ABOUT, help: resolution::HELP, run: resolution::run },
    Command { name: "fuzz", about: fuzz::ABOUT, help: fuzz::HELP, run: fuzz::run },
    Command { name: "web", about: web::ABOUT, help: web::HELP, run: web::run },
    Command { name: "bench", about: bench::ABOUT, help: bench::HELP, run: bench::run },
];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match dispatch(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Usage(message)) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
        Err(Failure::Failed(message)) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn dispatch(args: &[String]) -> Result {
    let Some((name, rest)) = args.split_first() else {
        return Err(Failure::Usage(overview()));
    };
    if matches!(name.as_str(), "-h" | "--help" | "help") {
        println!("{}", overview());
        return Ok(());
    }
    let Some(command) = COMMANDS.iter().find(|c| c.name == name) else {
        return Err(Failure::Usage(format!("error: there is no command '{name}'\n\n{}", overview())));
    };
    if rest.iter().any(|a| a == "-h" || a == "--help") {
        println!("cargo xtask {}: {}\n\n{}", command.name, command.about, command.help.trim());
        return Ok(());
    }
    (command.run)(rest)
}

fn overview() -> String {
    let rows: Vec<Vec<String>> = COMMANDS.iter().map(|c| vec![format!("  {}", c.name), c.about.to_owned()]).collect();
    format!("Usage: cargo xtask COMMAND [--help]\n\n{}", table::render(&[], &rows))
}
