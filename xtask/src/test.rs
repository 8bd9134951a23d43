//! `cargo xtask test`: all tests that need only Rust.

use crate::failure::{Failure, Result};
use crate::shell::{self, cargo, run as sh};
use crate::steps::{self, Step};
use crate::{codegen, licences, links, package, translations, words};
use std::process::Command;

pub const ABOUT: &str = "run all tests that need only Rust";

pub const HELP: &str = "
Usage: cargo xtask test [STEP...]
       cargo xtask test --long [NAME]

Runs the steps in this order, or only those named, and stops at the first failure:

  fmt           every file is formatted
  lists         the generated module and node lists are up to date
  words         names and texts use the field's terms
  links         relative links in Markdown files lead to files, and their anchors to headings
  translations  translated files have the headings, tables, code and links of their originals
  clippy        no warning in any target
  tests         unit tests, integration tests, doctests, examples build; of the studio what needs no window
  features      what is off by default: no warning, unit tests and doctests; the libraries without files and threads
  docs          the libraries' documentation builds without a warning
  licences      every dependency has a licence we accept
  package       every crate compiles from its own published archive

With --long, it runs the long tests instead, one at a time: all tests of the workspace that are marked as ignored, with a reason
that begins with `long: `, or those whose name contains NAME. All together take hours.

Needs only Rust and, the first time, a connection for the crates in Cargo.lock.
";

/// The whole workspace; the studio without its window, which its default features are. Two commands, one for the studio, would select other features of the
/// libraries and compile them twice. So the default features of all others are named.
const PACKAGES: &str = "--workspace --exclude orogen-gpu --no-default-features \
    --features orogen/default,orogen-engine/default,orogen-io/default,orogen-output/default";

const STEPS: &[&Step] = &[
    &Step { name: "fmt", about: "cargo fmt --all --check", group: None, run: || sh(&mut cargo("fmt --all --check")) },
    &Step {
        name: "lists",
        about: "the generated module and node lists are up to date",
        group: None,
        run: || codegen::lists(true),
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
            sh(&mut cargo(&format!("clippy --quiet {PACKAGES} {flags}")))
        },
    },
    &Step {
        name: "tests",
        about: "cargo test, the studio without its window",
        group: None,
        run: || sh(&mut cargo(&format!("test {PACKAGES}"))),
    },
    &Step {
        name: "features",
        about: "orogen-grid with ndarray, image and mint; orogen without files and threads",
        group: None,
        run: features,
    },
    &Step { name: "docs", about: "the libraries' documentation builds without a warning", group: None, run: docs },
    &Step { name: "licences", about: "every dependency has a licence we accept", group: None, run: licences::check },
    &Step {
        name: "package",
        about: "every crate compiles from its own published archive",
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

/// All ignored tests. Without doctests, where `ignore` marks code that is not meant to run.
fn long(name: Option<&str>) -> Result {
    reasons()?;
    let targets = format!("test {PACKAGES} --lib --bins --tests --examples");
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

/// A step of its own: other features of the whole workspace would have everything compiled twice.
fn features() -> Result {
    let grid = "--package orogen-grid --all-features";
    sh(&mut cargo(&format!("clippy --quiet {grid} --all-targets -- -D warnings")))?;
    sh(&mut unoptimised(&format!("test --quiet {grid} --lib interop")))?;
    sh(&mut unoptimised(&format!("test --quiet {grid} --doc")))?;
    without_files()
}

/// What runs for a moment: optimising our crates for it would take longer than all else here.
fn unoptimised(args: &str) -> Command {
    let mut command = cargo(args);
    command.env("CARGO_PROFILE_DEV_OPT_LEVEL", "0");
    command
}

/// Builds the libraries without files and threads. No code of theirs, tests aside, may then name anything of the standard library's file
/// system: `xtask/no_fs/clippy.toml` lists it. A program checks that what needs no file works, and what names one is an error.
fn without_files() -> Result {
    let mut clippy = cargo("clippy --quiet --package orogen --lib --no-default-features -- -D warnings");
    clippy.arg("-D").arg("clippy::disallowed_types");
    sh(clippy.env("CLIPPY_CONF_DIR", shell::root().join("xtask/no_fs")))?;
    sh(&mut unoptimised("run --quiet --package orogen-engine --example without_files --no-default-features"))
}

/// Without the binary `orogen`, whose pages would overwrite those of the library of the same name, and without the studio.
fn docs() -> Result {
    let mut command = cargo(
        "doc --quiet --workspace --no-deps --exclude orogen-cli --exclude orogen-studio --exclude orogen-gpu \
        --exclude orogen-bench --exclude orogen-fuzz-targets --exclude xtask",
    );
    sh(command.env("RUSTDOCFLAGS", "-D warnings"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn default_features_of_all_crates_but_the_studio_are_named() {
        let crates = std::fs::read_dir(shell::root().join("crates")).expect("the crates");
        let folders = crates
            .map(|entry| entry.expect("an entry").path())
            .chain(["bench", "xtask"].map(|name| shell::root().join(name)));
        let found: BTreeSet<String> = folders
            .filter(|folder| shell::read(&folder.join("Cargo.toml")).is_ok_and(|text| text.contains("\ndefault = [")))
            .map(|folder| format!("{}/default", folder.file_name().expect("a name").to_string_lossy()))
            .filter(|feature| feature != "orogen-studio/default" && feature != "orogen-gpu/default")
            .collect();
        let (_, named) = PACKAGES.split_once("--features ").expect("features");
        assert_eq!(named.split(',').map(str::to_owned).collect::<BTreeSet<_>>(), found);
    }
}
