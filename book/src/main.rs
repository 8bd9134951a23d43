//! The documentation as a site: `cargo xtask book` starts this program.
//!
//! - `places`: which page of `docs/` stands where in the site.
//! - `page`: what changes on a page between the repository and the site.
//! - `stage`: the sources of the books, as mdBook reads them.
//! - `site`: the books of all languages, made by mdBook.
//! - `check`: every link of the site leads to something in it.
//! - `recipes`: the recipes that pages contain, as files.
//! - `commands`: the commands that pages contain, run in their order.
//! - `pictures`: what the commands draw, as the pictures of the pages.
#![forbid(unsafe_code)]

mod check;
mod commands;
mod page;
mod pictures;
mod places;
mod recipes;
mod site;
mod stage;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};

const USAGE: &str = "Usage: orogen-book build ROOT OUT | recipes ROOT | commands ROOT OROGEN WORK [--write] [PAGE...]";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match run(&args.iter().map(String::as_str).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &[&str]) -> Result<()> {
    match args {
        ["build", root, out] => site::build(Path::new(root), Path::new(out)),
        ["recipes", root] => recipes::write(Path::new(root)),
        ["commands", root, orogen, work, rest @ ..] => {
            let pages: Vec<&str> = rest.iter().copied().filter(|arg| *arg != "--write").collect();
            let keep = if pages.len() < rest.len() { commands::Pictures::Write } else { commands::Pictures::Compare };
            commands::run(Path::new(root), Path::new(orogen), Path::new(work), keep, &pages)
        }
        _ => bail!("{USAGE}"),
    }
}
