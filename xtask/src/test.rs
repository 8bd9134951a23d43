//! `cargo xtask test`: all tests that need only Rust.

use crate::failure::Result;
use crate::shell::{cargo, run as sh};
use crate::steps::{self, Step};
use crate::{codegen, licences, words};

pub const ABOUT: &str = "run all tests that need only Rust";

pub const HELP: &str = "
Usage: cargo xtask test [STEP...]

Runs the steps in this order, or only those named, and stops at the first failure:

  fmt       every file is formatted
  lists     the generated module and node lists are up to date
  words     names and texts use the field's terms
  clippy    no warning in any target
  tests     unit tests, integration tests, doctests, examples build
  schema    recipes/orogen.schema.json is what `orogen schema` prints
  docs      the libraries' documentation builds without a warning
  licences  every dependency has a licence we accept

Needs only Rust and, the first time, a connection for the crates in Cargo.lock.
";

const STEPS: &[&Step] = &[
    &Step { name: "fmt", about: "cargo fmt --all --check", run: || sh(&mut cargo("fmt --all --check")) },
    &Step { name: "lists", about: "the generated module and node lists are up to date", run: || codegen::lists(true) },
    &Step { name: "words", about: "names and texts use the field's terms", run: words::check },
    &Step {
        name: "clippy",
        about: "cargo clippy --workspace --all-targets -- -D warnings",
        run: || sh(&mut cargo("clippy --quiet --workspace --all-targets --features orogen-bench/peers -- -D warnings")),
    },
    &Step { name: "tests", about: "cargo test --workspace", run: || sh(&mut cargo("test --workspace")) },
    &Step {
        name: "schema",
        about: "recipes/orogen.schema.json is what `orogen schema` prints",
        run: || codegen::written(true),
    },
    &Step { name: "docs", about: "the libraries' documentation builds without a warning", run: docs },
    &Step { name: "licences", about: "every dependency has a licence we accept", run: licences::check },
];

/// Runs the checks.
pub fn run(args: &[String]) -> Result {
    steps::run("cargo xtask test", STEPS, args)
}

/// Without the binary `orogen`, whose pages would overwrite those of the library of the same name.
fn docs() -> Result {
    let mut command =
        cargo("doc --quiet --workspace --no-deps --exclude orogen-cli --exclude orogen-bench --exclude xtask");
    sh(command.env("RUSTDOCFLAGS", "-D warnings"))
}
