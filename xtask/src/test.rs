//! `cargo xtask test`: all tests that need only Rust.

use crate::compiled::LIBRARIES;
use crate::failure::{Failure, Result};
use crate::scratch::Scratch;
use crate::shell::{self, cargo, run as sh};
use crate::steps::{self, Step};
use crate::{adding, codegen, licences, links, package, translations, words};

pub const ABOUT: &str = "run all tests that need only Rust";

pub const HELP: &str = "
Usage: cargo xtask test [STEP...]
       cargo xtask test --long [NAME]

Runs the steps in this order, or only those named, and stops at the first failure:

  fmt           every file is formatted
  lists         generated lists are up to date, and nothing is missing that belongs to what they list
  words         names and texts use the field's terms
  links         relative links in Markdown files lead to files, and their anchors to headings
  translations  translated files have the headings, tables, code and links of their originals
  clippy        no warning in any target
  tests         unit tests, integration tests, doctests, examples build; of the studio what needs no window
  features      the libraries without files and threads: no warning, and no use of the standard library's file system
  adding        a noise, a filter, a format and a preset are added to a copy, which compiles; what is missing is named
  licences      every dependency has a licence we accept
  package       every crate compiles from its own published archive, and documentation builds from there without a warning

With --long, it runs the long tests instead, one at a time: all tests of the workspace that are marked as ignored, with a reason
that begins with `long: `, or those whose name contains NAME. All together take hours.

Needs only Rust and, the first time, a connection for the crates in Cargo.lock.
";

const STEPS: &[&Step] = &[
    &Step { name: "fmt", about: "cargo fmt --all --check", group: None, run: || sh(&mut cargo("fmt --all --check")) },
    &Step {
        name: "lists",
        about: "generated lists are up to date, and nothing is missing that belongs to what they list",
        group: None,
        run: || codegen::lists(shell::root(), true),
    },
    &Step { name: "words", about: "names and texts use the field's terms", group: None, run: words::check },
    &Step {
        name: "links",
        about: "relative links in Markdown files lead to files and headings",
        group: None,
        run: links::check,
    },
    &Step {
        name: "translations",
        about: "translated files have the headings, tables, code and links of their originals",
        group: None,
        run: translations::check,
    },
    &Step {
        name: "clippy",
        about: "cargo clippy --all-targets -- -D warnings, the studio without its window",
        group: None,
        run: || {
            let flags = "--all-targets --features orogen-bench/peers -- -D warnings";
            sh(&mut cargo(&format!("clippy --quiet {LIBRARIES} {flags}")))
        },
    },
    &Step { name: "tests", about: "cargo test, the studio without its window", group: None, run: tests },
    &Step { name: "features", about: "the libraries without files and threads", group: None, run: features },
    &Step {
        name: "adding",
        about: "a noise, a filter, a format and a preset, added to a copy",
        group: None,
        run: adding::check,
    },
    &Step { name: "licences", about: "every dependency has a licence we accept", group: None, run: licences::check },
    &Step {
        name: "package",
        about: "every crate compiles from its own published archive, and is documented",
        group: None,
        run: package::check,
    },
];

/// Runs the checks, or the long tests.
pub fn run(args: &[String]) -> Result {
    if let [first, names @ ..] = args
        && first == "--long"
    {
        return match names {
            [] => long(None),
            [name] if !name.starts_with('-') => long(Some(name)),
            _ => Err(Failure::usage("expected --long [NAME]")),
        };
    }
    steps::run("cargo xtask test", STEPS, args)
}

/// Runs all ignored tests, without doctests, where `ignore` marks code that is not meant to run.
fn long(name: Option<&str>) -> Result {
    reasons()?;
    // Not with `--lib` and `--bins`: they compile the tests of targets with `test = false`, too, which have none.
    let targets = format!("test {LIBRARIES} --tests --examples");
    let with = |more: &[&str]| {
        let mut command = cargo(&targets);
        command.arg("--").args(name).arg("--ignored").args(more);
        command
    };
    let listed = shell::capture(&mut with(&["--list"]))?;
    let tests: Vec<&str> = listed.lines().filter_map(|line| line.strip_suffix(": test")).collect();
    if tests.is_empty() {
        return Err(Failure::new(match name {
            Some(name) => format!("no long test has a name that contains '{name}'"),
            None => "there are no long tests".to_owned(),
        }));
    }
    println!("{} long tests:", tests.len());
    tests.iter().for_each(|test| println!("  {test}"));
    sh(&mut with(&["--nocapture", "--test-threads=1"]))
}

/// Checks that every ignored test is a long one, so that `--long` runs what its help says.
fn reasons() -> Result {
    let listed = shell::capture(shell::program("git").args(["grep", "-n", "#\\[ignore", "--", "crates", "bench"]))?;
    let others: Vec<&str> = listed.lines().filter(|line| !line.contains("#[ignore = \"long: ")).collect();
    match others.is_empty() {
        true => Ok(()),
        false => Err(Failure::new(format!(
            "ignored tests without a reason that begins with `long: `:\n{}",
            others.join("\n")
        ))),
    }
}

/// Runs all tests. Clippy has checked that examples compile, so only those with tests are built.
fn tests() -> Result {
    let scratch = Scratch::new();
    let mut command = cargo(&format!("test {LIBRARIES} --tests"));
    // Not for doctests: they are programs in the temporary folder, and file systems in memory often do not allow
    // execution.
    command.envs(scratch.iter().map(|scratch| ("TMPDIR", scratch.path())));
    sh(&mut command)?;
    sh(&mut cargo(&format!("test {LIBRARIES} --doc")))
}

/// Checks the libraries without files and threads. Except in tests, their code may then not use the standard library's
/// file system: `xtask/no_fs/clippy.toml` lists the disallowed names. `cargo xtask clients wasm` runs the code that is
/// checked here.
fn features() -> Result {
    let mut clippy = cargo("clippy --quiet --package orogen --lib --no-default-features -- -D warnings");
    clippy.arg("-D").arg("clippy::disallowed_types");
    sh(clippy.env("CLIPPY_CONF_DIR", shell::root().join("xtask/no_fs")))
}
