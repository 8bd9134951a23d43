//! Object stores: moto's, and one of the tests that fails now and then.

use crate::failure::Result;
use crate::shell::{cargo, run as sh};

/// The packages of the release build, with object stores and the server.
pub const BUILT: &str =
    "--package orogen-cli --package orogen-py --package orogen-c --features orogen-cli/remote,orogen-cli/serve";

/// The tests with the store that fails, and clippy: they compile the clients of stores and the libraries again.
pub fn check_faults() -> Result {
    let stores =
        "--package orogen-remote --package orogen-cli --package orogen --features orogen-cli/remote,orogen/remote";
    sh(&mut cargo(&format!("clippy --quiet {stores} --lib --bins --test remote -- -D warnings")))?;
    sh(&mut cargo("test --quiet --package orogen-remote"))?;
    sh(&mut cargo("test --quiet --package orogen --features remote --test remote"))
}
