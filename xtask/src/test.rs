//! `cargo xtask test`: all tests that need only Rust.

use crate::failure::Result;
use crate::shell::{self, cargo, run as sh};
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
  features  what is off by default: no warning, unit tests and doctests
  schema    crates/orogen-engine/recipes/orogen.schema.json is what `orogen schema` prints
  docs      the libraries' documentation builds without a warning
  licences  every dependency has a licence we accept
  package   every crate builds from its own published archive

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
    &Step { name: "features", about: "orogen-grid with ndarray, image and mint", run: features },
    &Step {
        name: "schema",
        about: "crates/orogen-engine/recipes/orogen.schema.json is what `orogen schema` prints",
        run: || codegen::written(true),
    },
    &Step { name: "docs", about: "the libraries' documentation builds without a warning", run: docs },
    &Step { name: "licences", about: "every dependency has a licence we accept", run: licences::check },
    &Step { name: "package", about: "every crate builds from its own published archive", run: package },
];

/// Runs the checks.
pub fn run(args: &[String]) -> Result {
    steps::run("cargo xtask test", STEPS, args)
}

/// A step of its own: other features of the whole workspace would have everything compiled twice.
fn features() -> Result {
    let grid = "--package orogen-grid --all-features";
    sh(&mut cargo(&format!("clippy --quiet {grid} --all-targets -- -D warnings")))?;
    sh(&mut cargo(&format!("test --quiet {grid} --lib interop")))?;
    sh(&mut cargo(&format!("test --quiet {grid} --doc")))
}

/// Without the binary `orogen`, whose pages would overwrite those of the library of the same name.
fn docs() -> Result {
    let mut command =
        cargo("doc --quiet --workspace --no-deps --exclude orogen-cli --exclude orogen-bench --exclude xtask");
    sh(command.env("RUSTDOCFLAGS", "-D warnings"))
}

/// Packs every crate as it would be published and builds it from that archive alone, without optimisation: paths that lead out of a
/// crate's folder, and files that are missing in it, fail here.
fn package() -> Result {
    let mut command = cargo("package --quiet --workspace --exclude xtask --exclude orogen-bench --allow-dirty");
    command.arg("--target-dir").arg(shell::target_dir().join("packages"));
    sh(command.env("CARGO_PROFILE_DEV_OPT_LEVEL", "0").env("CARGO_PROFILE_DEV_DEBUG", "false"))
}
